// How far sending has come, over all photographs of this visit.
import { useRef } from 'preact/hooks';
import { texts } from '../texts';
import type { Upload } from '../upload_queue';

export function UploadProgress({ uploads }: { uploads: readonly Upload[] }) {
  const sent = useRef(new Set<number>()); // arrived ones leave the list
  const started = useRef(new Set<number>());
  for (const upload of uploads) {
    started.current.add(upload.key);
    if (upload.state === 'sent') sent.current.add(upload.key);
  }
  const current = uploads.find((u) => u.state === 'sending');
  const open = uploads.some((u) => u.state === 'queued' || u.state === 'sending' || u.state === 'pausing');
  if (!open) {
    sent.current.clear();
    started.current.clear();
    return null;
  }
  const [done, all] = [sent.current.size, started.current.size];
  return (
    <div class="upload-progress">
      <progress max={all} value={done + (current?.share ?? 0)} aria-label={texts.photographsPage.progress(done, all)} />
      <span>{texts.photographsPage.progress(done, all)}</span>
    </div>
  );
}

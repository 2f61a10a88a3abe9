// All photographs of a capture: those on their way first, then those that have arrived, the latest first.
import { useEffect } from 'preact/hooks';
import type { Photograph } from '../api';
import type { Upload, UploadQueue } from '../upload_queue';
import { PhotographTile } from './photograph_tile';
import { UploadTile } from './upload_tile';

interface ListProps {
  photographs: Photograph[];
  queue: UploadQueue;
  uploads: readonly Upload[];
  onLeaveOut?: (photograph: Photograph, leftOut: boolean) => void;
  onSelect?: (id: string | null) => void;
}

export function PhotographList({ photographs, queue, uploads, onLeaveOut, onSelect }: ListProps) {
  const there = new Map(photographs.map((p) => [p.id, p]));
  const arrived = (upload: Upload) => upload.state === 'sent' && upload.id !== null && there.has(upload.id);
  // A local preview goes once the server's thumbnail can be shown in its place.
  useEffect(() => {
    for (const upload of uploads) if (arrived(upload) && there.get(upload.id!)!.thumbnail) queue.remove(upload.key);
  }, [photographs, uploads]);
  const nameOf = (id: string) => there.get(id)?.name ?? '';
  const previews = new Map(uploads.filter(arrived).map((u) => [u.id!, u.preview]));
  const waiting = uploads.filter((u) => !arrived(u));
  const latestFirst = [...photographs].reverse().sort((a, b) => (b.added_s ?? 0) - (a.added_s ?? 0));
  return (
    <ul class="tiles">
      {waiting.map((upload) => (
        <UploadTile key={`upload-${upload.key}`} upload={upload} onRemove={() => queue.remove(upload.key)} onAgain={() => queue.again(upload.key)} />
      ))}
      {latestFirst.map((photograph) => (
        <PhotographTile
          key={photograph.id}
          photograph={photograph}
          preview={previews.get(photograph.id) ?? null}
          nameOf={nameOf}
          onLeaveOut={onLeaveOut && ((leftOut) => onLeaveOut(photograph, leftOut))}
          onHover={onSelect && ((over) => onSelect(over ? photograph.id : null))}
        />
      ))}
    </ul>
  );
}

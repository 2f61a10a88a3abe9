// A photograph on its way to the server: progress, a pause after a lost connection, or why it was not taken.
import { texts } from '../texts';
import type { Upload } from '../upload_queue';
import { Tile } from './photograph_tile';

const t = texts.photographsPage;

function stateText(upload: Upload): string {
  switch (upload.state) {
    case 'sending':
      return t.sending(Math.round(100 * upload.share));
    case 'pausing':
      return t.again(upload.again_s);
    case 'refused':
      return t.refused;
    case 'sent':
      return t.states.waiting;
    default:
      return t.queued;
  }
}

interface UploadTileProps {
  upload: Upload;
  onRemove: () => void;
  onAgain: () => void;
}

export function UploadTile({ upload, onRemove, onAgain }: UploadTileProps) {
  const refused = upload.state === 'refused';
  return (
    <Tile name={upload.name} picture={upload.preview}>
      <p class="tile-state">
        <span class={`badge ${refused ? 'bad' : upload.state === 'pausing' ? 'weak' : upload.state === 'queued' ? 'quiet' : 'busy'}`}>{stateText(upload)}</span>
      </p>
      {upload.state === 'sending' && <progress max={1} value={upload.share} aria-label={upload.name} />}
      {upload.message && <p class="tile-reason sentence">{upload.message}</p>}
      {upload.remedy && <p class="tile-remedy sentence">{upload.remedy}</p>}
      {refused && (
        <p class="tile-actions">
          <button type="button" class="link" onClick={onAgain}>{t.sendAgain}</button>
          <button type="button" class="link" onClick={onRemove}>{t.dismiss}</button>
        </p>
      )}
    </Tile>
  );
}

// The camera and the gallery. Both are file inputs, so that they work without HTTPS.
import { accepted } from '../parts/dropped_files';
import { CameraIcon, PicturesIcon } from '../parts/icons';
import { texts } from '../texts';

const t = texts.phone;

export function TakeButtons({ onFiles }: { onFiles: (files: File[]) => void }) {
  const take = (event: { currentTarget: HTMLInputElement }) => {
    onFiles([...(event.currentTarget.files ?? [])]);
    event.currentTarget.value = '';
  };
  return (
    <div class="take">
      <label class="button primary">
        <CameraIcon />
        {t.take}
        <input class="file" type="file" accept="image/*" capture="environment" onChange={take} />
      </label>
      <label class="button">
        <PicturesIcon />
        {t.gallery}
        <input class="file" type="file" accept={accepted} multiple onChange={take} />
      </label>
    </div>
  );
}

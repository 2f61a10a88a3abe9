// What to set on the phone before the first photograph; folded away for the rest of the visit once understood.
import { useState } from 'preact/hooks';
import { FlashIcon } from '../parts/icons';
import { texts } from '../texts';

const t = texts.phone;
const key = 'glint-reminder';

export function Reminder({ board }: { board: boolean }) {
  const [open, setOpen] = useState(() => sessionStorage.getItem(key) === null);
  if (!open) {
    return (
      <p class="reminder folded">
        <button type="button" class="link with-icon" onClick={() => setOpen(true)}><FlashIcon />{t.flash}</button>
      </p>
    );
  }
  const understood = () => {
    sessionStorage.setItem(key, 'seen');
    setOpen(false);
  };
  return (
    <section class="panel reminder" aria-labelledby="reminder-title">
      <h2 id="reminder-title" class="with-icon"><FlashIcon />{t.reminderTitle}</h2>
      <ul>
        {[...t.reminder, ...(board ? [t.reminderBoard] : [])].map((line) => (
          <li>{line}</li>
        ))}
      </ul>
      <button type="button" class="button wide" onClick={understood}>{t.understood}</button>
    </section>
  );
}

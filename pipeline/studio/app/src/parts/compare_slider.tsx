// Two pictures of the same thing on top of each other, with a divider that a finger, a mouse or the arrow keys move.
import { useState } from 'preact/hooks';
import { texts } from '../texts';

const t = texts.result;

export function CompareSlider({ before, after, name }: { before: string; after: string; name: string }) {
  const [percent, setPercent] = useState(50);
  return (
    <div class="compare">
      <img src={before} alt={`${t.before}: ${name}`} />
      <img src={after} alt={`${t.after}: ${name}`} style={{ clipPath: `inset(0 0 0 ${percent}%)` }} />
      <span class="compare-line" style={{ left: `${percent}%` }} aria-hidden="true" />
      <span class="compare-word left" aria-hidden="true">{t.before}</span>
      <span class="compare-word right" aria-hidden="true">{t.after}</span>
      <input type="range" min={0} max={100} step={1} value={percent} aria-label={t.divider} onInput={(event) => setPercent(Number(event.currentTarget.value))} />
    </div>
  );
}

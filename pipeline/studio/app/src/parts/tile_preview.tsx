// The material repeated side by side, to look for seams.
import { useState } from 'preact/hooks';
import { texts } from '../texts';

const t = texts.result;

export function TilePreview({ url }: { url: string }) {
  const [repeats, setRepeats] = useState(3);
  return (
    <section class="panel" aria-labelledby="tile-title">
      <header>
        <h2 id="tile-title">{t.tile}</h2>
        <label class="inline">
          {t.repeats}
          <input type="range" min={1} max={6} step={1} value={repeats} onInput={(event) => setRepeats(Number(event.currentTarget.value))} />
          <output>{repeats} × {repeats}</output>
        </label>
      </header>
      <p class="quiet">{t.tileText}</p>
      <div class="tile-preview" role="img" aria-label={t.tileAlt} style={{ backgroundImage: `url("${url}")`, backgroundSize: `${100 / repeats}%` }} />
    </section>
  );
}

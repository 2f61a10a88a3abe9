// The maps of the previous run against those of this one.
import { useState } from 'preact/hooks';
import type { ResultMap } from '../api';
import { mapName } from '../format';
import { texts } from '../texts';
import { CompareSlider } from './compare_slider';

const t = texts.result;

export function BeforeAfter({ before, after }: { before: ResultMap[]; after: ResultMap[] }) {
  const pairs = after.flatMap((map) => {
    const old = before.find((m) => m.name === map.name);
    return old ? [{ name: map.name, before: old.url, after: map.url }] : [];
  });
  const [name, setName] = useState(pairs[0]?.name);
  const pair = pairs.find((p) => p.name === name) ?? pairs[0];
  if (!pair) return null;
  return (
    <section class="panel" aria-labelledby="compare-title">
      <header>
        <h2 id="compare-title">{t.compare}</h2>
        <label class="inline">
          {t.compareMap}
          <select value={pair.name} onChange={(event) => setName(event.currentTarget.value)}>
            {pairs.map((p) => (
              <option value={p.name}>{mapName(p.name)}</option>
            ))}
          </select>
        </label>
      </header>
      <p class="quiet">{t.compareText}</p>
      <CompareSlider name={mapName(pair.name)} before={pair.before} after={pair.after} />
    </section>
  );
}

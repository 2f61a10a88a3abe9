// Photographs held out from the fit, ticked in a list; saved as the programs take them: names, separated by commas.
import type { OptionValue, Photograph } from '../api';
import { texts } from '../texts';

const t = texts.run;

interface HeldOutProps {
  photographs: Photograph[];
  value: OptionValue | undefined;
  onSave: (value: OptionValue | null) => void;
}

export function HeldOutField({ photographs, value, onSave }: HeldOutProps) {
  const names = new Set(String(value ?? '').split(',').map((name) => name.trim()).filter(Boolean));
  const usable = photographs.filter((p) => !p.left_out);
  const toggle = (name: string, held: boolean) => {
    if (held) names.add(name);
    else names.delete(name);
    onSave(names.size ? [...names].join(',') : null);
  };
  return (
    <details class="held-out">
      <summary>
        {t.heldOut} <span class="quiet">{names.size ? t.heldOutSome(names.size) : t.heldOutNone}</span>
      </summary>
      <p class="help">{t.heldOutHelp}</p>
      <div class="ticks">
        {usable.map((p) => (
          <label class="tick" key={p.id}>
            <input type="checkbox" checked={names.has(p.name)} onChange={(event) => toggle(p.name, event.currentTarget.checked)} />
            {p.thumbnail && <img src={p.thumbnail} alt="" width="40" height="30" loading="lazy" />}
            {p.name}
          </label>
        ))}
      </div>
    </details>
  );
}

// The options of a run: the few that people need, and behind a fold all others, as the programs describe them.
import { useState } from 'preact/hooks';
import { announce } from '../announce';
import { api, type Capture, type Failure, type OptionDescription, type OptionValue } from '../api';
import { useLive } from '../live';
import { texts } from '../texts';
import { HeldOutField } from './held_out_field';
import { FailureNotice } from './notice';
import { OptionField } from './option_field';

const t = texts.run;
const heldOutName = 'exclude';

interface PanelProps {
  capture: Capture;
  set: (capture: Capture) => void;
  disabled: boolean;
}

export function OptionsPanel({ capture, set, disabled }: PanelProps) {
  const described = useLive(api.options, () => false, 'options');
  const stages = described.data?.stages ?? [];
  const [query, setQuery] = useState('');
  const [failure, setFailure] = useState<Failure | null>(null);
  const save = async (stage: string, name: string, value: OptionValue | null) => {
    try {
      set(await api.saveOptions(capture.id, { [stage]: { [name]: value } }));
      setFailure(null);
      announce(t.saved);
    } catch (error) {
      setFailure(error as Failure);
    }
  };
  const field = (stage: string, option: OptionDescription) => {
    const value = capture.options[stage]?.[option.name];
    const onSave = (next: OptionValue | null) => void save(stage, option.name, next);
    if (option.name === heldOutName) return <HeldOutField key={option.name} photographs={capture.photographs} value={value} onSave={onSave} />;
    const friendly = option.important ? t.friendly[`${stage}.${option.name}`] : undefined;
    return (
      <OptionField key={`${stage}.${option.name}`} label={friendly?.[0] ?? option.name} help={friendly?.[1] || option.help} option={option} value={value} onSave={onSave} />
    );
  };
  const important = stages.flatMap((stage) => stage.options.filter((o) => o.important).map((option) => ({ stage: stage.name, option })));
  const wanted = query.trim().toLowerCase();
  const matching = stages
    .map((stage) => ({
      ...stage,
      options: stage.options.filter((o) => !o.important && (!wanted || o.name.toLowerCase().includes(wanted) || o.help.toLowerCase().includes(wanted))),
    }))
    .filter((stage) => stage.options.length > 0);
  const changed = (stage: string, options: OptionDescription[]) => options.filter((o) => (capture.options[stage]?.[o.name] ?? o.default) !== o.default).length;
  return (
    <fieldset class="panel options" disabled={disabled}>
      <legend>{t.options}</legend>
      <p class="quiet">{t.optionsText}</p>
      {failure && <FailureNotice failure={failure} />}
      {!described.data && (described.failure ? <FailureNotice failure={described.failure} retry={described.reload} /> : <p class="quiet" role="status">{texts.loading}</p>)}
      {important.map(({ stage, option }) => field(stage, option))}
      {stages.length > 0 && <details class="all-options">
        <summary>{t.all}</summary>
        <p class="help">{t.allText}</p>
        <label class="field">
          <span>{t.find}</span>
          <input type="search" value={query} onInput={(event) => setQuery(event.currentTarget.value)} />
        </label>
        {matching.length === 0 && <p class="quiet" role="status">{t.noneFound}</p>}
        {matching.map((stage) => {
          const n = changed(stage.name, stage.options);
          return (
            <details key={stage.name} open={wanted !== '' || undefined}>
              <summary>
                <b>{stage.name}</b> <span class="quiet">{stage.summary}</span> {n > 0 && <span class="badge weak">{t.changed(n)}</span>}
              </summary>
              <div class="option-list">{stage.options.map((option) => field(stage.name, option))}</div>
            </details>
          );
        })}
      </details>}
    </fieldset>
  );
}

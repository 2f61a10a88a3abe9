// One option of a program as a field. What equals the default is not saved, so that capture.toml holds choices only;
// but for the few important ones, which stand there with their value.
import { useEffect, useId, useState } from 'preact/hooks';
import type { OptionDescription, OptionValue } from '../api';
import { texts } from '../texts';

const t = texts.run;

interface OptionFieldProps {
  label: string;
  help: string;
  option: OptionDescription;
  value: OptionValue | undefined; // undefined: the default
  onSave: (value: OptionValue | null) => void;
}

function shown(value: OptionValue | null): string {
  return typeof value === 'boolean' ? (value ? t.on : t.off) : value === null ? '' : String(value);
}

export function OptionField({ label, help, option, value: given, onSave }: OptionFieldProps) {
  const value = given === option.default ? undefined : given;
  const back = () => onSave(option.important ? option.default : null);
  const id = useId();
  const saved = value === undefined ? '' : String(value);
  const [text, setText] = useState(saved);
  useEffect(() => setText(saved), [saved]);
  const save = (next: OptionValue) => (next === option.default ? back() : onSave(next));
  const isNumber = option.type === 'number' || option.type === 'integer';
  const saveText = () => {
    const trimmed = text.trim();
    if (trimmed === saved) return;
    if (trimmed === '') return back();
    // A number input answers '' for what is no number; the server judges ranges.
    save(isNumber ? Number(trimmed) : trimmed);
  };
  const common = { id, 'aria-describedby': help ? `${id}-help` : undefined };
  const reset = value !== undefined && (
    <button type="button" class="link" aria-label={t.resetOf(label)} onClick={back}>{t.reset}</button>
  );
  if (option.type === 'flag') {
    return (
      <div class="field flag">
        <label class="tick" for={id}>
          <input {...common} type="checkbox" checked={Boolean(value ?? option.default ?? false)} onChange={(event) => save(event.currentTarget.checked)} />
          {label}
        </label>
        {help && <p id={`${id}-help`} class="help sentence">{help}</p>}
      </div>
    );
  }
  return (
    <div class={value === undefined ? 'field' : 'field changed'}>
      <label for={id}>{label}</label>
      {option.type === 'choice' ? (
        <select {...common} value={String(value ?? option.default ?? '')} onChange={(event) => save(event.currentTarget.value)}>
          {(option.choices ?? []).map((choice) => (
            <option value={choice}>{choice}</option>
          ))}
        </select>
      ) : (
        <input
          {...common}
          type={isNumber ? 'number' : 'text'}
          step={option.type === 'integer' ? 1 : 'any'}
          min={option.low}
          max={option.high}
          inputMode={isNumber ? 'decimal' : undefined}
          autocomplete="off"
          spellcheck={false}
          placeholder={shown(option.default)}
          value={text}
          onInput={(event) => setText(event.currentTarget.value)}
          onBlur={saveText}
          onKeyDown={(event) => event.key === 'Enter' && saveText()}
        />
      )}
      {(help || reset) && (
        <p class="help sentence">
          {help && <span id={`${id}-help`}>{help} </span>}
          {reset}
        </p>
      )}
    </div>
  );
}

// A labelled input with its help and its error.
import { useId } from 'preact/hooks';

interface NumberFieldProps {
  label: string;
  value: string;
  onInput: (value: string) => void;
  help?: string;
  error?: string | null;
  min?: number;
  max?: number;
  step?: number | 'any';
  required?: boolean;
}

export function NumberField({ label, value, onInput, help, error, min, max, step = 'any', required }: NumberFieldProps) {
  const id = useId();
  return (
    <div class="field">
      <label for={id}>{label}</label>
      <input
        id={id}
        type="number"
        inputMode="decimal"
        value={value}
        min={min}
        max={max}
        step={step}
        required={required}
        aria-invalid={error ? true : undefined}
        aria-describedby={help || error ? `${id}-help` : undefined}
        onInput={(event) => onInput(event.currentTarget.value)}
      />
      {(error || help) && (
        <p id={`${id}-help`} class={error ? 'help error' : 'help'}>
          {error || help}
        </p>
      )}
    </div>
  );
}

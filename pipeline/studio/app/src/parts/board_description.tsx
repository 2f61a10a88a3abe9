// A board that is printed already, as a file or figures describe it; the server reads both alike.
import { useRef, useState } from 'preact/hooks';
import { announce } from '../announce';
import { api, Failure, type Board } from '../api';
import { texts } from '../texts';
import { NumberField } from './field';
import { FailureNotice } from './notice';

const t = texts.create.describe;
const most_bytes = 500_000;
const dictionaries = [
  ...[4, 5, 6, 7].flatMap((bits) => [50, 100, 250, 1000].map((size) => `DICT_${bits}X${bits}_${size}`)),
  'DICT_ARUCO_ORIGINAL', 'DICT_APRILTAG_16h5', 'DICT_APRILTAG_25h9', 'DICT_APRILTAG_36h10', 'DICT_APRILTAG_36h11',
];

type Figure = 'columns' | 'rows' | 'square' | 'marker' | 'windowColumn' | 'windowRow' | 'windowColumns' | 'windowRows';

// As glint init assumes them.
const usual: Record<Figure, string> = { columns: '13', rows: '17', square: '15', marker: '11', windowColumn: '3', windowRow: '5', windowColumns: '7', windowRows: '7' };

function Figures({ onDescription }: { onDescription: (description: string) => void }) {
  const [kind, setKind] = useState<'charuco' | 'checkerboard'>('charuco');
  const [figures, setFigures] = useState(usual);
  const [dictionary, setDictionary] = useState('DICT_5X5_1000');
  const [legacy, setLegacy] = useState(false);
  const [window, setWindow] = useState(false);
  const charuco = kind === 'charuco';
  const field = (name: Figure, help?: string) => (
    <NumberField label={t[name]} value={figures[name]} onInput={(value) => setFigures((all) => ({ ...all, [name]: value }))} help={help} min={0} />
  );
  const number = (name: Figure) => Number(figures[name]);
  const description = () => JSON.stringify({
    glint_board: 1,
    kind,
    squares: [number('columns'), number('rows')],
    square_mm: number('square'),
    ...(charuco ? { marker_mm: number('marker'), dictionary, legacy_layout: legacy } : {}),
    ...(charuco && window ? { window: [number('windowColumn'), number('windowRow'), number('windowColumns'), number('windowRows')] } : {}),
  });
  return (
    <div class="board-figures">
      <label class="field">
        <span>{t.kind}</span>
        <select value={kind} onChange={(event) => setKind(event.currentTarget.value as 'charuco' | 'checkerboard')}>
          <option value="charuco">{t.kinds.charuco}</option>
          <option value="checkerboard">{t.kinds.checkerboard}</option>
        </select>
      </label>
      <div class="pair">{field('columns')}{field('rows')}</div>
      <div class="pair">{field('square', t.squareHelp)}{charuco && field('marker')}</div>
      {charuco && (
        <>
          <label class="field">
            <span>{t.dictionary}</span>
            <select value={dictionary} onChange={(event) => setDictionary(event.currentTarget.value)}>
              {dictionaries.map((name) => <option value={name}>{name}</option>)}
            </select>
          </label>
          <label class="tick"><input type="checkbox" checked={legacy} onChange={(event) => setLegacy(event.currentTarget.checked)} />{t.legacy}</label>
          <label class="tick"><input type="checkbox" checked={window} onChange={(event) => setWindow(event.currentTarget.checked)} />{t.window}</label>
          {window && <div class="pair">{field('windowColumn')}{field('windowRow')}{field('windowColumns')}{field('windowRows')}</div>}
        </>
      )}
      <button type="button" class="button" onClick={() => onDescription(description())}>{t.save}</button>
    </div>
  );
}

export function BoardDescription({ onBoard }: { onBoard: (board: Board) => void }) {
  const input = useRef<HTMLInputElement>(null);
  const [failure, setFailure] = useState<Failure | null>(null);
  const take = async (name: string, description: string) => {
    try {
      const board = await api.describeBoard(name, description);
      setFailure(null);
      announce(t.taken(board.name));
      onBoard(board);
    } catch (error) {
      setFailure(error as Failure);
    }
  };
  const takeFile = async (file: File | undefined) => {
    if (!file) return;
    if (file.size > most_bytes) setFailure(new Failure(0, t.tooLarge, t.tooLargeRemedy));
    else await take(file.name, await file.text());
  };
  return (
    <div class="board-description">
      <div class="actions">
        <button type="button" class="button" aria-describedby="board-file-help" onClick={() => input.current?.click()}>{t.file}</button>
      </div>
      <input
        ref={input}
        class="file"
        type="file"
        accept=".json,.toml"
        aria-label={t.file}
        tabIndex={-1}
        onChange={(event) => {
          const chosen = event.currentTarget;
          void takeFile(chosen.files?.[0]);
          chosen.value = ''; // the same file may be chosen again
        }}
      />
      <p id="board-file-help" class="help">{t.fileHelp}</p>
      {failure && <FailureNotice failure={failure} />}
      <details>
        <summary>{t.figures}</summary>
        <Figures onDescription={(description) => void take('', description)} />
      </details>
    </div>
  );
}

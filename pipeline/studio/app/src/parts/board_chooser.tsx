// The printed board of a capture: one that was kept, or a new one made for a paper size and printed from its PDF.
import { useId, useState } from 'preact/hooks';
import { announce } from '../announce';
import { api, type Board, type Failure } from '../api';
import { texts } from '../texts';
import { OutIcon } from './icons';
import { NumberField } from './field';
import { FailureNotice } from './notice';

const t = texts.create;

function Ruler({ board, onChange }: { board: Board; onChange: (board: Board) => void }) {
  const [value, setValue] = useState('');
  const [failure, setFailure] = useState<Failure | null>(null);
  if (board.ruler_mm === null) return null;
  const save = async () => {
    const length = Number(value);
    if (!(length > 0)) return;
    try {
      onChange(await api.measureBoard(board.id, length));
      setFailure(null);
      setValue('');
      announce(t.rulerSaved);
    } catch (error) {
      setFailure(error as Failure);
    }
  };
  return (
    <div class="ruler">
      <NumberField label={t.ruler} value={value} onInput={setValue} help={t.rulerHelp(board.ruler_mm)} min={1} max={2000} />
      <button type="button" class="button" disabled={!(Number(value) > 0)} onClick={save}>{t.rulerSave}</button>
      {failure && <FailureNotice failure={failure} />}
    </div>
  );
}

interface ChooserProps {
  boards: Board[];
  chosen: string | null;
  onChoose: (id: string | null) => void;
  onBoard: (board: Board) => void;
}

export function BoardChooser({ boards, chosen, onChoose, onBoard }: ChooserProps) {
  const group = useId();
  const [paper, setPaper] = useState('A4');
  const [adding, setAdding] = useState(false);
  const [busy, setBusy] = useState(false);
  const [failure, setFailure] = useState<Failure | null>(null);
  const board = boards.find((b) => b.id === chosen) ?? null;
  const make = async () => {
    setBusy(true);
    try {
      const made = await api.makeBoard(paper);
      onBoard(made);
      onChoose(made.id);
      setAdding(false);
      setFailure(null);
      announce(t.boardMade(made.name));
    } catch (error) {
      setFailure(error as Failure);
    }
    setBusy(false);
  };
  const printing = adding || boards.length === 0;
  return (
    <fieldset class="panel">
      <legend>{t.board}</legend>
      <p class="quiet">{t.boardHelp}</p>
      {boards.length > 0 && (
        <div class="choices" role="radiogroup" aria-label={t.boardKept}>
          {boards.map((b) => (
            <label class="choice">
              <input type="radio" name={group} checked={b.id === chosen} onChange={() => onChoose(b.id)} />
              <span>
                <b>{b.name}</b>
                <small>
                  {[b.paper, t.window(b.window_mm[0], b.window_mm[1]), b.ruler_measured_mm ? t.rulerIs(b.ruler_measured_mm) : null].filter(Boolean).join(' · ')}
                </small>
              </span>
            </label>
          ))}
        </div>
      )}
      {printing ? (
        <div class="new-board">
          <label class="field">
            <span>{t.paper}</span>
            <select value={paper} onChange={(event) => setPaper(event.currentTarget.value)}>
              {t.papers.map((name) => (
                <option value={name}>{name}</option>
              ))}
            </select>
          </label>
          <button type="button" class="button" disabled={busy} onClick={make}>{t.makeBoard}</button>
        </div>
      ) : (
        <button type="button" class="link" onClick={() => setAdding(true)}>{t.boardNew}</button>
      )}
      {failure && <FailureNotice failure={failure} />}
      {board && (
        <div class="board-chosen">
          <a class="button" href={api.boardPdf(board.id)} target="_blank" rel="noopener">
            <OutIcon />
            {t.printPdf}
          </a>
          <Ruler key={board.id} board={board} onChange={onBoard} />
        </div>
      )}
    </fieldset>
  );
}

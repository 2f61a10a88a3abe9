// The printed board of a capture: one that Studio knows, one that a file or figures describe, or a new one made for a paper size and printed
// from its PDF.
import { useId, useState } from 'preact/hooks';
import { announce } from '../announce';
import { api, type Board, type Failure, type Size } from '../api';
import { texts } from '../texts';
import { BoardDescription } from './board_description';
import { OutIcon } from './icons';
import { NumberField } from './field';
import { FailureNotice } from './notice';

const t = texts.create;

// What the sheet's ruler measured; null: it was not measured, or is as its label says.
function measuredRuler({ ruler_mm, print_scale = 1 }: Board): number | null {
  return ruler_mm === null || Math.abs(print_scale - 1) < 1e-6 ? null : Math.round(10 * ruler_mm) / 10;
}

// What is chosen while the board is not described yet.
export const toDescribe = 'describe';

export function boardFacts(board: Board): string {
  const measured = measuredRuler(board);
  return [
    t.boardKnown[board.name],
    board.paper || (board.squares[0] > 0 ? t.squares(board.squares[0], board.squares[1], board.square_mm) : board.words), // of a capture: its sheet is not known
    board.window_mm && t.window(board.window_mm[0], board.window_mm[1]),
    measured !== null && t.rulerIs(measured),
  ].filter(Boolean).join(' · ');
}

function Ruler({ board, onChange }: { board: Board; onChange: (board: Board) => void }) {
  const measured = String(measuredRuler(board) ?? '');
  const [value, setValue] = useState(measured);
  const [failure, setFailure] = useState<Failure | null>(null);
  if (board.ruler_mm === null) return null;
  const save = async () => {
    const length = Number(value);
    if (!(length > 0)) return;
    try {
      onChange(await api.measureBoard(board.id, length));
      setFailure(null);
      announce(t.rulerSaved);
    } catch (error) {
      setFailure(error as Failure);
    }
  };
  return (
    <div class="ruler">
      <NumberField label={t.ruler} value={value} onInput={setValue} help={t.rulerHelp(Math.round((10 * board.ruler_mm) / (board.print_scale ?? 1)) / 10)} min={1} max={2000} />
      <button type="button" class="button" disabled={!(Number(value) > 0) || value === measured} onClick={save}>{t.rulerSave}</button>
      {failure && <FailureNotice failure={failure} />}
    </div>
  );
}

interface ChooserProps {
  boards: Board[];
  chosen: string | null; // null: a new one, made with the capture or before it; or toDescribe
  onChoose: (id: string | null) => void;
  onBoard: (board: Board) => void;
  paper: string;
  onPaper: (paper: string) => void;
  size: Size | null; // that the window must hold
}

export function BoardChooser({ boards, chosen, onChoose, onBoard, paper, onPaper, size }: ChooserProps) {
  const group = useId();
  const [busy, setBusy] = useState(false);
  const [failure, setFailure] = useState<Failure | null>(null);
  const board = boards.find((b) => b.id === chosen) ?? null;
  const isNew = board === null && chosen !== toDescribe;
  const make = async () => {
    if (!size) return;
    setBusy(true);
    try {
      const made = await api.makeBoard(paper, size);
      onBoard(made);
      onChoose(made.id);
      setFailure(null);
      announce(t.boardMade(made.name));
    } catch (error) {
      setFailure(error as Failure);
    }
    setBusy(false);
  };
  return (
    <fieldset class="panel">
      <legend>{t.board}</legend>
      <p class="quiet">{t.boardHelp}</p>
      <div class="choices">
        {boards.map((b) => (
          <label class="choice" key={b.id}>
            <input type="radio" name={group} checked={b.id === chosen} onChange={() => onChoose(b.id)} />
            <span>
              <b>{b.name}</b>
              <small>{boardFacts(b)}</small>
            </span>
          </label>
        ))}
        <label class="choice">
          <input type="radio" name={group} checked={chosen === toDescribe} onChange={() => onChoose(toDescribe)} />
          <span>
            <b>{t.boardOther}</b>
            <small>{t.boardOtherText}</small>
          </span>
        </label>
        <label class="choice">
          <input type="radio" name={group} checked={isNew} onChange={() => onChoose(null)} />
          <span>
            <b>{t.boardNew}</b>
            <small>{t.boardNewText}</small>
          </span>
        </label>
      </div>
      {chosen === toDescribe && (
        <BoardDescription
          onBoard={(described) => {
            onBoard(described);
            onChoose(described.id);
          }}
        />
      )}
      {isNew && (
        <div class="new-board">
          <label class="field">
            <span>{t.paper}</span>
            <select value={paper} onChange={(event) => onPaper(event.currentTarget.value)}>
              {t.papers.map((name) => (
                <option value={name}>{name}</option>
              ))}
            </select>
          </label>
          <button type="button" class="button" disabled={busy || !size} onClick={make}>{t.makeBoard}</button>
        </div>
      )}
      {failure && <FailureNotice failure={failure} />}
      {board && (board.pdf !== false || board.ruler_mm !== null) && (
        <div class="board-chosen">
          {board.pdf !== false && (
            <a class="button" href={api.boardPdf(board.id)} target="_blank" rel="noopener">
              <OutIcon />
              {t.printPdf}
            </a>
          )}
          <Ruler key={board.id} board={board} onChange={onBoard} />
        </div>
      )}
    </fieldset>
  );
}

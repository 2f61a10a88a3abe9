// The board of a capture: what it is, and the way to another.
import { useState } from 'preact/hooks';
import { announce } from '../announce';
import { api, type Board, type Capture, type Failure } from '../api';
import { texts } from '../texts';
import { boardFacts } from './board_chooser';
import { ChangeBoard } from './change_board';
import { FailureNotice } from './notice';
import { OfferedBoards } from './offered_boards';

const t = texts.photographsPage;

interface CaptureBoardProps {
  capture: Capture;
  set: (capture: Capture) => void;
}

// A photograph that was checked and shows no board of the capture's.
const lacksBoard = (capture: Capture) => {
  const checked = capture.photographs.filter((p) => p.state !== 'waiting' && p.state !== 'checking');
  return checked.some((p) => p.board_found) ? 0 : checked.length;
};

// Above the photographs, where the capture's board is in none of them.
export function OtherBoard({ capture, set }: CaptureBoardProps) {
  const [chosen, setChosen] = useState<Board | null>(null);
  const [open, setOpen] = useState(false);
  const [failure, setFailure] = useState<Failure | null>(null);
  const without = lacksBoard(capture);
  const use = async (board: Board) => {
    try {
      set(await api.setBoard(capture.id, board.id));
      setFailure(null);
      announce(t.boardChanged);
    } catch (error) {
      // The window is smaller than the sample, say.
      setFailure(error as Failure);
      setChosen(board);
      setOpen(true);
    }
  };
  if (!failure && without === 0 && !open) return null;
  return (
    <div class="other-board">
      {failure && <FailureNotice failure={failure} />}
      {without > 0 && <OfferedBoards id={capture.id} photographs={without} onUse={use} onOther={() => setOpen(true)} />}
      {open && <ChangeBoard capture={capture} board={chosen ?? capture.board ?? null} onChanged={(changed) => { setFailure(null); set(changed); }} onClose={() => setOpen(false)} />}
    </div>
  );
}

export function CaptureBoard({ capture, set }: CaptureBoardProps) {
  const [open, setOpen] = useState(false);
  const board = capture.board ?? null;
  if (!board) return null;
  return (
    <section class="capture-board" aria-label={t.board}>
      <p class="quiet">{t.boardIs} {board.name ? <><b>{board.name}</b>, {boardFacts(board)}</> : board.words}</p>
      <button type="button" class="link" onClick={() => setOpen(true)}>{t.changeBoard}</button>
      {open && <ChangeBoard capture={capture} board={board} onChanged={set} onClose={() => setOpen(false)} />}
    </section>
  );
}

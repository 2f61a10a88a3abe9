// Another board for a capture that is there, and the sample's size where the other window wants it.
import { useEffect, useState } from 'preact/hooks';
import { announce } from '../announce';
import { api, type Board, type Capture, type Failure, type Size } from '../api';
import { useLive } from '../live';
import { texts } from '../texts';
import { BoardChooser } from './board_chooser';
import { Dialog } from './dialog';
import { NumberField } from './field';
import { FailureNotice } from './notice';

const t = texts.photographsPage;

interface ChangeBoardProps {
  capture: Capture;
  board: Board | null; // chosen as the dialog opens
  onChanged: (capture: Capture) => void;
  onClose: () => void;
}

const fits = ([width, height]: Size, window: Size | null) => window === null || (width <= window[0] + 0.05 && height <= window[1] + 0.05);

export function ChangeBoard({ capture, board: first, onChanged, onClose }: ChangeBoardProps) {
  const kept = useLive(api.boards, () => false, 'boards');
  const [chosen, setChosen] = useState<string | null>(first?.id || null);
  const [paper, setPaper] = useState('A4');
  const [width, setWidth] = useState(String(capture.size_mm?.[0] ?? 100));
  const [height, setHeight] = useState(String(capture.size_mm?.[1] ?? 100));
  const [failure, setFailure] = useState<Failure | null>(null);
  const [busy, setBusy] = useState(false);
  const boards = kept.data?.boards ?? [];
  const board = boards.find((b) => b.id === chosen) ?? null;
  const size: Size = [Number(width) || 0, Number(height) || 0];
  const sized = size[0] >= 1 && size[1] >= 1;
  const opening = board?.window_mm ?? null;
  useEffect(() => {
    if (first && kept.data && !boards.some((b) => b.id === first.id)) setChosen(boards.find((b) => b.words === first.words)?.id ?? null);
  }, [kept.data]);

  const take = (changed: Board) => {
    const known = boards.some((b) => b.id === changed.id);
    kept.set({ boards: known ? boards.map((b) => (b.id === changed.id ? changed : b)) : [...boards, changed] });
    if (!known) setChosen(changed.id);
  };
  const use = async () => {
    if (!board) return;
    setBusy(true);
    try {
      onChanged(await api.setBoard(capture.id, board.id, size));
      announce(t.boardChanged);
      onClose();
    } catch (error) {
      setFailure(error as Failure);
      setBusy(false);
    }
  };
  return (
    <Dialog title={t.changeBoard} onClose={onClose}>
      <div class="stack">
        <p>{t.boardChange}</p>
        <BoardChooser boards={boards} chosen={chosen} onChoose={setChosen} onBoard={take} paper={paper} onPaper={setPaper} size={sized ? size : null} />
        <fieldset class="panel">
          <legend>{texts.create.sample}</legend>
          <div class="pair">
            <NumberField label={texts.create.width} value={width} onInput={setWidth} min={1} max={2000} />
            <NumberField label={texts.create.height} value={height} onInput={setHeight} min={1} max={2000} />
          </div>
          {!fits(size, opening) && <p class="help error" role="status">{texts.create.tooLarge(opening![0], opening![1])}</p>}
        </fieldset>
        {failure && <FailureNotice failure={failure} />}
        <div class="actions stay">
          <button type="button" class="button primary" disabled={!board || !sized || busy} onClick={use}>{t.useBoard}</button>
          <button type="button" class="button" onClick={onClose}>{texts.cancel}</button>
        </div>
      </div>
    </Dialog>
  );
}

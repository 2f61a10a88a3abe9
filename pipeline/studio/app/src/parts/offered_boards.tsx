// Where the capture's board is in no photograph: the boards that Studio knows and that are, one press away.
import { api, type Board } from '../api';
import { useLive } from '../live';
import { texts } from '../texts';
import { boardFacts } from './board_chooser';
import { Notice } from './notice';

const t = texts.photographsPage;

interface OfferedProps {
  id: string;
  photographs: number; // checked so far
  onUse: (board: Board) => void;
  onOther: () => void;
}

export function OfferedBoards({ id, photographs, onUse, onOther }: OfferedProps) {
  const tried = Math.min(photographs, 3); // more are not looked at
  const shown = useLive(() => api.boardsShown(id), (change) => change.what === 'library', `${id} ${tried}`).data;
  if (!shown) return null;
  const { another, boards } = shown;
  const other = <button type="button" class="button small" onClick={onOther}>{t.chooseBoard}</button>;
  if (boards.length === 0) return another && <Notice tone="warning" title={t.noOtherBoard}>{other}</Notice>;
  return (
    <Notice tone="warning" title={t.otherBoards(boards.length)} urgent>
      <ul class="offered">
        {boards.map((board) => (
          <li key={board.id}>
            <span>
              <b>{board.name}</b>
              <small>{boardFacts(board)}</small>
            </span>
            <button type="button" class="button small primary" aria-label={t.useBoardNamed(board.name)} onClick={() => onUse(board)}>{t.useBoard}</button>
          </li>
        ))}
      </ul>
      <p class="small">{t.otherBoardsText}</p>
      {other}
    </Notice>
  );
}

// The sample to scale: from above, in its board if there is one, and from the side with its thickness. Follows the numbers typed.
import type { Board, Size } from '../api';
import { texts } from '../texts';

const t = texts.create;

interface DrawingProps {
  size: Size;
  board: Board | null;
  paper: string | null; // of a board that is still to be made
  height_mm: number | null; // of the surface above the board; null: unknown
  pictureWidth_mm: number | null; // set for one photograph without a board
}

const papers_mm: Record<string, Size> = { A3: [297, 420], A4: [210, 297], A5: [148, 210], Letter: [215.9, 279.4], Legal: [215.9, 355.6], Tabloid: [279.4, 431.8] };

const width = 320;
const planHeight = 250;
const sideHeight = 62;
const labelWidth = 52; // of the height beside the drawing, which stays in the middle

// The squares of the frame; every second one is black.
function Squares({ board }: { board: Board }) {
  const [columns, rows] = board.squares;
  const s = board.square_mm;
  const [windowWidth, windowHeight] = board.window_mm ?? [0, 0];
  const black: string[] = [];
  for (let row = 0; row < rows; ++row) {
    for (let column = 0; column < columns; ++column) {
      if ((row + column) % 2) continue;
      const [x, y] = [(column - columns / 2) * s, (row - rows / 2) * s];
      if (Math.abs(x + s / 2) < windowWidth / 2 && Math.abs(y + s / 2) < windowHeight / 2) continue;
      black.push(`M${x} ${y}h${s}v${s}h${-s}z`);
    }
  }
  return <path class="draw-squares" d={black.join('')} />;
}

function Arrow({ from, to, label, vertical }: { from: number; to: number; label: string; vertical?: boolean }) {
  const middle = (from + to) / 2;
  return vertical ? (
    <g class="draw-arrow">
      <path d={`M0 ${from}V${to}M-3 ${from}h6M-3 ${to}h6`} />
      <text x={7} y={middle + 4}>{label}</text>
    </g>
  ) : (
    <g class="draw-arrow">
      <path d={`M${from} 0H${to}M${from} -3v6M${to} -3v6`} />
      <text x={middle} y={-6} text-anchor="middle">{label}</text>
    </g>
  );
}

// What becomes maps of one photograph: the largest square that stays clear of its borders.
function SquareIn({ side }: { side: number }) {
  return (
    <>
      <rect class="draw-sample" x={-side / 2} y={-side / 2} width={side} height={side} />
      <text class="draw-on-sample" y={4} text-anchor="middle">{t.becomesMaps}</text>
    </>
  );
}

function SideView({ size, board, height_mm, scale }: { size: Size; board: Board | null; height_mm: number | null; scale: number }) {
  const half = (size[0] / 2) * scale;
  const thick = height_mm === null ? 8 : Math.max(-18, Math.min(26, height_mm * scale));
  const window = board?.window_mm ? (board.window_mm[0] / 2) * scale : half + 8;
  return (
    <g transform={`translate(${width / 2} ${planHeight + 44})`}>
      <path class="draw-table" d={`M${-width / 2 + 16} 8H${width / 2 - 16}`} />
      <rect class="draw-sample" x={-half} y={Math.min(7 - thick, 6)} width={2 * half} height={Math.max(thick, 2)} />
      {board && <path class="draw-paper" d={`M${-width / 2 + 30} 7H${-window}M${window} 7H${width / 2 - 30}`} />}
      {height_mm !== null && (
        <g transform={`translate(${half + 8} 0)`}>
          <text class="draw-text" x={0} y={2 - thick / 2 + 5}>{texts.mm(height_mm)}</text>
        </g>
      )}
      <text class="draw-note" x={-width / 2 + 16} y={22}>{t.sideView}</text>
    </g>
  );
}

export function SampleDrawing({ size, board, paper, height_mm, pictureWidth_mm }: DrawingProps) {
  const sheet: Size | null = board ? (papers_mm[board.paper] ?? [board.squares[0] * board.square_mm, board.squares[1] * board.square_mm]) : (papers_mm[paper ?? ''] ?? null);
  const picture: Size | null = pictureWidth_mm === null ? null : [pictureWidth_mm, 0.75 * pictureWidth_mm];
  const extent: Size = [
    Math.max(size[0], sheet?.[0] ?? 0, picture?.[0] ?? 0),
    Math.max(size[1], sheet?.[1] ?? 0, picture?.[1] ?? 0),
  ];
  const scale = Math.min((width - 2 * labelWidth) / extent[0], (planHeight - 56) / extent[1]);
  const [w, h] = [size[0] * scale, size[1] * scale];
  const label = picture
    ? t.drawingSingle(pictureWidth_mm!)
    : t.drawing(size[0], size[1], height_mm) + (board || paper ? t.drawingOnBoard(board?.paper ?? paper!) : '');
  return (
    <figure class="sample-drawing">
      <svg viewBox={`0 0 ${width} ${planHeight + (picture ? 0 : sideHeight + 16)}`} role="img" aria-label={label}>
        <g transform={`translate(${width / 2} ${planHeight / 2 + 6})`}>
          {sheet && <rect class="draw-sheet" x={(-sheet[0] / 2) * scale} y={(-sheet[1] / 2) * scale} width={sheet[0] * scale} height={sheet[1] * scale} />}
          {board && (
            <g transform={`scale(${scale})`}>
              <Squares board={board} />
            </g>
          )}
          {board?.window_mm && <rect class="draw-window" x={(-board.window_mm[0] / 2) * scale} y={(-board.window_mm[1] / 2) * scale} width={board.window_mm[0] * scale} height={board.window_mm[1] * scale} />}
          {picture && <rect class="draw-frame" x={(-picture[0] / 2) * scale} y={(-picture[1] / 2) * scale} width={picture[0] * scale} height={picture[1] * scale} />}
          {picture && <SquareIn side={0.9 * picture[1] * scale} />}
          {!picture && <rect class="draw-sample" x={-w / 2} y={-h / 2} width={w} height={h} />}
          <g transform={`translate(0 ${(-extent[1] / 2) * scale - 8})`}>
            {picture ? <Arrow from={(-picture[0] / 2) * scale} to={(picture[0] / 2) * scale} label={texts.mm(pictureWidth_mm!)} /> : <Arrow from={-w / 2} to={w / 2} label={texts.mm(size[0])} />}
          </g>
          {!picture && (
            <g transform={`translate(${(extent[0] / 2) * scale + 8} 0)`}>
              <Arrow from={-h / 2} to={h / 2} label={String(size[1])} vertical />
            </g>
          )}
        </g>
        {!picture && <SideView size={size} board={board} height_mm={height_mm} scale={scale} />}
      </svg>
    </figure>
  );
}

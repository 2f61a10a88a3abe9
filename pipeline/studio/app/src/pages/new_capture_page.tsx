// A new capture: usable as it opens (name, kind and size are filled in), with everything else below.
import { useEffect, useState } from 'preact/hooks';
import { api, type Board, type Failure, type Kind } from '../api';
import { useLive } from '../live';
import { BoardChooser, toDescribe } from '../parts/board_chooser';
import { NumberField } from '../parts/field';
import { PageHeading } from '../parts/heading';
import { FailureNotice } from '../parts/notice';
import { SampleDrawing } from '../parts/sample_drawing';
import { go, links } from '../router';
import { texts } from '../texts';

const t = texts.create;
const kinds = ['board', 'single'] as const satisfies readonly Kind[];

// "Sample 1" becomes the folder Sample_1, which is the capture's name from then on.
const folderName = (name: string) => name.toLocaleLowerCase('en').replace(/[^\p{L}\p{N}]+/gu, '_');

function unusedName(taken: string[]): string {
  const names = new Set(taken.map(folderName));
  for (let n = 1; ; ++n) if (!names.has(folderName(t.firstName(n)))) return t.firstName(n);
}

const sizeError = (text: string) => (Number(text) >= 1 && Number(text) <= 2000 ? null : t.badSize);

export function NewCapturePage() {
  const library = useLive(api.library, () => false, 'library').data;
  const kept = useLive(api.boards, (change) => change.what === 'library', 'boards');
  const [name, setName] = useState<string | null>(null);
  const [kind, setKind] = useState<(typeof kinds)[number]>('board');
  const [width, setWidth] = useState('100');
  const [height, setHeight] = useState('100');
  const [thickness, setThickness] = useState<'auto' | 'given'>('auto');
  const [height_mm, setHeightMm] = useState('0');
  const [pictureWidth, setPictureWidth] = useState('120');
  const [chosen, setChosen] = useState<string | null | undefined>(undefined);
  const [paper, setPaper] = useState('A4');
  const [busy, setBusy] = useState(false);
  const [failure, setFailure] = useState<Failure | null>(null);

  const boards = kept.data?.boards ?? [];
  const board = kind === 'board' ? (boards.find((b) => b.id === chosen) ?? null) : null;
  useEffect(() => {
    if (chosen === undefined && kept.data) setChosen(boards.find((b) => !b.known)?.id ?? null);
  }, [kept.data]);
  const title = name ?? (library ? unusedName(library.captures.map((c) => c.name)) : '');
  const size: [number, number] = [Number(width) || 0, Number(height) || 0];
  const single = kind === 'single';
  const valid = title.trim() !== '' && (single ? !sizeError(pictureWidth) : !sizeError(width) && !sizeError(height) && chosen !== toDescribe);
  const drawn: [number, number] = [Math.min(Math.max(size[0], 1), 2000), Math.min(Math.max(size[1], 1), 2000)];
  const opening = board?.window_mm ?? null;
  const tooLarge = opening !== null && (size[0] > opening[0] || size[1] > opening[1]);

  const replaceBoard = (changed: Board) => {
    const known = boards.some((b) => b.id === changed.id);
    kept.set({ boards: known ? boards.map((b) => (b.id === changed.id ? changed : b)) : [...boards, changed] });
    if (!known) setChosen(changed.id); // made, or the measured copy of a capture's board
  };

  const create = async (event: Event) => {
    event.preventDefault();
    if (!valid || busy) return;
    setBusy(true);
    try {
      let boardId = board?.id ?? null;
      if (kind === 'board' && boardId === null) {
        const made = await api.makeBoard(paper, size);
        replaceBoard(made); // should the capture be refused, the board is there already
        boardId = made.id;
      }
      const { id } = await api.makeCapture({
        name: title.trim(),
        kind,
        size_mm: single ? null : size,
        height_mm: kind === 'board' && thickness === 'given' ? Number(height_mm) || 0 : 'auto',
        board: boardId,
        ...(single ? { picture_width_mm: Number(pictureWidth) } : {}),
      });
      go(links.step(id, 'photographs'));
    } catch (error) {
      setFailure(error as Failure);
      setBusy(false);
    }
  };

  return (
    <form class="new-capture" onSubmit={create} noValidate>
      <PageHeading title={t.title} />
      <div class="columns">
        <div class="stack">
          <div class="panel">
            <div class="field">
              <label for="name">{t.name}</label>
              <input id="name" type="text" maxLength={80} autocomplete="off" value={title} aria-describedby="name-help" onInput={(event) => setName(event.currentTarget.value)} />
              <p id="name-help" class="help">{t.nameHelp}</p>
            </div>
          </div>
          <fieldset class="panel">
            <legend>{t.kind}</legend>
            <div class="choices">
              {kinds.map((k) => (
                <label class="choice">
                  <input type="radio" name="kind" checked={k === kind} onChange={() => setKind(k)} />
                  <span>
                    <b>{t.kindNames[k]}</b>
                    <small>{t.kindTexts[k]}</small>
                  </span>
                </label>
              ))}
            </div>
            <p class="help">{t.otherKinds}</p>
          </fieldset>
          <fieldset class="panel">
            <legend>{t.sample}</legend>
            {single ? (
              <NumberField label={t.pictureWidth} value={pictureWidth} onInput={setPictureWidth} help={t.pictureWidthHelp} error={sizeError(pictureWidth)} min={1} max={2000} />
            ) : (
              <div class="pair">
                <NumberField label={t.width} value={width} onInput={setWidth} error={sizeError(width)} min={1} max={2000} />
                <NumberField label={t.height} value={height} onInput={setHeight} error={sizeError(height)} min={1} max={2000} />
              </div>
            )}
            {tooLarge && <p class="help error" role="status">{t.tooLarge(opening[0], opening[1])}</p>}
            {kind === 'board' && (
              <fieldset class="plain">
                <legend>{t.thickness}</legend>
                <label class="tick">
                  <input type="radio" name="thickness" checked={thickness === 'auto'} onChange={() => setThickness('auto')} />
                  {t.thicknessAuto}
                </label>
                <label class="tick">
                  <input type="radio" name="thickness" checked={thickness === 'given'} onChange={() => setThickness('given')} />
                  {t.thicknessGiven}
                </label>
                {thickness === 'given' && <NumberField label={t.thicknessMm} value={height_mm} onInput={setHeightMm} help={t.thicknessHelp} min={-50} max={50} />}
              </fieldset>
            )}
          </fieldset>
          {kind === 'board' && <BoardChooser boards={boards} chosen={chosen ?? null} onChoose={setChosen} onBoard={replaceBoard} paper={paper} onPaper={setPaper} size={!sizeError(width) && !sizeError(height) ? size : null} />}
        </div>
        <div class="stack sticky">
          <div class="panel">
            <SampleDrawing
              size={drawn}
              board={board}
              paper={kind === 'board' && chosen !== toDescribe ? paper : null}
              height_mm={kind === 'board' && thickness === 'given' ? Number(height_mm) || 0 : null}
              pictureWidth_mm={single ? Math.min(Math.max(Number(pictureWidth) || 0, 1), 2000) : null}
            />
          </div>
          {failure && <FailureNotice failure={failure} />}
          <div class="actions">
            <button type="submit" class="button primary wide" disabled={!valid || busy}>{t.create}</button>
            <a class="button" href={links.library}>{texts.cancel}</a>
          </div>
        </div>
      </div>
    </form>
  );
}

// Photographs of a capture: adding them, their verdicts, and what to shoot next.
import { useEffect, useRef, useState } from 'preact/hooks';
import { announce } from '../announce';
import { api, type Failure, type Photograph } from '../api';
import { AdvicePanel } from '../parts/advice';
import { CaptureBoard, OtherBoard } from '../parts/capture_board';
import { DropArea } from '../parts/drop_area';
import { OutIcon, PhoneIcon } from '../parts/icons';
import { FailureNotice, Notice } from '../parts/notice';
import { PhonePanel } from '../parts/phone_panel';
import { PhotographList } from '../parts/photograph_list';
import { UploadProgress } from '../parts/upload_progress';
import { links } from '../router';
import { texts } from '../texts';
import { useUploads } from '../use_uploads';
import type { StepProps } from './capture_page';

const t = texts.photographsPage;

// Says each verdict as it comes, not those that were there when the page opened.
function useVerdictsSpoken(photographs: Photograph[]): void {
  const known = useRef<Map<string, string> | null>(null);
  useEffect(() => {
    const before = known.current;
    known.current = new Map(photographs.map((p) => [p.id, p.state]));
    if (!before) return;
    const news = photographs.filter((p) => p.state !== 'waiting' && p.state !== 'checking' && before.get(p.id) !== p.state);
    if (news.length) announce(news.map((p) => t.arrived(p.name, [t.states[p.state], p.reason].filter(Boolean).join(', '))).join('. '));
  }, [photographs]);
}

const hasProblem = (p: Photograph) => p.left_out || p.state === 'bad' || p.state === 'weak';

export function PhotographsStep({ capture, reload, set }: StepProps) {
  const { queue, uploads } = useUploads(api.photographsPath(capture.id));
  const [phone, setPhone] = useState(false);
  const [selected, setSelected] = useState<string | null>(null);
  const [onlyProblems, setOnlyProblems] = useState(false);
  const [failure, setFailure] = useState<Failure | null>(null);
  queue.limit_bytes = capture.limits?.photograph_bytes ?? Infinity;
  useVerdictsSpoken(capture.photographs);

  const leaveOut = async (photograph: Photograph, left_out: boolean) => {
    set({ ...capture, photographs: capture.photographs.map((p) => (p.id === photograph.id ? { ...p, left_out } : p)) });
    try {
      await api.leaveOut(capture.id, photograph.id, left_out);
      announce((left_out ? t.isLeftOut : t.isTakenBack)(photograph.name));
      setFailure(null);
    } catch (error) {
      setFailure(error as Failure);
    }
    reload();
  };

  const { photographs } = capture;
  const imported = capture.kind === 'rectified';
  const advised = capture.kind === 'board' || capture.advice.target !== null || (!imported && capture.advice.sentence !== '');
  const leftOut = photographs.filter((p) => p.left_out).length;
  const problems = photographs.filter(hasProblem).length;
  const shown = onlyProblems && problems > 0 ? photographs.filter(hasProblem) : photographs;
  return (
    <div class="columns photographs">
      {capture.board && <OtherBoard capture={capture} set={set} />}
      <div class="stack">
        {imported && <Notice title={t.imported} />}
        {!imported && <DropArea onFiles={(files) => queue.add(files)}>
          <button type="button" class="button primary" onClick={() => setPhone(true)}><PhoneIcon />{t.phone}</button>
        </DropArea>}
        <UploadProgress uploads={uploads} />
        {failure && <FailureNotice failure={failure} />}
        {(!imported || photographs.length > 0) && <div class="list-head">
          <h2>{photographs.length ? t.list(photographs.length, leftOut) : uploads.length ? t.title : t.none}</h2>
          {problems > 0 && (
            <label class="tick">
              <input type="checkbox" checked={onlyProblems} onChange={(event) => setOnlyProblems(event.currentTarget.checked)} />
              {t.showBad}
            </label>
          )}
        </div>}
        {photographs.length === 0 && uploads.length === 0 && !imported && (
          <div class="stack start">
            {capture.board?.pdf && (
              <Notice title={t.printFirst}>
                <a class="button small" href={api.boardPdf(capture.board.id)} target="_blank" rel="noopener"><OutIcon />{texts.create.printPdf}</a>
              </Notice>
            )}
            <p class="quiet">{capture.kind === 'board' ? t.noneText : t.noneTextNoBoard}</p>
          </div>
        )}
        <PhotographList photographs={shown} queue={queue} uploads={uploads} onLeaveOut={leaveOut} onSelect={setSelected} />
      </div>
      <div class="stack sticky first-on-phone">
        {advised && <AdvicePanel advice={capture.advice} photographs={photographs} selected={selected} directions={capture.kind === 'board'} />}
        <CaptureBoard capture={capture} set={set} />
        {(photographs.length > 0 || imported) && (
          <a class={capture.advice.enough ? 'button primary wide' : 'button wide'} href={links.step(capture.id, 'run')}>{t.goRun}</a>
        )}
      </div>
      {phone && <PhonePanel id={capture.id} kept={capture.phone ?? null} onClose={() => setPhone(false)} />}
    </div>
  );
}

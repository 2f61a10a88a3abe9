// Runs a capture: a quick look or the maps, with progress, cancelling, and what to do where a stage failed.
import { useEffect, useRef, useState } from 'preact/hooks';
import { announce } from '../announce';
import { api, type Failure, type Run } from '../api';
import { FailureNotice, Notice } from '../parts/notice';
import { OptionsPanel } from '../parts/options_panel';
import { StageList } from '../parts/stage_list';
import { links } from '../router';
import { texts } from '../texts';
import type { StepProps } from './capture_page';

const t = texts.run;

// Says when a stage begins and how the run ends, not every percent.
function useRunSpoken(run: Run | null): void {
  const stage = run?.stages.find((s) => s.state === 'running')?.name ?? null;
  const before = useRef(run?.state);
  useEffect(() => {
    if (run?.state === 'running' && stage) announce(t.stageNames[stage] ?? stage);
  }, [stage]);
  useEffect(() => {
    if (before.current === 'running' && run?.state === 'done') announce(t.finished(run.quick));
    before.current = run?.state;
  }, [run?.state]);
}

export function RunStep({ capture, reload, set }: StepProps) {
  const [busy, setBusy] = useState(false);
  const [failure, setFailure] = useState<Failure | null>(null);
  const { run, result } = capture;
  useRunSpoken(run);
  const running = run?.state === 'running';
  const none = capture.kind !== 'rectified' && !capture.photographs.some((p) => !p.left_out);
  const act = async (action: () => Promise<unknown>) => {
    setBusy(true);
    try {
      await action();
      setFailure(null);
    } catch (error) {
      setFailure(error as Failure);
    }
    setBusy(false);
    reload();
  };
  return (
    <div class="columns">
      <div class="stack sticky">
        {none && !result && (
          <Notice title={capture.photographs.length ? t.allLeftOut : t.noPhotographs}>
            <a class="button small" href={links.step(capture.id, 'photographs')}>{capture.photographs.length ? t.seePhotographs : t.toPhotographs}</a>
          </Notice>
        )}
        {capture.status === 'out of date' && !running && <Notice tone="warning" title={t.outOfDate} />}
        {run?.state === 'failed' && <Notice tone="error" urgent title={<><b>{t.failed}.</b> {run.message || t.noMessage}</>} remedy={run.message ? run.remedy : t.noMessageRemedy} />}
        {run?.state === 'cancelled' && <Notice title={t.cancelled} />}
        {run?.state === 'done' && result && (
          <Notice tone="good" title={t.finished(run.quick)}>
            <a class="button small primary" href={links.step(capture.id, 'result')}>{t.showResult}</a>
          </Notice>
        )}
        {failure && <FailureNotice failure={failure} />}
        {running ? (
          <div class="panel run-now">
            <h2>{t.running(run.quick)}</h2>
            <button type="button" class="button danger" disabled={busy} onClick={() => act(() => api.cancel(capture.id))}>{t.cancel}</button>
          </div>
        ) : (
          <div class="run-choices">
            <div class="panel">
              <h2>{t.quick}</h2>
              <p class="quiet">{t.quickText}</p>
              <button type="button" class="button" disabled={busy || none} onClick={() => act(() => api.run(capture.id, true))}>{t.quick}</button>
            </div>
            <div class="panel">
              <h2>{t.full}</h2>
              <p class="quiet">{t.fullText}</p>
              <button type="button" class="button primary" disabled={busy || none} onClick={() => act(() => api.run(capture.id, false))}>
                {result && !result.quick ? t.fullAgain : t.full}
              </button>
            </div>
          </div>
        )}
        {run && <StageList run={run} />}
      </div>
      <div class="stack">
        <OptionsPanel capture={capture} set={set} disabled={running} />
      </div>
    </div>
  );
}

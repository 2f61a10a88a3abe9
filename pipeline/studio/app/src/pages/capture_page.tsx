// One capture: its name, the three steps, and the step that is shown.
import { useState } from 'preact/hooks';
import { api, type Capture } from '../api';
import { captureFacts } from '../format';
import { useLive } from '../live';
import { StatusBadge } from '../parts/badge';
import { PageHeading } from '../parts/heading';
import { BackIcon } from '../parts/icons';
import { FailureNotice, Notice } from '../parts/notice';
import { links, type Step } from '../router';
import { texts } from '../texts';
import { PhotographsStep } from './photographs_step';
import { ResultStep } from './result_step';
import { RunStep } from './run_step';

const steps: Step[] = ['photographs', 'run', 'result'];

// Where a capture opens: at what it needs next.
function usualStep(capture: Capture): Step {
  if (capture.status === 'running' || capture.status === 'failed') return 'run';
  return capture.result && capture.status === 'done' ? 'result' : 'photographs';
}

export interface StepProps {
  capture: Capture;
  reload: () => void;
  set: (capture: Capture) => void;
}

export function CapturePage({ id, step }: { id: string; step: Step | null }) {
  // Events about photographs may name the photograph; every one is answered with the capture as it is.
  const { data: capture, failure, reload, set } = useLive(() => api.capture(id), (change) => change.what !== 'library' || change.id === id, id);
  const [opened, setOpened] = useState<Step | null>(null);
  if (!capture) {
    return failure ? (
      <>
        <PageHeading title={texts.product} />
        <FailureNotice failure={failure} retry={reload} />
        <p><a href={links.library}>{texts.errors.toLibrary}</a></p>
      </>
    ) : (
      <p class="quiet loading" role="status">{texts.loading}</p>
    );
  }
  if (step === null && opened === null) setOpened(usualStep(capture)); // stays there while the status changes
  const shown = step ?? opened ?? usualStep(capture);
  const Page = shown === 'run' ? RunStep : shown === 'result' ? ResultStep : PhotographsStep;
  return (
    <>
      <nav class="back"><a href={links.library}><BackIcon />{texts.library.title}</a></nav>
      <div class="page-head">
        <div>
          <PageHeading title={capture.name} />
          <p class="quiet">{captureFacts(capture, capture.photographs.length)}</p>
        </div>
        <StatusBadge status={capture.status} photographs={capture.photographs.length} />
      </div>
      <nav class="steps" aria-label={texts.steps.label}>
        {steps.map((s) => (
          <a href={links.step(id, s)} aria-current={s === shown ? 'page' : undefined}>{texts.steps[s]}</a>
        ))}
      </nav>
      {failure && failure.status !== 0 && <FailureNotice failure={failure} retry={reload} />}
      {capture.problem && (
        <Notice tone="error" urgent title={capture.problem.message} remedy={capture.problem.remedy}>
          <button type="button" class="button small" onClick={reload}>{texts.retry}</button>
        </Notice>
      )}
      {(!capture.problem || shown === 'result') && <Page capture={capture} reload={reload} set={set} />}
    </>
  );
}

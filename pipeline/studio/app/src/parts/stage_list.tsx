// The stages of a run, each with its state and progress.
import type { Run } from '../api';
import { duration } from '../format';
import { texts } from '../texts';
import { CheckIcon, CrossIcon } from './icons';

const t = texts.run;

export function StageList({ run }: { run: Run }) {
  const running = run.state === 'running';
  return (
    <section class="panel" aria-labelledby="stages-title">
      <header>
        <h2 id="stages-title">{t.stages}</h2>
        {running && run.remaining_s !== null && <span class="quiet">{t.left(duration(run.remaining_s))}</span>}
      </header>
      {running && <progress class="overall" max={1} value={run.share ?? undefined} aria-label={t.running(run.quick)} />}
      <ol class="stages">
        {run.stages.map((stage) => (
          <li key={stage.name} class={`stage ${stage.state.replace(/ /g, '-')}`}>
            <span class="stage-mark" aria-hidden="true">
              {stage.state === 'done' || stage.state === 'up to date' ? <CheckIcon /> : stage.state === 'failed' ? <CrossIcon /> : null}
            </span>
            <span class="stage-name">{t.stageNames[stage.name] ?? stage.name}</span>
            <span class="stage-state">
              {stage.state === 'running' && stage.share !== null ? t.percent(stage.share) : (t.stageStates[stage.state] ?? stage.state)}
            </span>
          </li>
        ))}
      </ol>
    </section>
  );
}

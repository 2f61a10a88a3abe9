// What to shoot next: one sentence, how to hold the phone, and what is covered so far.
import type { Advice, Photograph } from '../api';
import { texts } from '../texts';
import { VerdictBadge } from './badge';
import { Polar } from './polar';
import { PoseDrawing } from './pose_drawing';

interface AdviceProps {
  advice: Advice;
  photographs: Photograph[];
  selected?: string | null;
  directions?: boolean; // whether photographs have directions: not without a board
  compact?: boolean;
}

export function AdvicePanel({ advice, photographs, selected, directions = true, compact }: AdviceProps) {
  const t = texts.photographsPage;
  const rest = advice.list.filter((line) => line !== advice.sentence);
  return (
    <section class={compact ? 'panel advice compact' : 'panel advice'} aria-labelledby="advice-title">
      <header>
        <h2 id="advice-title">{advice.enough ? t.enough : t.next}</h2>
        {advice.verdict !== 'none' && <VerdictBadge verdict={advice.verdict} />}
      </header>
      <p class="advice-sentence" role="status">{advice.sentence}</p>
      {(directions || advice.target) && (
        <div class="advice-drawings">
          {advice.target && <PoseDrawing target={advice.target} board={directions} />}
          {directions && <Polar photographs={photographs} target={advice.target} selected={selected} />}
        </div>
      )}
      {rest.length > 0 && (
        <details>
          <summary>{t.more}</summary>
          <ul>
            {rest.map((line) => (
              <li>{line}</li>
            ))}
          </ul>
        </details>
      )}
    </section>
  );
}

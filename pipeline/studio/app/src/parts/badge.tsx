// A verdict or a status in a word; colour only repeats what the word says.
import type { Status, Verdict } from '../api';
import { texts } from '../texts';

const statusTones: Record<Status, string> = {
  empty: 'quiet',
  ready: 'quiet',
  running: 'busy',
  done: 'good',
  'out of date': 'weak',
  failed: 'bad',
};
const verdictTones: Record<Verdict, string> = { good: 'good', usable: 'weak', poor: 'bad', none: 'quiet' };

export const StatusBadge = ({ status, photographs }: { status: Status; photographs: number }) => (
  <span class={`badge ${statusTones[status] ?? 'quiet'}`}>{status === 'empty' && photographs > 0 ? texts.allLeftOut : (texts.statuses[status] ?? status)}</span>
);

export const VerdictBadge = ({ verdict }: { verdict: Verdict }) => (
  <span class={`badge ${verdictTones[verdict] ?? 'quiet'}`}>{texts.verdicts[verdict] ?? verdict}</span>
);

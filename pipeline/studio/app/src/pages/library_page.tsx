// All captures of the folder, searched and sorted, with their live status.
import { useMemo, useState } from 'preact/hooks';
import { announce } from '../announce';
import { api, type CaptureRow, type Failure, type Verdict } from '../api';
import { ago, captureFacts } from '../format';
import { useLive } from '../live';
import { StatusBadge, VerdictBadge } from '../parts/badge';
import { Dialog } from '../parts/dialog';
import { PageHeading } from '../parts/heading';
import { PlusIcon, SearchIcon, TrashIcon } from '../parts/icons';
import { FailureNotice } from '../parts/notice';
import { links } from '../router';
import { texts } from '../texts';

const t = texts.library;
type Sort = keyof typeof t.sorts;

const verdictRank: Record<Verdict, number> = { good: 0, usable: 1, poor: 2, none: 3 };
const area = (row: CaptureRow) => (row.size_mm ? row.size_mm[0] * row.size_mm[1] : 0);
const orders: Record<Sort, (a: CaptureRow, b: CaptureRow) => number> = {
  changed: (a, b) => b.changed_s - a.changed_s,
  name: (a, b) => a.name.localeCompare(b.name, 'en', { numeric: true }),
  size: (a, b) => area(b) - area(a),
  photographs: (a, b) => b.photographs - a.photographs,
  verdict: (a, b) => verdictRank[a.verdict] - verdictRank[b.verdict],
};

// Search and order stay while captures are looked at.
let kept: { query: string; sort: Sort } = { query: '', sort: 'changed' };

function Card({ row, onTrash }: { row: CaptureRow; onTrash: () => void }) {
  return (
    <li class="card">
      <a href={links.capture(row.id)} class="card-link">
        <span class="card-picture">{row.thumbnail ? <img src={row.thumbnail} alt="" loading="lazy" decoding="async" /> : <span class="tile-blank" />}</span>
        <span class="card-name">{row.name}</span>
      </a>
      <p class="card-facts">{captureFacts(row, row.photographs)}</p>
      <p class="card-state">
        <StatusBadge status={row.status} photographs={row.photographs} />
        {row.verdict !== 'none' && <VerdictBadge verdict={row.verdict} />}
      </p>
      <p class="card-foot">
        <span>{t.changed(ago(row.changed_s))}</span>
        <button type="button" class="icon-button" title={t.trash} aria-label={t.trashOf(row.name)} onClick={onTrash}>
          <TrashIcon />
        </button>
      </p>
    </li>
  );
}

function TrashDialog({ row, onClose, onDone }: { row: CaptureRow; onClose: () => void; onDone: () => void }) {
  const [failure, setFailure] = useState<Failure | null>(null);
  const running = row.status === 'running';
  const trash = async () => {
    try {
      await api.trash(row.id);
      announce(t.trashed(row.name));
      onDone();
    } catch (error) {
      setFailure(error as Failure);
    }
  };
  return (
    <Dialog title={t.trashTitle(row.name)} onClose={onClose}>
      <p>{running ? t.running : t.trashText}</p>
      {failure && <FailureNotice failure={failure} />}
      <div class="actions end">
        <button type="button" class="button" onClick={onClose}>{texts.cancel}</button>
        <button type="button" class="button danger" disabled={running} onClick={trash}>{t.trash}</button>
      </div>
    </Dialog>
  );
}

function Empty() {
  return (
    <div class="empty">
      <img src="/icon.svg" alt="" width="72" height="72" />
      <h2>{t.emptyTitle}</h2>
      <p>{t.empty}</p>
      <a class="button primary" href={links.new}>{t.first}</a>
    </div>
  );
}

export function LibraryPage() {
  const { data, failure, reload } = useLive(api.library, () => true, 'library');
  const [query, setQuery] = useState(kept.query);
  const [sort, setSort] = useState(kept.sort);
  kept = { query, sort };
  const [trashing, setTrashing] = useState<CaptureRow | null>(null);
  const rows = useMemo(() => {
    const wanted = query.trim().toLocaleLowerCase('en');
    return (data?.captures ?? []).filter((row) => row.name.toLocaleLowerCase('en').includes(wanted)).sort(orders[sort]);
  }, [data, query, sort]);
  const empty = data !== null && data.captures.length === 0;
  return (
    <>
      <div class="page-head">
        <PageHeading title={t.title} />
        {!empty && <a class="button primary" href={links.new}><PlusIcon />{t.new}</a>}
      </div>
      {failure && <FailureNotice failure={failure} retry={reload} />}
      {empty && <Empty />}
      {data && !empty && (
        <>
          <div class="toolbar">
            <label class="search">
              <SearchIcon />
              <span class="hidden">{t.search}</span>
              <input type="search" placeholder={t.search} value={query} onInput={(event) => setQuery(event.currentTarget.value)} />
            </label>
            <label class="inline">
              {t.sort}
              <select value={sort} onChange={(event) => setSort(event.currentTarget.value as Sort)}>
                {Object.entries(t.sorts).map(([key, name]) => (
                  <option value={key}>{name}</option>
                ))}
              </select>
            </label>
            <p class="quiet found" role="status">{t.found(rows.length)}</p>
          </div>
          {rows.length > 0 ? (
            <ul class="cards">
              {rows.map((row) => (
                <Card key={row.id} row={row} onTrash={() => setTrashing(row)} />
              ))}
            </ul>
          ) : (
            <div class="empty small">
              <p>{t.nothing(query)}</p>
              <button type="button" class="button" onClick={() => setQuery('')}>{t.clear}</button>
            </div>
          )}
        </>
      )}
      {trashing && (
        <TrashDialog
          row={trashing}
          onClose={() => setTrashing(null)}
          onDone={() => {
            setTrashing(null);
            reload();
          }}
        />
      )}
    </>
  );
}

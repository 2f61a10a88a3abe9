// Takes photographs with the phone's camera or from its gallery, sends them, and says what to shoot next.
import { useContext, useEffect, useMemo } from 'preact/hooks';
import { Announcer } from '../announce';
import { api } from '../api';
import { Events } from '../events';
import { EventsContext, useLive } from '../live';
import { AdvicePanel } from '../parts/advice';
import { FailureNotice, Notice } from '../parts/notice';
import { PhotographList } from '../parts/photograph_list';
import { UploadProgress } from '../parts/upload_progress';
import { texts } from '../texts';
import { useUploads } from '../use_uploads';
import { Reminder } from './reminder';
import { TakeButtons } from './take_buttons';

const t = texts.phone;
const poll_ms = 5000; // where a phone's browser lets the event stream sleep

const gone = (status: number) => status === 401 || status === 403 || status === 404 || status === 410;

function Photographs({ base }: { base: string }) {
  const { data, failure, reload } = useLive(() => api.phoneState(base), () => true, base);
  const { queue, uploads } = useUploads(`${base}/photographs`);
  const events = useContext(EventsContext);
  const expired = failure !== null && gone(failure.status);
  useEffect(() => {
    if (expired) return events?.close();
    const timer = setInterval(() => document.visibilityState === 'visible' && reload(), poll_ms);
    return () => clearInterval(timer);
  }, [reload, expired]);
  useEffect(() => {
    if (data) document.title = data.name;
  }, [data?.name]);
  if (expired) {
    return (
      <main id="content" class="phone">
        <h1>{t.title}</h1>
        <Notice tone="error" urgent title={<b>{t.expiredTitle}</b>}><p>{t.expired}</p></Notice>
      </main>
    );
  }
  const board = !data?.kind || data.kind === 'board';
  const open = uploads.filter((u) => u.state === 'queued' || u.state === 'sending' || u.state === 'pausing').length;
  const offline = failure?.status === 0 || uploads.some((u) => u.state === 'pausing');
  return (
    <main id="content" class="phone">
      <h1>{data?.name ?? t.title}</h1>
      <Reminder board={board} />
      {offline ? <Notice tone="warning" title={t.offline} /> : failure && <FailureNotice failure={failure} retry={reload} />}
      {data && <AdvicePanel advice={data.advice} photographs={data.photographs} directions={board} compact />}
      <section class="phone-list" aria-labelledby="sent-title">
        <h2 id="sent-title">{t.sent}</h2>
        {data && data.photographs.length === 0 && uploads.length === 0 && <p class="quiet">{t.none}</p>}
        <PhotographList photographs={data?.photographs ?? []} queue={queue} uploads={uploads} />
      </section>
      <div class="phone-bar">
        <UploadProgress uploads={uploads} />
        {open > 0 && <p class="phone-sending">{t.sending(open)}</p>}
        <TakeButtons onFiles={(files) => queue.add(files)} />
      </div>
    </main>
  );
}

export function PhonePage({ base }: { base: string }) {
  const events = useMemo(() => new Events(`${base}/events`), [base]);
  return (
    <EventsContext.Provider value={events}>
      <Photographs base={base} />
      <Announcer />
    </EventsContext.Provider>
  );
}

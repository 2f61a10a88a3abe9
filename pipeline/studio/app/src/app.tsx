// The frame of every page: skip link, header, what is wrong with the folder or the connection, and the page itself.
import { useEffect, useMemo, useState } from 'preact/hooks';
import { Announcer } from './announce';
import { api } from './api';
import { Events } from './events';
import { bytes } from './format';
import { EventsContext, useLive } from './live';
import { CapturePage } from './pages/capture_page';
import { LibraryPage } from './pages/library_page';
import { NewCapturePage } from './pages/new_capture_page';
import { PageHeading } from './parts/heading';
import { Notice } from './parts/notice';
import { links, type Route, useRoute } from './router';
import { texts } from './texts';

const little_bytes = 2e9;

function Page({ route }: { route: Route }) {
  switch (route.page) {
    case 'library':
      return <LibraryPage />;
    case 'new':
      return <NewCapturePage />;
    case 'capture':
      return <CapturePage key={route.id} id={route.id} step={route.step} />;
    default:
      return (
        <>
          <PageHeading title={texts.errors.notFound} />
          <p><a href={links.library}>{texts.errors.toLibrary}</a></p>
        </>
      );
  }
}

function Frame() {
  const route = useRoute();
  const studio = useLive(api.studio, (change) => change.what === 'library', 'studio').data;
  return (
    <>
      <header class="top">
        <a class="brand" href={links.library}>
          <img src="/icon.svg" alt="" width="26" height="26" />
          <span>{texts.product}</span>
        </a>
        {studio && <span class="top-folder" title={studio.folder}>{studio.folder}</span>}
      </header>
      <main id="content">
        {studio?.read_only && <Notice tone="warning" title={texts.errors.readOnly} />}
        {studio && !studio.read_only && studio.free_bytes < little_bytes && <Notice tone="warning" title={texts.errors.littleSpace(bytes(studio.free_bytes))} />}
        <Page route={route} />
      </main>
    </>
  );
}

function LostConnection({ events }: { events: Events }) {
  const [connected, setConnected] = useState(events.connected);
  useEffect(() => events.watch(setConnected), [events]);
  return (
    <div class="lost-region" role="status">
      {!connected && <p class="lost">{texts.errors.lost}</p>}
    </div>
  );
}

export function App() {
  const events = useMemo(() => new Events('/api/events'), []);
  const skip = (event: Event) => {
    event.preventDefault(); // the part behind # is the route
    document.querySelector<HTMLElement>('main h1')?.focus();
  };
  return (
    <EventsContext.Provider value={events}>
      <a class="skip" href="#content" onClick={skip}>{texts.skip}</a>
      <Frame />
      <LostConnection events={events} />
      <Announcer />
    </EventsContext.Provider>
  );
}

// Data that follows the server: loaded once, loaded again when an event concerns it, never twice at the same time.
import { createContext } from 'preact';
import { useCallback, useContext, useEffect, useRef, useState } from 'preact/hooks';
import { type Change, Failure } from './api';
import type { Events } from './events';

export const EventsContext = createContext<Events | null>(null);

export interface Live<T> {
  data: T | null;
  failure: Failure | null;
  reload: () => void;
  set: (data: T) => void;
}

const pause_ms = 120; // events come in bursts; one answer serves them all

export function useLive<T>(load: () => Promise<T>, concerns: (change: Change) => boolean, key: string): Live<T> {
  const events = useContext(EventsContext);
  const [state, setState] = useState<{ key: string; data: T | null; failure: Failure | null }>({ key, data: null, failure: null });
  const loader = useRef(load);
  loader.current = load;
  const filter = useRef(concerns);
  filter.current = concerns;
  const again = useRef<() => void>(() => {});

  useEffect(() => {
    let ended = false;
    let busy = false;
    let stale = false;
    let timer = 0;
    const run = async () => {
      if (busy) {
        stale = true;
        return;
      }
      busy = true;
      do {
        stale = false;
        try {
          const data = await loader.current();
          if (!ended) setState({ key, data, failure: null });
        } catch (error) {
          const failure = error instanceof Failure ? error : new Failure(0, String(error), null);
          if (!ended) setState((old) => ({ key, data: old.key === key ? old.data : null, failure }));
        }
      } while (stale && !ended);
      busy = false;
    };
    const soon = () => {
      clearTimeout(timer);
      timer = window.setTimeout(run, pause_ms);
    };
    again.current = () => void run();
    void run();
    const stop = events?.listen((change) => {
      if (change === 'reconnected' || filter.current(change)) soon();
    });
    return () => {
      ended = true;
      clearTimeout(timer);
      stop?.();
    };
  }, [key, events]);

  const reload = useCallback(() => again.current(), []);
  const set = useCallback((data: T) => setState({ key, data, failure: null }), [key]);
  const current = state.key === key;
  return { data: current ? state.data : null, failure: current ? state.failure : null, reload, set };
}

// Server-sent events: who listens, and whether the connection stands. After a break everybody is told to load again.
import type { Change } from './api';

type Listener = (change: Change | 'reconnected') => void;

export class Events {
  private readonly listeners = new Set<Listener>();
  private readonly watchers = new Set<(connected: boolean) => void>();
  private source: EventSource | null = null;
  private timer = 0;
  private closed = false;
  connected = true;

  constructor(private readonly path: string) {
    this.open();
    addEventListener('pagehide', () => this.source?.close());
    addEventListener('pageshow', (event) => {
      if (event.persisted) this.open();
    });
  }

  listen(listener: Listener): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  watch(watcher: (connected: boolean) => void): () => void {
    this.watchers.add(watcher);
    return () => this.watchers.delete(watcher);
  }

  // For good: the address is no longer served.
  close(): void {
    this.closed = true;
    clearTimeout(this.timer);
    this.source?.close();
  }

  private open(): void {
    if (this.closed) return;
    clearTimeout(this.timer);
    this.source?.close();
    const source = new EventSource(this.path);
    this.source = source;
    source.addEventListener('change', (event) => {
      let change: Change;
      try {
        change = JSON.parse((event as MessageEvent<string>).data) as Change;
      } catch {
        return;
      }
      this.tell(change);
    });
    source.onopen = () => {
      const returned = !this.connected;
      this.report(true);
      if (returned) this.tell('reconnected');
    };
    source.onerror = () => {
      this.report(false);
      // A refused connection is closed for good by the browser; we go on asking.
      if (source.readyState === EventSource.CLOSED && !this.closed) this.timer = window.setTimeout(() => this.open(), 3000);
    };
  }

  private tell(change: Change | 'reconnected'): void {
    for (const listener of [...this.listeners]) listener(change);
  }

  private report(connected: boolean): void {
    if (connected === this.connected) return;
    this.connected = connected;
    for (const watcher of [...this.watchers]) watcher(connected);
  }
}

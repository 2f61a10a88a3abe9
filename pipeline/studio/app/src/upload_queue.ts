// Sends photographs one after the other, with progress. A connection that drops is tried again after a growing pause;
// what the server refuses is kept with its reason. Used by Studio and by the phone's page.
import { Failure, failureOf, requestHeader, type SentPhotograph } from './api';
import { texts } from './texts';

export type UploadState = 'queued' | 'sending' | 'pausing' | 'sent' | 'refused';

export interface Upload {
  key: number;
  file: File;
  name: string;
  preview: string | null; // the local picture, until the server has a thumbnail
  state: UploadState;
  share: number;
  again_s: number;
  message: string | null;
  remedy: string | null;
  id: string | null;
}

const firstPause_s = 1;
const longestPause_s = 20;
const silence_ms = 45_000; // without any progress for so long a connection counts as lost
const progress_ms = 100; // between two reports of progress
const showsInBrowsers = /\.(jpe?g|png|webp|avif|gif)$/i;

export class UploadQueue {
  limit_bytes = Infinity; // of a photograph, as the server says
  private uploads: Upload[] = [];
  private next = 0;
  private busy = false;
  private wake: (() => void) | null = null;
  private readonly watchers = new Set<() => void>();

  constructor(private readonly path: string) {
    const resume = () => this.wake?.();
    addEventListener('online', resume);
    document.addEventListener('visibilitychange', resume);
    addEventListener('beforeunload', (event) => {
      if (this.pending > 0) event.preventDefault();
    });
  }

  get list(): readonly Upload[] {
    return this.uploads;
  }

  get pending(): number {
    return this.uploads.filter((u) => u.state === 'queued' || u.state === 'sending' || u.state === 'pausing').length;
  }

  watch(watcher: () => void): () => void {
    this.watchers.add(watcher);
    return () => this.watchers.delete(watcher);
  }

  add(files: Iterable<File>): number {
    let added = 0;
    for (const file of files) {
      const empty = file.size === 0;
      const large = file.size > this.limit_bytes;
      this.uploads.push({
        key: this.next++,
        file,
        name: file.name,
        preview: !empty && showsInBrowsers.test(file.name) ? URL.createObjectURL(file) : null,
        state: empty || large ? 'refused' : 'queued',
        share: 0,
        again_s: 0,
        message: empty ? texts.photographsPage.empty : large ? texts.photographsPage.tooLarge(Math.floor(this.limit_bytes / 1e6)) : null,
        remedy: large ? texts.photographsPage.tooLargeRemedy : null,
        id: null,
      });
      ++added;
    }
    this.changed();
    void this.work();
    return added;
  }

  remove(key: number): void {
    const upload = this.uploads.find((u) => u.key === key);
    if (!upload || upload.state === 'sending') return;
    if (upload.preview) URL.revokeObjectURL(upload.preview);
    this.uploads = this.uploads.filter((u) => u.key !== key);
    this.changed();
  }

  again(key: number): void {
    this.update(key, { state: 'queued', share: 0, message: null, remedy: null });
    void this.work();
  }

  private changed(): void {
    this.uploads = [...this.uploads];
    for (const watcher of [...this.watchers]) watcher();
  }

  private update(key: number, change: Partial<Upload>): void {
    this.uploads = this.uploads.map((u) => (u.key === key ? { ...u, ...change } : u));
    this.changed();
  }

  private async work(): Promise<void> {
    if (this.busy) return;
    this.busy = true;
    for (;;) {
      const upload = this.uploads.find((u) => u.state === 'queued');
      if (!upload) break;
      await this.sendUntilDone(upload);
    }
    this.busy = false;
  }

  private async sendUntilDone(upload: Upload): Promise<void> {
    const { key } = upload;
    for (let pause_s = firstPause_s; ; pause_s = Math.min(2 * pause_s, longestPause_s)) {
      this.update(key, { state: 'sending', share: 0 });
      try {
        const { id, error } = await this.send(upload);
        if (error !== null || id === null) {
          const [message, ...remedy] = (error ?? texts.photographsPage.refused).split('; ');
          this.update(key, { state: 'refused', message, remedy: remedy.join('; ') || null });
        } else {
          this.update(key, { state: 'sent', share: 1, id });
        }
        return;
      } catch (error) {
        const failure = error as Failure;
        if (!worthTrying(failure.status)) {
          this.update(key, { state: 'refused', message: failure.message, remedy: failure.remedy });
          return;
        }
        await this.pause(key, pause_s);
      }
    }
  }

  private async pause(key: number, pause_s: number): Promise<void> {
    for (let left = pause_s; left > 0; --left) {
      this.update(key, { state: 'pausing', again_s: left });
      const woken = await new Promise<boolean>((done) => {
        const timer = window.setTimeout(() => done(false), 1000);
        this.wake = () => {
          clearTimeout(timer);
          done(true);
        };
      });
      this.wake = null;
      if (woken) return;
    }
  }

  private send(upload: Upload): Promise<SentPhotograph> {
    return new Promise((resolve, reject) => {
      const request = new XMLHttpRequest();
      let watchdog = 0;
      let shown = 0;
      const alive = () => {
        clearTimeout(watchdog);
        watchdog = window.setTimeout(() => request.abort(), silence_ms);
      };
      const lost = () => {
        clearTimeout(watchdog);
        reject(new Failure(0, texts.errors.noAnswer, null));
      };
      request.open('POST', this.path);
      request.setRequestHeader(...requestHeader);
      request.upload.onprogress = (event) => {
        alive();
        if (!event.lengthComputable || performance.now() - shown < progress_ms) return;
        shown = performance.now();
        this.update(upload.key, { share: event.loaded / event.total });
      };
      request.onerror = request.onabort = lost;
      request.onload = () => {
        clearTimeout(watchdog);
        if (request.status === 0) return lost();
        if (request.status >= 300) {
          return reject(failureOf(request.status, request.responseText, texts.errors.status(request.status)));
        }
        try {
          const answer = JSON.parse(request.responseText) as { photographs: SentPhotograph[] };
          resolve(answer.photographs[0]);
        } catch {
          lost();
        }
      };
      alive();
      const body = new FormData();
      body.append('photographs', upload.file, upload.name);
      request.send(body);
    });
  }
}

// Lost connections and servers that are busy or starting; not what is wrong with the photograph itself.
function worthTrying(status: number): boolean {
  return status === 0 || status === 408 || status === 429 || (status >= 500 && status !== 501 && status !== 507);
}

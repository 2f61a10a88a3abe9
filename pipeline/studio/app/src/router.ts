// Where the reader is: the part of the address behind #, so that links, back and reload work.
import { useEffect, useState } from 'preact/hooks';

export type Step = 'photographs' | 'run' | 'result';
export type Route =
  | { page: 'library' }
  | { page: 'new' }
  | { page: 'capture'; id: string; step: Step | null }
  | { page: 'unknown' };

export const links = {
  library: '#/',
  new: '#/new',
  capture: (id: string) => `#/capture/${encodeURIComponent(id)}`,
  step: (id: string, step: Step) => `#/capture/${encodeURIComponent(id)}/${step}`,
};

export function routeOf(hash: string): Route {
  const parts = hash.replace(/^#\/?/, '').split('/').filter(Boolean);
  if (parts.length === 0) return { page: 'library' };
  if (parts[0] === 'new' && parts.length === 1) return { page: 'new' };
  if (parts[0] === 'capture' && parts.length >= 2 && parts.length <= 3) {
    const step = parts[2] ?? null;
    if (step === null || step === 'photographs' || step === 'run' || step === 'result') {
      try {
        return { page: 'capture', id: decodeURIComponent(parts[1]), step };
      } catch {
        return { page: 'unknown' };
      }
    }
  }
  return { page: 'unknown' };
}

export function go(link: string): void {
  location.hash = link;
}

export function useRoute(): Route {
  const [hash, setHash] = useState(location.hash);
  useEffect(() => {
    const changed = () => setHash(location.hash);
    addEventListener('hashchange', changed);
    changed();  // it may have changed before this was listening
    return () => removeEventListener('hashchange', changed);
  }, []);
  return routeOf(hash);
}

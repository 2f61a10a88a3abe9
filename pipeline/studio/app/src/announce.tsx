// One polite live region for the whole page: what a screen reader is told when something has happened.
import { useEffect, useState } from 'preact/hooks';

let speak: (text: string) => void = () => {};

export function announce(text: string): void {
  speak(text);
}

export function Announcer() {
  const [text, setText] = useState('');
  useEffect(() => {
    let timer = 0;
    speak = (next) => {
      setText('');
      clearTimeout(timer);
      timer = window.setTimeout(() => setText(next), 50); // the same text twice is read twice
    };
    return () => {
      speak = () => {};
      clearTimeout(timer);
    };
  }, []);
  return (
    <div class="hidden" role="status" aria-live="polite">
      {text}
    </div>
  );
}

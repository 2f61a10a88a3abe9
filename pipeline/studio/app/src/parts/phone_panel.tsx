// The phone's way in: the code to scan, how long it is valid, a new one, and closing it.
import { useEffect, useState } from 'preact/hooks';
import { announce } from '../announce';
import { api, type Failure, type PhoneLink } from '../api';
import { clock } from '../format';
import { texts } from '../texts';
import { Dialog } from './dialog';
import { FailureNotice } from './notice';

const t = texts.phoneLink;

function useSecondsLeft(ends_ms: number): number {
  const [now, setNow] = useState(Date.now());
  useEffect(() => {
    setNow(Date.now());
    const timer = setInterval(() => setNow(Date.now()), 1000);
    return () => clearInterval(timer);
  }, [ends_ms]);
  return Math.max(0, Math.round((ends_ms - now) / 1000));
}

function Code({ link, ends_ms, onRenew, onStop }: { link: PhoneLink; ends_ms: number; onRenew: () => void; onStop: () => void }) {
  const left = useSecondsLeft(ends_ms);
  const expired = left === 0;
  return (
    <>
      <div class={expired ? 'qr expired' : 'qr'} role="img" aria-label={t.qr} dangerouslySetInnerHTML={{ __html: link.qr_svg }} />
      <p class="centre">{expired ? t.expired : t.expires(clock(left))}</p>
      {!expired && (
        <p class="centre small">
          {t.link} <code class="address">{link.url}</code>
        </p>
      )}
      <div class="actions centre">
        <button type="button" class={expired ? 'button primary' : 'button'} onClick={onRenew}>{t.renew}</button>
        {!expired && <button type="button" class="button" onClick={onStop}>{t.stop}</button>}
      </div>
    </>
  );
}

interface Valid {
  link: PhoneLink;
  ends_ms: number;
}

function fromNow(link: PhoneLink): Valid {
  return { link, ends_ms: link.expires_s > 1e9 ? 1000 * link.expires_s : Date.now() + 1000 * link.expires_s };
}

interface PhonePanelProps {
  id: string;
  kept: PhoneLink | null; // a code that was made before and is valid still
  onClose: () => void;
}

export function PhonePanel({ id, kept, onClose }: PhonePanelProps) {
  const [link, setLink] = useState<Valid | null>(() => kept && fromNow(kept));
  const [failure, setFailure] = useState<Failure | null>(null);
  const open = async () => {
    try {
      setLink(fromNow(await api.openPhone(id)));
      setFailure(null);
    } catch (error) {
      setFailure(error as Failure);
    }
  };
  const stop = async () => {
    try {
      await api.closePhone(id);
      announce(t.stopped);
      onClose();
    } catch (error) {
      setFailure(error as Failure);
    }
  };
  useEffect(() => {
    if (!link) void open();
  }, [id]);
  return (
    <Dialog title={t.title} onClose={onClose}>
      <p>{t.text}</p>
      {failure && <FailureNotice failure={failure} retry={open} />}
      {link ? <Code link={link.link} ends_ms={link.ends_ms} onRenew={open} onStop={stop} /> : !failure && <div class="qr" aria-hidden="true" />}
    </Dialog>
  );
}

// One photograph with its verdict; a bad one with its reason and remedy. Out of a fit does not mean out of the folder.
import type { ComponentChildren } from 'preact';
import { useState } from 'preact/hooks';
import type { Photograph, PhotographState } from '../api';
import { sideOf } from '../format';
import { texts } from '../texts';

const t = texts.photographsPage;

function facts(photograph: Photograph): string {
  const parts: string[] = [];
  if (photograph.tilt_deg !== null && photograph.azimuth_deg !== null) {
    const side = sideOf(photograph as { tilt_deg: number; azimuth_deg: number });
    parts.push(side === null ? t.above : `${t.tilt(photograph.tilt_deg)} ${t.from(side)}`);
  }
  if (photograph.clipped_share !== null && photograph.clipped_share >= 0.02) parts.push(t.clipped(photograph.clipped_share));
  return parts.join(' · ');
}

export function StateBadge({ state }: { state: PhotographState }) {
  const tone = { waiting: 'quiet', checking: 'busy', good: 'good', weak: 'weak', bad: 'bad' }[state] ?? 'quiet';
  return <span class={`badge ${tone}`}>{t.states[state] ?? state}</span>;
}

interface TileProps {
  name: string;
  picture: string | null;
  dimmed?: boolean;
  children: ComponentChildren;
  onHover?: (over: boolean) => void;
}

export function Tile({ name, picture, dimmed, children, onHover }: TileProps) {
  const [broken, setBroken] = useState<string | null>(null); // a picture that the browser cannot show
  return (
    <li class={dimmed ? 'tile dimmed' : 'tile'} onMouseEnter={() => onHover?.(true)} onMouseLeave={() => onHover?.(false)}>
      <div class="tile-picture">{picture && picture !== broken ? <img src={picture} alt="" loading="lazy" decoding="async" onError={() => setBroken(picture)} /> : <span class="tile-blank" aria-hidden="true" />}</div>
      <div class="tile-text">
        <h3 title={name}>{name}</h3>
        {children}
      </div>
    </li>
  );
}

interface PhotographTileProps {
  photograph: Photograph;
  preview: string | null;
  nameOf: (id: string) => string;
  onLeaveOut?: (leftOut: boolean) => void;
  onHover?: (over: boolean) => void;
}

export function PhotographTile({ photograph, preview, nameOf, onLeaveOut, onHover }: PhotographTileProps) {
  const { name, state, left_out, reason, remedy, same_as } = photograph;
  const why = reason ?? (same_as ? t.sameAs(nameOf(same_as)) : null);
  const fact = facts(photograph);
  return (
    <Tile name={name} picture={photograph.thumbnail ?? preview} dimmed={left_out} onHover={onHover}>
      <p class="tile-state">
        <StateBadge state={state} />
        {left_out && <span class="badge quiet">{t.leftOut}</span>}
      </p>
      {fact && <p class="tile-facts">{fact}</p>}
      {why && <p class="tile-reason sentence">{why}</p>}
      {remedy && <p class="tile-remedy sentence">{remedy}</p>}
      {onLeaveOut && state !== 'waiting' && state !== 'checking' && (
        <button type="button" class="link" onClick={() => onLeaveOut(!left_out)} aria-label={left_out ? t.takeBackOf(name) : t.leaveOutOf(name)}>
          {left_out ? t.takeBack : t.leaveOut}
        </button>
      )}
    </Tile>
  );
}

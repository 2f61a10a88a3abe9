// The directions that photographs were taken from, as seen from above the sample: the middle is straight above it, a ring is
// 10° of tilt, the sample's top is up. Sectors with a photograph are tinted; the next one to take is a ring with a cross.
import type { Direction, Photograph } from '../api';
import { nearVertical_deg, sideIndex, sideNames, sideOf } from '../format';
import { texts } from '../texts';

const edge_deg = 50;
const radius = 100;

const scale = (tilt_deg: number) => (Math.min(tilt_deg, edge_deg) / edge_deg) * radius;

function point({ tilt_deg, azimuth_deg }: Direction): [number, number] {
  const angle = (azimuth_deg * Math.PI) / 180;
  const r = scale(tilt_deg);
  return [r * Math.cos(angle), -r * Math.sin(angle)];
}

function sector(index: number): string {
  const [from, to] = [(index - 0.5) * 45, (index + 0.5) * 45];
  const at = (tilt_deg: number, azimuth_deg: number) => point({ tilt_deg, azimuth_deg }).map((v) => v.toFixed(2)).join(' ');
  const inner = scale(nearVertical_deg);
  return `M${at(nearVertical_deg, from)} L${at(edge_deg, from)} A${radius} ${radius} 0 0 0 ${at(edge_deg, to)} L${at(nearVertical_deg, to)} A${inner} ${inner} 0 0 1 ${at(nearVertical_deg, from)}Z`;
}

type Mark = 'good' | 'weak' | 'bad';
const markOf = (photograph: Photograph): Mark | null =>
  photograph.left_out || photograph.state === 'bad' ? 'bad' : photograph.state === 'good' || photograph.state === 'weak' ? photograph.state : null;

function Dot({ mark, x, y, r = 5 }: { mark: Mark; x: number; y: number; r?: number }) {
  if (mark === 'bad') {
    const d = 0.75 * r;
    return <path class="dot bad" d={`M${x - d} ${y - d} ${x + d} ${y + d}M${x + d} ${y - d} ${x - d} ${y + d}`} />;
  }
  return <circle class={`dot ${mark}`} cx={x} cy={y} r={r} />;
}

interface PolarProps {
  photographs: Photograph[];
  target: Direction | null;
  selected?: string | null;
}

export function Polar({ photographs, target, selected }: PolarProps) {
  const seen = photographs.filter((p): p is Photograph & Direction => p.tilt_deg !== null && p.azimuth_deg !== null && markOf(p) !== null);
  const used = seen.filter((p) => markOf(p) !== 'bad');
  const tilted = used.filter((p) => p.tilt_deg >= nearVertical_deg);
  const above = used.length - tilted.length;
  const covered = new Set(tilted.map((p) => sideIndex(p.azimuth_deg)));
  const names = (wanted: boolean) => sideNames.filter((_, index) => covered.has(index) === wanted);
  const label =
    texts.polar.label(used.length, above, names(true), names(false)) +
    (target ? ` ${texts.polar.target(target.tilt_deg, sideOf(target))}` : '');
  const [tx, ty] = target ? point(target) : [0, 0];
  return (
    <figure class="polar">
      <svg viewBox="-158 -126 316 250" role="img" aria-label={label}>
        <circle class="polar-ground" r={radius} />
        {[...covered].map((index) => (
          <path class="polar-covered" d={sector(index)} />
        ))}
        <circle class={above > 0 ? 'polar-covered' : 'polar-open'} r={scale(nearVertical_deg)} />
        {[10, 20, 30, 40, 50].map((tilt) => (
          <circle class="polar-ring" r={scale(tilt)} />
        ))}
        {[0, 1, 2, 3].map((k) => {
          const [x, y] = [Math.cos((2 * k + 1) * Math.PI / 8), Math.sin((2 * k + 1) * Math.PI / 8)];
          const inner = scale(nearVertical_deg);
          return (
            <g class="polar-spoke">
              <path d={`M${inner * x} ${inner * y} ${radius * x} ${radius * y}`} />
              <path d={`M${-inner * x} ${-inner * y} ${-radius * x} ${-radius * y}`} />
            </g>
          );
        })}
        {[20, 40].map((tilt) => (
          <text class="polar-degree" x={scale(tilt) * Math.SQRT1_2 * 0.38 + 2} y={-scale(tilt) * 0.925 + 3.5}>
            {tilt}°
          </text>
        ))}
        <text class="polar-side" y={-105} text-anchor="middle">{texts.polar.sides.top}</text>
        <text class="polar-side" y={118} text-anchor="middle">{texts.polar.sides.bottom}</text>
        <text class="polar-side" x={104} y={3.5}>{texts.polar.sides.right}</text>
        <text class="polar-side" x={-104} y={3.5} text-anchor="end">{texts.polar.sides.left}</text>
        {seen.map((photograph) => {
          const [x, y] = point(photograph);
          return (
            <g key={photograph.id}>
              {selected === photograph.id && <circle class="polar-selected" cx={x} cy={y} r={10} />}
              <Dot mark={markOf(photograph)!} x={x} y={y} />
              <title>{`${photograph.name}: ${texts.photographsPage.tilt(photograph.tilt_deg)}`}</title>
            </g>
          );
        })}
        {target && (
          <g class="polar-target">
            <circle cx={tx} cy={ty} r={9} />
            <path d={`M${tx - 4.5} ${ty}h9M${tx} ${ty - 4.5}v9`} />
          </g>
        )}
      </svg>
      <figcaption class="polar-legend" aria-hidden="true">
        {(['good', 'weak', 'bad'] as const).map((mark) => (
          <span>
            <svg viewBox="-6 -6 12 12" width="12" height="12"><Dot mark={mark} x={0} y={0} r={4.5} /></svg>
            {texts.polar.legend[mark]}
          </span>
        ))}
        {target && (
          <span>
            <svg viewBox="-10 -10 20 20" width="14" height="14"><g class="polar-target"><circle r={8} /><path d="M-4 0h8M0-4v8" /></g></svg>
            {texts.polar.legend.target}
          </span>
        )}
      </figcaption>
    </figure>
  );
}

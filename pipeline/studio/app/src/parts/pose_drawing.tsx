// How to hold the phone: the board on the table seen from the photographer's place, the phone above it, tilted toward the
// sample's centre, with the angle from straight above.
import type { Direction } from '../api';
import { sideOf } from '../format';
import { texts } from '../texts';

type Point = [number, number, number]; // x right, y away from the photographer, z up

const elevation = (48 * Math.PI) / 180; // of the eye above the table
const distance = 1.75; // of the phone, in sides of the sample
const unit = 62; // pixels of the drawing

function project([x, y, z]: Point): [number, number] {
  return [unit * x, -unit * (y * Math.sin(elevation) + z * Math.cos(elevation))];
}

const path = (points: Point[]) => `M${points.map((p) => project(p).map((v) => v.toFixed(1)).join(' ')).join('L')}Z`;

function square(half: number, z = 0): Point[] {
  return [[-half, -half, z], [half, -half, z], [half, half, z], [-half, half, z]];
}

function combine(origin: Point, ...terms: [number, Point][]): Point {
  return terms.reduce<Point>((sum, [factor, v]) => [sum[0] + factor * v[0], sum[1] + factor * v[1], sum[2] + factor * v[2]], origin);
}

function toward({ tilt_deg, azimuth_deg }: Direction): Point {
  const [t, a] = [(tilt_deg * Math.PI) / 180, (azimuth_deg * Math.PI) / 180];
  return [Math.sin(t) * Math.cos(a), Math.sin(t) * Math.sin(a), Math.cos(t)];
}

// The phone's own right and up, held upright by somebody at the sample's bottom edge.
function axes([dx, dy, dz]: Point): { right: Point; up: Point } {
  const length = Math.hypot(dz, dx);
  const right: Point = [dz / length, 0, -dx / length];
  const up: Point = [dy * right[2] - dz * right[1], dz * right[0] - dx * right[2], dx * right[1] - dy * right[0]];
  return { right, up };
}

function rectangle(centre: Point, right: Point, up: Point, halfWidth: number, halfHeight: number): Point[] {
  return ([[-1, -1], [1, -1], [1, 1], [-1, 1]] as const).map(([u, v]) => combine(centre, [u * halfWidth, right], [v * halfHeight, up]));
}

function arc(direction: Direction, radius: number): string {
  const points: string[] = [];
  for (let k = 0; k <= 16; ++k) {
    const d = toward({ ...direction, tilt_deg: (direction.tilt_deg * k) / 16 });
    points.push(project([radius * d[0], radius * d[1], radius * d[2]]).map((v) => v.toFixed(1)).join(' '));
  }
  return `M${points.join('L')}`;
}

export function poseSentence(target: Direction): string {
  const side = sideOf(target);
  return side === null ? texts.pose.above : texts.pose.tilted(target.tilt_deg, side);
}

export function PoseDrawing({ target }: { target: Direction }) {
  const side = sideOf(target);
  const d = toward(target);
  const { right, up } = axes(d);
  const centre: Point = [distance * d[0], distance * d[1], distance * d[2]];
  const lens = combine(centre, [-0.12, right], [0.3, up]);
  const middle = toward({ ...target, tilt_deg: target.tilt_deg / 2 });
  const [labelX, labelY] = project([1.28 * middle[0], 1.28 * middle[1], 1.28 * middle[2]]);
  const [cx, cy] = project(centre);
  const [zx, zy] = project([0, 0, 1.55]);
  return (
    <figure class="pose">
      <svg viewBox="-128 -150 256 236" role="img" aria-label={texts.pose.label(poseSentence(target))}>
        <path class="pose-board" d={path(square(0.92))} />
        <path class="pose-board-line" d={path(square(0.72))} />
        <path class="pose-sample" d={path(square(0.5))} />
        {square(0.5).map((corner) => {
          const [x, y] = project(corner);
          return <path class="pose-beam" d={`M${cx} ${cy}L${x.toFixed(1)} ${y.toFixed(1)}`} />;
        })}
        {side !== null && <path class="pose-vertical" d={`M0 0L${zx} ${zy}`} />}
        <path class="pose-axis" d={`M0 0L${cx.toFixed(1)} ${cy.toFixed(1)}`} />
        {side !== null && <path class="pose-arc" d={arc(target, 1.05)} />}
        <path class="pose-phone" d={path(rectangle(centre, right, up, 0.24, 0.48))} />
        <path class="pose-screen" d={path(rectangle(centre, right, up, 0.19, 0.4))} />
        <circle class="pose-lens" cx={project(lens)[0]} cy={project(lens)[1]} r="3" />
        {side !== null && (
          <text class="pose-degree" x={labelX} y={labelY} text-anchor={d[0] < -0.1 ? 'end' : d[0] > 0.1 ? 'start' : 'middle'}>
            {Math.round(target.tilt_deg)}°
          </text>
        )}
        <text class="polar-side" y={project([0, -0.92, 0])[1] + 16} text-anchor="middle">{texts.polar.sides.bottom}</text>
      </svg>
    </figure>
  );
}

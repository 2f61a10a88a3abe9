// How to hold the phone: the board on the table seen from the photographer's place, the phone above it, tilted toward the
// sample's centre, with the angle from straight above.
import type { Direction } from '../api';
import { sideOf } from '../format';
import { texts } from '../texts';

type Point = [number, number, number]; // x right, y away from the photographer, z up

const elevation = (27 * Math.PI) / 180; // of the eye above the table
const yaw = (24 * Math.PI) / 180; // the eye stands a little to the right, so that a tilt toward it shows
const distance = 1.95; // of the phone, in sides of the sample
const arcRadius = 1.3;
const unit = 66; // pixels of the drawing
const [cosYaw, sinYaw] = [Math.cos(yaw), Math.sin(yaw)];
const toEye: Point = [Math.cos(elevation) * sinYaw, -Math.cos(elevation) * cosYaw, Math.sin(elevation)];

function project([x, y, z]: Point): [number, number] {
  const [u, v] = [x * cosYaw + y * sinYaw, y * cosYaw - x * sinYaw];
  return [unit * u, -unit * (v * Math.sin(elevation) + z * Math.cos(elevation))];
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

export function PoseDrawing({ target, board }: { target: Direction; board: boolean }) {
  const tilted = sideOf(target) !== null;
  const d = toward(target);
  const { right, up } = axes(d);
  const centre: Point = [distance * d[0], distance * d[1], distance * d[2]];
  const seesBack = d[0] * toEye[0] + d[1] * toEye[1] + d[2] * toEye[2] < 0;
  const [lensX, lensY] = project(combine(centre, [-0.13, right], [0.33, up]));
  const [cx, cy] = project(centre).map((v) => v.toFixed(1));
  const leansRight = project(d)[0] >= 0;
  // Beside the arc's upper end; above it where the phone leans toward the eye and would cover it.
  const labelY = project([0, 0, d[1] < -0.2 ? 2 : arcRadius])[1] + 5;
  const [frontX, frontY] = project([0, -1.02, 0]);
  return (
    <figure class="pose">
      <svg viewBox="-128 -142 256 196" role="img" aria-label={texts.pose.label(poseSentence(target))}>
        {board && <path class="pose-board" d={path(square(1))} />}
        {board && <path class="pose-board-line" d={path(square(0.8))} />}
        <path class="pose-sample" d={path(square(board ? 0.56 : 1))} />
        <path class="pose-light" d={square(0.56).map((corner) => `M${cx} ${cy}L${project(corner).map((v) => v.toFixed(1)).join(' ')}`).join('')} />
        {tilted && <path class="pose-vertical" d={`M0 0L${project([0, 0, 2.05]).join(' ')}`} />}
        <path class="pose-axis" d={`M0 0L${cx} ${cy}`} />
        {tilted && <path class="pose-arc" d={arc(target, arcRadius)} />}
        <path class="pose-phone" d={path(rectangle(centre, right, up, 0.25, 0.5))} />
        {seesBack ? <circle class="pose-lens" cx={lensX} cy={lensY} r="3.5" /> : <path class="pose-screen" d={path(rectangle(centre, right, up, 0.21, 0.44))} />}
        {tilted && (
          <text class="pose-degree" x={leansRight ? -7 : 7} y={labelY} text-anchor={leansRight ? 'end' : 'start'}>
            {Math.round(target.tilt_deg)}°
          </text>
        )}
        <text class="polar-side" x={frontX - 4} y={frontY + 3} text-anchor="middle" dominant-baseline="hanging">{texts.polar.sides.bottom}</text>
      </svg>
    </figure>
  );
}

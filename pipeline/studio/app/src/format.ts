// Times, sizes and directions as people read them.
import type { CaptureRow, Direction } from './api';
import { texts } from './texts';

export function ago(unix_s: number, now_s = Date.now() / 1000): string {
  const s = now_s - unix_s;
  if (s < 60) return texts.time.now;
  if (s < 3600) return texts.time.minutes(Math.floor(s / 60));
  if (s < 86400) return texts.time.hours(Math.floor(s / 3600));
  if (s < 172800) return texts.time.yesterday;
  return new Date(unix_s * 1000).toLocaleDateString('en-GB', { day: 'numeric', month: 'long', year: 'numeric' });
}

// Coarse on purpose: an estimate to the second would flicker.
export function duration(s: number): string {
  if (s < 10) return texts.time.seconds(Math.max(1, Math.round(s)));
  if (s < 90) return texts.time.seconds(Math.round(s / 5) * 5);
  return texts.time.minutesLong(Math.round(s / 60));
}

export function clock(s: number): string {
  const whole = Math.max(0, Math.floor(s));
  return `${Math.floor(whole / 60)}:${String(whole % 60).padStart(2, '0')}`;
}

export function bytes(n: number): string {
  return n < 1e9 ? `${Math.round(n / 1e6)} MB` : `${(n / 1e9).toFixed(n < 1e10 ? 1 : 0)} GB`;
}

const sides = ['right', 'topRight', 'top', 'topLeft', 'left', 'bottomLeft', 'bottom', 'bottomRight'] as const;

export const sideNames: string[] = sides.map((side) => texts.polar.sides[side]);

// Which of the eight sides an azimuth lies on, 0: right, counter-clockwise.
export function sideIndex(azimuth_deg: number): number {
  return (((Math.round(azimuth_deg / 45) % 8) + 8) % 8);
}

export const nearVertical_deg = 10;

// The side a photograph was taken from; null near the vertical, where there is none.
export function sideOf({ tilt_deg, azimuth_deg }: Direction): string | null {
  return tilt_deg < nearVertical_deg ? null : sideNames[sideIndex(azimuth_deg)];
}

// A map's name for people; names that are not known stand as they are.
export function mapName(name: string): string {
  return texts.result.mapNames[name] ?? name;
}

// Kind, size and number of photographs, in a line.
export function captureFacts({ kind, size_mm }: Pick<CaptureRow, 'kind' | 'size_mm'>, photographs: number): string {
  return [
    texts.kinds[kind] ?? kind,
    size_mm && texts.size(size_mm[0], size_mm[1]),
    (photographs > 0 || kind === 'board') && texts.photographs(photographs),
  ].filter(Boolean).join(' · ');
}

// What the page and the server say to each other: the types of the answers and one function for each request.

import { texts } from './texts';

export type Kind = 'board' | 'single' | 'rectified' | 'fixed camera';
export type Verdict = 'good' | 'usable' | 'poor' | 'none';
// 'empty': no photograph is used.
export type Status = 'empty' | 'ready' | 'running' | 'done' | 'out of date' | 'failed';
export type Size = [number, number];

export interface Studio {
  version: string;
  folder: string;
  free_bytes: number;
  read_only: boolean;
  lan: boolean;
}

export interface CaptureRow {
  id: string;
  name: string;
  kind: Kind;
  size_mm: Size | null;
  photographs: number;
  verdict: Verdict;
  status: Status;
  thumbnail: string | null;
  changed_s: number;
}

export interface Direction {
  tilt_deg: number;
  azimuth_deg: number; // 0: right of the sample, 90: its top
}

export type PhotographState = 'waiting' | 'checking' | 'good' | 'weak' | 'bad';

export interface Photograph {
  id: string;
  name: string;
  thumbnail: string | null;
  state: PhotographState;
  left_out: boolean;
  reason: string | null;
  remedy: string | null;
  board_found: boolean;
  sharpness: number | null;
  clipped_share: number | null;
  tilt_deg: number | null;
  azimuth_deg: number | null;
  same_as: string | null;
  added_s?: number; // since 1970
}

export interface Advice {
  verdict: Verdict;
  sentence: string;
  target: Direction | null;
  enough: boolean;
  list: string[];
}

export type StageState = 'waiting' | 'running' | 'done' | 'up to date' | 'failed';

export interface RunStage {
  name: string;
  state: StageState;
  share: number | null;
}

export interface Run {
  state: 'running' | 'done' | 'failed' | 'cancelled';
  quick: boolean;
  stages: RunStage[];
  share: number | null;
  remaining_s: number | null;
  message: string | null;
  remedy: string | null;
}

export interface ResultMap {
  name: string;
  url: string;
  meaning: string;
}

export interface Figure {
  name: string;
  value: string | number;
  meaning: string;
}

export interface Result {
  quick: boolean;
  page: string;
  tile: string | null;
  maps: ResultMap[];
  figures: Figure[];
  zip: string | null;
  glb: string | null;
  previous: { maps: ResultMap[] } | null;
}

export type OptionValue = string | number | boolean;
export type SavedOptions = Record<string, Record<string, OptionValue>>;

export interface Capture extends Omit<CaptureRow, 'photographs'> {
  folder: string;
  board?: Board | null; // with an empty id where it is not among the kept ones
  problem?: { message: string; remedy: string } | null; // capture.toml cannot be read
  limits?: { photograph_bytes: number; photographs: number };
  phone?: PhoneLink | null; // a code that is valid still
  photographs: Photograph[];
  advice: Advice;
  options: SavedOptions;
  run: Run | null;
  result: Result | null;
}

export interface OptionDescription {
  name: string;
  type: 'number' | 'integer' | 'text' | 'flag' | 'choice';
  choices?: string[];
  default: OptionValue | null;
  low?: number;
  high?: number;
  help: string;
  important: boolean;
}

export interface StageOptions {
  name: string;
  summary: string;
  options: OptionDescription[];
}

export interface Board {
  id: string;
  name: string;
  words?: string; // what it is, as the programs say it
  paper: string;
  squares: Size;
  square_mm: number;
  window_mm: Size | null; // null: a whole board, without a window
  ruler_mm: number | null; // as printed
  pdf?: boolean; // false: of a capture whose PDF is elsewhere
  known?: boolean; // to Studio, without a file
  print_scale?: number; // printed over designed size, from the ruler that was measured; 1: as its label says
}

export interface PhoneLink {
  url: string;
  qr_svg: string;
  expires_s: number;
}

export interface NewCapture {
  name: string;
  kind: Kind;
  size_mm: Size | null;
  height_mm: number | 'auto';
  board: string | null;
  picture_width_mm?: number;
}

export interface SentPhotograph {
  name: string;
  id: string | null;
  error: string | null; // "what is wrong; what to do"
}

export interface PhoneState {
  name: string;
  kind?: Kind;
  advice: Advice;
  photographs: Photograph[];
  expires_s?: number;
}

export interface Change {
  what: 'library' | 'capture' | 'photograph' | 'run';
  id: string;
}

// An answer that says what went wrong and what to do; status 0: no answer at all.
export class Failure extends Error {
  constructor(readonly status: number, message: string, readonly remedy: string | null) {
    super(message);
  }
}

export function failureOf(status: number, body: string, fallback: string): Failure {
  try {
    const { error } = JSON.parse(body) as { error: { message: string; remedy?: string } };
    return new Failure(status, error.message, error.remedy || null);
  } catch {
    return new Failure(status, fallback, null);
  }
}


// Without it no request that changes anything is accepted; a form of another site cannot send it.
export const requestHeader = ['X-Glint', '1'] as const;

async function ask<T>(method: string, path: string, body?: unknown): Promise<T> {
  const headers: Record<string, string> = {};
  if (method !== 'GET') headers[requestHeader[0]] = requestHeader[1];
  if (body !== undefined) headers['Content-Type'] = 'application/json';
  let answer: Response;
  let text: string;
  try {
    answer = await fetch(path, { method, headers, body: body === undefined ? null : JSON.stringify(body), cache: 'no-store' });
    text = await answer.text();
  } catch {
    throw new Failure(0, texts.errors.noAnswer, texts.errors.noAnswerRemedy);
  }
  if (!answer.ok) throw failureOf(answer.status, text, texts.errors.status(answer.status));
  return (text ? JSON.parse(text) : {}) as T;
}

const of = (id: string) => `/api/captures/${encodeURIComponent(id)}`;

export const api = {
  studio: () => ask<Studio>('GET', '/api/studio'),
  library: () => ask<{ captures: CaptureRow[] }>('GET', '/api/library'),
  capture: (id: string) => ask<Capture>('GET', of(id)),
  options: () => ask<{ stages: StageOptions[] }>('GET', '/api/options'),
  boards: () => ask<{ boards: Board[] }>('GET', '/api/boards'),
  makeCapture: (capture: NewCapture) => ask<{ id: string }>('POST', '/api/captures', capture),
  trash: (id: string) => ask<object>('POST', `${of(id)}/trash`, {}),
  makeBoard: (paper: string, window_mm?: Size) =>
    ask<Board>('POST', '/api/boards', window_mm ? { paper, window_mm } : { paper }),
  describeBoard: (file_name: string, description: string) => ask<Board>('POST', '/api/boards', { file_name, description }),
  measureBoard: (id: string, ruler_measured_mm: number) =>
    ask<Board>('PUT', `/api/boards/${encodeURIComponent(id)}`, { ruler_measured_mm }),
  boardPdf: (id: string) => `/api/boards/${encodeURIComponent(id)}/board.pdf`,
  photographsPath: (id: string) => `${of(id)}/photographs`,
  leaveOut: (id: string, photograph: string, left_out: boolean) =>
    ask<object>('PUT', `${of(id)}/photographs/${encodeURIComponent(photograph)}`, { left_out }),
  boardsShown: (id: string) => ask<{ another: boolean; boards: Board[] }>('GET', `${of(id)}/boards`),
  setBoard: (id: string, board: string, size_mm?: Size) => ask<Capture>('PUT', `${of(id)}/board`, size_mm ? { board, size_mm } : { board }),
  saveOptions: (id: string, options: Record<string, Record<string, OptionValue | null>>) =>
    ask<Capture>('PUT', `${of(id)}/options`, options),
  run: (id: string, quick: boolean) => ask<object>('POST', `${of(id)}/run`, { quick }),
  cancel: (id: string) => ask<object>('POST', `${of(id)}/cancel`, {}),
  openFolder: (id: string) => ask<object>('POST', `${of(id)}/open-folder`, {}),
  openPhone: (id: string) => ask<PhoneLink>('POST', `${of(id)}/phone`, {}),
  closePhone: (id: string) => ask<object>('DELETE', `${of(id)}/phone`),
  phoneState: (path: string) => ask<PhoneState>('GET', `${path}/state`),
};

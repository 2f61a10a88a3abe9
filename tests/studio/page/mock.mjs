// A stand-in for Studio's server: the same requests and answers with made-up captures, in memory. For developing and testing the page:
// node mock.mjs APP [PORT] serves the built page in folder APP. Photographs are judged by their name: blur…, dark…, text…, same…
import fs from 'node:fs';
import http from 'node:http';
import path from 'node:path';
import * as pictures from './pictures.mjs';

const security = "default-src 'self'; img-src 'self' blob: data:; frame-src 'self'; object-src 'none'; base-uri 'none'; form-action 'none'; frame-ancestors 'self'";
const kinds = { '.html': 'text/html; charset=utf-8', '.js': 'text/javascript; charset=utf-8', '.css': 'text/css; charset=utf-8', '.svg': 'image/svg+xml' };
const ring = [[4, 80], [6, 300], [28, 10], [31, 95], [26, 185], [33, 262], [30, 48], [24, 140], [29, 225], [34, 318], [5, 200], [8, 20]];

class Refusal extends Error {
  constructor(status, message, remedy) {
    super(message);
    Object.assign(this, { status, remedy });
  }
}

const good = (id, name, [tilt_deg, azimuth_deg], more = {}) => ({
  id, name, state: 'good', left_out: false, reason: null, remedy: null, board_found: true, sharpness: 0.8, clipped_share: 0.004,
  tilt_deg, azimuth_deg, same_as: null, ...more,
});

const bad = {
  blur: { state: 'bad', left_out: true, sharpness: 0.12, reason: 'Blurred: edges are 3.4 pixels wide, in the others 1.2.', remedy: 'Hold the phone still, or rest your elbows on the table, and take it again.' },
  dark: { state: 'weak', reason: 'Dark: the board’s paper reaches 18 % of the range.', remedy: 'Switch the flash on.' },
  text: { state: 'bad', left_out: true, board_found: false, tilt_deg: null, azimuth_deg: null, reason: 'The board was not found.', remedy: 'Show the whole board, flat, without a shadow on it.' },
  same: { state: 'bad', left_out: true, reason: null, remedy: 'Nothing to do: one of the two is enough.' },
};

function sixPhotographs() {
  const list = ring.slice(0, 5).map((d, i) => good(`p${i + 1}`, `IMG_20${41 + i}.jpg`, d));
  list.push(good('p6', 'IMG_2046.jpg', [27, 60], bad.blur));
  list.push(good('p7', 'IMG_2047.jpg', [12, 110], bad.dark));
  list.push(good('p8', 'IMG_2048.jpg', [0, 0], bad.text));
  list.push(good('p9', 'IMG_2049.jpg', [28, 10], { ...bad.same, same_as: 'p3' }));
  return list;
}

const stageNames = ['calib', 'rectify', 'fit', 'refine', 'export', 'report'];
const finishedRun = (quick) => ({ state: 'done', quick, share: 1, remaining_s: null, message: null, remedy: null, stages: stageNames.map((name) => ({ name, state: 'done', share: 1 })) });

function example(now) {
  const all = (n) => ring.slice(0, n).map((d, i) => good(`p${i + 1}`, `IMG_${1200 + i}.jpg`, d));
  const capture = (id, name, family, more) => ({ id, name, family, seed: id.length * 7 + id.charCodeAt(0), kind: 'board', board: 'b1', size_mm: [100, 100], photographs: all(12), status: 'done', changed_s: now - 4000, options: {}, run: null, done: null, folder: `/home/you/Glint/${name}`, ...more });
  return [
    capture('oak', 'oak, oiled', 'oak', { done: { quick: false, previous: true, tile: true }, run: finishedRun(false), options: { tile: { enabled: true } } }),
    capture('felt', 'green felt', 'felt', { photographs: sixPhotographs(), status: 'ready', changed_s: now - 50, size_mm: [80, 120] }),
    capture('slate', 'slate tile', 'slate', { status: 'running', changed_s: now - 20, run: { state: 'running', quick: false, share: 0.42, remaining_s: 34, message: null, remedy: null, stages: [['calib', 'up to date', 1], ['rectify', 'done', 1], ['fit', 'running', 0.63], ['refine', 'waiting', null], ['export', 'waiting', null], ['report', 'waiting', null]].map(([name, state, share]) => ({ name, state, share })) } }),
    capture('leather', 'saddle leather', 'leather', { status: 'failed', changed_s: now - 90000, photographs: all(5), run: { state: 'failed', quick: false, share: 0.2, remaining_s: null, message: 'calib: the focal length cannot be determined: all five photographs were taken from straight above.', remedy: 'Add two photographs tilted by 20 to 40°, then run again.', stages: stageNames.map((name, i) => ({ name, state: i ? 'waiting' : 'failed', share: null })) } }),
    capture('brass', 'brass, hammered', 'brass', { status: 'out of date', done: { quick: true }, changed_s: now - 200000, kind: 'single', size_mm: [60, 60], photographs: all(1), run: finishedRun(true) }),
    capture('icon', 'icon of Saint George, tempera and gilding on panel, second half of the sixteenth century', 'linen', { kind: 'fixed camera', changed_s: now - 3e6, size_mm: [310, 420], done: { quick: false }, run: finishedRun(false), photographs: all(12).map((p) => ({ ...p, tilt_deg: null, azimuth_deg: null })) }),
    capture('linen', 'linen, from another program', 'linen', { kind: 'rectified', changed_s: now - 4e6, photographs: [], status: 'ready' }),
  ];
}

function advise(photographs, kind = 'board') {
  if (kind !== 'board') return { verdict: 'none', sentence: '', target: null, enough: photographs.length > 0, list: [] };
  const used = photographs.filter((p) => !p.left_out && p.state !== 'bad' && p.tilt_deg !== null);
  const next = ring.find(([tilt, azimuth]) => !used.some((p) => Math.hypot(p.tilt_deg - tilt, tilt < 10 ? 0 : (p.azimuth_deg - azimuth) / 3) < 6));
  const side = ['right', 'top right', 'top', 'top left', 'left', 'bottom left', 'bottom', 'bottom right'];
  const enough = used.length >= 12 || !next;
  const sentence = enough ? 'Nothing of weight is missing. Make the maps.'
    : next[0] < 10 ? 'Take one from straight above, the whole board in the picture.'
    : `Take one from the ${side[Math.round(next[1] / 45) % 8]}, about ${next[0]}° from straight above.`;
  return {
    verdict: used.length === 0 ? 'none' : enough ? 'good' : used.length >= 5 ? 'usable' : 'poor', sentence, enough,
    target: enough ? null : { tilt_deg: next[0], azimuth_deg: next[1] },
    list: enough ? [] : [sentence, '38 % of the sample (the left edge) never shows a highlight.', `${12 - used.length} more photographs (12 in all) would lower the error of renderings by about 60 %.`],
  };
}

const options = {
  stages: [
    { name: 'sample', summary: 'the maps’ size', options: [{ name: 'resolution_px', type: 'integer', default: 1024, help: 'Width of the maps in texels.', important: true }] },
    { name: 'calib', summary: 'cameras and light', options: [
      { name: 'model', type: 'choice', choices: ['auto', 'simple-radial', 'opencv'], default: 'auto', help: 'Camera model.', important: false },
      { name: 'paper-reflectance', type: 'number', default: 0.85, help: 'Reflectance of the white paper (0.05 to 1).', important: false }] },
    { name: 'fit', summary: 'maps in the latent space', options: [
      { name: 'metals', type: 'choice', choices: ['rare', 'possible'], default: 'rare', help: 'Whether there may be bare metal.', important: true },
      { name: 'iterations', type: 'integer', default: 1000, help: 'Steps of the optimiser.', important: false }] },
    { name: 'run', summary: 'the whole run', options: [{ name: 'exclude', type: 'text', default: '', help: 'Photographs held out.', important: true }] },
    { name: 'refine', summary: 'texel by texel', options: [
      { name: 'correct-views', type: 'choice', choices: ['auto', 'always', 'never'], default: 'auto', help: 'Estimate errors in lights, registration and ambient illumination.', important: false },
      { name: 'correct-exposures', type: 'flag', default: false, help: 'Estimate exposures too.', important: false },
      { name: 'prior', type: 'number', default: 1, help: 'Factor on the weight of the priors; 0: none (0 to 1000000).', important: false }] },
    { name: 'tile', summary: 'a seamless patch', options: [{ name: 'enabled', type: 'flag', default: false, help: 'Make a seamless tile.', important: true }] },
  ],
};

export class Mock {
  constructor(app, { empty = false, judge_ms = 500, run_ms = 400 } = {}) {
    const now = Math.floor(Date.now() / 1000);
    Object.assign(this, { app, judge_ms, run_ms, broken: false, phones: new Map(), clients: new Set(), sockets: new Set(), next: 1, log: [] });
    this.studio = { version: '0.1.0', folder: '/home/you/Glint', free_bytes: 120e9, read_only: false, lan: false };
    this.captures = new Map((empty ? [] : example(now)).map((c) => [c.id, c]));
    this.boards = empty ? [] : [
      { id: 'b1', name: 'A4, September', paper: 'A4', squares: [13, 17], square_mm: 15, window_mm: [105, 105], ruler_mm: 149.2, print_scale: 149.2 / 150 },
      { id: 'b2', name: 'A3', paper: 'A3', squares: [19, 27], square_mm: 15, window_mm: [195, 225], ruler_mm: 200, print_scale: 1 },
    ];
  }

  listen(port = 0) {
    this.server = http.createServer((request, response) => this.answer(request, response));
    this.server.on('connection', (socket) => {
      this.sockets.add(socket);
      socket.on('close', () => this.sockets.delete(socket));
    });
    return new Promise((done) => this.server.listen(port, '127.0.0.1', () => done(this.server.address().port)));
  }

  close() {
    for (const socket of this.sockets) socket.destroy();
    return new Promise((done) => this.server.close(done));
  }

  tell(what, id) {
    for (const response of this.clients) response.write(`event: change\ndata: ${JSON.stringify({ what, id })}\n\n`);
  }

  async answer(request, response) {
    const url = new URL(request.url, 'http://mock');
    this.log.push(`${request.method} ${url.pathname}`);
    const send = (body, kind = 'application/json', status = 200) => {
      response.writeHead(status, { 'Content-Type': kind, 'Content-Security-Policy': kind.startsWith('text/html') && url.pathname.startsWith('/files') ? 'sandbox allow-scripts' : security, 'X-Content-Type-Options': 'nosniff' });
      response.end(typeof body === 'string' || Buffer.isBuffer(body) ? body : JSON.stringify(body));
    };
    try {
      const chunks = [];
      for await (const chunk of request) {
        chunks.push(chunk);
        if (this.broken && url.pathname.endsWith('/photographs') && request.method === 'POST') {
          request.socket.destroy();
          return;
        }
      }
      await this.route(request, url, Buffer.concat(chunks), send, response);
    } catch (error) {
      if (!(error instanceof Refusal)) console.error(error);
      send({ error: { message: error.message, remedy: error.remedy ?? '' } }, 'application/json', error.status ?? 500);
    }
  }

  async route(request, url, body, send, response) {
    const parts = url.pathname.split('/').filter(Boolean).map(decodeURIComponent);
    const { method } = request;
    if (method !== 'GET' && request.headers['x-glint'] !== '1') throw new Refusal(403, 'Cross-site requests are not allowed.');
    const json = () => JSON.parse(body.toString() || '{}');
    if (parts[0] === 'p') return this.routePhone(method, parts, url, request, body, send, response);
    if (parts[0] !== 'api') return this.file(parts, send);
    if (parts[1] === 'studio') return send(this.studio);
    if (parts[1] === 'options') return send(options);
    if (parts[1] === 'library') return send({ captures: [...this.captures.values()].map((c) => this.row(c)) });
    if (parts[1] === 'events') return this.events(response);
    if (parts[1] === 'boards') return this.routeBoards(method, parts, json, send);
    if (parts[1] === 'captures' && parts.length === 2 && method === 'POST') return send(this.make(json()));
    const capture = this.captures.get(parts[2]);
    if (parts[1] !== 'captures' || !capture) throw new Refusal(404, 'This capture does not exist.', 'It may have been moved. Go back to the library.');
    const action = parts[3];
    if (!action) return send(this.whole(capture));
    if (action === 'thumbnail') return this.picture(capture, parts[4], send);
    if (action === 'map') return send(pictures.map(capture.family, capture.seed, parts[4], parts[5] ? 3 : 0), 'image/svg+xml');
    if (action === 'photographs' && method === 'POST') return send({ photographs: this.receive(capture, request, body) });
    if (action === 'photographs' && method === 'PUT') return send(this.leaveOut(capture, parts[4], json().left_out));
    if (action === 'options' && method === 'PUT') return send(this.saveOptions(capture, json()));
    if (action === 'boards') return send({ another: false, boards: [] });
    if (action === 'board' && method === 'PUT') {
      capture.board = json().board;
      return send(this.whole(capture));
    }
    if (action === 'run') return send(this.run(capture, json().quick));
    if (action === 'cancel') return send(this.cancel(capture));
    if (action === 'open-folder') return send({});
    if (action === 'trash') {
      this.captures.delete(capture.id);
      this.tell('library', capture.id);
      return send({});
    }
    if (action === 'phone' && method === 'POST') return send(this.openPhone(capture, request.headers.host));
    if (action === 'phone' && method === 'DELETE') {
      this.closePhone(capture);
      return send({});
    }
    throw new Refusal(404, 'No such request.');
  }

  file(parts, send) {
    const name = parts[0] ?? 'studio.html';
    if (parts[0] === 'files') {
      const capture = this.captures.get(parts[1]);
      return send(pictures.report(capture.family, capture.name), 'text/html; charset=utf-8');
    }
    const file = path.join(this.app, path.basename(name));
    if (!fs.existsSync(file)) throw new Refusal(404, 'No such file.');
    send(fs.readFileSync(file), kinds[path.extname(file)] ?? 'application/octet-stream');
  }

  events(response) {
    response.writeHead(200, { 'Content-Type': 'text/event-stream', 'Cache-Control': 'no-store' });
    response.write(': here\n\n');
    this.clients.add(response);
    response.on('close', () => this.clients.delete(response));
  }

  row(c) {
    return {
      id: c.id, name: c.name, kind: c.kind, size_mm: c.size_mm, photographs: c.photographs.length, verdict: c.kind === 'board' ? advise(c.photographs).verdict : 'none',
      status: c.status, thumbnail: c.photographs.length ? `/api/captures/${c.id}/thumbnail/${c.photographs[0].id}` : null, changed_s: c.changed_s,
    };
  }

  shown(c, base) {
    return c.photographs.map(({ uploaded, ...p }) => ({ ...p, thumbnail: p.state === 'waiting' ? null : `${base}/thumbnail/${p.id}` }));
  }

  whole(c) {
    const at = `/api/captures/${c.id}`;
    const meanings = { 'base colour': 'Colour without shading; for glTF and most programs.', normal: 'Direction of the surface, OpenGL convention.', roughness: 'From mirror (black) to matt (white).', specular: 'Reflectance at normal incidence, F0.', height: 'Relief, from the normals.' };
    const list = (old) => pictures.maps.map((name) => ({ name, url: `${at}/map/${encodeURIComponent(name)}${old}`, meaning: meanings[name] }));
    const result = c.done && {
      quick: c.done.quick, page: `/files/${c.id}/report`, tile: c.done.tile ? `${at}/map/base%20colour` : null, maps: list(''), zip: `${at}/material.zip`, glb: `${at}/material.glb`,
      figures: [
        { name: 'Rendering error', value: '0.9 %', meaning: 'RMS, of the radiance of a white surface, over the photographs used.' },
        { name: 'Held-out views', value: '1.14', meaning: 'Brightness ratio between prediction and photograph; 1 is perfect.' },
        { name: 'Calibration', value: '0.21 px', meaning: 'RMS reprojection error of the board’s corners.' },
        { name: 'Roughness, 1σ', value: '0.03', meaning: 'Median standard deviation over the texels.' }],
      previous: c.done.previous ? { maps: list('/previous') } : null,
    };
    return { ...this.row(c), folder: c.folder, board: (c.kind === 'board' && this.boards.find((b) => b.id === c.board)) || null, problem: null, limits: { photograph_bytes: 200e6, photographs: 300 }, phone: null, photographs: this.shown(c, at), advice: advise(c.photographs, c.kind), options: { ...c.options, sample: { resolution_px: 1024, ...c.options.sample }, tile: { enabled: false, ...c.options.tile } }, run: c.run, result };
  }

  picture(c, id, send) {
    const index = c.photographs.findIndex((p) => p.id === id);
    if (index < 0) throw new Refusal(404, 'No such photograph.');
    const p = c.photographs[index];
    if (p.uploaded) return send(p.uploaded, 'image/jpeg');
    send(pictures.photograph(c.family, c.seed + index, { tilt_deg: p.tilt_deg ?? 0, azimuth_deg: p.azimuth_deg ?? 0 }), 'image/svg+xml');
  }

  make({ name, kind, size_mm, board }) {
    if ([...this.captures.values()].some((c) => c.name === name)) throw new Refusal(409, `A capture “${name}” exists already.`, 'Choose another name.');
    const id = `new${this.next++}`;
    this.captures.set(id, { id, name, kind, size_mm, board: board ?? null, family: pictures.families[this.next % 6], seed: this.next, photographs: [], status: 'empty', changed_s: Date.now() / 1000, options: {}, run: null, done: null, folder: `/home/you/Glint/${name}` });
    this.tell('library', id);
    return { id };
  }

  routeBoards(method, parts, json, send) {
    const board = this.boards.find((b) => b.id === parts[2]);
    if (method === 'GET' && parts.length === 2) return send({ boards: this.boards });
    if (method === 'POST') {
      const { paper } = json();
      const large = paper === 'A3' || paper === 'Tabloid';
      const made = { id: `b${this.boards.length + 1}`, name: `${paper} board`, paper, squares: large ? [19, 27] : [13, 17], square_mm: 15, window_mm: large ? [195, 225] : [105, 105], ruler_mm: 150, print_scale: 1 };
      this.boards.push(made);
      return send(made);
    }
    if (!board) throw new Refusal(404, 'No such board.');
    if (method === 'PUT') {
      const { ruler_measured_mm } = json();
      board.print_scale *= ruler_measured_mm / board.ruler_mm;
      board.ruler_mm = ruler_measured_mm;
      return send(board);
    }
    send('%PDF-1.4\n', 'application/pdf');
  }

  // The names and bytes of a multipart body, enough of the format for a browser's.
  receive(c, request, body) {
    const boundary = /boundary=(.+)$/.exec(request.headers['content-type'])?.[1];
    return body.toString('latin1').split(`--${boundary}`).slice(1, -1).map((part) => {
      const name = Buffer.from(/filename="([^"]*)"/.exec(part)[1], 'latin1').toString();
      const bytes = Buffer.from(part.slice(part.indexOf('\r\n\r\n') + 4, -2), 'latin1');
      const word = Object.keys(bad).find((w) => name.startsWith(w));
      if (word === 'text') return { name, id: null, error: `${name} is no photograph: it begins with plain text; send a JPEG` };
      const used = c.photographs.length;
      const jpeg = bytes[0] === 0xff && bytes[1] === 0xd8;
      const p = good(`u${this.next++}`, name, ring[used % ring.length], { uploaded: jpeg ? bytes : null, state: 'waiting', tilt_deg: null, azimuth_deg: null, sharpness: null, clipped_share: null });
      c.photographs.push(p);
      c.status = 'ready';
      this.tell('photograph', p.id);
      setTimeout(() => {
        const [tilt_deg, azimuth_deg] = ring[used % ring.length];
        Object.assign(p, { state: 'good', tilt_deg, azimuth_deg, sharpness: 0.8, clipped_share: 0.003 }, bad[word]);
        if (word === 'same') p.same_as = c.photographs[0].id;
        this.tell('photograph', p.id);
      }, this.judge_ms);
      return { name, id: p.id, error: null };
    });
  }

  leaveOut(c, id, left_out) {
    c.photographs.find((p) => p.id === id).left_out = left_out;
    this.tell('capture', c.id);
    return {};
  }

  saveOptions(c, changes) {
    for (const [stage, values] of Object.entries(changes)) {
      c.options[stage] ??= {};
      for (const [name, value] of Object.entries(values)) {
        if (name === 'prior' && value < 0) throw new Refusal(400, 'refine: prior = -1 is out of range (0 to 1000000).', 'Enter a number from 0 to 1000000.');
        if (value === null) delete c.options[stage][name];
        else c.options[stage][name] = value;
      }
    }
    this.tell('capture', c.id);
    return this.whole(c);
  }

  run(c, quick) {
    if (c.status === 'running') throw new Refusal(409, 'This capture is running already.', 'Wait, or cancel the run.');
    const names = c.options.tile?.enabled ? [...stageNames.slice(0, 4), 'tile', ...stageNames.slice(4)] : stageNames;
    c.run = { state: 'running', quick, share: 0, remaining_s: 12, message: null, remedy: null, stages: names.map((name) => ({ name, state: 'waiting', share: null })) };
    c.status = 'running';
    let step = 0;
    c.timer = setInterval(() => {
      const { stages } = c.run;
      const [at, part] = [Math.floor(step / 2), step % 2];
      if (at >= stages.length) {
        clearInterval(c.timer);
        c.run = { ...finishedRun(quick), stages: stages.map((s) => ({ ...s, state: 'done' })) };
        c.status = 'done';
        c.done = { quick, previous: c.done !== null, tile: names.includes('tile') };
      } else {
        if (at > 0) Object.assign(stages[at - 1], { state: 'done', share: 1 });
        Object.assign(stages[at], { state: 'running', share: 0.5 * part });
        Object.assign(c.run, { share: step / (2 * stages.length), remaining_s: 12 - step });
      }
      ++step;
      this.tell('run', c.id);
    }, quick ? this.run_ms / 2 : this.run_ms);
    this.tell('run', c.id);
    return {};
  }

  cancel(c) {
    clearInterval(c.timer);
    c.run = { ...c.run, state: 'cancelled', remaining_s: null, stages: c.run.stages.map((s) => (s.state === 'running' ? { ...s, state: 'waiting', share: null } : s)) };
    c.status = 'ready';
    this.tell('run', c.id);
    return {};
  }

  openPhone(c, host) {
    const token = `demo${this.next++}${Math.random().toString(36).slice(2, 12)}`;
    this.closePhone(c);
    this.phones.set(token, c);
    const url = `http://${host}/p/${token}`;
    return { url, qr_svg: pictures.code(url), expires_s: 900 };
  }

  closePhone(capture) {
    for (const [token, c] of this.phones) if (c === capture) this.phones.delete(token);
  }

  routePhone(method, parts, url, request, body, send, response) {
    const c = this.phones.get(parts[1]);
    if (parts.length === 2) return this.file(['phone.html'], send);
    if (!c) throw new Refusal(410, 'This link has expired.', 'Make a new code in Studio.');
    if (parts[2] === 'state') return send({ name: c.name, kind: c.kind, advice: advise(c.photographs, c.kind), photographs: this.shown(c, `/p/${parts[1]}`) });
    if (parts[2] === 'events') return this.events(response);
    if (parts[2] === 'thumbnail') return this.picture(c, parts[3], send);
    if (parts[2] === 'photographs' && method === 'POST') return send({ photographs: this.receive(c, request, body) });
    throw new Refusal(404, 'No such request.');
  }
}

if (process.argv[1] === import.meta.filename) {
  const port = await new Mock(process.argv[2], { empty: process.argv.includes('--empty') }).listen(Number(process.argv[3] ?? 8790));
  console.log(`http://127.0.0.1:${port}/`);
}

// node bad_input.mjs PROGRAMS SCREENSHOTS: what goes wrong between a page and the real server: files that are no photographs, the same one twice,
// one that is too large, three hundred at once, capture.toml broken by hand, a cancelled run, a reload half-way, two browsers, Studio killed while
// photographs are on their way.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { finish, launch, open, screenshots, verdict } from './browser.mjs';
import { startStudio } from './studio.mjs';

const [programs, out] = process.argv.slice(2);
const shot = screenshots(out);
const work = fs.mkdtempSync(path.join(os.tmpdir(), 'glint-bad-input-'));
const folder = path.join(work, 'captures');
fs.mkdirSync(folder);
const wide = { width: 1400, height: 950, scheme: 'light' };
let studio = await startStudio(programs, folder);
const port = new URL(studio.address).port;
const browser = await launch();
const { page, said } = await open(browser, wide, studio.address);

await page.getByRole('link', { name: 'Make the first capture' }).click();
await page.getByLabel('Name').fill('../../etc/passwd');
await page.getByRole('button', { name: 'Create capture' }).click();
await page.waitForSelector('.drop, .notice.error');
verdict(fs.readdirSync(folder).every((name) => name !== 'etc') && !fs.existsSync(path.join(work, '../etc/passwd.d')), `a name with slashes stays in the folder (${fs.readdirSync(folder).filter((n) => !n.startsWith('.')).join(', ') || 'refused'})`);
await page.goto(`${studio.home}/#/new`);
await page.waitForFunction(() => document.querySelector('#name')?.value);
await page.getByLabel('Name').fill('wood');
await page.getByRole('button', { name: 'Create capture' }).click();
await page.waitForSelector('.drop');
const capture = path.join(folder, 'wood');
execFileSync(path.join(programs, 'glint-synth'), ['capture', path.join(work, 'shot'), '--board', path.join(capture, 'board.json'), '--family', 'wood', '--seed', '5', '--photos', '4', '--megapixels', '1', '--texels', '256', '--sample-mm', '100']);
const photographs = fs.readdirSync(path.join(work, 'shot/photos')).sort().map((name) => path.join(work, 'shot/photos', name));
const input = page.locator('input[type=file]').first();
const kept = () => fs.readdirSync(path.join(capture, 'photos')).length;
const tile = (name) => page.locator('.tile', { hasText: name });

// No photographs.
fs.writeFileSync(path.join(work, 'notes.jpg'), 'This is a text.\n'.repeat(100));
fs.writeFileSync(path.join(work, 'empty.jpg'), '');
const torn = fs.readFileSync(photographs[0]);
fs.writeFileSync(path.join(work, 'torn.jpg'), torn.subarray(0, torn.length / 3));
const huge = fs.openSync(path.join(work, 'huge.jpg'), 'w');
fs.writeSync(huge, torn);
fs.ftruncateSync(huge, 260e6);
fs.closeSync(huge);
await input.setInputFiles(['notes.jpg', 'empty.jpg', 'torn.jpg', 'huge.jpg'].map((name) => path.join(work, name)));
for (const name of ['notes.jpg', 'empty.jpg', 'huge.jpg']) {
  await tile(name).getByText('Not taken').waitFor({ timeout: 60000 });
  const why = (await tile(name).locator('.tile-reason').textContent()) ?? '';
  verdict(why.length > 10, `${name}: ${why}`);
}
await tile('torn.jpg').locator('.badge.bad').first().waitFor({ timeout: 60000 });
verdict(true, `torn.jpg: ${await tile('torn.jpg').locator('.tile-reason').textContent()}`);
await shot(page, 'bad-files');

// The same one twice.
await input.setInputFiles(photographs[0]);
await page.waitForFunction(() => [...document.querySelectorAll('.badge.good')].length >= 1, null, { timeout: 60000 });
const before = kept();
await input.setInputFiles(photographs[0]);
await page.waitForTimeout(2500);
verdict(kept() === before, 'the same file sent twice is kept once');

// A reload, and Studio killed, while photographs are on their way.
await input.setInputFiles(photographs.slice(1));
await page.waitForTimeout(300);
page.once('dialog', (dialog) => dialog.accept());
await page.reload();
await page.waitForSelector('.drop');
await input.setInputFiles(photographs.slice(1));
await page.waitForTimeout(50);
await studio.kill();
await page.getByText('Connection lost').or(page.getByText('is lost')).first().waitFor({ timeout: 30000 });
verdict(true, 'a killed Studio is named');
await shot(page, 'bad-killed');
studio = await startStudio(programs, folder, port);
await page.goto(studio.address);
await page.goto(`${studio.home}/#/`);
await page.locator('.card', { hasText: 'wood' }).getByRole('link').click();
await page.getByRole('link', { name: 'Photographs' }).click();
await page.waitForSelector('.tile');
await input.setInputFiles(photographs);
await page.waitForFunction(() => document.querySelectorAll('.badge.good').length >= 4, null, { timeout: 60000 });
await page.waitForFunction(() => !document.querySelector('.upload-progress'), null, { timeout: 60000 });
const bytes = photographs.map((file) => fs.readFileSync(file).toString('base64'));
const there = fs.readdirSync(path.join(capture, 'photos')).map((name) => fs.readFileSync(path.join(capture, 'photos', name)).toString('base64'));
const times = bytes.map((one) => there.filter((other) => other === one).length);
verdict(times.every((n) => n === 1), `after a kill every photograph is there whole, and once (${times.join(', ')} times)`);

// Two browsers.
const second = await open(browser, wide, studio.address);
await second.page.goto(page.url());
await second.page.waitForSelector('.tile');
await second.page.getByRole('button', { name: `Leave out: ${path.basename(photographs[3])}` }).click();
await page.getByRole('button', { name: `Take back in: ${path.basename(photographs[3])}` }).waitFor({ timeout: 5000 });
verdict(true, 'what one browser changes the other shows');
await second.close();

// capture.toml broken by hand, and put right.
const toml = path.join(capture, 'capture.toml');
const text = fs.readFileSync(toml, 'utf8');
fs.writeFileSync(toml, text.replace('[sample]', '[sample'));
await page.reload();
await page.locator('.notice.error').waitFor();
verdict(true, `a broken capture.toml: ${(await page.locator('.notice.error').innerText()).replace(/\s+/g, ' ')}`);
await shot(page, 'bad-toml');
fs.writeFileSync(toml, text);
await page.reload();
await page.waitForSelector('.tile');
verdict(await page.locator('.notice.error').count() === 0, 'one that was put right is read again');

// A run that is cancelled, and one that another program kills.
await page.getByRole('link', { name: 'Maps', exact: true }).click();
await page.getByRole('button', { name: 'Make the maps' }).click();
await page.waitForSelector('.stage.running', { timeout: 20000 });
await page.getByRole('button', { name: 'Cancel the run' }).click();
await page.getByText('The run was cancelled').waitFor({ timeout: 20000 });
verdict(true, 'a run is cancelled');
await page.getByRole('button', { name: 'Make the maps' }).click();
await page.waitForSelector('.stage.running', { timeout: 20000 });
const ofStudio = fs.readdirSync('/proc').filter((pid) => /^\d+$/.test(pid) && fs.existsSync(`/proc/${pid}/stat`)
  && fs.readFileSync(`/proc/${pid}/stat`, 'utf8').split(') ')[1].split(' ')[1] === String(studio.pid));
for (const pid of ofStudio) process.kill(Number(pid), 'SIGKILL');
await page.locator('.notice.error').waitFor({ timeout: 30000 });
verdict(ofStudio.length > 0, `a run that something kills: ${(await page.locator('.notice.error').innerText()).replace(/\s+/g, ' ')}`);
await shot(page, 'bad-run');

// Three hundred at once, each a little different.
const many = path.join(work, 'many');
fs.mkdirSync(many);
for (let n = 0; n < 300; ++n) fs.writeFileSync(path.join(many, `many_${String(n).padStart(3, '0')}.jpg`), Buffer.concat([fs.readFileSync(photographs[n % 4]), Buffer.from(`#${n}`)]));
await page.getByRole('link', { name: 'Photographs' }).click();
await page.waitForSelector('.drop');
const begun = performance.now();
await input.setInputFiles(fs.readdirSync(many).map((name) => path.join(many, name)));
await page.waitForFunction(() => document.querySelectorAll('.tile').length > 250);
const listed = performance.now() - begun;
// The page answers while they are sent.
const clicked = performance.now();
await page.getByLabel('Only those with a problem').or(page.getByRole('button', { name: 'Use the phone' })).first().click();
const answered = performance.now() - clicked;
verdict(listed < 5000 && answered < 1500, `300 photographs are listed after ${(listed / 1000).toFixed(1)} s; a click is answered after ${(answered / 1000).toFixed(2)} s meanwhile`);
await page.keyboard.press('Escape');
await page.waitForFunction(() => !document.querySelector('.upload-progress'), null, { timeout: 240000 });
console.log(`     all are sent after ${((performance.now() - begun) / 1000).toFixed(0)} s; ${kept()} files lie in photos/`);
await shot(page, 'bad-many');

const strange = said.filter((line) => !/Failed to load resource|net::ERR/.test(line));
verdict(strange.length === 0, `the console has no error but of requests that failed ${strange.slice(0, 3).join(' | ')}`);
await browser.close();
await studio.end();
fs.rmSync(work, { recursive: true, force: true });
finish();

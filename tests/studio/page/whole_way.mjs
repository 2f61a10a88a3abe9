// node whole_way.mjs PROGRAMS SCREENSHOTS [MEGAPIXELS]: the whole way with the real server: an empty folder, a capture in a printed board, twelve
// synthetic photographs of it sent from the phone's page, a quick look, the run, the relit material. At each step: pictures at 390 and 1400 px,
// light and dark, axe, a silent console.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { finish, launch, open, relitByPointer, setResolution, shapes, stepsOf, verdict, viewerIn } from './browser.mjs';
import { startStudio } from './studio.mjs';

const [programs, out, megapixels = '2'] = process.argv.slice(2);
fs.mkdirSync(out, { recursive: true });
const work = fs.mkdtempSync(path.join(os.tmpdir(), 'glint-whole-way-'));
const folder = path.join(work, 'captures');
fs.mkdirSync(folder);
const studio = await startStudio(programs, folder);
const browser = await launch();
const desk = await open(browser, shapes[2], studio.address);
const { page } = desk;

const step = stepsOf(page, out);
const narrow = shapes.slice(0, 2);
const seconds = (since) => ((performance.now() - since) / 1000).toFixed(1);

// An empty folder, a capture.
await page.getByRole('link', { name: 'Make the first capture' }).waitFor();
const loads = [];
for (let n = 0; n < 3; ++n) {
  const begun = performance.now();
  await page.reload();
  await page.getByRole('link', { name: 'Make the first capture' }).waitFor();
  loads.push(performance.now() - begun);
}
verdict(Math.min(...loads) <= 1000, `the first page stands after ${loads.map((ms) => `${ms.toFixed(0)} ms`).join(', ')}`);
await step('empty library');
await page.getByRole('link', { name: 'Make the first capture' }).click();
await page.waitForFunction(() => document.querySelector('#name')?.value);
await page.getByLabel('Name').fill('leather');
await step('new capture');
await page.getByRole('button', { name: 'Create capture' }).click();
await page.waitForSelector('.drop');
await step('no photographs');
const capture = path.join(folder, 'leather');
verdict(fs.existsSync(path.join(capture, 'capture.toml')), 'capture.toml is written');

// Its board, photographed.
execFileSync(path.join(programs, 'glint-synth'), ['capture', path.join(work, 'shot'), '--board', path.join(capture, 'board.json'), '--family', 'leather', '--seed', '3',
  '--megapixels', megapixels, '--texels', '512', '--sample-mm', '100']);
const photographs = fs.readdirSync(path.join(work, 'shot/photos')).sort().map((name) => path.join(work, 'shot/photos', name));
verdict(photographs.length === 12, 'twelve photographs are rendered');

// The phone.
await page.getByRole('button', { name: 'Use the phone' }).click();
await page.waitForSelector('.qr svg');
await step('code for the phone');
const address = await page.locator('.address').textContent();
await page.keyboard.press('Escape');
const phone = await open(browser, narrow[0], address, { hasTouch: true, isMobile: true });
await phone.page.getByRole('button', { name: 'Understood' }).waitFor();
await step('phone before the first photograph', phone.page, narrow);
await phone.page.getByRole('button', { name: 'Understood' }).click();
const camera = phone.page.locator('input[capture]');
const judged = (subject, n) =>
  subject.waitForFunction((wanted) => [...document.querySelectorAll('.tile .badge')].filter((b) => ['Good', 'Weak', 'Bad'].includes(b.textContent)).length >= wanted, n, { timeout: 120000 });
const waits = [];
for (let n = 0; n < 4; ++n) {
  const since = performance.now();
  await camera.setInputFiles(photographs[n]);
  await judged(phone.page, n + 1);
  waits.push(performance.now() - since);
}
console.log(`     a photograph has its verdict after ${waits.map((w) => (w / 1000).toFixed(1)).join(', ')} s`);
await step('phone after four photographs', phone.page, narrow);
await page.waitForFunction(() => document.querySelectorAll('.tile').length === 4);
await step('four photographs');
const since = performance.now();
await phone.page.locator('input[multiple]').setInputFiles(photographs.slice(4));
await phone.page.waitForTimeout(400);
await step('phone while sending', phone.page, narrow);
await judged(phone.page, 12);
console.log(`     eight more are sent and judged within ${seconds(since)} s`);
await step('phone after twelve photographs', phone.page, narrow);
verdict(fs.readdirSync(path.join(capture, 'photos')).length === 12, 'twelve photographs lie in the capture’s folder');
verdict(phone.said.length === 0, `the phone’s console is silent ${phone.said.join(' | ')}`);
await phone.close();
await page.waitForFunction(() => document.querySelectorAll('.tile').length === 12);
await step('twelve photographs');

// A quick look, then the maps.
async function run(button, name) {
  await page.getByRole('navigation', { name: 'Steps' }).getByRole('link', { name: 'Maps' }).click();
  const begun = performance.now();
  await page.getByRole('button', { name: button }).click();
  await page.waitForSelector('.stage.running');
  await step(`${name} running`);
  await page.getByRole('link', { name: 'Look at the result' }).waitFor({ timeout: 300000 });
  console.log(`     ${name}: ${seconds(begun)} s, pictures included`);
  await step(`${name} done`);
  await page.getByRole('link', { name: 'Look at the result' }).click();
  return viewerIn(page);
}
await page.getByRole('navigation', { name: 'Steps' }).getByRole('link', { name: 'Maps' }).click();
await setResolution(page, 512);
verdict(/resolution_px = 512/.test(fs.readFileSync(path.join(capture, 'capture.toml'), 'utf8')), 'capture.toml has the resolution');
await page.getByLabel('Make a seamless tile').check();
await step('options');
await run('Quick look', 'quick look');
await step('quick look result');
const viewer = await run('Make the maps', 'maps');
await page.locator('.report').scrollIntoViewIfNeeded();
await step('result');
for (const [name, selector] of [['figures and maps', '#figures-title'], ['tile and comparison', '#tile-title, #compare-title'], ['files', '#files-title']]) {
  const place = page.locator(selector).first();
  if (await place.count()) {
    await place.scrollIntoViewIfNeeded();
    await page.evaluate((s) => document.querySelector(s).closest('section').scrollIntoView(), selector);
    await page.waitForTimeout(400);
    await step(name);
  } else verdict(false, `${name} is shown`);
}

// The light moves, and with it the picture.
verdict(await relitByPointer(page, viewer), 'the material is relit as the pointer moves');
await step('relit');

// The library knows, and what was downloaded is whole.
const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('link', { name: 'All maps and materials' }).click()]);
const zip = fs.readFileSync(await download.path());
verdict(zip.subarray(0, 2).toString() === 'PK' && zip.length > 100000, `the zip has ${(zip.length / 1e6).toFixed(1)} MB`);
await page.getByRole('link', { name: 'Library' }).click();
await page.waitForSelector('.card');
await step('library');
verdict(desk.said.length === 0, `the console is silent ${desk.said.join(' | ')}`);

await browser.close();
await studio.end();
const status = execFileSync(path.join(programs, 'glint-status'), [capture]).toString();
verdict(/report/.test(status), 'glint status reads the same capture');
fs.rmSync(work, { recursive: true, force: true });
finish();

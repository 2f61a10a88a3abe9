// node demo_photographs.mjs PROGRAMS SCREENSHOTS [MEGAPIXELS]: somebody who has the photographs of `glint demo` as files, and an empty folder:
// they show another board than the one that Studio makes; Studio says so and offers theirs; then the maps, relit. Then the other ways to a board
// that is printed already: its file, its figures, another one for a capture that is there.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { finish, launch, open, relitByPointer, setResolution, shapes, stepsOf, verdict, viewerIn } from './browser.mjs';
import { startStudio } from './studio.mjs';

const [programs, out, megapixels = '2'] = process.argv.slice(2);
fs.mkdirSync(out, { recursive: true });
const work = fs.mkdtempSync(path.join(os.tmpdir(), 'glint-demo-photographs-'));
const demo = path.join(work, 'demo');
execFileSync(path.join(programs, 'glint-synth'), ['capture', demo, '--family', 'leather', '--seed', '3', '--resolution', '512', '--megapixels', megapixels]);
const photographs = fs.readdirSync(path.join(demo, 'photos')).sort().map((name) => path.join(demo, 'photos', name));
const folder = path.join(work, 'captures');
fs.mkdirSync(folder);
const studio = await startStudio(programs, folder);
const browser = await launch();
const desk = await open(browser, shapes[2], studio.address);
const { page } = desk;
const step = stepsOf(page, out, 'demo-');
const read = (...names) => fs.readFileSync(path.join(folder, ...names), 'utf8');
const chooser = () => page.getByRole('group', { name: 'Board' });

// The first capture as it is proposed, and the photographs.
await page.getByRole('link', { name: 'Make the first capture' }).click();
await page.waitForFunction(() => document.querySelector('#name')?.value);
verdict(await page.getByRole('radio', { name: /A new board/ }).isChecked(), 'a new board is proposed, not one that nobody may have');
await page.getByLabel('Name').fill('leather');
await page.getByRole('radio', { name: /Another board that is printed already/ }).check();
verdict(await page.getByRole('button', { name: 'Create capture' }).isDisabled(), 'a board that is not described yet makes no capture');
await page.getByText('Enter its figures instead').click();
await step('a board by its figures');
await page.getByRole('radio', { name: /A new board/ }).check();
await page.getByRole('button', { name: 'Create capture' }).click();
await page.waitForSelector('.drop');
await page.locator('input[type=file][multiple]').first().setInputFiles(photographs);
const use = page.getByRole('button', { name: 'Use this board: glint-demo' });
await use.waitFor({ timeout: 120000 });
await page.waitForFunction(() => document.querySelectorAll('.tile .badge.bad').length === 12, null, { timeout: 120000 });
verdict(await page.getByText('Every photograph shows another board').first().isVisible(), 'another board is said to be another board');
await step('another board');
const before = read('leather', 'board.json');
await use.click();
await page.waitForFunction(() => document.querySelectorAll('.tile .badge.good, .tile .badge.weak').length === 12, null, { timeout: 120000 });
verdict(await page.locator('.tile.dimmed').count() === 0, 'one press takes all photographs back in');
verdict(read('leather', 'board-1.json') === before, 'the old board is kept');
verdict(/file = "board.json"/.test(read('leather', 'capture.toml')) && JSON.parse(read('leather', 'board.json')).squares[0] === 18, 'the capture has the board of the photographs');
await step('the board of the photographs');

// To the material.
await page.getByRole('link', { name: 'Go on to Maps' }).click();
await setResolution(page, 256);
await page.getByRole('button', { name: 'Make the maps' }).click();
await page.getByRole('link', { name: 'Look at the result' }).waitFor({ timeout: 300000 });
await step('maps done');
await page.getByRole('link', { name: 'Look at the result' }).click();
const viewer = await viewerIn(page);
await page.locator('.report').scrollIntoViewIfNeeded();
await step('result');
verdict(await relitByPointer(page, viewer), 'the material is relit as the pointer moves');

// A board's file for a new capture; what describes none is refused and leaves nothing.
await page.goto(`${studio.home}/#/new`);
await page.waitForFunction(() => document.querySelector('#name')?.value);
verdict(await page.getByRole('radio', { name: /glint-demo/ }).count() === 1, 'the demo’s board is there to choose, once');
await page.getByRole('radio', { name: /Another board that is printed already/ }).check();
const file = chooser().locator('input[type=file]');
const boards = fs.readdirSync(path.join(folder, '.glint-studio/boards')).length;
await file.setInputFiles({ name: 'board.json', mimeType: 'application/json', buffer: Buffer.from('{"glint_board": 1, "kind": "charuco", "squares": [9, 0]}') });
await chooser().getByRole('alert').waitFor();
await step('a file that describes no board');
verdict(fs.readdirSync(path.join(folder, '.glint-studio/boards')).length === boards, 'what describes no board is not kept');
await file.setInputFiles({ name: 'capture.toml', mimeType: '', buffer: Buffer.from(fs.readFileSync(path.join(demo, 'capture.toml'), 'utf8').replace('square_mm = 13', 'square_mm = 14')) });
await page.getByRole('radio', { name: /charuco-18x14-14mm/ }).waitFor();
verdict(await page.getByRole('radio', { name: /charuco-18x14-14mm/ }).isChecked(), 'the board of a capture.toml is taken and chosen');
await step('a board by its file');
await page.getByRole('radio', { name: /Another board that is printed already/ }).check();
await page.getByText('Enter its figures instead').click();
await page.getByLabel('Kind').selectOption('checkerboard');
await page.getByLabel('Columns', { exact: true }).fill('10');
await page.getByLabel('Rows', { exact: true }).fill('7');
await page.getByLabel('Side of a square (mm)').fill('25');
await page.getByRole('button', { name: 'Take this board' }).click();
await page.getByRole('radio', { name: /checkerboard-10x7-25mm/ }).waitFor();
await page.getByLabel('Name').fill('checkerboard');
await page.getByRole('button', { name: 'Create capture' }).click();
await page.waitForSelector('.drop');
verdict(JSON.parse(read('checkerboard', 'board.json')).kind === 'checkerboard', 'a capture has the board of the figures');

// Another board for it.
await page.getByRole('button', { name: 'Change the board' }).click();
await page.getByRole('dialog').getByRole('radio', { name: /glint-demo/ }).check();
await step('change the board');
await page.getByRole('dialog').getByRole('button', { name: 'Use this board' }).click();
await page.getByRole('dialog').waitFor({ state: 'detached' });
await page.locator('section', { hasText: 'Change the board' }).getByText('glint-demo').waitFor();
verdict(JSON.parse(read('checkerboard', 'board.json')).squares[0] === 18 && JSON.parse(read('checkerboard', 'board-1.json')).kind === 'checkerboard', 'the board of a capture can be changed');

// The demo's whole folder, where maps of its truth lie beside the photographs.
await page.locator('input[webkitdirectory]').setInputFiles(demo);
await page.waitForFunction(() => document.querySelectorAll('.tile .badge.good, .tile .badge.weak').length === 12, null, { timeout: 120000 });
verdict(fs.readdirSync(path.join(folder, 'checkerboard/photos')).every((name) => name.endsWith('.jpg')), 'of a capture’s folder the photographs alone are sent');
desk.said.splice(0, desk.said.length, ...desk.said.filter((text) => !/status of 422/.test(text))); // what the browser says of the refused file
verdict(desk.said.length === 0, `the console is silent ${desk.said.join(' | ')}`);

await browser.close();
await studio.end();
fs.rmSync(work, { recursive: true, force: true });
finish();

// node actions.mjs APP [SCREENSHOTS]: what a person does, against the mock server: a new capture in two clicks, photographs dropped, sent from the
// phone over a connection that breaks, left out and taken back in; options; a run, its result, cancelling; trash; the keyboard alone.
import { deflateSync } from 'node:zlib';
import { finish, launch, open, screenshots, verdict } from './browser.mjs';
import { Mock } from './mock.mjs';

const [app, folder] = process.argv.slice(2);
const shot = screenshots(folder);
const browser = await launch();
const wide = { width: 1400, height: 950, scheme: 'light' };
const narrow = { width: 390, height: 844, scheme: 'light' };
const mock = new Mock(app, { empty: true, judge_ms: 200, run_ms: 150 });
const home = `http://127.0.0.1:${await mock.listen()}`;

// A PNG of one colour: something that a browser can show.
function png(width, height, [r, g, b]) {
  const table = Array.from({ length: 256 }, (_, n) => {
    for (let k = 0; k < 8; ++k) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
    return n >>> 0;
  });
  const chunk = (kind, data) => {
    const body = Buffer.concat([Buffer.from(kind), data]);
    let sum = 0xffffffff;
    for (const byte of body) sum = table[(sum ^ byte) & 255] ^ (sum >>> 8);
    const ends = Buffer.alloc(8);
    ends.writeUInt32BE(data.length, 0);
    ends.writeUInt32BE((sum ^ 0xffffffff) >>> 0, 4);
    return Buffer.concat([ends.subarray(0, 4), body, ends.subarray(4)]);
  };
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header.set([8, 2, 0, 0, 0], 8);
  const row = Buffer.concat([Buffer.from([0]), Buffer.alloc(3 * width).map((_, i) => [r, g, b][i % 3])]);
  return Buffer.concat([Buffer.from('89504e470d0a1a0a', 'hex'), chunk('IHDR', header), chunk('IDAT', deflateSync(Buffer.concat(Array(height).fill(row)))), chunk('IEND', Buffer.alloc(0))]);
}
const file = (name, colour = [150, 110, 70]) => ({ name, mimeType: 'image/png', buffer: png(64, 48, colour) });

const studio = await open(browser, wide, `${home}/`);
const { page } = studio;

// A new capture in two clicks.
await page.getByRole('link', { name: 'Make the first capture' }).click();
await page.waitForFunction(() => document.querySelector('#name')?.value);
await page.getByRole('button', { name: 'Create capture' }).click();
await page.waitForSelector('.drop');
verdict(mock.captures.size === 1 && mock.boards.length === 1, 'two clicks make a capture and its board');
verdict(await page.evaluate(() => document.activeElement?.tagName === 'H1'), 'the new page’s title has the focus');

// Dropped files, one of which is no photograph, one blurred, one dark.
const [capture] = mock.captures.values();
const names = ['a.png', 'b.png', 'blur1.png', 'dark1.png', 'text.jpg'];
await page.evaluate(async (list) => {
  const transfer = new DataTransfer();
  for (const { name, bytes } of list) transfer.items.add(new File([new Uint8Array(bytes)], name, { type: 'image/png' }));
  document.querySelector('.drop').dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true, cancelable: true }));
}, names.map((name) => ({ name, bytes: [...png(64, 48, [120, 120, 90])] })));
await page.waitForSelector('.tile');
verdict(await page.locator('.tile').count() === 5, 'every photograph appears at once');
await page.waitForFunction(() => document.querySelectorAll('.badge.good').length >= 2 && document.querySelector('.tile .badge.weak'));
await page.getByText('is no photograph: it begins with plain text').waitFor();
verdict(capture.photographs.length === 4, 'what is no photograph is named and not kept');
verdict(await page.locator('.tile', { hasText: 'blur1.png' }).getByText('Hold the phone still').isVisible(), 'a bad one is named with reason and remedy');
await shot(page, 'do-dropped');
await page.getByRole('button', { name: 'Take back in: blur1.png' }).click();
await page.getByRole('button', { name: 'Leave out: blur1.png' }).waitFor();
verdict(capture.photographs.find((p) => p.name === 'blur1.png').left_out === false, 'a photograph that was left out can be taken back in');
await page.getByRole('button', { name: 'Dismiss' }).click();
verdict(await page.locator('.tile').count() === 4, 'a refusal can be dismissed');

// The phone, over a connection that breaks.
await page.getByRole('button', { name: 'Use the phone' }).click();
const address = await page.locator('.address').textContent();
await page.keyboard.press('Escape');
verdict(await page.evaluate(() => document.activeElement?.textContent?.includes('Use the phone')), 'Escape closes the code and returns the focus');
const phone = await open(browser, narrow, address, { hasTouch: true, isMobile: true });
await phone.page.getByRole('button', { name: 'Understood' }).click();
mock.broken = true;
await phone.page.locator('input[multiple]').setInputFiles([1, 2, 3].map((n) => file(`phone${n}.png`, [60 * n, 90, 80])));
await phone.page.getByText('Trying again').first().waitFor();
await shot(phone.page, 'do-phone-broken');
mock.broken = false;
await phone.page.waitForFunction(() => document.querySelectorAll('.badge.good').length >= 5 && !document.querySelector('.phone-sending'), null, { timeout: 20000 });
verdict(capture.photographs.filter((p) => p.name.startsWith('phone')).length === 3, 'three photographs arrive over a connection that broke, each once');
await shot(phone.page, 'do-phone');
await page.locator('.tile', { hasText: 'phone3.png' }).waitFor({ timeout: 2000 });
verdict(true, 'they appear in Studio by themselves');
mock.closePhone(capture);
await phone.page.locator('input[multiple]').setInputFiles([file('late.png')]);
await phone.page.getByText('no longer valid').waitFor();
verdict(true, 'an expired link says what to do');
await phone.close();

// Options, a run, its result.
await page.getByRole('navigation', { name: 'Steps' }).getByRole('link', { name: 'Maps' }).click();
await page.getByLabel('Bare metal in the sample').selectOption('possible');
await page.getByLabel('Make a seamless tile').check();
await page.getByLabel('Resolution of the maps').fill('512');
await page.getByLabel('Resolution of the maps').press('Enter');
await page.getByText('Held-out photographs').click();
await page.getByRole('checkbox', { name: 'a.png' }).check();
await page.getByText('1 held out').waitFor();
verdict(JSON.stringify(capture.options) === JSON.stringify({ fit: { metals: 'possible' }, tile: { enabled: true }, sample: { resolution_px: 512 }, run: { exclude: 'a.png' } }), 'the options people need are saved');
await page.getByText('All options of the programs').click();
await page.getByLabel('Find an option').fill('prior');
await page.getByLabel('prior', { exact: true }).fill('-1');
await page.getByLabel('prior', { exact: true }).press('Enter');
await page.getByText('is out of range').waitFor();
verdict(true, 'a value that the program refuses is named with its remedy');
await page.getByRole('button', { name: 'Make the maps' }).click();
await page.waitForSelector('.stage.running');
await shot(page, 'do-run');
await page.getByRole('link', { name: 'Look at the result' }).click({ timeout: 15000 });
await page.waitForSelector('iframe.report');
const frame = page.frameLocator('iframe.report');
await frame.getByRole('heading').waitFor();
verdict(await page.locator('.maps li').count() === 5 && await page.locator('.tile-preview').isVisible(), 'a run ends in maps, page and tile');
await page.getByRole('navigation', { name: 'Steps' }).getByRole('link', { name: 'Maps' }).click();
await page.getByRole('button', { name: 'Quick look' }).click();
await page.getByRole('button', { name: 'Cancel the run' }).click();
await page.getByText('The run was cancelled').waitFor();
verdict(capture.run.state === 'cancelled', 'a run can be cancelled');

// The connection goes and comes back.
const port = Number(new URL(home).port);
studio.said.length = 0;
await mock.close();
await page.getByText('The connection to Glint Studio is lost').waitFor();
await mock.listen(port);
await page.getByText('The connection to Glint Studio is lost').waitFor({ state: 'detached', timeout: 15000 });
verdict(true, 'a lost connection is named, and found again');
studio.said.length = 0; // what the browser itself says of connections that were refused

// The library by keyboard alone: search, open, back, trash.
await page.goto(`${home}/#/`);
await page.waitForSelector('.card');
await page.keyboard.press('Tab');
verdict(await page.evaluate(() => document.activeElement !== document.body), 'Tab reaches the page');
await page.getByLabel('Search captures').focus();
await page.keyboard.type('nothing of the kind');
await page.getByText('No capture is called').waitFor();
await page.getByLabel('Search captures').fill('');
await page.getByRole('button', { name: /to the trash/ }).focus();
await page.keyboard.press('Enter');
await page.getByRole('dialog').waitFor();
await page.getByRole('dialog').getByRole('button', { name: 'Move to trash' }).focus();
await page.keyboard.press('Enter');
await page.getByText('No captures yet').waitFor();
verdict(mock.captures.size === 0, 'a capture goes to the trash by keyboard');
verdict(studio.said.length === 0, `the console is silent ${studio.said.join(' | ')}`);

await browser.close();
await mock.close();
finish();

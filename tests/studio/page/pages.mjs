// node pages.mjs APP [SCREENSHOTS]: every page against the mock server at 390 and 1400 px, light and dark: it fits, nothing jumps,
// axe has no serious finding, the console is silent, nothing outside is asked for; and the size of what is sent.
import fs from 'node:fs';
import path from 'node:path';
import { finish, launch, layoutShift, open, screenshots, seriousFindings, shapes, tooWide, verdict } from './browser.mjs';
import { Mock } from './mock.mjs';

const [app, folder] = process.argv.slice(2);
const shot = screenshots(folder);
const browser = await launch();
const bytes = fs.readdirSync(app).reduce((sum, file) => sum + fs.statSync(path.join(app, file)).size, 0);
verdict(bytes <= 1.2e6, `the pages weigh ${(bytes / 1000).toFixed(0)} kB`);

const mock = new Mock(app);
const home = `http://127.0.0.1:${await mock.listen()}`;
const phone = mock.openPhone(mock.captures.get('felt'), new URL(home).host).url;
const empty = new Mock(app, { empty: true });
const emptyHome = `http://127.0.0.1:${await empty.listen()}`;
const { id: fresh } = empty.make({ name: 'Sample 1', kind: 'board', size_mm: [100, 100] });
const freshPhone = empty.openPhone(empty.captures.get(fresh), new URL(emptyHome).host).url;

const pages = {
  library: [`${home}/`, '.card'],
  'no captures': [`${emptyHome}/#/`, '.card, .empty'],
  'new capture': [`${home}/#/new`, '.sample-drawing'],
  'first board': [`${emptyHome}/#/new`, '.new-board'],
  photographs: [`${home}/#/capture/felt/photographs`, '.tile'],
  'no photographs': [`${emptyHome}/#/capture/${fresh}/photographs`, '.drop'],
  options: [`${home}/#/capture/felt/run`, '.options .field'],
  running: [`${home}/#/capture/slate`, '.stage.running'],
  failed: [`${home}/#/capture/leather`, '.notice.error'],
  result: [`${home}/#/capture/oak`, '.maps img'],
  'quick look': [`${home}/#/capture/brass/result`, '.figures'],
  'no result': [`${home}/#/capture/felt/result`, '.empty'],
  'fixed camera': [`${home}/#/capture/icon/photographs`, '.tile'],
  'imported set': [`${home}/#/capture/linen/photographs`, '.notice'],
  'unknown page': [`${home}/#/nowhere`, 'h1'],
  phone: [phone, '.tile'],
  'first photograph': [freshPhone, '.take'],
};

for (const shape of shapes) {
  const at = `${shape.width} ${shape.scheme}`;
  for (const [name, [address, ready]] of Object.entries(pages)) {
    const { page, said, close } = await open(browser, shape, address);
    await page.waitForSelector(ready);
    await page.waitForLoadState('load');
    const shift = await layoutShift(page);
    const findings = await seriousFindings(page);
    const wide = await tooWide(page);
    await shot(page, `${name.replace(/ /g, '-')}-${shape.width}-${shape.scheme}`);
    const wrong = [...said, ...findings, ...(wide ? ['wider than the window'] : []), ...(shift > 0.1 ? [`things move by ${shift.toFixed(2)}`] : [])];
    verdict(wrong.length === 0, `${name}, ${at}${wrong.length ? `: ${wrong.join(' | ')}` : ''}`);
    await close();
  }
}

// In the dialogs too.
for (const shape of shapes) {
  const { page, said, close } = await open(browser, shape, `${home}/#/capture/oak/photographs`);
  await page.getByRole('button', { name: 'Use the phone' }).click();
  await page.waitForSelector('.qr svg');
  const findings = await seriousFindings(page);
  await shot(page, `code-${shape.width}-${shape.scheme}`);
  verdict(findings.length + said.length === 0, `the phone’s code, ${shape.width} ${shape.scheme} ${[...findings, ...said].join(' | ')}`);
  await close();
}
for (const shape of shapes) {
  const { page, said, close } = await open(browser, shape, `${home}/#/capture/felt/photographs`);
  await page.getByRole('button', { name: 'Change the board' }).click();
  await page.getByRole('dialog').getByRole('radio', { name: /Another board/ }).check();
  await page.getByText('Enter its figures instead').click();
  const findings = await seriousFindings(page);
  await shot(page, `change-the-board-${shape.width}-${shape.scheme}`);
  verdict(findings.length + said.length === 0, `another board, ${shape.width} ${shape.scheme} ${[...findings, ...said].join(' | ')}`);
  await close();
}
for (const width of [390, 768, 1024, 1600]) {
  for (const name of ['library', 'new capture', 'photographs', 'options', 'result', 'phone']) {
    const { page, close } = await open(browser, { width, height: 900, scheme: 'light' }, pages[name][0]);
    await page.waitForSelector(pages[name][1]);
    if (await tooWide(page)) verdict(false, `${name} fits into ${width} px`);
    await close();
  }
}
await browser.close();
await mock.close();
await empty.close();
finish();

// What the page's tests share: the browser, a page whose console is listened to, axe, verdicts.
import fs from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { chromium } from 'playwright-core';

const axe = createRequire(import.meta.url).resolve('axe-core/axe.min.js');

export const shapes = [390, 1400].flatMap((width) => ['light', 'dark'].map((scheme) => ({ width, height: width < 600 ? 844 : 950, scheme })));

export const launch = () =>
  chromium.launch({
    executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
    args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
  });

// For trying changed pages with a server that was built before: the folder that `npm run build` has filled.
const builtPages = process.env.GLINT_STUDIO_PAGES;

let failures = 0;

export function verdict(fine, text) {
  console.log(`${fine ? 'ok  ' : 'FAIL'} ${text}`);
  if (!fine) ++failures;
}

export function finish() {
  console.log(failures ? `${failures} failed` : 'all fine');
  process.exit(failures ? 1 : 0);
}

// A page in a window of its own; `said` collects warnings and errors of the console and requests to elsewhere.
export async function open(browser, { width, height, scheme }, address, options = {}) {
  const context = await browser.newContext({ viewport: { width, height }, colorScheme: scheme, ...options });
  if (builtPages) {
    for (const file of fs.readdirSync(builtPages).filter((name) => !name.endsWith('.html'))) {
      await context.route(`**/${file}`, (route) => route.fulfill({ path: path.join(builtPages, file) }));
    }
  }
  const page = await context.newPage();
  const said = [];
  const home = new URL(address).origin;
  page.on('console', (message) => {
    if (['error', 'warning'].includes(message.type())) said.push(message.text());
  });
  page.on('pageerror', (error) => said.push(String(error)));
  page.on('request', (request) => {
    if (!request.url().startsWith(home) && !/^(data|blob):/.test(request.url())) said.push(`request to ${request.url()}`);
  });
  await page.goto(address);
  return { page, said, close: () => context.close() };
}

// Findings of axe that are serious or critical; axe is put in from outside, where the page's own policy does not reach.
export async function seriousFindings(page) {
  await page.evaluate(fs.readFileSync(axe, 'utf8'));
  const { violations } = await page.evaluate(() => window.axe.run(document, { iframes: false, resultTypes: ['violations'] }));
  return violations
    .filter((violation) => ['serious', 'critical'].includes(violation.impact))
    .map((violation) => `${violation.id}: ${violation.nodes.map((node) => node.target.join(' ')).slice(0, 3).join(', ')}`);
}

export const tooWide = (page) => page.evaluate(() => document.documentElement.scrollWidth > window.innerWidth);

// How far things have moved by themselves since the page opened (Cumulative Layout Shift).
export const layoutShift = (page) =>
  page.evaluate(() => new Promise((done) => {
    let sum = 0;
    new PerformanceObserver((list) => {
      for (const entry of list.getEntries()) if (!entry.hadRecentInput) sum += entry.value;
    }).observe({ type: 'layout-shift', buffered: true });
    setTimeout(() => done(sum), 100);
  }));

export function screenshots(folder) {
  if (folder) fs.mkdirSync(folder, { recursive: true });
  return async (page, name) => {
    if (folder) await page.screenshot({ path: path.join(folder, `${name}.png`), fullPage: true });
  };
}

// A function that judges `page`, or another, as it is now in the four shapes: pictures in `out`, width, axe; then it is as it was before.
export function stepsOf(page, out, prefix = '') {
  let number = 0;
  return async function step(name, subject = page, subjectShapes = shapes) {
    const label = `${prefix}${String(++number).padStart(2, '0')}-${name.replace(/ /g, '-')}`;
    const before = subject.viewportSize();
    const wrong = [];
    for (const { width, height, scheme } of subjectShapes) {
      await subject.setViewportSize({ width, height });
      await subject.emulateMedia({ colorScheme: scheme });
      await subject.waitForTimeout(150);
      if (await tooWide(subject)) wrong.push(`wider than ${width} px`);
      await subject.screenshot({ path: path.join(out, `${label}-${width}-${scheme}.png`) });
      wrong.push(...(await seriousFindings(subject)));
    }
    await subject.setViewportSize(before);
    await subject.emulateMedia({ colorScheme: 'light' });
    verdict(wrong.length === 0, `${name}${wrong.length ? `: ${[...new Set(wrong)].join(' | ')}` : ''}`);
  };
}

export async function setResolution(page, texels) {
  const resolution = page.getByRole('spinbutton', { name: 'Resolution of the maps' });
  await resolution.fill(String(texels));
  await resolution.press('Enter');
  await page.getByText('Options are saved').waitFor();
}

// The frame of the result's viewer once it shows the material.
export async function viewerIn(page) {
  const viewer = await (await page.waitForSelector('iframe.report')).contentFrame();
  await viewer.waitForFunction(() => window.glintViewer?.ready, null, { timeout: 120000 });
  return viewer;
}

// Whether the picture changes as the pointer moves the light.
export async function relitByPointer(page, viewer) {
  const picture = () => viewer.evaluate(() => document.getElementById('viewer-canvas').toDataURL('image/png'));
  const first = await picture();
  await viewer.evaluate(() => document.getElementById('viewer-canvas').scrollIntoView({ block: 'center' }));
  await page.waitForTimeout(300);
  const box = await (await viewer.$('#viewer-canvas')).boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 4, box.y + box.height / 3, { steps: 5 });
  await page.mouse.up();
  await page.waitForTimeout(500);
  return (await picture()) !== first;
}

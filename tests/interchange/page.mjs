// node page.mjs REPORT.html PAIRS OUT: the report in headless Chromium against the pictures that
// glint-eval views --pairs PAIRS wrote (photograph | rendering | difference); screenshots into OUT.
import fs from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const require = createRequire(import.meta.url);
const [report, pairs, out] = process.argv.slice(2).map((p) => path.resolve(p));
fs.mkdirSync(out, { recursive: true });
let failures = 0;
function verdict(fine, text) {
  console.log(`${fine ? 'ok  ' : 'FAIL'} ${text}`);
  failures += fine ? 0 : 1;
}

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM || '/usr/bin/chromium',
  args: ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'],
});

async function open(width, height, colorScheme) {
  const page = await browser.newPage({ viewport: { width, height }, colorScheme });
  const said = [], asked = [];
  page.on('console', (m) => { if (['error', 'warning'].includes(m.type())) said.push(m.text()); });
  page.on('pageerror', (e) => said.push(String(e)));
  page.on('request', (r) => { if (!/^(file|data|blob):/.test(r.url())) asked.push(r.url()); });
  await page.goto(pathToFileURL(report).href);
  await page.waitForFunction(() => window.glintViewer?.ready, null, { timeout: 120000 });
  return { page, said, asked };
}

// Statistics of |a − b| over the bytes of two pictures, the second cut to its middle third.
async function difference(page, rendering, pair) {
  return page.evaluate(async ([a, b]) => {
    const pixels = async (uri, third) => {
      const bitmap = await createImageBitmap(await (await fetch(uri)).blob());
      const width = third ? bitmap.width / 3 : bitmap.width;
      const canvas = new OffscreenCanvas(width, bitmap.height);
      const context = canvas.getContext('2d');
      context.drawImage(bitmap, third ? -width : 0, 0);
      return context.getImageData(0, 0, width, bitmap.height).data;
    };
    const one = await pixels(a, false), other = await pixels(b, true);
    let sum = 0, near = 0;
    for (let i = 0; i < one.length; i += 4) {
      let most = 0;
      for (let c = 0; c < 3; ++c) {
        const d = Math.abs(one[i + c] - other[i + c]);
        sum += d;
        most = Math.max(most, d);
      }
      near += most <= 4 ? 1 : 0;
    }
    return { mean: sum / (one.length * 0.75), near: near / (one.length / 4) };
  }, [rendering, `data:image/png;base64,${fs.readFileSync(pair).toString('base64')}`]);
}

const { page, said, asked } = await open(1400, 1000, 'light');
const material = JSON.parse(await page.textContent('#viewer-material'));
for (const [index, view] of material.views.entries()) {
  const rendering = await page.evaluate(
    ([i, size]) => window.glintViewer.renderView(i, ...size), [index, material.size_texel]);
  const { mean, near } = await difference(page, rendering, path.join(pairs, `${view.name}.png`));
  verdict(mean <= 1 && near >= 0.99,
    `${view.name}: mean ${mean.toFixed(3)}/255, ${(100 * near).toFixed(2)} % within 4/255`);
}
// Every light of the menu: drawn, neither black nor white.
await page.reload();
await page.waitForFunction(() => window.glintViewer?.ready, null, { timeout: 120000 });
const lights = await page.$$eval('#viewer-light option', (all) => all.map((one) => one.value));
verdict(lights[0] === 'point' && lights.length > 1, `lights: ${lights.join(', ')}`);
for (const light of lights) {
  await page.selectOption('#viewer-light', light);
  const brightness = await page.evaluate(async () => {
    const uri = document.getElementById('viewer-canvas').toDataURL('image/png');
    const bitmap = await createImageBitmap(await (await fetch(uri)).blob());
    const context = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
    context.drawImage(bitmap, 0, 0);
    const { data } = context.getImageData(bitmap.width / 2 - 50, bitmap.height / 2 - 50, 100, 100);
    return data.reduce((sum, value, i) => sum + (i % 4 < 3 ? value : 0), 0) / 30000;
  });
  verdict(brightness > 5 && brightness < 250, `${light}: mean ${brightness.toFixed(0)}/255`);
}
await page.addScriptTag({ path: require.resolve('axe-core/axe.min.js') });
const { violations } = await page.evaluate(() => window.axe.run());
const serious = violations.filter((v) => ['serious', 'critical'].includes(v.impact));
verdict(serious.length === 0, `axe: ${violations.length} findings, serious ones: ` +
  (serious.map((v) => `${v.id} (${v.nodes[0].target})`).join(', ') || 'none'));
verdict(said.length === 0, `console: ${said.join(' | ') || 'silent'}`);
verdict(asked.length === 0, `network: ${asked.join(' ') || 'nothing asked for'}`);
for (const [name, width, height, scheme] of [
  ['wide_light', 1400, 1000, 'light'], ['wide_dark', 1400, 1000, 'dark'],
  ['phone_light', 375, 800, 'light'], ['phone_dark', 375, 800, 'dark']]) {
  const opened = await open(width, height, scheme);
  await opened.page.screenshot({ path: path.join(out, `${name}.png`) });
  verdict(opened.said.length === 0, `${name}.png, console: ${opened.said.join(' | ') || 'silent'}`);
}
await browser.close();
process.exit(failures > 0 ? 1 : 0);

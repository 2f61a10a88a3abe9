// Bundles the pages of Studio into dist/: two scripts, one style sheet, two pages and the icon.
import fs from 'node:fs';
import { build } from 'esbuild';

await build({
  entryPoints: { studio: 'src/main.tsx', phone: 'src/phone/main.tsx' },
  entryNames: '[name].bundle',
  outdir: 'dist',
  bundle: true,
  minify: true,
  format: 'iife',
  target: 'es2020',
  jsx: 'automatic',
  jsxImportSource: 'preact',
  legalComments: 'inline',
});
await build({ entryPoints: { studio: 'src/style/studio.css' }, outdir: 'dist', bundle: true, minify: true });
for (const file of ['studio.html', 'phone.html', 'icon.svg']) fs.copyFileSync(`src/${file}`, `dist/${file}`);

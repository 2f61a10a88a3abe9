// node materials.mjs FOLDER…: every .glb, .mtlx and .usda in them, read by libraries that no one here
// wrote. Exit code 1 when one complains.
import fs from 'node:fs';
import { createRequire } from 'node:module';
import path from 'node:path';
import gltf from 'gltf-validator';

const require = createRequire(import.meta.url);
let failures = 0;
function verdict(file, fine, text) {
  console.log(`${fine ? 'ok  ' : 'FAIL'} ${file}: ${text}`);
  failures += fine ? 0 : 1;
}

async function checkGltf(file) {
  const { issues } = await gltf.validateBytes(new Uint8Array(fs.readFileSync(file)));
  verdict(file, issues.numErrors === 0 && issues.numWarnings === 0,
    `glTF validator: ${issues.numErrors} errors, ${issues.numWarnings} warnings`);
}

let materialx;
async function loadMaterialX() {
  const folder = path.join(path.dirname(require.resolve('@needle-tools/materialx/package.json')), 'bin');
  globalThis.require = require;  // its loader looks for node's own
  globalThis.__dirname = folder;
  const module = await import(path.join(folder, 'JsMaterialXGenShader.js'));
  const bytes = (name) => {
    const read = fs.readFileSync(path.join(folder, name));
    return read.buffer.slice(read.byteOffset, read.byteOffset + read.byteLength);
  };
  return (module.default || module)({
    wasmBinary: fs.readFileSync(path.join(folder, 'JsMaterialXGenShader.wasm')),
    getPreloadedPackage: () => bytes('JsMaterialXGenShader.data.txt'),
  });
}

async function checkMaterialX(file) {
  materialx ??= await loadMaterialX();
  const generator = materialx.EsslShaderGenerator.create();
  const context = new materialx.GenContext(generator);
  const library = materialx.loadStandardLibraries(context);
  const document = materialx.createDocument();
  document.importLibrary(library);
  await materialx.readFromXmlString(document, fs.readFileSync(file, 'utf8'), '');
  const element = materialx.findRenderableElement(document);
  const shader = generator.generate(element.getNamePath(), element, context);
  const length = shader.getSourceCode('pixel').length;
  verdict(file, document.validate() && length > 1000,
    `MaterialX: valid ${document.validate()}, a shader of ${length} characters`);
}

let usd;
async function loadUsd() {
  // It is built for pages alone.
  process.type = 'renderer';
  globalThis.window = globalThis;
  globalThis.document = {};
  const module = await import('tinyusdz/tinyusdz.js');
  const folder = path.dirname(require.resolve('tinyusdz/package.json'));
  return module.default({ wasmBinary: fs.readFileSync(path.join(folder, 'tinyusdz.wasm')) });
}

async function checkUsd(file) {
  usd ??= await loadUsd();
  const loader = new usd.TinyUSDZLoaderNative();
  const fine = loader.loadFromBinary(new Uint8Array(fs.readFileSync(file)), path.basename(file));
  verdict(file, fine && loader.numMeshes() === 1, `TinyUSDZ: ${fine ? 'parsed' : loader.error()}, ` +
    `${loader.numMeshes()} mesh`);
}

const checks = { '.glb': checkGltf, '.mtlx': checkMaterialX, '.usda': checkUsd };
for (const kind of ['.glb', '.mtlx', '.usda']) {
  for (const folder of process.argv.slice(2)) {
    for (const name of fs.readdirSync(folder).filter((n) => n.endsWith(kind))) {
      await checks[kind](path.join(folder, name));
    }
  }
}
process.exit(failures > 0 ? 1 : 0);

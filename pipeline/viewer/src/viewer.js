// The viewer of the report page: finds the page's material and its elements, and connects them.
import { environments } from './environments.js';
import { channels, MaterialScene } from './scene.js';
import { shapes } from './shapes.js';

const byId = (id) => document.getElementById(id);

function options(select, labels) {
  labels.forEach(([value, label]) => select.add(new Option(label, value)));
}

// Pointer and keys move the light while "Light" is chosen; OrbitControls has the rest.
function connectLight(scene, canvas, isLight) {
  const move = (event) => {
    const box = canvas.getBoundingClientRect();
    scene.lightFrom(
      1.15 * (2 * (event.clientX - box.left) / box.width - 1),
      1.15 * (1 - 2 * (event.clientY - box.top) / box.height));
  };
  canvas.addEventListener('pointerdown', (event) => {
    if (!isLight()) return;
    canvas.setPointerCapture(event.pointerId);
    move(event);
  });
  canvas.addEventListener('pointermove', (event) => {
    if (isLight() && event.buttons !== 0) move(event);
  });
  const steps = { ArrowLeft: [-0.06, 0], ArrowRight: [0.06, 0], ArrowUp: [0, 0.06], ArrowDown: [0, -0.06] };
  canvas.addEventListener('keydown', (event) => {
    const step = steps[event.key];
    if (!step || scene.view) return;
    event.preventDefault();
    scene.lightFrom(scene.lightAcross[0] + step[0], scene.lightAcross[1] + step[1]);
  });
}

function labels(table) {
  return Object.entries(table).map(([key, { label }]) => [key, label]);
}

function connectRelighting(scene, canvas) {
  const drag = byId('viewer-drag');
  const isLight = () => drag.value === 'light' && !scene.view;
  drag.addEventListener('change', () => { scene.controls.enableRotate = drag.value !== 'light'; });
  scene.controls.enableRotate = drag.value !== 'light';
  connectLight(scene, canvas, isLight);
  options(byId('viewer-shape'), labels(shapes));
  byId('viewer-shape').addEventListener('change', (event) => scene.wear(event.target.value));
  options(byId('viewer-channel'), channels.map((label, i) => [i, label]));
  if (scene.material.maps.confidence) options(byId('viewer-channel'), [[5, 'Roughness, standard deviation']]);
  byId('viewer-channel').addEventListener('change', (event) => {
    scene.channel = Number(event.target.value);
    scene.draw();
  });
  options(byId('viewer-light'), [['point', 'Point light'], ...labels(environments)]);
  byId('viewer-light').addEventListener('change', (event) => scene.useEnvironment(event.target.value));
  byId('viewer-exposure').addEventListener('input', (event) => {
    scene.exposure = 2 ** Number(event.target.value);
    scene.draw();
  });
}

function connectComparison(scene, resize) {
  const { views } = scene.material;
  const select = byId('viewer-view'), photograph = byId('viewer-photograph');
  const slider = byId('viewer-slider');
  options(select, [['', 'Relight'], ...views.map((view, i) =>
    [i, `${view.photo}${view.fitted ? '' : ' (held out)'}`])]);
  const clip = () => { photograph.style.clipPath = `inset(0 ${100 - slider.value}% 0 0)`; };
  const show = () => {
    const view = select.value === '' ? null : views[Number(select.value)];
    byId('viewer').classList.toggle('comparing', view !== null);
    scene.controls.enabled = view === null;
    if (view) {
      photograph.src = view.photograph;
      photograph.alt = `photograph ${view.photo}`;
      clip();
      scene.drawView(view, ...scene.material.size_texel);
    } else if (scene.view) {
      scene.leaveView();
    }
    resize();
  };
  select.addEventListener('change', show);
  slider.addEventListener('input', clip);
}

async function start() {
  const element = byId('viewer-material');
  if (!element) return;
  const material = JSON.parse(element.textContent);
  const canvas = byId('viewer-canvas');
  let scene;
  try {
    scene = new MaterialScene(canvas, material);
    await scene.load();
  } catch (error) {
    byId('viewer-note').textContent = `This browser cannot draw the material (WebGL 2): ${error.message}`;
    byId('viewer').classList.add('failed');
    return;
  }
  const stage = canvas.parentElement;
  const resize = () => {
    if (scene.view) return;
    scene.resize(stage.clientWidth, stage.clientHeight, Math.min(window.devicePixelRatio || 1, 2));
  };
  connectRelighting(scene, canvas);
  connectComparison(scene, resize);
  new ResizeObserver(resize).observe(stage);
  resize();
  // For tests: the pixels of one photograph's rendering, row by row from the top.
  window.glintViewer = {
    ready: true,
    renderView(index, width, height) {
      scene.drawView(material.views[index], width, height);
      return canvas.toDataURL('image/png');
    },
  };
}

start();

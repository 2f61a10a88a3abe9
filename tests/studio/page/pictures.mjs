// Pictures for the mock server, drawn as SVG: photographs of a board, maps, a code, a result page.

const hue = { oak: '#b98a56', felt: '#4f7a6b', slate: '#5d6672', leather: '#8a4b32', brass: '#c9a84c', linen: '#cdbf9f' };
export const families = Object.keys(hue);

const svg = (width, height, body) => `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${width} ${height}" width="${width}" height="${height}">${body}</svg>`;

const texture = (id, seed, frequency = '0.02 0.09', strength = 0.5) =>
  `<filter id="${id}"><feTurbulence type="fractalNoise" baseFrequency="${frequency}" numOctaves="4" seed="${seed}"/>` +
  `<feColorMatrix values="0 0 0 0 0  0 0 0 0 0  0 0 0 0 0  ${strength} 0 0 0 ${-0.25 * strength}"/><feComposite in2="SourceGraphic" operator="in"/></filter>`;

// A photograph of a board, seen from a direction.
export function photograph(family, seed, { tilt_deg, azimuth_deg }) {
  const angle = (azimuth_deg * Math.PI) / 180;
  const squeeze = Math.cos((tilt_deg * Math.PI) / 180);
  let squares = '';
  for (let row = 0; row < 13; ++row) {
    for (let column = 0; column < 9; ++column) {
      const inside = column > 1 && column < 7 && row > 3 && row < 9;
      if ((row + column) % 2 === 0 && !inside) squares += `M${column * 15} ${row * 15}h15v15h-15z`;
    }
  }
  const turn = `rotate(${-azimuth_deg}) scale(${squeeze.toFixed(3)} 1) rotate(${azimuth_deg})`;
  return svg(320, 240,
    `<defs>${texture('t', seed)}<radialGradient id="f"><stop offset="0" stop-color="#fff" stop-opacity=".85"/><stop offset=".3" stop-color="#fff" stop-opacity=".18"/><stop offset="1" stop-color="#000" stop-opacity=".5"/></radialGradient></defs>` +
    `<rect width="320" height="240" fill="#3a3632"/><g transform="translate(160 120) ${turn} translate(-67.5 -97.5)">` +
    `<rect x="-8" y="-8" width="151" height="211" fill="#eeece6"/><path d="${squares}" fill="#24262a"/>` +
    `<rect x="30" y="60" width="75" height="75" fill="${hue[family]}"/><rect x="30" y="60" width="75" height="75" filter="url(#t)"/></g>` +
    `<circle cx="${160 - 1.1 * tilt_deg * Math.cos(angle)}" cy="${120 + 1.1 * tilt_deg * Math.sin(angle)}" r="210" fill="url(#f)"/>`);
}

export const maps = ['base colour', 'normal', 'roughness', 'specular', 'height'];

export function map(family, seed, name, shift = 0) {
  const ground = { 'base colour': hue[family], normal: '#8080ff', roughness: '#7a7a7a', specular: '#2c2c2c', height: '#808080' }[name];
  return svg(512, 512,
    `<defs>${texture('t', seed + shift, '0.012 0.05', 0.7)}</defs><rect width="512" height="512" fill="${ground}"/>` +
    `<g opacity="${shift ? 0.3 : 0.8}"><rect width="512" height="512" filter="url(#t)"/></g>`);
}

export function code(text) {
  let cells = '';
  let state = [...text].reduce((sum, c) => (sum * 31 + c.charCodeAt(0)) >>> 0, 7);
  for (let y = 0; y < 29; ++y) {
    for (let x = 0; x < 29; ++x) {
      state = (state * 1664525 + 1013904223) >>> 0;
      const corner = [[0, 0], [22, 0], [0, 22]].find(([a, b]) => x >= a && x < a + 7 && y >= b && y < b + 7);
      const ring = corner && Math.max(Math.abs(x - corner[0] - 3), Math.abs(y - corner[1] - 3));
      if (corner ? ring !== 2 : state >>> 31) cells += `M${x} ${y}h1v1h-1z`;
    }
  }
  return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="-2 -2 33 33"><path d="${cells}" fill="#000"/></svg>`;
}

export function report(family, name) {
  return `<!doctype html><html lang="en"><head><meta charset="utf-8"><title>${name}</title><meta name="color-scheme" content="light dark">` +
    `<style>body{margin:0;font:15px system-ui,sans-serif;padding:20px}#s{width:min(60vw,320px);aspect-ratio:1;border-radius:50%;background:radial-gradient(circle at var(--x,35%) 30%,#fff,${hue[family]} 35%,#181410)}</style></head>` +
    `<body><main><h1>${name}</h1><p>Move over the sphere to relight it.</p><div id="s"></div></main>` +
    `<script>s.onpointermove=(e)=>s.style.setProperty('--x',100*e.offsetX/s.clientWidth+'%')</script></body></html>`;
}

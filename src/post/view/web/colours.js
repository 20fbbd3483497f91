// Colour maps and palettes, as textures and as CSS.
import * as THREE from 'three';

const STOPS = {
  viridis: '440154 482475 414487 355f8d 2a788e 21918c 22a884 44bf70 7ad151 bddf26 fde725',
  cividis: '00224e 123570 3b496c 575d6d 707173 8a8678 a59c74 c3b369 e1cc55 fee838',
  'blue-red': '0000ff 0080ff 00ffff 00ff80 00ff00 80ff00 ffff00 ff8000 ff0000',
  diverging: '3b4cc0 6788ee 9abbff c9d7f0 edd1c2 f7a889 e26952 b40426',
};

/** Names of the maps with what the user reads. */
export const MAPS = [
  ['viridis', 'viridis (colour-blind safe)'],
  ['cividis', 'cividis (colour-blind safe)'],
  ['blue-red', 'blue to red (classic)'],
  ['diverging', 'blue–white–red'],
];

/** A colour `#rrggbb` as three numbers from 0 to 1. */
export function rgb(hex) {
  const n = parseInt(hex.replace('#', ''), 16);
  return [(n >> 16 & 255) / 255, (n >> 8 & 255) / 255, (n & 255) / 255];
}

/** The colour of a map at t from 0 to 1. */
export function colourAt(name, t) {
  const stops = (STOPS[name] ?? STOPS.viridis).split(' ');
  const at = Math.min(Math.max(t, 0), 1) * (stops.length - 1);
  const k = Math.min(Math.floor(at), stops.length - 2);
  const [a, b] = [rgb(stops[k]), rgb(stops[k + 1])];
  return a.map((v, c) => v + (b[c] - v) * (at - k));
}

function texture(colour) {
  const data = new Uint8Array(256 * 4);
  for (let k = 0; k < 256; k++) data.set([...colour(k).map((v) => Math.round(255 * v)), 255], 4 * k);
  const made = new THREE.DataTexture(data, 256, 1);
  made.minFilter = made.magFilter = THREE.NearestFilter;
  made.needsUpdate = true;
  return made;
}

const made = new Map();

/** A map as a texture of 256 places. */
export function mapTexture(name) {
  if (!made.has(name)) made.set(name, texture((k) => colourAt(name, k / 255)));
  return made.get(name);
}

/** Groups: colours that differ in lightness too (Okabe and Ito 2008, and lighter ones of the same). */
const GROUPS = 'e69f00 56b4e9 009e73 f0e442 0072b2 d55e00 cc79a7 999999 ffd37a a8dcf8 7fd6bd 7fb3dd'.split(' ');

/** Colours by group number. */
export function groupTexture() {
  if (!made.has('groups')) made.set('groups', texture((k) => rgb(GROUPS[k % GROUPS.length])));
  return made.get('groups');
}

/** Pieces: place 0, the largest, red; the others green of several shades. */
export function pieceTexture() {
  const green = (k) => [0.05 + 0.25 * ((k * 5) % 7) / 7, 0.5 + 0.38 * ((k * 3) % 8) / 8, 0.12 + 0.2 * ((k * 2) % 5) / 5];
  if (!made.has('pieces')) made.set('pieces', texture((k) => (k === 0 ? [0.86, 0.1, 0.1] : green(k))));
  return made.get('pieces');
}

/** Colour of the page by the name of its CSS variable. */
export const colour = (name) => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

/** Least and largest of values; those of equal values, apart from rounding, are set apart by a share of their size. */
export function limits(values, share = 0) {
  let [low, high] = [Infinity, -Infinity];
  for (const v of values) {
    if (v < low) low = v;
    if (v > high) high = v;
  }
  if (!(high >= low)) return [0, 1];
  const size = Math.max(Math.abs(low), Math.abs(high));
  const half = high - low <= 1e-6 * size ? share * (size || 1) : 0;
  return [low - half, high + half];
}

/** A number with three digits. */
export function figure(value) {
  if (value === 0) return '0';
  const size = Math.abs(value);
  if (size >= 1e5 || size < 1e-3) return value.toExponential(2).replace('e+', 'e').replace(/^-/, '−');
  return String(Number(value.toPrecision(3))).replace('-', '−');
}

/** At most `most` steps of 1, 2 or 5 times a power of ten between two limits. */
export function ticks(low, high, most) {
  if (!(high > low)) return [low];
  const rough = (high - low) / most;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= rough * (1 - 1e-9));
  const out = [];
  for (let k = Math.ceil(low / step - 1e-6); k * step <= high + 1e-6 * step; k++) out.push(k * step);
  return out;
}

/** Texts of ticks, with the same decimals. */
export function figures(at) {
  const step = at.length > 1 ? at[1] - at[0] : 0;
  const decimals = Math.max(-Math.floor(Math.log10(step) + 1e-6), 0);
  if (!step || decimals > 6 || Math.max(...at.map(Math.abs)) >= 1e6) return at.map(figure);
  return at.map((t) => t.toFixed(decimals).replace(/^-(?=0(\.0*)?$)/, '').replace('-', '−'));
}

const PREFIXES = [[1e9, 'G'], [1e6, 'M'], [1e3, 'k'], [1, ''], [1e-3, 'm'], [1e-6, 'µ']];
/** Units with prefixes: smallest and largest factor. */
const PREFIXED = { Pa: [1, 1e9], N: [1, 1e9], 'N/m': [1, 1e9], J: [1e-6, 1e9], m: [1e-6, 1], 'm/s': [1e-6, 1] };

/** The prefix with which numbers up to `most` of a unit read best, as { factor, unit }. */
export function scaled(unit, most) {
  const size = Math.abs(most);
  const [least, largest] = PREFIXED[unit] ?? [1, 1];
  if (!PREFIXED[unit] || !(size > 0)) return { factor: 1, unit };
  const known = PREFIXES.filter(([f]) => f >= least && f <= largest);
  const [factor, prefix] = known.find(([f]) => size >= 1.1 * f) ?? known.at(-1);
  return { factor, unit: prefix + unit };
}

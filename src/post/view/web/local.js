// Files that the user opens in the page: tables of particles, .vtp files of frames, exported pages.
import { EmbeddedSource, MadeSource, embeddedTexts, bytesOf } from 'source';

/** What is wrong with a file: one sentence with file, line, found and expected. */
export class Fault extends Error {}

/** A source of blocks from files; several tables or frames are shown one after the other, in the order of their names. */
export async function read(files) {
  const list = [...files].sort((a, b) => path(a).localeCompare(path(b), 'en', { numeric: true }));
  const page = list.find((file) => /\.html?$/i.test(file.name));
  if (page) return exported(page);
  const frames = list.filter((file) => /\.vtp$/i.test(file.name));
  const tables = list.filter((file) => /\.(csv|txt|dat|tsv)$/i.test(file.name) && !/^(history|cycles|push|breaks|gradation|radial)\.csv$/.test(file.name));
  if (frames.length) return ofFrames(frames, list);
  if (tables.length) return ofTables(tables);
  const found = list.length ? list.slice(0, 3).map((f) => f.name).join(', ') : 'nothing';
  throw new Fault(`found ${found}, expected .csv or .txt tables of particles, .vtp frames, or an exported .html page`);
}

const path = (file) => file.webkitRelativePath || file.name;

async function exported(file) {
  const page = new DOMParser().parseFromString(await file.text(), 'text/html');
  const texts = embeddedTexts(page);
  if (!texts.has('scene')) throw new Fault(`${file.name}: found no data, expected a page written by trackbed view --export`);
  return new EmbeddedSource(texts);
}

/** Names of columns that are known, by what files call them. */
const COLUMNS = {
  x: 'x', y: 'y', z: 'z', r: 'radius', radius: 'radius', d: 'diameter', diameter: 'diameter', vx: 'vx', vy: 'vy', vz: 'vz',
  speed: 'speed', id: 'id', part: 'part', group: 'part', fragment: 'fragment', piece: 'fragment',
};

/** Particles of a table: `2D` in front or no z column means a plane. */
export function table(text, name) {
  const lines = text.split(/\r?\n/);
  let [columns, flat, width] = [null, false, 0];
  const rows = [];
  lines.forEach((line, at) => {
    const words = line.trim().split(/[\s,;]+/).filter(Boolean);
    if (!words.length || words[0].startsWith('#')) return;
    if (/^[23]d$/i.test(words[0]) && words.length === 1) {
      flat = words[0][0] === '2';
      return;
    }
    const numbers = words.map(Number);
    if (!rows.length && !columns && numbers.some(Number.isNaN)) {
      columns = line.trim().split(line.includes(',') ? ',' : /[\s;]+/).map((w) => w.replace(/\[.*?\]|"/g, '').trim());
      width = columns.length;
      return;
    }
    const bad = numbers.findIndex((v) => !Number.isFinite(v));
    if (bad >= 0) throw new Fault(`${name}:${at + 1}: found "${words[bad].slice(0, 40)}", expected a number`);
    width ||= numbers.length;
    if (numbers.length !== width) throw new Fault(`${name}:${at + 1}: found ${numbers.length} numbers, expected ${width}`);
    rows.push(numbers);
  });
  if (!columns) {
    flat ||= width === 3;
    const given = flat ? ['x', 'y', 'radius'] : ['x', 'y', 'z', 'radius'];
    columns = Array.from({ length: width }, (_, k) => given[k] ?? (k === width - 1 ? 'user quantity' : `column ${k + 1}`));
  }
  const known = columns.map((c) => COLUMNS[c.toLowerCase()] ?? c);
  flat ||= !known.includes('z');
  const need = flat ? ['x', 'y'] : ['x', 'y', 'z'];
  const missing = need.find((c) => !known.includes(c)) ?? (known.includes('radius') || known.includes('diameter') ? null : 'radius');
  if (missing) throw new Fault(`${name}: found columns ${columns.join(', ')}, expected one named ${missing}`);
  if (!rows.length) throw new Fault(`${name}: found no rows, expected particles`);
  return { known, rows, flat };
}

/** A block of particles and its fields. */
function particles({ known, rows }) {
  const column = (name) => known.indexOf(name);
  const values = (name) => Float32Array.from(rows, (row) => row[column(name)]);
  const n = rows.length;
  const radius = known.includes('radius') ? values('radius') : values('diameter').map((d) => 0.5 * d);
  const position = new Float32Array(3 * n);
  ['x', 'y', 'z'].forEach((axis, k) => {
    if (column(axis) >= 0) rows.forEach((row, b) => { position[3 * b + k] = row[column(axis)]; });
  });
  const id = known.includes('id') ? Uint32Array.from(values('id')) : Uint32Array.from({ length: n }, (_, b) => b);
  const fields = new Map();
  known.forEach((name) => {
    if (!['x', 'y', 'z', 'radius', 'diameter', 'vx', 'vy', 'vz', 'id'].includes(name)) fields.set(name, values(name));
  });
  const v = ['vx', 'vy', 'vz'].filter((c) => known.includes(c)).map(values);
  if (v.length) fields.set('speed', Float32Array.from(rows, (_, b) => Math.hypot(...v.map((c) => c[b]))));
  const start = Uint32Array.from({ length: n + 1 }, (_, b) => b);
  return { arrays: { position, start, id, radius, diameter: radius.map((r) => 2 * r) }, fields };
}

async function ofTables(files) {
  const blocks = new Map();
  const tables = [];
  for (const file of files) tables.push(table(await file.text(), file.name));
  const made = tables.map(particles);
  made.forEach(({ arrays, fields }, k) => {
    blocks.set(`grains/${k}`, { meta: { own: true }, arrays });
    fields.forEach((value, name) => blocks.set(`grains/${k}/${name}`, { meta: {}, arrays: { value } }));
  });
  const names = new Set(made.flatMap(({ fields }) => [...fields.keys()]));
  return finish(blocks, files[0].name, made.map((_, k) => ({ time: k, parts: ['grains'] })), [...names]);
}

/** Adds what holds for all frames. */
function finish(blocks, title, frames, grainFields) {
  blocks.set('grains', { meta: {}, arrays: {} });
  const bounds = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  const first = blocks.get('grains/0');
  const add = (p, r) => p.forEach((x, k) => {
    bounds[0][k] = Math.min(bounds[0][k], x - r);
    bounds[1][k] = Math.max(bounds[1][k], x + r);
  });
  first?.arrays.radius.forEach((r, s) => {
    const { position, offset, start } = first.arrays;
    if (!offset) add(position.subarray(3 * s, 3 * s + 3), r);
    else if (s < start.length - 1) add(position.subarray(3 * s, 3 * s + 3), 4 * r);
  });
  if (!first) for (const block of blocks.values()) (block.arrays.ends ?? block.arrays.points)?.forEach((x, k) => {
    bounds[0][k % 3] = Math.min(bounds[0][k % 3], x);
    bounds[1][k % 3] = Math.max(bounds[1][k % 3], x);
  });
  const meta = { title, status: 'opened from disk', folder: '', frames, origin: [0, 0, 0], bounds, grainFields, solidFields: [], tables: [] };
  blocks.set('scene', { meta, arrays: {} });
  return new MadeSource(blocks);
}

/** Frames of .vtp files named as the program names them: grains_00000.vtp, chains_…, walls_…. */
async function ofFrames(files, all) {
  const blocks = new Map();
  const numbers = new Map();
  const fields = new Set();
  const times = await timesOf(all.find((file) => file.name === 'results.pvd'));
  for (const file of files) {
    const [, part, number] = /^(grains|chains|walls)_(\d+)\.vtp$/.exec(file.name) ?? [];
    const key = number ?? '0';
    if (!numbers.has(key)) numbers.set(key, { time: times.get(file.name), parts: [], files: {} });
    const data = await vtp(file);
    const kind = part ?? (data.sections.Lines ? 'chains' : data.sections.Polys ? 'walls' : 'grains');
    numbers.get(key).parts.push(kind);
    numbers.get(key).files[kind] = data;
  }
  const frames = [...numbers.values()];
  frames.forEach((frame, k) => {
    frame.time ??= k;
    const { grains, chains, walls } = frame.files;
    if (grains) grainBlocks(grains, k, blocks, fields);
    if (chains) blocks.set(`chains/${k}`, { meta: {}, arrays: { ends: linked(chains, 'Lines'), ...chains.sections.CellData } });
    if (walls) wallBlocks(walls, k, blocks, fields);
    delete frame.files;
  });
  return finish(blocks, files[0].name, frames, [...fields]);
}

async function timesOf(series) {
  const times = new Map();
  if (!series) return times;
  for (const [, time, file] of (await series.text()).matchAll(/timestep="([^"]*)"[^>]*file="([^"]*)"/g)) times.set(file.split('/').pop(), Number(time));
  return times;
}

function linked(data, section) {
  const index = data.sections[section].connectivity;
  const out = new Float32Array(3 * index.length);
  index.forEach((n, k) => out.set(data.points.subarray(3 * n, 3 * n + 3), 3 * k));
  return out;
}

function grainBlocks({ points, sections }, k, blocks, fields) {
  const data = sections.PointData ?? {};
  const n = points.length / 3;
  const numbers = data.id ?? Float32Array.from({ length: n }, (_, s) => s);
  const [start, id, offset, position] = [[], [], new Float32Array(3 * n), []];
  for (let s = 0; s < n; s++) {
    if (!s || numbers[s] !== numbers[s - 1]) {
      start.push(s);
      id.push(numbers[s]);
      position.push(...points.subarray(3 * s, 3 * s + 3));
    }
    for (let c = 0; c < 3; c++) offset[3 * s + c] = points[3 * s + c] - position[position.length - 3 + c];
  }
  start.push(n);
  const radius = data.radius ?? new Float32Array(n).fill(0.01);
  const turn = Float32Array.from({ length: 4 * id.length }, (_, q) => (q % 4 ? 0 : 1));
  const arrays = { position: Float32Array.from(position), start: Uint32Array.from(start), id: Uint32Array.from(id), radius, offset, orientation: turn };
  arrays.diameter = Float32Array.from(id, (_, b) => 2 * Math.max(...radius.subarray(start[b], start[b + 1])));
  blocks.set(`grains/${k}`, { meta: { own: true }, arrays });
  for (const [name, values] of Object.entries(data)) {
    if (['radius', 'id', 'orientation'].includes(name)) continue;
    const width = values.length / n;
    const value = Float32Array.from(id, (_, b) => {
      const item = values.subarray(width * start[b], width * (start[b] + 1));
      return width === 1 ? item[0] : Math.hypot(...item);
    });
    const shown = name === 'velocity' ? 'speed' : name;
    fields.add(shown);
    blocks.set(`grains/${k}/${shown}`, { meta: {}, arrays: { value } });
  }
}

function wallBlocks({ points, sections }, k, blocks, fields) {
  const { connectivity, offsets } = sections.Polys;
  const { id: ids, kind: kinds } = sections.CellData ?? {};
  const [triangles, edges, id, kind, of] = [[], [], [], [], []];
  offsets.forEach((end, p) => {
    const polygon = [...connectivity.subarray(p ? offsets[p - 1] : 0, end)];
    for (let c = 1; c + 1 < polygon.length; c++) {
      triangles.push(polygon[0], polygon[c], polygon[c + 1]);
      of.push(p);
      id.push(ids?.[p] ?? 0);
      kind.push(kinds?.[p] ?? 1);
    }
    polygon.forEach((corner, c) => edges.push(corner, polygon[(c + 1) % polygon.length]));
  });
  blocks.set(`walls/${k}`, { meta: {}, arrays: { points, triangles, edges, id, kind: Uint8Array.from(kind) } });
  for (const [name, values] of Object.entries(sections.CellData ?? {})) {
    if (['id', 'kind'].includes(name)) continue;
    const width = values.length / offsets.length;
    const value = Float32Array.from(of, (p) => (width === 1 ? values[p] : Math.hypot(...values.subarray(width * p, width * (p + 1)))));
    const shown = name === 'velocity' ? 'speed' : name;
    fields.add(shown);
    blocks.set(`walls/${k}/${shown}`, { meta: {}, arrays: { value } });
  }
}

const TYPES = { Float64: Float64Array, Float32: Float32Array, UInt32: Uint32Array, UInt8: Uint8Array, Int32: Int32Array };

/** Arrays of a .vtp file that this program wrote. */
async function vtp(file) {
  const page = new DOMParser().parseFromString(await file.text(), 'text/xml');
  const root = page.documentElement;
  if (root.nodeName !== 'VTKFile' || root.getAttribute('type') !== 'PolyData') {
    throw new Fault(`${file.name}: found no PolyData, expected a .vtp file written by a run`);
  }
  const sections = {};
  let points = null;
  for (const element of root.querySelectorAll('DataArray')) {
    const name = element.getAttribute('Name');
    const section = element.parentElement.nodeName;
    if (section === 'Verts') continue;
    let values;
    try {
      values = await numbers(element);
    } catch (error) {
      throw new Fault(`${file.name}: array ${name}: found damaged data (${error.message}), expected zlib blocks in base64`);
    }
    if (section === 'Points') points = values; else (sections[section] ??= {})[name] = values;
  }
  if (!points) throw new Fault(`${file.name}: found no points, expected some`);
  return { points, sections };
}

/** Number and lengths of blocks, base64 of their own, then the blocks. */
async function numbers(element) {
  const text = element.textContent.trim();
  const count = Number(new DataView(bytesOf(text.slice(0, 12)).buffer).getBigUint64(0, true));
  const letters = Math.ceil((8 * (3 + count)) / 3) * 4;
  const head = new DataView(bytesOf(text.slice(0, letters)).buffer);
  const packed = bytesOf(text.slice(letters));
  const parts = [];
  for (let k = 0, at = 0; k < count; k++) {
    const length = Number(head.getBigUint64(24 + 8 * k, true));
    const stream = new Blob([packed.subarray(at, at + length)]).stream().pipeThrough(new DecompressionStream('deflate'));
    parts.push(new Uint8Array(await new Response(stream).arrayBuffer()));
    at += length;
  }
  const bytes = new Uint8Array(await new Blob(parts).arrayBuffer());
  const type = element.getAttribute('type');
  if (type === 'UInt64' || type === 'Int64') return Uint32Array.from(new BigUint64Array(bytes.buffer), Number);
  return Float32Array.from(new (TYPES[type] ?? Float64Array)(bytes.buffer));
}

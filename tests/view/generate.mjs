// Writes large results: node tests/view/generate.mjs FOLDER clumps|spheres [BODIES] [FRAMES]
//
// clumps: 20,000 moving clumps of ten spheres, 200 frames, with force chains; spheres: a million, one frame.
import fs from 'node:fs';
import path from 'node:path';
import zlib from 'node:zlib';

const [folder, kind, given, frameCount] = process.argv.slice(2);
const clumps = kind === 'clumps';
const bodies = Number(given ?? (clumps ? 20000 : 1e6));
const frames = Number(frameCount ?? (clumps ? 200 : 1));
const BLOCK = 32768;

/** VTK array: lengths, then zlib blocks, in base64. */
function encoded(array) {
  const bytes = Buffer.from(array.buffer, array.byteOffset, array.byteLength);
  const packed = [];
  for (let at = 0; at < bytes.length; at += BLOCK) packed.push(zlib.deflateSync(bytes.subarray(at, at + BLOCK), { level: 1 }));
  const head = new BigUint64Array([packed.length, BLOCK, bytes.length % BLOCK, ...packed.map((p) => p.length)].map(BigInt));
  return Buffer.from(head.buffer).toString('base64') + Buffer.concat(packed).toString('base64');
}

const TYPES = { Float64Array: 'Float64', Uint32Array: 'UInt32', BigUint64Array: 'UInt64' };

function file(name, count, cells, sections) {
  const out = fs.openSync(path.join(folder, name), 'w');
  const put = (text) => fs.writeSync(out, text);
  put('<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64" compressor="vtkZLibDataCompressor">');
  put(`<PolyData><Piece NumberOfPoints="${count}" NumberOf${cells[0]}="${cells[1]}">`);
  for (const [section, arrays] of Object.entries(sections)) {
    put(`<${section}>`);
    for (const [array, [values, components]] of Object.entries(arrays)) {
      put(`<DataArray type="${TYPES[values.constructor.name]}" Name="${array}" NumberOfComponents="${components}" format="binary">${encoded(values)}</DataArray>`);
    }
    put(`</${section}>`);
  }
  put('</Piece></PolyData></VTKFile>');
  fs.closeSync(out);
}

/** Reproducible random numbers. */
let seed = 1;
const random = () => {
  seed = (Math.imul(seed, 1664525) + 1013904223) >>> 0;
  return seed / 4294967296;
};

const each = clumps ? 10 : 1;
const n = bodies * each;
const side = Math.ceil(Math.cbrt(bodies / 2));
const size = 0.04;
const shape = Array.from({ length: each }, () => [0, 1, 2].map(() => (random() - 0.5) * size * (clumps ? 0.6 : 0)));
const jitter = Float64Array.from({ length: 3 * bodies }, () => (random() - 0.5) * 0.2 * size);
const radius = Float64Array.from({ length: n }, () => size * (clumps ? 0.24 : 0.4 + 0.1 * random()));
const id = Uint32Array.from({ length: n }, (_, s) => Math.floor(s / each));
const zeros = new Uint32Array(n);

fs.mkdirSync(path.join(folder, 'frames'), { recursive: true });
let list = '<?xml version="1.0"?>\n<VTKFile type="Collection"><Collection>\n';
for (let f = 0; f < frames; f++) {
  const share = frames > 1 ? f / (frames - 1) : 0;
  const centre = (b) => {
    const [i, j, k] = [b % side, Math.floor(b / side) % side, Math.floor(b / side / side)];
    return [i * size + jitter[3 * b], j * size + jitter[3 * b + 1], k * size * (1 - 0.1 * share) + jitter[3 * b + 2]];
  };
  const [points, velocity, spin, force] = Array.from({ length: 4 }, () => new Float64Array(3 * n));
  const orientation = new Float64Array(4 * n);
  const stress = new Float64Array(n);
  for (let b = 0; b < bodies; b++) {
    const c = centre(b);
    const angle = share * ((b % 7) - 3) * 0.2;
    const [co, si] = [Math.cos(angle), Math.sin(angle)];
    for (let m = 0; m < each; m++) {
      const s = b * each + m;
      const [x, y, z] = shape[m];
      points.set([c[0] + co * x - si * y, c[1] + si * x + co * y, c[2] + z], 3 * s);
      velocity.set([0, 0, -0.1 * c[2] * (1 + 0.1 * jitter[3 * b])], 3 * s);
      force.set([0, 0, 1000 * jitter[3 * b]], 3 * s);
      orientation.set([Math.cos(angle / 2), 0, 0, Math.sin(angle / 2)], 4 * s);
      stress[s] = -1000 * (1 - c[2] / (side * size)) + 100 * jitter[3 * b + 1];
    }
  }
  const number = String(f).padStart(5, '0');
  const index = BigUint64Array.from({ length: n }, (_, k) => BigInt(k));
  file(`frames/grains_${number}.vtp`, n, ['Verts', n], {
    PointData: {
      radius: [radius, 1], velocity: [velocity, 3], spin: [spin, 3], orientation: [orientation, 4], id: [id, 1], part: [zeros, 1],
      mean_stress: [stress, 1], force: [force, 3], coordination: [zeros, 1], fragment: [id, 1],
    },
    Points: { Points: [points, 3] },
    Verts: { connectivity: [index, 1], offsets: [index.map((k) => k + 1n), 1] },
  });
  list += `<DataSet timestep="${0.01 * f}" part="1" name="grains" file="frames/grains_${number}.vtp"/>\n`;
  if (!clumps) continue;
  const lines = 2 * bodies;
  const ends = new Float64Array(6 * lines);
  const normal = new Float64Array(lines);
  for (let l = 0; l < lines; l++) {
    const b = l >> 1;
    ends.set([...centre(b), ...centre(Math.min(b + (l & 1 ? side : 1), bodies - 1))], 6 * l);
    normal[l] = 50 * (1 + jitter[b]) * (1 + share) * random();
  }
  const ids = BigUint64Array.from({ length: 2 * lines }, (_, k) => BigInt(k));
  file(`frames/chains_${number}.vtp`, 2 * lines, ['Lines', lines], {
    CellData: { normal_force: [normal, 1], magnitude: [normal, 1] },
    Points: { Points: [ends, 3] },
    Lines: { connectivity: [ids, 1], offsets: [BigUint64Array.from({ length: lines }, (_, k) => BigInt(2 * k + 2)), 1] },
  });
  list += `<DataSet timestep="${0.01 * f}" part="2" name="force chains" file="frames/chains_${number}.vtp"/>\n`;
}
fs.writeFileSync(path.join(folder, 'results.pvd'), `${list}</Collection></VTKFile>\n`);
console.log(`${folder}: ${bodies} bodies of ${each} spheres, ${frames} frames`);

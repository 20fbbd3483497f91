// Grains of a frame: places of all spheres from those of their bodies, colours, removal by the section.
import * as THREE from 'three';
import { FIELDS } from 'fields';
import { groupTexture, limits, mapTexture, pieceTexture, rgb } from 'colours';
import { Spheres } from 'spheres';

/** Number of the kind in pictures for picking. */
export const GRAIN = 1;

/** What the user reads of a field, and its unit. */
export const label = (field) => (field === 'sieve' ? 'Sieve size' : FIELDS[field]?.label ?? field);
export const unit = (field) => (field === 'sieve' ? 'm' : FIELDS[field]?.unit ?? '');
/** Name of a group in the scene, or its number. */
export const groupName = (meta, number) => meta.groups?.[number]?.name || `group ${number}`;

export class Grains {
  constructor() {
    this.spheres = new Spheres();
    this.bodies = null;
    this.values = null;
    this.range = [0, 1];
  }

  get group() { return this.spheres.group; }
  get count() { return this.bodies?.id.length ?? 0; }

  /** Takes the list of bodies of all frames, or of the frame where it has one, and the places of the frame. */
  frame(common, block) {
    this.bodies = block.meta.own ? block.arrays : common.arrays;
    this.position = block.arrays.position;
    this.orientation = block.arrays.orientation;
    this.spheres.reserve(this.bodies.radius.length);
    this.place();
  }

  /** Places of all spheres. */
  place() {
    const { start, radius, offset } = this.bodies;
    const { position, orientation } = this;
    const out = this.spheres.places;
    for (let b = 0; b < this.count; b++) {
      const [px, py, pz] = [position[3 * b], position[3 * b + 1], position[3 * b + 2]];
      let m = null;
      if (orientation && start[b + 1] - start[b] > 1) m = matrix(orientation, 4 * b);
      for (let s = start[b]; s < start[b + 1]; s++) {
        let [x, y, z] = [px, py, pz];
        if (m) {
          const [ox, oy, oz] = [offset[3 * s], offset[3 * s + 1], offset[3 * s + 2]];
          x += m[0] * ox + m[1] * oy + m[2] * oz;
          y += m[3] * ox + m[4] * oy + m[5] * oz;
          z += m[6] * ox + m[7] * oy + m[8] * oz;
        }
        out[4 * s] = x;
        out[4 * s + 1] = y;
        out[4 * s + 2] = z;
        out[4 * s + 3] = radius[s];
      }
    }
    this.spheres.moved();
  }

  /** Removes bodies that lie before `low` or behind `high` along `axis`; returns how many. */
  section(axis, low, high) {
    const { start, radius } = this.bodies;
    const out = this.spheres.places;
    let removed = 0;
    for (let b = 0; b < this.count; b++) {
      const d = this.position[3 * b] * axis[0] + this.position[3 * b + 1] * axis[1] + this.position[3 * b + 2] * axis[2];
      const gone = d < low || d > high;
      removed += gone;
      for (let s = start[b]; s < start[b + 1]; s++) out[4 * s + 3] = gone ? 0 : radius[s];
    }
    this.spheres.moved();
    return removed;
  }

  /** Colours bodies by one number each; `null`: all alike. `look` has the mode, the map and limits. */
  colour(values, look) {
    this.values = values;
    const u = this.spheres.material.uniforms;
    u.tint.value.set(...rgb(look.constant));
    u.mode.value = look.palette ? 2 : values ? 0 : 1;
    if (!values) return;
    u.map.value = look.palette === 'pieces' ? pieceTexture() : look.palette ? groupTexture() : mapTexture(look.map);
    this.range = look.auto ? limits(values, 0.01) : [look.min, look.max];
    u.range.value.set(...this.range);
    const { start } = this.bodies;
    const out = this.spheres.numbers;
    for (let b = 0; b < this.count; b++) out.fill(values[b], start[b], start[b + 1]);
    this.spheres.coloured();
  }

  /** Places of pieces by size, 0 the largest, from the piece that each body belongs to; and the sizes. */
  pieces(fragment) {
    const size = new Map();
    const { start, radius } = this.bodies;
    for (let b = 0; b < this.count; b++) {
      let volume = 0;
      for (let s = start[b]; s < start[b + 1]; s++) volume += radius[s] ** 3;
      const known = size.get(fragment[b]) ?? { volume: 0, bodies: 0 };
      size.set(fragment[b], { volume: known.volume + volume, bodies: known.bodies + 1 });
    }
    const order = [...size.keys()].sort((a, b) => size.get(b).volume - size.get(a).volume || a - b);
    const rank = new Map(order.map((piece, k) => [piece, k === 0 ? 0 : 1 + ((k - 1) % 255)]));
    return { values: Float32Array.from(fragment, (f) => rank.get(f)), sizes: order.map((f) => size.get(f)) };
  }

  /** How far bodies have moved since another frame; 0 for those that were not there. */
  moved(common, block) {
    const bodies = block.meta.own ? block.arrays : common.arrays;
    const before = new Map();
    bodies.id.forEach((id, b) => before.set(id, b));
    const p = block.arrays.position;
    return Float32Array.from(this.bodies.id, (id, b) => {
      const a = before.get(id);
      if (a === undefined) return 0;
      return Math.hypot(...[0, 1, 2].map((k) => this.position[3 * b + k] - p[3 * a + k]));
    });
  }

  /** Sieve size of a body [m]: middle of its extents along its principal axes. */
  sieve(body) {
    const { start, radius, offset, diameter } = this.bodies;
    if (start[body + 1] - start[body] === 1) return diameter[body];
    const extents = [0, 1, 2].map((k) => {
      let [low, high] = [Infinity, -Infinity];
      for (let s = start[body]; s < start[body + 1]; s++) {
        low = Math.min(low, offset[3 * s + k] - radius[s]);
        high = Math.max(high, offset[3 * s + k] + radius[s]);
      }
      return high - low;
    });
    return extents.sort((a, b) => a - b)[1];
  }

  /** The body that a sphere belongs to. */
  bodyOf(sphere) {
    const { start } = this.bodies;
    let [low, high] = [0, this.count];
    while (high - low > 1) {
      const mid = (low + high) >> 1;
      if (start[mid] <= sphere) low = mid; else high = mid;
    }
    return low;
  }

  /** The box around all spheres; null without any. */
  box() {
    if (!this.count) return null;
    const box = new THREE.Box3();
    const array = this.spheres.places;
    const { min, max } = box;
    for (let s = 0; s < 4 * this.spheres.count; s += 4) {
      const r = this.bodies.radius[s >> 2];
      const [x, y, z] = [array[s], array[s + 1], array[s + 2]];
      min.set(Math.min(min.x, x - r), Math.min(min.y, y - r), Math.min(min.z, z - r));
      max.set(Math.max(max.x, x + r), Math.max(max.y, y + r), Math.max(max.z, z + r));
    }
    return box;
  }

  /** Place of a body in a block, by its number; null where it is not there. */
  static placeIn(common, block, id) {
    const bodies = block.meta.own ? block.arrays : common.arrays;
    const b = bodies.id.indexOf(id);
    return b < 0 ? null : { body: b, place: [0, 1, 2].map((k) => block.arrays.position[3 * b + k]) };
  }
}

/** Rotation of a quaternion w, x, y, z, by rows. */
function matrix(q, at) {
  const [w, x, y, z] = [q[at], q[at + 1], q[at + 2], q[at + 3]];
  return [
    1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
    2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
    2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y),
  ];
}

// Walls, sleepers and rails.
import * as THREE from 'three';
import { groupTexture, mapTexture, rgb } from 'colours';
import { lineMaterial, surfaceMaterial } from 'shaders';

/** Kinds as the program numbers them: their names, what is drawn in which order. */
export const KINDS = ['planes', 'walls', 'sleepers', 'rails', 'stones'];
const STONE = 4;
/** Number of grains with faces in pictures for picking. */
export const FACED = 3;

export class Walls {
  constructor() {
    this.group = new THREE.Group();
    this.parts = KINDS.map((kind, k) => {
      const [surface, lines] = [surfaceMaterial(), lineMaterial([0.1, 0.12, 0.15], 0.8)];
      const [mesh, edges] = [
        new THREE.Mesh(new THREE.BufferGeometry(), surface),
        new THREE.LineSegments(new THREE.BufferGeometry(), lines),
      ];
      mesh.frustumCulled = edges.frustumCulled = false;
      // What is seen through comes last.
      mesh.renderOrder = 20 + (k < 2 ? 5 : 0);
      edges.renderOrder = 30;
      this.group.add(mesh, edges);
      return { kind, mesh, edges, count: 0 };
    });
  }

  frame(block) {
    const { points, triangles, edges, kind, id } = block.arrays;
    const kindOf = new Uint8Array(points.length / 3);
    const idOf = new Uint32Array(points.length / 3);
    this.ids = new Set(id);
    kind.forEach((k, t) => [0, 1, 2].forEach((c) => {
      kindOf[triangles[3 * t + c]] = k;
      idOf[triangles[3 * t + c]] = id[t];
    }));
    this.parts.forEach((part, p) => {
      const corners = [];
      kind.forEach((k, t) => {
        if (k === p) for (let c = 0; c < 3; c++) corners.push(...points.subarray(3 * triangles[3 * t + c], 3 * triangles[3 * t + c] + 3));
      });
      const [lines, owners] = [[], []];
      for (let e = 0; e < edges.length; e += 2) {
        if (kindOf[edges[e]] !== p) continue;
        owners.push(idOf[edges[e]]);
        for (const n of [edges[e], edges[e + 1]]) lines.push(...points.subarray(3 * n, 3 * n + 3));
      }
      fill(part.mesh, corners);
      fill(part.edges, lines);
      part.count = corners.length / 9;
      if (p === STONE) this.faced = { corners: Float32Array.from(corners), lines: Float32Array.from(lines), owners };
    });
    this.stones = Uint32Array.from(kind.keys()).filter((t) => kind[t] === STONE);
    this.stoneIds = Array.from(this.stones, (t) => id[t]);
    this.places = centres(this.faced.corners, this.stoneIds);
  }

  /** What grains with faces are drawn on. */
  get stoneMesh() { return this.parts[STONE].mesh; }

  /** Place, number and longest extent of the grain that a triangle of theirs belongs to, and that triangle among all. */
  stoneAt(triangle) {
    const id = this.stoneIds[triangle];
    const { corners } = this.faced;
    const own = [];
    this.stoneIds.forEach((other, t) => { if (other === id) own.push(...corners.subarray(9 * t, 9 * t + 9)); });
    let extent = 0;
    for (let a = 0; a < own.length; a += 3) {
      for (let b = 0; b < a; b += 3) extent = Math.max(extent, Math.hypot(own[a] - own[b], own[a + 1] - own[b + 1], own[a + 2] - own[b + 2]));
    }
    return { id, place: this.places.get(id), extent, triangle: this.stones[triangle] };
  }

  /** Place of a grain with faces in another frame, and one of its triangles; null where it is not there. */
  static stoneIn(block, id) {
    const { points, triangles, kind, id: ids } = block.arrays;
    const [own, first] = [[], ids.findIndex((other, t) => other === id && kind[t] === STONE)];
    if (first < 0) return null;
    ids.forEach((other, t) => {
      if (other === id && kind[t] === STONE) for (let c = 0; c < 3; c++) own.push(...points.subarray(3 * triangles[3 * t + c], 3 * triangles[3 * t + c] + 3));
    });
    return { triangle: first, place: centres(own, Array(own.length / 9).fill(id)).get(id) };
  }

  /** Removes grains with faces whose middles lie before `low` or behind `high` along `axis`; returns how many. */
  section(axis, low, high) {
    if (!this.stones?.length) return 0;
    const gone = new Set();
    for (const [id, place] of this.places) {
      const d = place.reduce((sum, x, k) => sum + x * axis[k], 0);
      if (d < low || d > high) gone.add(id);
    }
    const { corners, lines, owners } = this.faced;
    collapse(this.parts[STONE].mesh, corners, 9, (t) => gone.has(this.stoneIds[t]));
    collapse(this.parts[STONE].edges, lines, 6, (e) => gone.has(owners[e]));
    return gone.size;
  }

  /** Values of the triangles of grains with faces, of those of all triangles. */
  ofStones(values) { return Float32Array.from(this.stones, (t) => values[t]); }

  /** Colours grains with faces by one number for each of their triangles; null: all alike. `palette`: numbers are groups. */
  paint(values, range, look, palette) {
    const { mesh } = this.parts[STONE];
    const u = mesh.material.uniforms;
    u.mode.value = values ? (palette ? 2 : 0) : 1;
    if (!values) return;
    u.map.value = palette ? groupTexture() : mapTexture(look.map);
    u.range.value.set(...range);
    const attribute = mesh.geometry.getAttribute('value');
    values.forEach((v, t) => attribute.array.fill(v, 3 * t, 3 * t + 3));
    attribute.needsUpdate = true;
  }

  /** `look`: planes and walls (boundary) and sleepers with rails, each shown or not, with colour and opacity; `grains`: that of grains. */
  look(look, grains) {
    this.parts.forEach((part, p) => {
      const boundary = p < 2;
      const own = p === STONE ? grains : boundary ? look.boundary : look.track;
      part.mesh.visible = part.edges.visible = own.show && part.count > 0;
      // Triangulated walls would be hidden by their own edges.
      part.edges.visible &&= !(p === 1 && part.count > 400);
      const u = part.mesh.material.uniforms;
      u.tint.value.set(...rgb(p === 3 ? look.rail : p === STONE ? look.stone : own.colour));
      u.opacity.value = own.opacity;
      const glass = own.opacity < 1;
      if (part.mesh.material.transparent !== glass) {
        part.mesh.material.transparent = glass;
        part.mesh.material.depthWrite = !glass;
        part.mesh.material.needsUpdate = true;
      }
    });
  }

  /** Box of sleepers, rails and walls other than planes; `visible`: without hidden ones. */
  bounds(visible = false) {
    const box = new THREE.Box3();
    this.parts.slice(1).forEach((part) => {
      if (part.count && (part.mesh.visible || !visible)) box.union(part.mesh.geometry.boundingBox);
    });
    return box;
  }
}

/** Middles of the volumes of closed convex surfaces, by the numbers of their triangles. */
function centres(corners, ids) {
  const sums = new Map();
  ids.forEach((id, t) => {
    const own = sums.get(id) ?? { sum: [0, 0, 0], count: 0, triangles: [] };
    for (let c = 0; c < 9; c++) own.sum[c % 3] += corners[9 * t + c] / 3;
    own.count += 1;
    own.triangles.push(t);
    sums.set(id, own);
  });
  const out = new Map();
  for (const [id, { sum, count, triangles }] of sums) {
    const inside = sum.map((s) => s / count);
    const total = [0, 0, 0, 0];
    for (const t of triangles) {
      const [a, b, c] = [0, 3, 6].map((at) => inside.map((x, k) => corners[9 * t + at + k] - x));
      const volume = Math.abs(a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0]));
      total[3] += volume;
      for (let k = 0; k < 3; k++) total[k] += 0.25 * volume * (a[k] + b[k] + c[k]);
    }
    out.set(id, inside.map((x, k) => x + (total[3] > 0 ? total[k] / total[3] : 0)));
  }
  return out;
}

/** Draws the pieces of a geometry, `size` numbers each, without those that are gone: these shrink to a point. */
function collapse(object, whole, size, gone) {
  const attribute = object.geometry.getAttribute('position');
  attribute.array.set(whole);
  for (let n = 0; n < whole.length / size; n++) {
    if (gone(n)) for (let k = 3; k < size; k++) attribute.array[size * n + k] = whole[size * n + (k % 3)];
  }
  attribute.needsUpdate = true;
}

function fill(object, corners) {
  object.geometry.dispose();
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute('position', new THREE.Float32BufferAttribute(corners, 3));
  geometry.setAttribute('shift', new THREE.Float32BufferAttribute(new Float32Array(corners.length), 3));
  geometry.setAttribute('value', new THREE.Float32BufferAttribute(new Float32Array(corners.length / 3), 1));
  if (corners.length) geometry.computeBoundingBox();
  object.geometry = geometry;
}

// Walls, sleepers and rails.
import * as THREE from 'three';
import { groupTexture, mapTexture, rgb } from 'colours';
import { lineMaterial, surfaceMaterial } from 'shaders';

/** Kinds as the program numbers them: their names, what is drawn in which order. */
export const KINDS = ['planes', 'walls', 'sleepers', 'rails', 'stones'];
const STONE = 4;

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
    this.ids = new Set(id);
    kind.forEach((k, t) => [0, 1, 2].forEach((c) => { kindOf[triangles[3 * t + c]] = k; }));
    this.parts.forEach((part, p) => {
      const corners = [];
      kind.forEach((k, t) => {
        if (k === p) for (let c = 0; c < 3; c++) corners.push(...points.subarray(3 * triangles[3 * t + c], 3 * triangles[3 * t + c] + 3));
      });
      const lines = [];
      for (let e = 0; e < edges.length; e += 2) {
        if (kindOf[edges[e]] !== p) continue;
        for (const n of [edges[e], edges[e + 1]]) lines.push(...points.subarray(3 * n, 3 * n + 3));
      }
      fill(part.mesh, corners);
      fill(part.edges, lines);
      part.count = corners.length / 9;
    });
    this.stones = Uint32Array.from(kind.keys()).filter((t) => kind[t] === STONE);
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

  /** Box around what has an end: sleepers, rails, walls that are no planes. */
  bounds() {
    const box = new THREE.Box3();
    this.parts.slice(1).forEach((part) => {
      if (part.count) box.union(part.mesh.geometry.boundingBox);
    });
    return box;
  }
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

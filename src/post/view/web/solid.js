// The solid: its deformed skin with a field.
import * as THREE from 'three';
import { limits, mapTexture, rgb } from 'colours';
import { SOLID_FIELDS } from 'fields';
import { lineMaterial, surfaceMaterial } from 'shaders';

/** Number of the kind in pictures for picking. */
export const NODE = 2;

/** Parts of the displacement, which the page makes itself. */
export const DISPLACEMENTS = ['displacement', 'displacement_x', 'displacement_y', 'displacement_z'];

export const label = (field) => SOLID_FIELDS[field]?.label ?? field;
/** Unit, also of parts such as `strain_xx`. */
export const unit = (field) => (SOLID_FIELDS[field] ?? SOLID_FIELDS[field.replace(/_[^_]*$/, '')])?.unit ?? '';

export class Solid {
  constructor() {
    this.group = new THREE.Group();
    this.material = surfaceMaterial();
    this.lines = lineMaterial([0.08, 0.1, 0.14], 0.35);
    this.range = [0, 1];
  }

  /** Takes the skin. */
  mesh(block) {
    this.group.clear();
    const { points, triangles, edges } = block.arrays;
    this.skin = block.arrays;
    this.surface = spread(points, triangles);
    this.wire = spread(points, edges);
    const mesh = new THREE.Mesh(this.surface, this.material);
    const wire = new THREE.LineSegments(this.wire, this.lines);
    mesh.frustumCulled = wire.frustumCulled = false;
    wire.renderOrder = 8;
    this.wireObject = wire;
    this.object = mesh;
    this.group.add(mesh, wire);
  }

  /** Takes the displacement of a frame, from that of another frame where there is one. */
  frame(block, before) {
    let u = block.arrays.displacement;
    if (before) u = u.map((v, k) => v - before.arrays.displacement[k]);
    this.displacement = u;
    gather(this.surface, 'shift', this.skin.triangles, (n, out, k) => out.set(u.subarray(3 * n, 3 * n + 3), 3 * k));
    gather(this.wire, 'shift', this.skin.edges, (n, out, k) => out.set(u.subarray(3 * n, 3 * n + 3), 3 * k));
  }

  /** The displacement as one number per node. */
  displacementField(name) {
    const u = this.displacement;
    const c = ['displacement_x', 'displacement_y', 'displacement_z'].indexOf(name);
    const of = (n) => (c >= 0 ? u[3 * n + c] : Math.hypot(u[3 * n], u[3 * n + 1], u[3 * n + 2]));
    return Float32Array.from({ length: u.length / 3 }, (_, n) => of(n));
  }

  /** Colours by one number per node, or per triangle (`ofElements`); null: one colour. */
  colour(values, ofElements, look) {
    this.values = values;
    this.ofElements = ofElements;
    const u = this.material.uniforms;
    u.tint.value.set(...rgb(look.constant));
    u.mode.value = values ? 0 : 1;
    if (!values) return;
    this.range = look.auto ? limits(values, 0.01) : [look.min, look.max];
    u.range.value.set(...this.range);
    u.map.value = mapTexture(look.map);
    u.bands.value = look.bands ? 12 : 0;
    gather(this.surface, 'value', this.skin.triangles, (n, out, k) => { out[k] = values[ofElements ? Math.floor(k / 3) : n]; });
  }

  look(look) {
    this.wireObject.visible = look.edges;
    for (const material of [this.material, this.lines]) material.uniforms.factor.value = look.factor;
    this.material.uniforms.opacity.value = look.opacity;
    const glass = look.opacity < 1;
    if (this.material.transparent !== glass) {
      this.material.transparent = glass;
      this.material.depthWrite = !glass;
      this.material.needsUpdate = true;
    }
    this.object.renderOrder = glass ? 22 : 0;
  }

  /** Leaves out what lies beyond the ends along an axis. */
  cut(axis, low, high) {
    for (const material of [this.material, this.lines]) {
      material.uniforms.cut.value.set(...axis);
      material.uniforms.ends.value.set(low, high);
    }
  }

  /** Box of the deformed skin. */
  box(factor) {
    const box = new THREE.Box3();
    for (let n = 0; n < this.skin.node_ids.length; n++) box.expandByPoint(new THREE.Vector3(...this.place(n, factor)));
    return box;
  }

  /** Deformed place of a node of the skin. */
  place(node, factor) {
    return [0, 1, 2].map((k) => this.skin.points[3 * node + k] + factor * this.displacement[3 * node + k]);
  }
}

/** A geometry with its own corner for each entry of `index`: a field of elements jumps between them. */
export function spread(points, index) {
  const geometry = new THREE.BufferGeometry();
  const place = new Float32Array(3 * index.length);
  index.forEach((n, k) => place.set(points.subarray(3 * n, 3 * n + 3), 3 * k));
  geometry.setAttribute('position', new THREE.BufferAttribute(place, 3));
  geometry.setAttribute('shift', new THREE.BufferAttribute(new Float32Array(3 * index.length), 3));
  geometry.setAttribute('value', new THREE.BufferAttribute(new Float32Array(index.length), 1));
  return geometry;
}

function gather(geometry, name, index, put) {
  const attribute = geometry.getAttribute(name);
  index.forEach((n, k) => put(n, attribute.array, k));
  attribute.needsUpdate = true;
}

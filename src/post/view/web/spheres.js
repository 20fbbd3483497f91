// Any number of spheres in one draw call, each a quad that faces the eye. Their places are in a texture: drawing instances of a
// quad takes a thousand times longer where software draws.
import * as THREE from 'three';
import { sphereMaterial } from 'shaders';

/** Width of the texture; that of shaders.js. */
const WIDTH = 2048;

export class Spheres {
  constructor() {
    this.material = sphereMaterial();
    // Behind glass the nearest surface alone is seen: depth first, then colour.
    this.depth = sphereMaterial();
    this.depth.colorWrite = false;
    this.group = new THREE.Group();
    this.count = 0;
    this.meshes = [];
  }

  /** Makes room for `count` spheres. */
  reserve(count) {
    if (this.count === count && this.meshes.length) return;
    this.meshes.forEach((mesh) => { this.group.remove(mesh); mesh.geometry.dispose(); });
    this.place?.dispose();
    this.value?.dispose();
    const height = Math.max(Math.ceil(count / WIDTH), 1);
    const texture = (items, format) => new THREE.DataTexture(new Float32Array(items * WIDTH * height), WIDTH, height, format, THREE.FloatType);
    [this.place, this.value] = [texture(4, THREE.RGBAFormat), texture(1, THREE.RedFormat)];
    // No corners are stored: the shader knows a corner by its number.
    const geometry = new THREE.BufferGeometry();
    geometry.setDrawRange(0, 6 * count);
    this.count = count;
    this.meshes = [this.depth, this.material].map((material, k) => {
      const mesh = new THREE.Mesh(geometry, material);
      material.uniforms.places.value = this.place;
      material.uniforms.values.value = this.value;
      mesh.frustumCulled = false;
      mesh.renderOrder = 10 + k;
      mesh.visible = k === 1;
      this.group.add(mesh);
      return mesh;
    });
  }

  /** x, y, z and radius of all spheres, and one number each. */
  get places() { return this.place.image.data; }
  get numbers() { return this.value.image.data; }

  /** Places changed: upload them. */
  moved() { this.place.needsUpdate = true; }

  /** Values changed: upload them. */
  coloured() { this.value.needsUpdate = true; }

  set opacity(value) {
    const glass = value < 1;
    this.material.transparent = glass;
    this.material.uniforms.opacity.value = value;
    this.material.needsUpdate = true;
    if (this.meshes.length) this.meshes[0].visible = glass;
  }

  /** Marks the spheres from `first` up to `end`. */
  mark(first, end) {
    this.material.uniforms.chosen.value.set(first, end);
  }
}

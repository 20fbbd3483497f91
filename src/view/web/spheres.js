// Any number of spheres in one draw call, each a quad that faces the eye.
import * as THREE from 'three';
import { sphereMaterial } from 'shaders';

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
    const geometry = new THREE.InstancedBufferGeometry();
    const corners = new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]);
    geometry.setAttribute('position', new THREE.BufferAttribute(corners, 3));
    geometry.setIndex([0, 1, 2, 0, 2, 3]);
    this.place = new THREE.InstancedBufferAttribute(new Float32Array(4 * count), 4);
    this.value = new THREE.InstancedBufferAttribute(new Float32Array(count), 1);
    this.place.setUsage(THREE.DynamicDrawUsage);
    geometry.setAttribute('place', this.place);
    geometry.setAttribute('value', this.value);
    geometry.instanceCount = count;
    this.count = count;
    this.meshes = [this.depth, this.material].map((material, k) => {
      const mesh = new THREE.Mesh(geometry, material);
      mesh.frustumCulled = false;
      mesh.renderOrder = 10 + k;
      mesh.visible = k === 1;
      this.group.add(mesh);
      return mesh;
    });
  }

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

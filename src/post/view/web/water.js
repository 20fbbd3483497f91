// Water surface with regular waves, at the time of the frame.
import * as THREE from 'three';
import { rgb } from 'colours';
import { surfaceMaterial } from 'shaders';

export class Water {
  constructor() {
    this.group = new THREE.Group();
    const material = surfaceMaterial();
    this.mesh = new THREE.Mesh(new THREE.BufferGeometry(), material);
    this.mesh.frustumCulled = false;
    // What is seen through comes last.
    this.mesh.renderOrder = 28;
    this.group.add(this.mesh);
  }

  /** Takes `water`, null without, of a scene whose numbers begin at `origin`. */
  take(water, origin) {
    this.water = water;
    if (!water) return;
    const [across, along] = water.cells;
    const { geometry } = this.mesh;
    const corners = [];
    for (let j = 0; j < along; j++) {
      for (let i = 0; i < across; i++) {
        for (const [a, b] of [[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]]) {
          const cell = [(i + a) / across, (j + b) / along];
          corners.push(...[0, 1].map((k) => water.low[k] + water.size[k] * cell[k] - origin[k]), water.level - origin[2]);
        }
      }
    }
    this.origin = origin;
    this.level = water.level - origin[2];
    const zeros = (n) => new THREE.Float32BufferAttribute(new Float32Array(n), n === corners.length ? 3 : 1);
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(corners, 3));
    geometry.setAttribute('shift', zeros(corners.length));
    geometry.setAttribute('value', zeros(corners.length / 3));
    this.frame(0);
  }

  /** Height of the surface above still water [m] at a place relative to the origin. */
  elevation(x, y, time) {
    const { wave } = this.water;
    if (!wave) return 0;
    const [kx, ky] = wave.number;
    return wave.amplitude * Math.cos(kx * (x + this.origin[0]) + ky * (y + this.origin[1]) - wave.frequency * time + wave.phase);
  }

  /** Moves the surface to where it is at a time [s]. */
  frame(time) {
    if (!this.water?.wave) return;
    const { array } = this.mesh.geometry.getAttribute('position');
    for (let k = 0; k < array.length; k += 3) array[k + 2] = this.level + this.elevation(array[k], array[k + 1], time);
    this.mesh.geometry.getAttribute('position').needsUpdate = true;
  }

  look({ show, colour, opacity }) {
    this.group.visible = Boolean(this.water) && show;
    const { material } = this.mesh;
    material.uniforms.tint.value.set(...rgb(colour));
    material.uniforms.opacity.value = opacity;
    const glass = opacity < 1;
    if (material.transparent !== glass) Object.assign(material, { transparent: glass, depthWrite: !glass, needsUpdate: true });
  }
}

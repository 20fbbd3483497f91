// Force chains: a cylinder for each contact, as thick as its force is large.
import * as THREE from 'three';
import { mapTexture, rgb } from 'colours';
import { chainMaterial } from 'shaders';

/** Sides of a cylinder, of many few. */
const sides = (count) => (count > 100000 ? 4 : count > 20000 ? 6 : 10);

export class Chains {
  constructor() {
    this.material = chainMaterial();
    this.material.side = THREE.DoubleSide;
    this.group = new THREE.Group();
    this.count = 0;
    this.range = [0, 1];
  }

  /** Takes the chains of a frame; `strongOnly` leaves out those below the mean. */
  frame(block, strongOnly) {
    if (this.mesh) {
      this.group.remove(this.mesh);
      this.mesh.geometry.dispose();
      this.mesh = null;
    }
    const { ends, normal_force: normal, strong } = block.arrays;
    const force = block.arrays.magnitude ?? normal ?? new Float32Array(ends.length / 6).fill(1);
    const kept = [];
    for (let k = 0; k < force.length; k++) if (!strongOnly || !strong || strong[k]) kept.push(k);
    const [a, b, f] = [new Float32Array(3 * kept.length), new Float32Array(3 * kept.length), new Float32Array(kept.length)];
    kept.forEach((k, n) => {
      a.set(ends.subarray(6 * k, 6 * k + 3), 3 * n);
      b.set(ends.subarray(6 * k + 3, 6 * k + 6), 3 * n);
      f[n] = force[k];
    });
    this.count = kept.length;
    this.force = f;
    if (!kept.length) return;
    const n = sides(kept.length);
    const ring = [];
    for (let k = 0; k < n; k++) {
      const t = (2 * Math.PI * k) / n;
      ring.push(Math.cos(t), Math.sin(t), 0, Math.cos(t), Math.sin(t), 1);
    }
    const index = [];
    for (let k = 0; k < n; k++) {
      const [p, q] = [2 * k, 2 * ((k + 1) % n)];
      index.push(p, q, p + 1, q, q + 1, p + 1);
    }
    const geometry = new THREE.InstancedBufferGeometry();
    geometry.setAttribute('position', new THREE.Float32BufferAttribute(ring, 3));
    geometry.setIndex(index);
    geometry.setAttribute('first', new THREE.InstancedBufferAttribute(a, 3));
    geometry.setAttribute('second', new THREE.InstancedBufferAttribute(b, 3));
    geometry.setAttribute('force', new THREE.InstancedBufferAttribute(f, 1));
    geometry.instanceCount = kept.length;
    this.mesh = new THREE.Mesh(geometry, this.material);
    this.mesh.frustumCulled = false;
    this.group.add(this.mesh);
    let most = 0;
    for (const v of f) most = Math.max(most, Math.abs(v));
    this.most = most || 1;
  }

  /** `look`: map, colour by force or constant, thickness [m] of the strongest, least share of force that is shown, limits. */
  look(look, metres) {
    const u = this.material.uniforms;
    let [least, most] = [Infinity, 0];
    for (const v of this.force ?? []) [least, most] = [Math.min(least, v), Math.max(most, v)];
    this.range = look.auto ? [Math.min(least, most), most] : [look.min, look.max];
    u.mode.value = look.colour === 'constant' ? 1 : 0;
    u.tint.value.set(...rgb(look.constant));
    u.map.value = mapTexture(look.map);
    u.range.value.set(...this.range);
    u.most.value = look.auto ? this.most ?? 1 : Math.max(Math.abs(look.max), 1e-30);
    u.least.value = look.least;
    u.thickness.value = metres * look.thickness;
  }
}

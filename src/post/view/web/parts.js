// Objects of a frame: their update from blocks, section, fields.
import * as THREE from 'three';
import { Chains } from 'chains';
import { Grains, label as grainLabel, unit as grainUnit } from 'grains';
import { Model } from 'model';
import { Solid, DISPLACEMENTS, label as solidLabel } from 'solid';
import { Walls } from 'walls';
import { Water } from 'water';

/** Settings of the user; limits from the data are left out. */
export const chosen = (look) => (look.auto ? { ...look, min: 0, max: 0 } : look);
const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

/** Base of the application with `state`, `stage`, `meta`, `block`. */
export class Parts {
  /** Removes what is drawn. */
  clear() {
    this.stage.scene.clear();
    this.model?.dispose();
    this.grains = new Grains();
    this.chains = new Chains();
    this.walls = new Walls();
    this.solid = new Solid();
    this.model = new Model();
    this.water = new Water();
    this.stage.scene.add(this.model.group, this.solid.group, this.chains.group, this.grains.group, this.walls.group, this.water.group);
    this.shown = {};
    this.common = {};
    this.largestFactor = this.size = this.base = null;
  }

  /** Box of the visible parts of the frame; planes have no end. */
  frameBox() {
    const box = this.walls.group.visible ? this.walls.bounds(true) : new THREE.Box3();
    if (this.grains.group.visible) box.union(this.grains.box() ?? box);
    if (this.solid.group.visible && this.solidSkin) box.union(this.solid.box(this.state.solid.factor));
    return box.isEmpty() ? this.stage.box : box;
  }

  get solidSkin() { return this.common.solid; }

  /** The axis along which all grains lie in one plane, or null. */
  flatAxis() {
    const p = this.grains.position;
    if (!p || this.grains.count < 2) return null;
    return ['x', 'y', 'z'].find((_, k) => {
      let [low, high] = [Infinity, -Infinity];
      for (let b = k; b < p.length; b += 3) [low, high] = [Math.min(low, p[b]), Math.max(high, p[b])];
      return high - low < 1e-3 * this.grains.bodies.radius[0];
    }) ?? null;
  }

  /** Does something if what it follows from has changed since the last time. */
  async once(key, from, act) {
    const text = JSON.stringify(from);
    if (this.shown[key] === text) return;
    await act();
    this.shown[key] = text;
  }

  /** Radius of the strongest chain at thickness 1 [m]. */
  thickness() {
    const { diameter } = this.grains.bodies ?? {};
    if (!diameter?.length) return 0.006 * (this.size ?? 1);
    if (this.sortedFrom !== diameter) {
      this.sortedFrom = diameter;
      this.middle = Float32Array.from(diameter).sort()[diameter.length >> 1];
    }
    return 0.22 * this.middle;
  }

  async updateGrains(k) {
    const { state, grains } = this;
    const look = state.grains;
    await this.once('grains', k, async () => {
      const block = await this.block(`grains/${k}`);
      grains.frame(this.common.grains, block);
      this.grainBlock = block;
      this.shown.section = this.shown.colour = null;
      // Stones may leave the place where they began.
      const box = this.grains.box();
      if (this.base && box) this.stage.setBox(box.union(this.base));
    });
    await this.once('colour', [chosen(look), state.reference.frame], async () => {
      const values = await this.grainValues(look.colour, k);
      const palette = { part: 'groups', piece: 'pieces' }[look.colour];
      const pieces = look.colour === 'piece' ? grains.pieces(values) : null;
      this.pieces = pieces?.sizes ?? null;
      grains.colour(pieces?.values ?? values, { ...look, palette });
      if (look.auto && values && !palette) [look.min, look.max] = grains.range;
      grains.spheres.opacity = look.opacity;
    });
    this.section();
  }

  /** Colours grains with faces as the others, within limits for both. */
  async paintStones(k) {
    const { state, walls, grains } = this;
    const { colour, auto } = state.grains;
    const block = walls.stones.length && this.meta.grainFields.includes(colour) ? await this.block(`walls/${k}/${colour}`) : null;
    const values = block ? walls.ofStones(block.arrays.value) : null;
    this.stoneValues = values;
    if (!values) return walls.paint(null);
    const own = grains.count && grains.values ? grains.range : [Infinity, -Infinity];
    let range = [state.grains.min, state.grains.max];
    if (auto) {
      range = values.reduce(([low, high], v) => [Math.min(low, v), Math.max(high, v)], own);
      [state.grains.min, state.grains.max] = range;
    }
    grains.range = range;
    grains.spheres.material.uniforms.range.value.set(...range);
    walls.paint(values, range, state.grains, colour === 'part');
    return null;
  }

  /** One number per body of a frame; null for a constant colour. */
  async grainValues(field, k) {
    if (field === 'constant') return null;
    if (field === 'diameter') return this.grains.bodies.diameter;
    if (field === 'sieve') return Float32Array.from(this.grains.bodies.diameter, (_, body) => this.grains.sieve(body));
    if (field === 'displacement') {
      return this.grains.moved(this.common.grains, await this.block(`grains/${this.state.reference.frame}`));
    }
    const block = await this.block(`grains/${k}/${field === 'piece' ? 'fragment' : field}`);
    if (!block) throw new Error(`found no ${field} in this frame, expected one of its fields`);
    return block.arrays.value;
  }

  async updateSolid(k) {
    const { state, solid } = this;
    const look = state.solid;
    const since = Boolean(state.reference.since);
    await this.once('solid', [k, since && state.reference.frame], async () => {
      const before = since ? await this.block(`solid/${state.reference.frame}`) : null;
      solid.frame(await this.block(`solid/${k}`), before);
      this.shown.field = null;
      const most = solid.displacement.reduce((m, v) => Math.max(m, Math.abs(v)), 0);
      // The slider ends where the largest displacement is a tenth of everything.
      if (most > 0) this.largestFactor = Math.max(this.largestFactor ?? 10, 10 ** Math.ceil(Math.log10((0.1 * this.size) / most || 1)));
    });
    await this.once('field', chosen(look), async () => {
      const { field } = look;
      const made = DISPLACEMENTS.includes(field);
      const values = !field || field === 'constant' ? null : made ? solid.displacementField(field) : (await this.block(`solid/${k}/${field}`))?.arrays.value;
      solid.colour(values ?? null, field.startsWith('element:'), look);
      if (look.auto && values) [look.min, look.max] = solid.range;
      solid.look(look);
    });
  }

  /** Removes grains in front and at the rear, along an axis or the line of sight. */
  section() {
    const { state, stage } = this;
    const { axis, front, rear, solid } = state.section;
    const along = axis === 'view' ? stage.sight().toArray() : AXES[axis];
    const box = stage.box;
    const [middle, half] = [box.getCenter(new THREE.Vector3()), box.getSize(new THREE.Vector3()).multiplyScalar(0.5)];
    const centre = middle.dot(new THREE.Vector3(...along));
    const reach = along.reduce((sum, a, k) => sum + Math.abs(a) * half.getComponent(k), 0);
    const [low, high] = [centre - reach + 2 * reach * front, centre + reach - 2 * reach * rear];
    const off = !front && !rear;
    const key = JSON.stringify([off ? null : [along, low, high], solid]);
    if (this.shown.section === key) return;
    this.shown.section = key;
    const [from, to] = off ? [-1e30, 1e30] : [front ? low : -1e30, rear ? high : 1e30];
    const removed = this.grains.bodies ? this.grains.section(along, from, to) : 0;
    state.section.removed = removed + this.walls.section(along, from, to) + this.model.section(along, from, to);
    this.solid.cut(along, solid ? from : -1e30, solid ? to : 1e30);
  }

  /** Colours that grains can have. */
  grainFields() {
    const own = (this.meta?.grainFields ?? []).filter((f) => f !== 'fragment' && f !== 'part');
    const fields = this.meta?.grainFields ?? [];
    const named = own.map((f) => [f, grainUnit(f) ? `${grainLabel(f)} [${grainUnit(f)}]` : grainLabel(f)]);
    const out = [['constant', 'constant'], ['sieve', 'Sieve size [m]'], ['diameter', 'Diameter [m]'], ...named];
    if (this.state.frames > 1) out.push(['displacement', 'Displacement since ref. [m]']);
    if (fields.includes('part')) out.push(['part', 'Group']);
    if (fields.includes('fragment')) out.push(['piece', 'Fragment (largest red)']);
    return out;
  }

  solidFields() {
    if (!this.solidSkin) return [];
    return [['constant', 'constant'], ...[...DISPLACEMENTS, ...this.meta.solidFields].map((f) => [f, solidLabel(f)])];
  }
}

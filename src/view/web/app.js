// The state of the page and what follows from it: blocks of the frame, objects, picture, legends, plots.
import * as THREE from 'three';
import { Chains } from 'chains';
import { rgb } from 'colours';
import { Grains, label as grainLabel, unit as grainUnit } from 'grains';
import { legendsOf } from 'legend';
import { Model } from 'model';
import { legends as drawLegends } from 'plots';
import { Solid, DISPLACEMENTS, label as solidLabel } from 'solid';
import { initial, put } from 'state';
import { ServedSource } from 'source';
import { Stage } from 'stage';
import { Walls } from 'walls';
import * as local from 'local';

const $ = (id) => document.getElementById(id);
/** What the user has chosen of a look: limits from the data follow from it. */
const chosen = (look) => (look.auto ? { ...look, min: 0, max: 0 } : look);
const AXES = { x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] };

export class App {
  constructor(served) {
    this.served = served;
    this.state = initial();
    this.stage = new Stage($('canvas'));
    this.stage.before = () => this.beforeDrawing();
    this.stage.after = () => this.afterDrawing();
    this.listeners = [];
    this.running = null;
    this.said = [];
    this.clear();
  }

  /** Removes what is drawn. */
  clear() {
    this.stage.scene.clear();
    this.model?.dispose();
    this.grains = new Grains();
    this.chains = new Chains();
    this.walls = new Walls();
    this.solid = new Solid();
    this.model = new Model();
    this.stage.scene.add(this.model.group, this.solid.group, this.chains.group, this.grains.group, this.walls.group);
    this.shown = {};
    this.common = {};
    this.largestFactor = this.size = this.base = null;
  }

  /** Opens a run below the folder of the program. */
  openRun(run) { return this.open(new ServedSource(run), run); }

  async openFiles(files) { return this.open(await local.read(files), ''); }

  /** Shows the results of a source from its first frame on. */
  async open(source, run, again = false) {
    await this.idle();
    const scene = await source.block('scene');
    if (!scene) throw new Error('there are no results');
    const { meta } = scene;
    const has = (part) => meta.frames.some((frame) => frame.parts.includes(part));
    const grains = has('grains') ? await source.block('grains') : null;
    const solid = has('solid') && meta.solidFields.length ? await source.block('solid') : null;
    const model = meta.model ? await source.block('model') : null;
    if (again && this.meta) this.follow(meta.origin);
    this.source = source;
    this.meta = meta;
    this.clear();
    this.common = { grains, solid };
    const kept = this.state;
    const state = Object.assign(this.state, { ...initial(), view: { ...kept.view, flat: null }, model: kept.model }, { run, title: meta.title, status: meta.status });
    state.times = meta.frames.map((frame) => frame.time);
    state.frames = meta.frames.length;
    for (const part of Object.keys(state.parts)) state.parts[part] = has(part);
    state.solid.field = ['stress_zz', 'von_mises', 'displacement'].find((f) => meta.solidFields.includes(f)) ?? (solid ? 'displacement' : '');
    // Where chains are all that there is, they are what is wanted.
    state.chains.show = state.parts.chains && !state.parts.grains;
    state.walls.boundary.show = !state.parts.solid;
    if (solid) this.solid.mesh(solid);
    state.parts.model = Boolean(model);
    if (model) this.model.take(meta.model, model);
    document.title = `${state.title} – trackbed`;
    await this.changed();
    await this.first(again && this.seen);
    this.seen ||= Boolean(model);
  }

  /** Reads the scene again and looks at it from the same place. */
  reload() { return this.open(new ServedSource(''), '', true); }

  /** Moves the eye with the origin of the numbers. */
  follow(origin) {
    const way = new THREE.Vector3(...this.meta.origin.map((x, k) => x - origin[k]));
    Object.values(this.stage.controls).forEach(({ target, object }) => { target.add(way); object.position.add(way); });
  }

  /** Looks at an object of a scene and shows what it is. */
  fly(k) {
    const item = this.model.items[k];
    const box = this.model.box(k);
    if (box) this.stage.look(this.state.view.side, box.translate(new THREE.Vector3(...this.meta.origin).negate()));
    return this.set({ picked: this.about({ item }), pickedQuantity: '' });
  }

  /** Rows about a picked object of a scene. */
  about({ item, place, number }) {
    const { label, word } = this.model.kinds[item.kind];
    const data = [['kind', label, ''], ['key', item.key, '']];
    if (item.count) data.push(['number', item.count, '']);
    if (number !== undefined) data.push([word === 'grains' ? 'grain' : 'node', `${number}`, '']);
    if (place) data.push(['place [m]', place.map((x, k) => x + this.meta.origin[k]), '']);
    return { kind: 'object', title: item.name, data };
  }

  /** What is known once a frame is there: the size of everything, whether it is plane. */
  async first(stay = false) {
    const { bounds, origin } = this.meta;
    const box = new THREE.Box3(...bounds.map((corner) => new THREE.Vector3(...corner.map((x, k) => x - origin[k]))));
    box.union(this.walls.bounds());
    this.base = box;
    this.stage.setBox(box);
    this.size = box.getSize(new THREE.Vector3()).length();
    const { state } = this;
    state.view.flat = this.solidSkin ? null : this.flatAxis();
    if (state.view.flat) {
      state.view.projection = 'parallel';
      state.view.side = { x: 'right', y: 'front', z: 'top' }[state.view.flat];
    } else if (state.view.side === 'top' && state.view.projection === 'parallel') {
      state.view.side = 'oblique';
    }
    this.stage.select(state.view.projection);
    Object.values(this.stage.controls).forEach((controls) => { controls.enableRotate = !state.view.flat; });
    if (!stay) this.look();
    await this.changed();
  }

  /** Looks at everything, or at the grains with a part of the solid below. */
  look() {
    const { side, focus } = this.state.view;
    const box = focus === 'grains' ? this.grains.box() : null;
    if (box && this.solidSkin) {
      const size = box.getSize(new THREE.Vector3());
      box.min.z -= 0.35 * Math.max(size.x, size.y);
    }
    this.stage.look(side, box ?? this.stage.box);
    this.shown.side = side;
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

  /** Sets one value, or several by their paths, and shows what follows. */
  set(path, value) {
    const values = typeof path === 'string' ? { [path]: value } : path;
    for (const [p, v] of Object.entries(values)) {
      put(this.state, p, v);
      if (p === 'view.side' || p === 'view.focus') this.shown.side = null;
    }
    return this.changed();
  }

  /** Brings everything up to date; changes that come meanwhile are taken in as well. */
  changed() {
    this.dirty = true;
    this.running ??= (async () => {
      while (this.dirty) {
        this.dirty = false;
        try {
          await this.update();
          this.state.error = '';
        } catch (error) {
          this.state.error = error.message;
          this.state.playing = 0;
        }
        this.say('');
        this.listeners.forEach((listener) => listener(this.state));
        this.stage.wanted();
      }
      this.running = null;
    })();
    return this.running;
  }

  /** Waits until everything is up to date and drawn. */
  async idle() {
    while (this.running) await this.running;
    this.stage.now();
  }

  say(text) {
    this.state.loading = text;
    if (text) this.said.push(text);
    const box = $('message');
    box.textContent = this.state.error || text;
    box.className = this.state.error ? 'shown error' : text ? 'shown' : '';
  }

  /** A block, with a word to the user if it takes long. */
  async block(name) {
    const wait = setTimeout(() => this.say('Loading file, please wait'), name.startsWith('chains') ? 0 : 150);
    if (name.startsWith('chains') && this.shown.chains === undefined) this.say('Loading file, please wait');
    try {
      return await this.source.block(name);
    } finally {
      clearTimeout(wait);
    }
  }

  /** Does something if what it follows from has changed since the last time. */
  async once(key, from, act) {
    const text = JSON.stringify(from);
    if (this.shown[key] === text) return;
    await act();
    this.shown[key] = text;
  }

  async update() {
    const { state, stage } = this;
    if (!this.source) return;
    const k = state.frame = Math.min(Math.max(Math.round(state.frame), 0), state.frames - 1);
    state.reference.frame = Math.min(Math.max(Math.round(state.reference.frame), 0), state.frames - 1);
    state.time = state.times[k];
    const has = this.meta.frames[k].parts;
    this.grains.group.visible = state.grains.show && has.includes('grains');
    this.chains.group.visible = state.chains.show && has.includes('chains');
    this.size ??= new THREE.Vector3(...this.meta.bounds[1]).distanceTo(new THREE.Vector3(...this.meta.bounds[0]));
    this.solid.group.visible = state.solid.show && has.includes('solid');
    this.walls.group.visible = has.includes('walls');
    if (has.includes('grains')) await this.updateGrains(k);
    if (this.chains.group.visible) {
      await this.once('chains', [k, state.chains.strong], async () => this.chains.frame(await this.block(`chains/${k}`), state.chains.strong));
      this.chains.look(state.chains, this.thickness());
      state.chains.count = this.chains.count;
      if (state.chains.auto) [state.chains.min, state.chains.max] = this.chains.range;
    }
    if (has.includes('walls')) {
      await this.once('walls', k, async () => {
        this.walls.frame(await this.block(`walls/${k}`));
        this.shown.stones = this.shown.section = null;
      });
      await this.once('stones', chosen(state.grains), async () => this.paintStones(k));
      this.walls.look(state.walls, state.grains);
      this.section();
    }
    if (has.includes('solid') && this.solidSkin) await this.updateSolid(k);
    if (state.parts.model) {
      this.model.look(state.model);
      this.section();
    }
    if (state.view.projection !== stage.projection) stage.select(state.view.projection);
    if (this.shown.side !== state.view.side && this.shown.side !== undefined) {
      this.look();
    }
    stage.lamp = state.view.light;
    Object.values(stage.controls).forEach((controls) => { controls.autoRotate = state.view.autoRotate; });
    stage.scene.background = new THREE.Color(...rgb(state.view.background));
    state.legends = legendsOf(this);
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

  beforeDrawing() {
    if (this.source && (this.grains.bodies || this.walls.stones?.length || this.state.parts.model) && (this.state.section.front || this.state.section.rear)) this.section();
  }

  /** Legends over the picture. */
  afterDrawing() {
    const canvas = $('legend');
    const ratio = this.stage.renderer.getPixelRatio();
    [canvas.width, canvas.height] = [this.stage.width * ratio, this.stage.height * ratio];
    const g = canvas.getContext('2d');
    g.scale(ratio, ratio);
    // On narrow screens the list below the picture is the legend of a scene.
    const legends = this.state.legends.filter(({ part }) => part !== 'model' || this.stage.width > 640);
    if (this.state.view.legends) drawLegends(g, this.stage.width, legends, this.dark());
  }

  dark() {
    const [r, g, b] = rgb(this.state.view.background);
    return 0.3 * r + 0.59 * g + 0.11 * b < 0.4;
  }

  /** Colours that grains can have. */
  grainFields() {
    const own = (this.meta?.grainFields ?? []).filter((f) => f !== 'fragment' && f !== 'part');
    const fields = this.meta?.grainFields ?? [];
    const named = own.map((f) => [f, grainUnit(f) ? `${grainLabel(f)} [${grainUnit(f)}]` : grainLabel(f)]);
    const out = [['constant', 'constant'], ['diameter', 'Diameter [m]'], ...named];
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

// The state of the page and what follows from it: blocks of the frame, objects, picture, legends, plots.
import * as THREE from 'three';
import { rgb } from 'colours';
import { drawLegends, legendSpace, legendsOf } from 'legend';
import { Parts, chosen } from 'parts';
import { initial, put } from 'state';
import { ServedSource } from 'source';
import { Stage } from 'stage';
import * as local from 'local';

const $ = (id) => document.getElementById(id);

export class App extends Parts {
  constructor(served) {
    super();
    this.served = served;
    this.state = initial();
    this.stage = new Stage($('canvas'));
    this.stage.before = () => this.beforeDrawing();
    this.stage.after = () => this.afterDrawing();
    this.stage.resized = () => this.refit(true);
    /** Reads more of a source before its first picture. */
    this.opened = async () => {};
    this.listeners = [];
    this.running = null;
    this.said = [];
    this.clear();
  }

  /** Opens a run below the folder of the program. */
  openRun(run) { return this.open(new ServedSource(run), run); }

  async openFiles(files) { return this.open(await local.read(files), ''); }

  /** Shows the last frame of a source. */
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
    const state = Object.assign(this.state, { ...initial(), view: { ...kept.view, flat: null }, model: kept.model }, { run, title: meta.title, status: meta.status, frame: meta.frames.length - 1 });
    state.times = meta.frames.map((frame) => frame.time);
    state.frames = meta.frames.length;
    for (const part of Object.keys(state.parts)) state.parts[part] = has(part);
    state.solid.field = ['stress_zz', 'von_mises', 'displacement'].find((f) => meta.solidFields.includes(f)) ?? (solid ? 'displacement' : '');
    // Where chains are all that there is, they are what is wanted.
    state.chains.show = state.parts.chains && !state.parts.grains;
    state.walls.boundary.show = !state.parts.solid;
    if (solid) this.solid.mesh(solid);
    state.parts.water = Boolean(meta.water);
    this.water.take(meta.water, meta.origin);
    state.parts.model = Boolean(model);
    if (model) this.model.take(meta.model, model);
    document.title = `${state.title} – trackbed`;
    await this.changed();
    await this.opened(meta);
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
    this.stage.moved = true;
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
    this.shown.side = null;
    if (stay) Object.assign(this.shown, { side: state.view.side, margins: JSON.stringify(this.margins()) });
    await this.changed();
  }

  /** Fits the frame, or its grains with a part of the solid below, between legends and plots. */
  look() {
    const { side, focus } = this.state.view;
    const box = focus === 'grains' ? this.grains.box() : null;
    if (box && this.solidSkin) {
      const size = box.getSize(new THREE.Vector3());
      box.min.z -= 0.35 * Math.max(size.x, size.y);
    }
    this.stage.margins = this.margins();
    this.stage.look(side, box ?? this.frameBox());
    Object.assign(this.shown, { side, margins: JSON.stringify(this.stage.margins) });
  }

  /** Edges of the picture below title, legends and plots [CSS pixels]. */
  margins() {
    const { view, legends } = this.state;
    const { right, top } = legendSpace(view.legends ? legends : [], this.stage.width);
    const plots = $('plots').offsetHeight;
    return { left: 0, right, top: top + 32, bottom: plots ? plots + 14 : 0 };
  }

  /** Fits again for another side, or for other margins while the camera is where it was put. */
  refit(resized) {
    const { shown, state } = this;
    if (shown.side === undefined) return;
    const other = resized || JSON.stringify(this.margins()) !== shown.margins;
    if (shown.side !== state.view.side || (other && !this.stage.moved)) this.look();
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
        this.refit();
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
    if (state.parts.water) {
      this.water.frame(state.time);
      this.water.look(state.water);
    }
    if (has.includes('solid') && this.solidSkin) await this.updateSolid(k);
    if (state.parts.model) {
      this.model.look(state.model);
      this.section();
    }
    if (state.view.projection !== stage.projection) stage.select(state.view.projection);
    stage.lamp = state.view.light;
    Object.values(stage.controls).forEach((controls) => { controls.autoRotate = state.view.autoRotate; });
    stage.moved ||= state.view.autoRotate;
    stage.scene.background = new THREE.Color(...rgb(state.view.background));
    state.legends = legendsOf(this);
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
    if (this.state.view.legends) drawLegends(g, this.stage.width, this.state.legends, this.dark());
    $('caption').classList.toggle('dark', this.dark());
  }

  dark() {
    const [r, g, b] = rgb(this.state.view.background);
    return 0.3 * r + 0.59 * g + 0.11 * b < 0.4;
  }
}

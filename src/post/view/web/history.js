// Curves beside the picture: settlement, load and deflection, what was picked; with the time of the frame marked.
import { facedCard, grainCard, nodeCard } from 'cards';
import { FACED, Walls } from 'walls';
import { Grains, GRAIN, label as grainLabel, unit as grainUnit } from 'grains';
import { limits } from 'colours';
import { NODE, label as solidLabel, unit as solidUnit } from 'solid';
import { cyclesAt, plot, rowAt } from 'plots';
import { Picker } from 'pick';
import { showPicked } from 'dialogs';

const $ = (id) => document.getElementById(id);
/** Frames that a history is made of at most. */
const MOST = 200;
/** Columns of `history.csv` that are plotted first: displacements of probes, reactions, energies. */
const FIRST = [/_u_z \[m\]/, /reaction_z \[N\]/, /displacement_z \[m\]/, /force_z \[N\]/, /formation_pressure/, /^solid_strain/, /^grains_kinetic/];

/** Unit of a column such as `load [N]`, with its brackets. */
const unitOf = (name) => / \[.*\]$/.exec(name)?.[0] ?? '';

const varies = (values) => { const [low, high] = limits(values); return high > low; };

export class Histories {
  constructor(app) {
    this.app = app;
    this.picker = new Picker(app.stage);
    const canvas = app.stage.canvas;
    let down = null;
    canvas.addEventListener('pointerdown', (e) => { down = [e.offsetX, e.offsetY]; canvas.focus(); });
    canvas.addEventListener('pointerup', (e) => {
      if (down && e.button === 0 && Math.hypot(e.offsetX - down[0], e.offsetY - down[1]) < 4) this.pick(e.offsetX, e.offsetY);
    });
    $('picked-close').onclick = () => app.set('picked', null);
    for (const quantity of ['picked', 'history']) {
      $(`${quantity}-quantity`).onchange = () => app.set(`${quantity}Quantity`, $(`${quantity}-quantity`).value);
    }
    app.listeners.push((state) => this.update(state));
  }

  /** Tables of the run. */
  async load() {
    const { app } = this;
    this.tables = {};
    for (const name of app.meta.tables) {
      try {
        const block = await app.source.block(`table/${name}`);
        if (block) this.tables[name] = new Map(block.meta.columns.map((c, k) => [c, block.arrays[k]]));
      } catch (error) {
        app.state.error = error.message;
      }
    }
    const history = this.tables.history ?? new Map();
    const column = (test) => [...history].find(([name]) => test.test(name))?.[1];
    const [load, place] = [column(/^load(_1)? \[/), column(/^sleeper(_1)?_z \[/)];
    this.time = history.get('time [s]');
    this.curve = this.loads = this.settlement = null;
    if (load && place && this.time?.length > 1) {
      this.curve = { x: place.map((z) => place[0] - z), y: load, xLabel: 'deflection [m]', yLabel: 'load [N]' };
      this.cycles = cyclesAt(load);
      this.loads = load;
    }
    if (this.tables.push) {
      const [x, y] = this.tables.push.values();
      this.curve = { x, y, xLabel: 'displacement [m]', yLabel: 'force [N]', still: true };
    }
    const { cycles } = this.tables;
    if (cycles?.get('cycle')?.length) {
      this.settlement = { x: cycles.get('cycle'), y: cycles.get('settlement [m]'), xLabel: 'cycle N', yLabel: 'settlement [m]' };
    }
    this.columns = new Map([...history].filter(([name, values]) => name !== 'time [s]' && values.length > 1 && varies(values)));
    this.profiles = this.profilesOf(history);
    const names = this.quantities();
    const first = FIRST.map((test) => names.find((name) => test.test(name))).find((name) => name) ?? names[0];
    app.state.historyQuantity = first ?? '';
  }

  /** Profiles along line probes by name, from the columns of their points, which are then not listed themselves. */
  profilesOf(history) {
    const profiles = new Map();
    for (const { name: line, length } of this.app.meta.lines ?? []) {
      const first = `${line}_1_`;
      for (const head of [...history.keys()].filter((name) => name.startsWith(first))) {
        const quantity = head.slice(first.length);
        const heads = [];
        for (let k = 1; history.has(`${line}_${k}_${quantity}`); k += 1) heads.push(`${line}_${k}_${quantity}`);
        const columns = heads.map((name) => history.get(name));
        const limit = limits(columns.flatMap((values) => limits(values)));
        heads.forEach((name) => this.columns.delete(name));
        if (heads.length < 2 || limit[0] === limit[1]) continue;
        const x = heads.map((_, k) => (length * k) / (heads.length - 1));
        profiles.set(`along ${line}: ${quantity}`, { x, columns, limit, xLabel: 'distance [m]', yLabel: `${line}${unitOf(quantity)}` });
      }
    }
    return profiles;
  }

  /** Names of the columns and profiles that can be plotted. */
  quantities() { return [...(this.columns?.keys() ?? []), ...(this.profiles?.keys() ?? [])]; }

  /** Plot of a column over time or of a profile in a row of the table. */
  historyAt(name, row, time) {
    const column = this.columns?.get(name);
    if (column) return { x: this.time, y: column, xLabel: 'time [s]', yLabel: unitOf(name), line: time };
    const profile = this.profiles?.get(name);
    return profile && { ...profile, y: profile.columns.map((values) => values[row]), points: profile.x.length < 40 };
  }

  /** The frame in which the load is largest; the last one where there is no load. */
  peakFrame() {
    const { times } = this.app.state;
    if (!this.loads) return times.length - 1;
    let best = 0;
    const load = times.map((t) => this.loads[rowAt(this.time, t)]);
    load.forEach((f, k) => { if (f > load[best]) best = k; });
    return best;
  }

  update(state) {
    const row = this.time ? rowAt(this.time, state.time) : 0;
    const show = (id, data) => {
      const figure = $(id);
      figure.hidden = !data || !state.view.plots;
      return figure.hidden ? null : plot(figure.querySelector('canvas'), data);
    };
    this.marks = {
      settlement: show('plot-settlement', this.settlement && this.settlementAt(row)),
      load: show('plot-load', this.curve && (this.curve.still ? this.curve : { ...this.curve, mark: [this.curve.x[row], this.curve.y[row]] })),
    };
    const { picked, historyQuantity: name } = state;
    this.marks.history = show('plot-history', this.historyAt(name, row, state.time));
    if (this.marks.history) this.offer('history', this.quantities(), name);
    const curve = picked?.history?.[state.pickedQuantity];
    this.marks.picked = show('plot-picked', curve && { ...curve, line: state.time });
    if (curve) this.offer('picked', Object.keys(picked.history), state.pickedQuantity);
    showPicked(picked);
    if (picked?.renew) this.renew(picked, state);
  }

  /** Brings card and curve of what was picked to the frame and the fields of the picture. */
  renew(picked, { frame, playing }) {
    const fields = this.fields();
    if (picked.fields !== fields) {
      picked.fields = fields;
      this.following = this.follow(picked);
    }
    if (playing || (picked.frame === frame && picked.carded === fields)) return;
    Object.assign(picked, { frame, carded: fields });
    const current = (rows) => rows && this.app.state.picked === picked;
    // Without its fields in a frame, the card keeps the last ones.
    picked.renew().then((rows) => { if (current(rows)) showPicked(Object.assign(picked, rows)); }, () => {});
  }

  settlementAt(row) {
    const { x } = this.settlement;
    const ended = this.cycles ? this.cycles[row] : 0;
    const line = ended ? x[Math.min(ended, x.length) - 1] : x[0];
    return { ...this.settlement, points: x.length < 60, line };
  }

  offer(plotted, names, chosen) {
    const select = $(`${plotted}-quantity`);
    if ([...select.options].map((o) => o.value).join() !== names.join()) select.replaceChildren(...names.map((n) => new Option(n, n)));
    select.value = chosen;
  }

  /** What lies below a point of the picture. */
  async pick(x, y) {
    const { app } = this;
    await app.idle();
    if (app.state.parts.model) {
      const found = app.model.pick(this.picker, x, y);
      return app.set({ picked: found && app.about(found), pickedQuantity: '' });
    }
    const meshes = [];
    if (app.grains.group.visible && app.grains.count) meshes.push([app.grains.spheres.meshes[1], GRAIN]);
    if (app.solid.group.visible && app.solid.object) meshes.push([app.solid.object, NODE]);
    if (app.walls.group.visible && app.walls.stoneMesh.visible) meshes.push([app.walls.stoneMesh, FACED]);
    const found = this.picker.at(x, y, meshes);
    const kinds = { [GRAIN]: grainCard, [FACED]: facedCard, [NODE]: nodeCard };
    const picked = found && await kinds[found.kind](app, found.index, (point) => this.far(point, x, y));
    if (picked) Object.assign(picked, { frame: app.state.frame, carded: this.fields() });
    await app.set({ picked, pickedQuantity: '' });
    return this.following;
  }

  /** Distance in the picture between a point and a pixel [CSS pixels]. */
  far(point, x, y) {
    const [px, py] = this.picker.project(point);
    return Math.hypot(px - x, py - y);
  }

  /** Fields that card and curve of what was picked depend on. */
  fields() {
    const { grains, solid, reference } = this.app.state;
    return JSON.stringify([grains.colour, solid.field, reference]);
  }

  /** Makes the history of what was picked, frame by frame. */
  async follow(picked) {
    const { app } = this;
    const { state } = app;
    const step = Math.ceil(state.frames / MOST);
    const [times, rows] = [[], []];
    const node = picked.kind === 'node';
    const field = node ? state.solid.field : state.grains.colour;
    const current = () => state.picked === picked && picked.fields === this.fields();
    for (let k = 0; k < state.frames; k += step) {
      if (!current()) return;
      const row = node ? await this.nodeRow(picked.node, k, field) : await this.stoneRow(picked, k, field);
      if (!row) continue;
      times.push(state.times[k]);
      rows.push(row);
    }
    if (!rows.length || !current()) return;
    const history = {};
    for (const name of Object.keys(rows[0])) {
      const first = name.startsWith('displacement') && !node ? rows[0][name] : 0;
      const y = rows.map((row) => row[name] - first);
      history[name] = { x: times, y, xLabel: 'time [s]', yLabel: `${picked.title}${unitOf(name)}`, points: times.length < 40 };
    }
    picked.history = history;
    const names = Object.keys(history);
    const { pickedQuantity: chosen } = state;
    // The field of the picture follows the displacements.
    const coloured = names.length > 3 && (node || app.meta.grainFields.includes(field));
    if (!names.includes(chosen) || picked.shown !== field) await app.set('pickedQuantity', names[coloured ? 3 : 0]);
    picked.shown = field;
  }

  async stoneRow({ kind, id }, k, field) {
    const { source, common, meta } = this.app;
    const part = kind === 'faced' ? 'walls' : 'grains';
    const block = await source.block(`${part}/${k}`);
    const found = block && (kind === 'faced' ? Walls.stoneIn(block, id) : Grains.placeIn(common.grains, block, id));
    if (!found) return null;
    const row = { 'displacement z [m]': found.place[2], 'displacement x [m]': found.place[0], 'displacement y [m]': found.place[1] };
    if (!meta.grainFields.includes(field)) field = meta.grainFields.includes('speed') ? 'speed' : '';
    if (field) {
      const unit = grainUnit(field);
      row[`${grainLabel(field)}${unit ? ` [${unit}]` : ''}`] = (await source.block(`${part}/${k}/${field}`))?.arrays.value[found.body ?? found.triangle] ?? 0;
    }
    return row;
  }

  async nodeRow(node, k, field) {
    const { source, state } = this.app;
    const u = (await source.block(`solid/${k}`))?.arrays.displacement;
    if (!u) return null;
    const before = state.reference.since ? (await source.block(`solid/${state.reference.frame}`)).arrays.displacement : null;
    const of = (c) => u[3 * node + c] - (before ? before[3 * node + c] : 0);
    const row = { 'displacement z [m]': of(2), 'displacement x [m]': of(0), 'displacement y [m]': of(1) };
    if (field && field !== 'constant' && !field.startsWith('displacement') && !field.startsWith('element:')) {
      const unit = solidUnit(field);
      row[`${solidLabel(field)}${unit ? ` [${unit}]` : ''}`] = (await source.block(`solid/${k}/${field}`)).arrays.value[node];
    }
    return row;
  }
}

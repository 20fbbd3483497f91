// Curves beside the picture: settlement, load and deflection, what was picked; with the time of the frame marked.
import { FACED, Walls } from 'walls';
import { Grains, GRAIN, label as grainLabel, unit as grainUnit } from 'grains';
import { NODE, label as solidLabel, unit as solidUnit } from 'solid';
import { cyclesAt, plot, rowAt } from 'plots';
import { Picker } from 'pick';
import { showPicked } from 'dialogs';

const $ = (id) => document.getElementById(id);
/** Frames that a history is made of at most. */
const MOST = 200;

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
    $('picked-quantity').onchange = () => app.set('pickedQuantity', $('picked-quantity').value);
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
    const history = this.tables.history;
    const column = (test) => [...(history?.entries() ?? [])].find(([name]) => test.test(name));
    const [load, place] = [column(/^load(_1)? \[/), column(/^sleeper(_1)?_z \[/)];
    this.time = history?.get('time [s]');
    this.curve = null;
    if (load && place && this.time?.length > 1) {
      const start = place[1][0];
      const x = place[1].map((z) => 1000 * (start - z));
      this.curve = { x, y: load[1].map((f) => f / 1000), xLabel: 'deflection [mm]', yLabel: 'load [kN]' };
      this.cycles = cyclesAt(load[1]);
      this.loads = load[1];
    }
    const push = this.tables.push;
    if (push) {
      const [x, y] = [[...push.values()][0], [...push.values()][1]];
      this.curve = { x: x.map((v) => 1000 * v), y: y.map((v) => v / 1000), xLabel: 'displacement [mm]', yLabel: 'force [kN]', still: true };
    }
    const cycles = this.tables.cycles;
    this.settlement = cycles && cycles.get('cycle')?.length
      ? { x: cycles.get('cycle'), y: cycles.get('settlement [m]').map((s) => 1000 * s), xLabel: 'cycle N', yLabel: 'settlement [mm]' }
      : null;
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
    const { picked } = state;
    showPicked(picked);
    const curve = picked?.history?.[state.pickedQuantity];
    this.marks.picked = show('plot-picked', curve && { ...curve, line: state.time });
    if (picked?.history) this.offer(Object.keys(picked.history), state.pickedQuantity);
  }

  settlementAt(row) {
    const { x } = this.settlement;
    const ended = this.cycles ? this.cycles[row] : 0;
    const line = ended ? x[Math.min(ended, x.length) - 1] : x[0];
    return { ...this.settlement, points: x.length < 60, line };
  }

  offer(names, chosen) {
    const select = $('picked-quantity');
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
    if (!found) return app.set('picked', null);
    const made = { [GRAIN]: () => this.grain(found.index), [FACED]: () => this.faced(found.index), [NODE]: () => this.node(found.index, x, y) };
    const picked = await made[found.kind]();
    await app.set({ picked, pickedQuantity: '' });
    return this.follow(picked);
  }

  async grain(sphere) {
    const { app } = this;
    const { grains, meta, state } = app;
    const body = grains.bodyOf(sphere);
    const id = grains.bodies.id[body];
    const place = [0, 1, 2].map((k) => grains.position[3 * body + k] + meta.origin[k]);
    const data = [['position', place, 'm'], ['diameter', grains.bodies.diameter[body], 'm']];
    const spheres = grains.bodies.start[body + 1] - grains.bodies.start[body];
    if (spheres > 1) data.push(['spheres', spheres, '']);
    for (const field of meta.grainFields) {
      const values = await app.grainValues(field, state.frame);
      data.push([grainLabel(field), values[body], grainUnit(field)]);
    }
    return { kind: 'grain', id, title: `Grain ${id}`, data, place };
  }

  /** A grain with faces, by one of its triangles. */
  async faced(triangle) {
    const { source, walls, meta, state } = this.app;
    const stone = walls.stoneAt(triangle);
    const place = stone.place.map((x, k) => x + meta.origin[k]);
    const data = [['position', place, 'm'], ['longest extent', stone.extent, 'm']];
    for (const field of meta.grainFields) {
      const block = await source.block(`walls/${state.frame}/${field}`);
      if (block) data.push([grainLabel(field), block.arrays.value[stone.triangle], grainUnit(field)]);
    }
    return { kind: 'faced', id: stone.id, title: `Grain ${stone.id}`, data, place };
  }

  async node(triangle, x, y) {
    const { app } = this;
    const { solid, meta, state } = app;
    const corners = [...solid.skin.triangles.subarray(3 * triangle, 3 * triangle + 3)];
    const far = (n) => {
      const [px, py] = this.picker.project(solid.place(n, state.solid.factor));
      return Math.hypot(px - x, py - y);
    };
    const node = corners.reduce((a, b) => (far(b) < far(a) ? b : a));
    const id = solid.skin.node_ids[node];
    const u = [0, 1, 2].map((k) => solid.displacement[3 * node + k]);
    const place = [0, 1, 2].map((k) => solid.skin.points[3 * node + k] + meta.origin[k]);
    const data = [['position', place, 'm'], ['displacement x', u[0], 'm'], ['displacement y', u[1], 'm'], ['displacement z', u[2], 'm']];
    const { field } = state.solid;
    if (solid.values && !field.startsWith('displacement')) {
      data.push([solidLabel(field), solid.values[solid.ofElements ? triangle : node], solidUnit(field)]);
    }
    data.push(['element', solid.skin.element_ids[triangle], '']);
    return { kind: 'node', id, node, title: `Node ${id}`, data, place };
  }

  /** Makes the history of what was picked, frame by frame. */
  async follow(picked) {
    const { app } = this;
    const { state, meta } = app;
    const step = Math.ceil(state.frames / MOST);
    const [times, rows] = [[], []];
    const field = picked.kind !== 'node' ? (meta.grainFields.includes(state.grains.colour) ? state.grains.colour : 'speed') : state.solid.field;
    for (let k = 0; k < state.frames; k += step) {
      if (state.picked !== picked) return;
      const row = picked.kind === 'node' ? await this.nodeRow(picked.node, k, field) : await this.stoneRow(picked, k, field);
      if (!row) continue;
      times.push(state.times[k]);
      rows.push(row);
    }
    if (!rows.length || state.picked !== picked) return;
    const history = {};
    for (const name of Object.keys(rows[0])) {
      const first = name.startsWith('displacement') && picked.kind !== 'node' ? rows[0][name] : 0;
      history[name] = { x: times, y: rows.map((row) => row[name] - first), xLabel: 'time [s]', yLabel: `${picked.title}: ${name}`, points: times.length < 40 };
    }
    picked.history = history;
    await app.set('pickedQuantity', Object.keys(history)[0]);
  }

  async stoneRow({ kind, id }, k, field) {
    const { source, common, meta } = this.app;
    const part = kind === 'faced' ? 'walls' : 'grains';
    const block = await source.block(`${part}/${k}`);
    const found = block && (kind === 'faced' ? Walls.stoneIn(block, id) : Grains.placeIn(common.grains, block, id));
    if (!found) return null;
    const row = { 'displacement z [m]': found.place[2], 'displacement x [m]': found.place[0], 'displacement y [m]': found.place[1] };
    if (meta.grainFields.includes(field)) {
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

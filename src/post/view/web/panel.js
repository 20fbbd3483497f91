// Controls at the side: each is tied to a place in the state by its path.
import { MAPS } from 'colours';

/** Settings with a colour map. */
const mapped = (look) => !['constant', 'part', 'piece'].includes(look.colour ?? look.field);

/** Rows: kind, path, label, what the kind needs, and when it is shown. */
const sections = (app) => [
  ['Grains', 'grains', [
    ['check', 'grains.show', 'Show'],
    ['select', 'grains.colour', 'Colour by', () => app.grainFields()],
    ['colour', 'grains.constant', 'Constant colour', null, (s) => s.grains.colour === 'constant'],
    ['select', 'grains.map', 'Colour map', () => MAPS, (s) => mapped(s.grains)],
    ['limits', 'grains', null, null, (s) => mapped(s.grains)],
    ['range', 'grains.opacity', 'Opacity', [0.05, 1, 0.05]],
  ]],
  ['Section', 'section', [
    ['select', 'section.axis', 'Along', () => [['view', 'line of sight'], ['x', 'x'], ['y', 'y'], ['z', 'z']]],
    ['range', 'section.front', 'Front', [0, 1, 0.005]],
    ['range', 'section.rear', 'Rear', [0, 1, 0.005]],
    ['check', 'section.solid', 'Cut the solid', null, (s) => !s.parts.model],
  ]],
  ['Force chains', 'chains', [
    ['check', 'chains.show', 'Show (loads its file)'],
    ['select', 'chains.colour', 'Colour by', () => [['force', 'magnitude'], ['constant', 'constant']]],
    ['colour', 'chains.constant', 'Constant colour', null, (s) => s.chains.colour === 'constant'],
    ['select', 'chains.map', 'Colour map', () => MAPS, (s) => mapped(s.chains)],
    ['limits', 'chains', null, null, (s) => mapped(s.chains)],
    ['range', 'chains.thickness', 'Thickness', [0.1, 4, 0.1]],
    ['range', 'chains.least', 'Smallest force / largest', [0, 1, 0.01]],
    ['check', 'chains.strong', 'Above the mean force only'],
  ]],
  ['Solid', 'solid', [
    ['check', 'solid.show', 'Show'],
    ['select', 'solid.field', 'Contour', () => app.solidFields()],
    ['colour', 'solid.constant', 'Constant colour', null, (s) => s.solid.field === 'constant'],
    ['select', 'solid.map', 'Colour map', () => MAPS, (s) => mapped(s.solid)],
    ['limits', 'solid', null, null, (s) => mapped(s.solid)],
    ['check', 'solid.bands', 'In 12 bands', null, (s) => mapped(s.solid)],
    ['range', 'solid.factor', 'Deformation ×', [0, 100, 1]],
    ['check', 'solid.edges', 'Element edges'],
    ['range', 'solid.opacity', 'Opacity', [0.05, 1, 0.05]],
  ]],
  ['Displacement', 'reference', [
    ['select', 'reference.since', 'Displacement of the solid', () => [['', 'total'], ['1', 'since the reference']]],
    ['number', 'reference.frame', 'Reference frame', [0, 1]],
  ]],
  ['Boundary, track', 'walls', [
    ['check', 'walls.boundary.show', 'Boundary'],
    ['colour', 'walls.boundary.colour', 'Colour'],
    ['range', 'walls.boundary.opacity', 'Opacity', [0.05, 1, 0.05]],
    ['check', 'walls.track.show', 'Sleepers, rails'],
    ['colour', 'walls.track.colour', 'Sleeper colour'],
    ['range', 'walls.track.opacity', 'Opacity', [0.05, 1, 0.05]],
  ]],
  ['Water', 'water', [
    ['check', 'water.show', 'Show'],
    ['colour', 'water.colour', 'Colour'],
    ['range', 'water.opacity', 'Opacity', [0.05, 1, 0.05]],
  ]],
  ['View', 'view', [
    ['select', 'view.side', 'From', () => ['oblique', 'front', 'back', 'left', 'right', 'top', 'bottom'].map((s) => [s, s])],
    ['select', 'view.focus', 'Frame', () => [['all', 'everything'], ['grains', 'grains']]],
    ['select', 'view.projection', 'Projection', () => [['perspective', 'perspective'], ['parallel', 'parallel']]],
    ['select', 'view.light', 'Light', () => [['camera', 'from the eye'], ['x', 'along x'], ['y', 'along y'], ['z', 'along z']]],
    ['palette', 'view.background', 'Background', ['#ffffff', '#e8edf2', '#9fb3c8', '#33414f', '#000000']],
    ['check', 'view.autoRotate', 'Auto-rotate'],
    ['check', 'view.legends', 'Legends'],
    ['check', 'view.plots', 'Plots'],
  ]],
];

const at = (state, path) => path.split('.').reduce((o, key) => o?.[key], state);

export function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [key, value] of Object.entries(attributes)) {
    if (key in made) made[key] = value; else made.setAttribute(key, value);
  }
  made.append(...children);
  return made;
}

export class Panel {
  constructor(root, app) {
    this.root = root;
    this.app = app;
    this.inputs = [];
    this.conditions = [];
    for (const [title, key, rows] of sections(app)) {
      const body = element('div', { className: 'rows' });
      rows.forEach((row) => {
        const made = this.row(...row);
        if (row[4]) this.conditions.push([row[4], made]);
        body.append(...made);
      });
      const box = element('details', { id: `part-${key}`, open: key === 'solid' || key === 'grains' }, element('summary', { textContent: title }), body);
      root.append(box);
    }
  }

  row(kind, path, label, extra) {
    const id = path.replaceAll('.', '-');
    const set = (value) => this.app.set(path, value);
    const text = element('label', { textContent: label ?? '', htmlFor: id });
    const tie = (input, read, write) => {
      this.inputs.push({ path, input, write, extra });
      input.addEventListener(input.type === 'range' || input.type === 'color' ? 'input' : 'change', () => set(read(input)));
      return input;
    };
    const number = (input) => (Number.isFinite(input.valueAsNumber) ? input.valueAsNumber : 0);
    switch (kind) {
      case 'check': {
        const input = tie(element('input', { type: 'checkbox', id }), (i) => i.checked, (i, v) => { i.checked = v; });
        return [element('div', { className: 'row check' }, input, text)];
      }
      case 'select': {
        const input = tie(element('select', { id }), (i) => i.value, (i, v) => {
          const options = extra();
          const have = [...i.options].map((o) => o.value + o.text).join();
          if (have !== options.map(([value, shown]) => value + shown).join()) i.replaceChildren(...options.map(([value, shown]) => element('option', { value, textContent: shown })));
          i.value = v;
        });
        return [element('div', { className: 'row' }, text, input)];
      }
      case 'range': {
        const [min, max, step] = extra;
        const shown = element('input', { type: 'number', id: `${id}-number`, min, step, className: 'small', ariaLabel: label });
        shown.addEventListener('change', () => set(number(shown)));
        const input = tie(element('input', { type: 'range', id, min, max, step }), number, (i, v) => {
          if (v > Number(i.max)) i.max = v;
          i.value = v;
          if (document.activeElement !== shown) shown.value = Number(v.toPrecision(4));
        });
        return [element('div', { className: 'row' }, text, shown), element('div', { className: 'row' }, input)];
      }
      case 'number': {
        const input = tie(element('input', { type: 'number', id, className: 'small', min: extra[0], step: extra[1] }), number, (i, v) => { i.value = v; });
        return [element('div', { className: 'row' }, text, input)];
      }
      case 'colour': {
        const input = tie(element('input', { type: 'color', id }), (i) => i.value, (i, v) => { i.value = v; });
        return [element('div', { className: 'row' }, text, input)];
      }
      case 'palette': {
        const input = tie(element('input', { type: 'color', id, title: 'custom' }), (i) => i.value, (i, v) => { i.value = v; });
        const swatches = extra.map((colour) => {
          const swatch = element('button', { className: 'swatch', title: colour, id: `${id}-${colour.slice(1)}` });
          swatch.style.background = colour;
          swatch.addEventListener('click', () => set(colour));
          return swatch;
        });
        return [element('div', { className: 'row' }, text), element('div', { className: 'row' }, ...swatches, input)];
      }
      default: {
        // Limits of the colours: from the data, or given.
        const auto = this.row('check', `${path}.auto`, 'Limits from the data');
        const box = element('div', { className: 'row limits' });
        for (const end of ['min', 'max']) {
          const p = `${path}.${end}`;
          const input = element('input', { type: 'number', id: p.replaceAll('.', '-'), step: 'any', ariaLabel: `${end} of the colours` });
          input.addEventListener('change', () => this.app.set({ [p]: number(input), [`${path}.auto`]: false }));
          this.inputs.push({ path: p, input, write: (i, v) => { if (document.activeElement !== i) i.value = Number(v.toPrecision(5)); } });
          box.append(input);
        }
        return [...auto, box];
      }
    }
  }

  /** Shows the state. */
  update(state) {
    document.getElementById('solid-factor').max = this.app.largestFactor ?? 100;
    for (const { path, input, write } of this.inputs) write(input, at(state, path));
    for (const [holds, made] of this.conditions) made.forEach((row) => { row.hidden = !holds(state); });
    for (const part of ['grains', 'solid', 'chains', 'walls', 'water', 'reference']) {
      const has = part === 'reference' ? state.parts.solid || state.parts.grains : state.parts[part];
      document.getElementById(`part-${part}`).hidden = !has;
    }
    document.getElementById('part-section').hidden = !state.parts.grains && !state.parts.model;
  }
}

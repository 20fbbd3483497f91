// Contents of a scene at the side: warnings, objects by kind, report; messages where it has errors.
import { element } from 'panel';

const $ = (id) => document.getElementById(id);

export class Outline {
  constructor(app) {
    this.app = app;
    this.root = $('outline');
  }

  /** Lists the scene of `meta`. */
  take({ model, errors, reading }) {
    this.inputs = [];
    $('reading').hidden = !reading;
    $('errors').hidden = !errors;
    $('error-list').replaceChildren(...(errors ?? []).map((text) => element('li', { textContent: text })));
    document.body.classList.toggle('scene', Boolean(model || errors));
    this.root.replaceChildren(...(model ? this.parts(model) : []));
  }

  parts({ kinds, items, warnings }) {
    const parts = warnings.length ? [this.warnings(warnings)] : [];
    kinds.forEach((kind, number) => {
      const own = [...items.entries()].filter(([, item]) => item.kind === number);
      if (own.length) parts.push(this.kind(kind, own));
    });
    this.report = element('details', { id: 'part-check', hidden: true }, element('summary', { textContent: 'Check' }), element('pre', { id: 'check-text' }));
    return [...parts, this.report];
  }

  warnings(warnings) {
    const rows = warnings.map(({ text, serious, item }) => {
      const row = element('button', { className: serious ? 'warning serious' : 'warning', textContent: text });
      if (item !== null) row.onclick = () => this.app.fly(item); else row.disabled = true;
      return row;
    });
    const title = `Warnings (${warnings.length})`;
    return element('details', { id: 'part-warnings', open: true }, element('summary', { textContent: title }), element('div', { className: 'rows' }, ...rows));
  }

  kind({ word, label, shown }, own) {
    const { model } = this.app.state;
    const box = this.box(`show-${word}`, (v) => { model.kinds[word] = v; }, () => model.kinds[word] ?? shown);
    box.onclick = (event) => event.stopPropagation();
    box.ariaLabel = label;
    const rows = own.map(([k, item]) => {
      const id = `${word}/${item.name}`;
      const swatch = element('span', { className: 'swatch' });
      swatch.style.background = item.colour;
      const name = element('button', { className: 'name', textContent: item.name });
      name.onclick = () => this.app.fly(k);
      const show = this.box(`show-${k}`, (v) => { model.hidden[id] = !v; }, () => !model.hidden[id]);
      show.ariaLabel = item.name;
      return element('div', { className: 'row item', title: `${item.name} (${item.key}): ${item.count}` }, show, swatch, name, element('span', { className: 'count', textContent: item.count }));
    });
    const summary = element('summary', {}, box, ` ${label} (${own.length})`);
    return element('details', { id: `kind-${word}`, open: own.length <= 12 }, summary, element('div', { className: 'rows' }, ...rows));
  }

  box(id, put, get) {
    const input = element('input', { type: 'checkbox', id });
    input.onchange = () => { put(input.checked); this.app.changed(); };
    this.inputs.push([input, get]);
    return input;
  }

  /** Shows the report of the program, once it is there. */
  check(block) {
    if (!block || !this.report) return;
    const { text, errors } = block.meta;
    $('check-text').textContent = errors ? errors.join('\n') : text;
    $('check-text').className = errors ? 'error' : '';
    Object.assign(this.report, { hidden: false, open: Boolean(errors) });
    if (errors) this.root.prepend(this.report);
  }

  update() {
    for (const [input, get] of this.inputs ?? []) input.checked = get();
  }
}

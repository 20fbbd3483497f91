// Legends of the picture: in a column at the right, on narrow screens in rows at the top.
import { colourAt, figures, scaled, ticks } from 'colours';
import { groupName, label as grainLabel, unit as grainUnit } from 'grains';
import { label as solidLabel, unit as solidUnit } from 'solid';

const GROUP_COLOURS = ['#e69f00', '#56b4e9', '#009e73', '#f0e442', '#0072b2', '#d55e00', '#cc79a7', '#999999'];

/** Width of the picture [CSS pixels] below which legends lie at the top. */
const NARROW = 640;
const COLUMN = 180;
const ROW = 46;
/** Length of the bar in a column. */
const BAR = 132;

export function legendsOf(app) {
  const { state, grains, chains, solid } = app;
  const list = [];
  const named = app.model.items.filter((item) => app.model.shows(item, state.model)).slice(0, 14);
  if (named.length) list.push({ part: 'model', title: 'Model', unit: '', swatches: named.map((item) => [item.colour, item.name]) });
  const stones = state.grains.show ? app.stoneValues : null;
  if ((grains.group.visible && grains.count || stones) && state.grains.colour !== 'constant') {
    const field = state.grains.colour;
    if (field === 'piece' && app.pieces?.length) {
      const [largest, ...others] = app.pieces;
      const swatches = [['#db1a1a', `largest: ${largest.bodies} of ${grains.count}`]];
      if (others.length) swatches.push(['#1a9933', `${others.length} other fragment${others.length > 1 ? 's' : ''}`]);
      list.push({ part: 'grains', title: 'Fragments', unit: '', swatches });
    } else if (field === 'part') {
      const groups = [...new Set([...(grains.values ?? []), ...(stones ?? [])])].sort((a, b) => a - b).slice(0, 8);
      list.push({ part: 'grains', title: 'Groups', unit: '', swatches: groups.map((g) => [GROUP_COLOURS[g % 8], groupName(app.meta, g)]) });
    } else {
      const title = field === 'displacement' ? 'Displacement' : grainLabel(field);
      list.push({ part: 'grains', title: `Grains: ${title}`, unit: grainUnit(field), range: grains.range, map: state.grains.map });
    }
  }
  if (chains.group.visible && chains.count && state.chains.colour !== 'constant') {
    list.push({ part: 'chains', title: 'Contact force', unit: 'N', range: chains.range, map: state.chains.map });
  }
  if (solid.group.visible && solid.values && state.solid.field !== 'constant') {
    const since = state.reference.since && state.solid.field.startsWith('displacement');
    const title = solidLabel(state.solid.field);
    const note = since ? `since frame ${state.reference.frame}` : '';
    const { map } = state.solid;
    const numbers = state.solid.field === 'element:material' ? [...new Set(solid.values)].sort((a, b) => a - b) : [];
    if (numbers.length && numbers.length < 13) {
      const [low, high] = solid.range;
      const swatches = numbers.map((n) => [shade(map, 0, high > low ? (n - low) / (high - low) : 0), app.meta.materials?.[n] ?? `material ${n}`]);
      list.push({ part: 'solid', title: 'Materials', unit: '', swatches });
    } else list.push({ part: 'solid', title, note, unit: solidUnit(state.solid.field), range: solid.range, map, bands: state.solid.bands ? 12 : 0 });
  }
  return list;
}

/** Room for legends [CSS pixels]. Lists of a scene are left out on narrow screens. */
export function legendSpace(list, width) {
  if (!list.length) return { right: 0, top: 0 };
  if (width >= NARROW) return { right: COLUMN, top: 0 };
  return { right: 0, top: ROW * list.filter(({ part }) => part !== 'model').length };
}

/** Draws legends on a picture `width` wide; `dark`: its background is dark. */
export function drawLegends(g, width, list, dark) {
  const ink = dark ? '#f2f4f7' : '#1c2733';
  const write = (text, x, y, align = 'left', most = undefined) => {
    Object.assign(g, { fillStyle: ink, textAlign: align });
    g.fillText(text, x, y, most);
  };
  const narrow = width < NARROW;
  let y = narrow ? 34 : 14;
  for (const legend of narrow ? list.filter(({ part }) => part !== 'model') : list) {
    const { factor, unit } = scaled(legend.unit, legend.range ? Math.max(...legend.range.map(Math.abs)) : 0);
    g.font = '600 12px system-ui, sans-serif';
    const title = unit ? `${legend.title} [${unit}]` : legend.title;
    const note = legend.note ?? '';
    g.fillStyle = dark ? 'rgba(20,26,33,0.72)' : 'rgba(255,255,255,0.82)';
    const high = narrow ? ROW - 2 : 34 + (note ? 15 : 0) + (legend.swatches ? 18 * legend.swatches.length : BAR + 12);
    const left = narrow ? 12 : width - COLUMN + 16;
    g.beginPath(); g.roundRect(left - 8, y - 2, width - left + 4, high, 5); g.fill();
    write(title, left, y + 12, 'left', width - left - 10);
    g.font = '12px system-ui, sans-serif';
    if (note && narrow) write(note, width - 12, y + 12, 'right');
    else if (note) write(note, left, y + 27);
    const draw = legend.swatches ? (narrow ? rowOfNames : names) : narrow ? rowOfColours : colours;
    draw({ g, write, ink, left, top: y + (narrow ? 20 : note ? 43 : 28), right: width - 12, factor, ...legend });
    y += high + (narrow ? 2 : 10);
  }
}

function names({ g, write, left, top, right, swatches }) {
  swatches.forEach(([colour, text], k) => {
    g.fillStyle = colour; g.fillRect(left, top + 18 * k - 4, 14, 12);
    write(text, left + 22, top + 18 * k + 6, 'left', right - left - 22);
  });
}

function rowOfNames({ g, write, left, top, right, swatches }) {
  const step = Math.max((right - left) / swatches.length, 64);
  swatches.slice(0, Math.floor((right - left) / step)).forEach(([colour, text], k) => {
    g.fillStyle = colour; g.fillRect(left + step * k, top, 12, 10);
    write(text, left + step * k + 16, top + 9, 'left', step - 20);
  });
}

/** Ticks between the limits as [share, text]. */
function scale([low, high], factor, most) {
  const at = ticks(low / factor, high / factor, most);
  const texts = figures(at);
  return at.map((t, k) => [high > low ? (t * factor - low) / (high - low) : 0.5, texts[k]]);
}

/** Colour at a share of the bar. */
function shade(map, bands, share) {
  const t = bands ? (Math.floor(Math.min(share, 0.99999) * bands) + 0.5) / bands : share;
  return `rgb(${colourAt(map, t).map((v) => Math.round(255 * v)).join(',')})`;
}

function colours({ g, write, ink, left, top, range, factor, map, bands }) {
  for (let k = 0; k < BAR; k++) {
    g.fillStyle = shade(map, bands, 1 - k / (BAR - 1));
    g.fillRect(left, top + k, 18, 1.5);
  }
  g.strokeStyle = ink; g.lineWidth = 0.8; g.strokeRect(left, top, 18, BAR);
  for (const [share, text] of scale(range, factor, 9)) {
    const y = top + (1 - share) * BAR;
    g.fillStyle = ink; g.fillRect(left + 18, y - 0.5, 4, 1);
    write(text, left + 27, y + 4);
  }
}

function rowOfColours({ g, write, ink, left, top, right, range, factor, map, bands }) {
  const wide = right - left;
  for (let k = 0; k < wide; k++) {
    g.fillStyle = shade(map, bands, k / (wide - 1));
    g.fillRect(left + k, top, 1.5, 8);
  }
  g.strokeStyle = ink; g.lineWidth = 0.8; g.strokeRect(left, top, wide, 8);
  g.font = '11px system-ui, sans-serif';
  for (const [share, text] of scale(range, factor, 8)) {
    const align = share < 0.04 ? 'left' : share > 0.96 ? 'right' : 'center';
    write(text, left + share * wide, top + 19, align);
  }
}

// Which legends the picture has.
import { label as grainLabel, unit as grainUnit } from 'grains';
import { label as solidLabel, unit as solidUnit } from 'solid';

const GROUP_COLOURS = ['#e69f00', '#56b4e9', '#009e73', '#f0e442', '#0072b2', '#d55e00', '#cc79a7', '#999999'];

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
      list.push({ part: 'grains', title: 'Groups', unit: '', swatches: groups.map((g) => [GROUP_COLOURS[g % 8], `group ${g}`]) });
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
    const title = since ? `${solidLabel(state.solid.field)} since frame ${state.reference.frame}` : solidLabel(state.solid.field);
    list.push({ part: 'solid', title, unit: solidUnit(state.solid.field), range: solid.range, map: state.solid.map, bands: state.solid.bands ? 12 : 0 });
  }
  return list;
}

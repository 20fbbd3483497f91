// Presets: displays of a run by one button.
import { initial } from 'state';
import { element } from 'panel';

/** Displays of common quantities; `fits`: whether the run has their data, `values`: settings that differ from the initial ones. */
const PRESETS = [
  {
    id: 'peak', label: 'Track at peak load', title: 'Contact forces of the grains and vertical stress of the solid at the largest load',
    fits: ({ state }, { loads }) => Boolean(loads) && state.parts.chains,
    values: ({ state, meta }, histories) => ({
      frame: histories.peakFrame(), grains: { show: false }, chains: { show: true, map: 'blue-red' }, solid: { field: stress(meta) ?? '' },
      walls: { track: { ...initial().walls.track, opacity: 0.35 } },
      view: { side: 'oblique', focus: state.parts.grains ? 'grains' : 'all' },
    }),
  },
  {
    id: 'settlement', label: 'Settlement', title: 'Vertical displacement of the solid and displacement of the grains since the first frame',
    fits: ({ state }) => state.frames > 1 && state.parts.solid,
    values: ({ state }) => ({
      frame: state.frames - 1, grains: { colour: 'displacement' }, solid: { field: 'displacement_z' }, reference: { since: '1', frame: 0 },
    }),
  },
  {
    id: 'stress', label: 'Vertical stress', title: 'Vertical stress of the solid, grains transparent',
    fits: ({ meta }) => stress(meta) !== undefined,
    values: ({ meta }) => ({ grains: { opacity: 0.25 }, solid: { field: stress(meta) } }),
  },
  {
    id: 'chains', label: 'Force chains', title: 'Contact forces, grains transparent',
    fits: ({ state }) => state.parts.chains,
    values: () => ({
      grains: { opacity: 0.15 }, chains: { show: true, map: 'blue-red' }, solid: { field: 'constant' }, view: { focus: 'grains' },
    }),
  },
  {
    id: 'sizes', label: 'Stones by size', title: 'Grains by sieve size',
    fits: ({ state }) => state.parts.grains,
    values: () => ({ grains: { colour: 'sieve' }, solid: { field: 'constant' }, view: { focus: 'grains' } }),
  },
];

const stress = (meta) => (meta.solidFields.includes('stress_zz') ? 'stress_zz' : undefined);

/** Applies a preset. */
export async function apply(preset, app, histories) {
  const fresh = initial();
  fresh.walls.boundary.show = !app.state.parts.solid;
  const { frame = app.state.frame, view = { focus: 'all' }, ...parts } = preset.values(app, histories);
  const values = { frame };
  for (const part of ['grains', 'chains', 'solid', 'section', 'reference', 'walls']) values[part] = { ...fresh[part], ...parts[part] };
  for (const [key, value] of Object.entries(view)) {
    // Setting a side turns the camera back; the same focus leaves it.
    if ((key === 'side' || app.state.view[key] !== value) && !app.state.view.flat) values[`view.${key}`] = value;
  }
  await app.set(values);
  if (values.solid.field === stress(app.meta)) await trim(app, 'solid', 0.01);
  if (values.grains.colour === 'displacement') await trim(app, 'grains', 0.02);
}

/** Limits of the colours without a share of the values at both ends: stress peaks below single stones, single loose stones. */
async function trim(app, part, share) {
  const sorted = Float32Array.from(app[part].values ?? []).sort();
  if (sorted.length <= 1 / share) return;
  const [min, max] = [share, 1 - share].map((at) => sorted[Math.round(at * (sorted.length - 1))]);
  if (max > min) await app.set({ [`${part}.auto`]: false, [`${part}.min`]: min, [`${part}.max`]: max });
}

/** Buttons of the presets that fit the run. */
export function presetButtons(app, histories, before) {
  const fitting = PRESETS.filter(({ fits }) => !app.meta.model && !app.meta.errors && fits(app, histories));
  return fitting.map((preset) => element('button', {
    id: `preset-${preset.id}`, textContent: preset.label, title: preset.title,
    onclick: () => { before(); return apply(preset, app, histories); },
  }));
}

export const presetOf = (id) => PRESETS.find((preset) => preset.id === id);

// What the page shows, in one object.

export function initial() {
  return {
    run: '', title: '', status: '', frame: 0, frames: 0, time: 0, times: [],
    playing: 0, speed: 10, loading: '', error: '',
    parts: { grains: false, chains: false, walls: false, solid: false, model: false, water: false },
    view: {
      side: 'oblique', focus: 'all', projection: 'perspective', light: 'camera', background: '#ffffff', autoRotate: false,
      legends: true, plots: true, flat: null,
    },
    grains: { show: true, colour: 'constant', constant: '#b9ab94', map: 'viridis', auto: true, min: 0, max: 1, opacity: 1 },
    section: { axis: 'view', front: 0, rear: 0, solid: false, removed: 0 },
    chains: {
      show: false, colour: 'force', constant: '#d55e00', map: 'viridis', auto: true, min: 0, max: 1, thickness: 1, least: 0,
      strong: false, count: 0,
    },
    solid: {
      show: true, field: '', constant: '#9aa7b3', map: 'viridis', auto: true, min: 0, max: 1, bands: false, factor: 1, edges: true,
      opacity: 1,
    },
    reference: { since: '', frame: 0 },
    walls: {
      boundary: { show: false, colour: '#7d8fa3', opacity: 0.25 },
      track: { show: true, colour: '#8f959c', opacity: 1 }, rail: '#5b4a3f', stone: '#a89f91',
    },
    water: { show: true, colour: '#56b4e9', opacity: 0.35 },
    model: { kinds: {}, hidden: {} },
    picked: null, pickedQuantity: '', historyQuantity: '', legends: [], saved: null,
  };
}

/** Sets a value by its path. */
export function put(state, path, value) {
  const keys = path.split('.');
  const last = keys.pop();
  keys.reduce((o, key) => o[key], state)[last] = value;
}

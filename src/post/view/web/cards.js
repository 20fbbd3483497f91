// Data of a picked grain or node in the frame shown.
import { label as grainLabel, groupName, unit as grainUnit } from 'grains';
import { label as solidLabel, unit as solidUnit } from 'solid';

const MATERIAL = 'element:material';

/** Card with rows [name, value, unit], which `renew` gives for another frame. */
async function card(kind, id, rows, more = {}) {
  const title = `${kind === 'node' ? 'Node' : 'Grain'} ${id}`;
  return { kind, id, title, ...more, renew: rows, ...await rows() };
}

const world = (place, origin) => Array.from(place, (x, k) => x + origin[k]);

/** Rows of a grain: group and material by name, `own` ones, fields. */
async function grainRows(meta, own, valueOf) {
  const [names, fields] = [[], []];
  for (const field of meta.grainFields) {
    const value = await valueOf(field);
    if (value === undefined) continue;
    if (field !== 'part') {
      fields.push([grainLabel(field), value, grainUnit(field)]);
      continue;
    }
    names.push(['Group', groupName(meta, value), '']);
    const material = meta.groups?.[value]?.material;
    if (material) names.push(['Material', material, '']);
  }
  return [...names, ...own, ...fields];
}

/** Card of the grain of a sphere. */
export function grainCard(app, sphere) {
  const id = app.grains.bodies.id[app.grains.bodyOf(sphere)];
  return card('grain', id, async () => {
    const { grains, meta, state } = app;
    const body = grains.bodies.id.indexOf(id);
    if (body < 0) return null;
    const { start, diameter } = grains.bodies;
    const place = world(grains.position.subarray(3 * body, 3 * body + 3), meta.origin);
    const spheres = start[body + 1] - start[body];
    const sizes = spheres > 1 ? [['Longest extent', diameter[body], 'm'], ['Spheres', spheres, '']] : [['Diameter', diameter[body], 'm']];
    const own = [['Sieve size', grains.sieve(body), 'm'], ...sizes, ['Position', place, 'm']];
    return { data: await grainRows(meta, own, async (field) => (await app.grainValues(field, state.frame))[body]), place };
  });
}

/** Card of a grain with faces, by one of its triangles. */
export function facedCard(app, triangle) {
  const id = app.walls.stoneIds[triangle];
  return card('faced', id, async () => {
    const { source, walls, meta, state } = app;
    const first = walls.stoneIds.indexOf(id);
    if (first < 0) return null;
    const stone = walls.stoneAt(first);
    const place = world(stone.place, meta.origin);
    const own = [['Longest extent', stone.extent, 'm'], ['Position', place, 'm']];
    const valueOf = async (field) => (await source.block(`walls/${state.frame}/${field}`))?.arrays.value[stone.triangle];
    return { data: await grainRows(meta, own, valueOf), place };
  });
}

/** Card of the node of a triangle that is nearest in the picture, by `far`. */
export function nodeCard(app, triangle, far) {
  const { skin } = app.solid;
  const corners = [...skin.triangles.subarray(3 * triangle, 3 * triangle + 3)];
  const away = (n) => far(app.solid.place(n, app.state.solid.factor));
  const node = corners.reduce((a, b) => (away(b) < away(a) ? b : a));
  return card('node', skin.node_ids[node], async () => {
    const { solid, meta, state, source } = app;
    const u = solid.displacement.subarray(3 * node, 3 * node + 3);
    const place = world(solid.skin.points.subarray(3 * node, 3 * node + 3), meta.origin);
    const data = [['Position', place, 'm'], ...['x', 'y', 'z'].map((axis, k) => [`Displacement ${axis}`, u[k], 'm'])];
    const { field } = state.solid;
    if (solid.values && !field.startsWith('displacement') && field !== MATERIAL) {
      data.push([solidLabel(field), solid.values[solid.ofElements ? triangle : node], solidUnit(field)]);
    }
    data.push(['Element', solid.skin.element_ids[triangle], '']);
    if (meta.solidFields.includes(MATERIAL)) {
      const number = (await source.block(`solid/${state.frame}/${MATERIAL}`))?.arrays.value[triangle];
      data.push(['Material', meta.materials?.[number] ?? number, '']);
    }
    return { data, place };
  }, { node });
}

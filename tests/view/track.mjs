// Checks on a short run of the reference case: forces, solid, pictures, videos, history.
import fs from 'node:fs';
import { check as named, expect } from './expect.mjs';

const bytesOf = async (download) => fs.readFileSync(await download.path());

/** Waits until something of this kind is picked and its history is there; an earlier pick stays until then. */
const pickedOf = (page, kind) => page.waitForFunction((k) => trackbed.state.picked?.kind === k && trackbed.state.picked.history, kind);

/** All checks, or those in `only`. */
export async function onTrack(view, only) {
  const { page } = view;
  const check = (id, ...rest) => (!only || only.includes(id) ? named(id, ...rest) : null);
  const frames = (await view.state()).frames;

  await check('S0-58', 'background: palette and a colour of its own', async () => {
    const at = () => view.pixel(20, 45);
    const seen = [];
    for (const colour of ['33414f', 'ffffff', '000000']) {
      await view.control('view-background');
      await page.locator(`#view-background-${colour}`).click();
      await view.idle();
      seen.push((await at()).map((v) => v.toString(16).padStart(2, '0')).join(''));
      expect(seen.at(-1) === colour, `${seen.at(-1)} in place of ${colour}`);
    }
    await (await view.control('view-background')).fill('#123456');
    await view.idle();
    expect((await at()).join() === '18,52,86', `own colour: ${await at()}`);
    await page.locator('#view-background-ffffff').click();
    await view.idle();
    return seen.join(' ');
  });

  await check('S0-69', 'rotate, zoom, pan, perspective, picking', async () => {
    const before = await view.camera();
    await view.drag([400, 200], [480, 240]);
    const turned = await view.camera();
    expect(Math.abs(turned.distance - before.distance) < 1e-4 && turned.place[0] !== before.place[0], 'drag turns');
    const [x, y] = await view.corner();
    await page.mouse.move(x + 400, y + 250);
    await page.mouse.wheel(0, -300);
    await page.waitForTimeout(100);
    await view.idle();
    const zoomed = await view.camera();
    expect(zoomed.distance < 0.95 * turned.distance, `wheel zooms: ${turned.distance} to ${zoomed.distance}`);
    await view.drag([400, 200], [460, 210], 'right');
    const panned = await view.camera();
    expect(Math.hypot(...panned.target.map((v, k) => v - zoomed.target[k])) > 0.01, 'right button pans');
    await view.select('view-projection', 'parallel');
    expect(!(await view.camera()).perspective, 'parallel');
    await view.select('view-projection', 'perspective');
    await view.select('view-focus', 'grains');
    await view.select('view-side', 'oblique');
    const seen = await visibleStone(view);
    await view.clickAt(seen.at);
    await pickedOf(page, 'grain');
    const { picked } = await view.state();
    expect(picked.kind === 'grain' && picked.id === seen.id, `${picked.title} in place of stone ${seen.id}`);
    const text = await page.locator('#picked').innerText();
    expect(text.includes(`Grain ${seen.id}`) && ['Speed', 'Sieve size', 'Longest extent'].every((row) => text.includes(row)), text.replaceAll('\n', ' '));
    const rows = new Map(picked.data.map(([name, value]) => [name, value]));
    // Sieve sizes lie between the sieves of the gradation, in the scale of the scene.
    expect(rows.get('Sieve size') > 0.045 && rows.get('Sieve size') < 0.142 && rows.get('Sieve size') < rows.get('Longest extent'), JSON.stringify(picked.data));
    expect(/^(ballast|crib_front|crib_back)$/.test(rows.get('Group')) && rows.get('Material') === 'stone', JSON.stringify(picked.data));
    await view.run(() => trackbed.app.set('frame', 0));
    await page.waitForFunction((was) => document.getElementById('picked-data').innerText !== was, await page.locator('#picked-data').innerText()).catch(() => {});
    const before0 = (await view.state()).picked.data.find((row) => row[0] === 'Position')[1];
    expect(before0.join() !== rows.get('Position').join(), 'the card follows the frame');
    await view.run((k) => trackbed.app.set('frame', k), frames - 1);
    const history = Object.values(picked.history)[0];
    expect(history.x.length === frames, `${history.x.length} points in the history`);
    expect(await page.locator('#plot-picked').isVisible(), 'its plot is there');
    return `${picked.title}, history of ${history.x.length} frames`;
  });

  await check('nodes', 'picking a node shows its data and history', async () => {
    await view.check('grains-show', false);
    const node = await view.run(() => {
      const { app, histories } = trackbed;
      const n = app.solid.skin.node_ids.length;
      for (let k = 0; k < n; k += 7) {
        const [x, y] = histories.picker.project(app.solid.place(k, app.state.solid.factor));
        if (x < 200 || y < 130 || x > 500 || y > 330) continue;
        const found = histories.picker.at(Math.round(x), Math.round(y), [[app.solid.object, 2]]);
        const corners = found && [...app.solid.skin.triangles.slice(3 * found.index, 3 * found.index + 3)];
        if (corners?.includes(k)) return { at: [Math.round(x), Math.round(y)], id: app.solid.skin.node_ids[k] };
      }
      return null;
    });
    expect(node, 'no node is seen');
    await view.clickAt(node.at);
    await pickedOf(page, 'node');
    const { picked, pickedQuantity: quantity } = await view.state();
    expect(picked.kind === 'node' && picked.id === node.id, `${picked.title} in place of ${node.id}`);
    expect(/stress/.test(quantity), `curve of ${quantity} in place of the field of the picture`);
    expect(picked.history[quantity].x.length === frames, `${picked.history[quantity].x.length} points in the curve`);
    const names = picked.data.filter(([name]) => name === 'Material').map((row) => row[1]);
    expect(names.length === 1 && /^(subgrade|embankment)$/.test(names[0]), JSON.stringify(picked.data));
    await view.select('solid-field', 'von_mises');
    await page.waitForFunction(() => /Von Mises/.test(trackbed.state.pickedQuantity));
    await view.select('solid-field', 'stress_zz');
    await page.locator('#picked-quantity').selectOption({ index: 0 });
    await view.idle();
    expect(/displacement z/.test((await view.state()).pickedQuantity), 'another quantity is selected');
    await page.keyboard.press('Escape');
    await view.idle();
    expect((await view.state()).picked === null, 'Escape closes it');
    await view.check('grains-show', true);
    return `${picked.title}, ${quantity}`;
  });

  await check('S0-63', 'section: rear and front sliders remove stones', async () => {
    await view.select('section-axis', 'view');
    const all = await view.run(() => trackbed.app.grains.count);
    const whole = await view.hash();
    await view.slide('section-front', 0.5);
    const front = (await view.state()).section.removed;
    const cut = await view.hash();
    await view.slide('section-front', 0);
    await view.slide('section-rear', 0.5);
    const rear = (await view.state()).section.removed;
    expect(front > 0 && rear > 0 && front < all && rear < all, `${front} and ${rear} of ${all} removed`);
    expect(cut !== whole && await view.hash() !== cut, 'the picture changes');
    // The remaining ones are nearer than the removed ones.
    const order = await view.run(() => {
      const { app } = trackbed;
      const d = app.stage.sight().toArray();
      let [near, far] = [-Infinity, Infinity];
      for (let b = 0; b < app.grains.count; b++) {
        const at = d.reduce((sum, v, k) => sum + v * app.grains.position[3 * b + k], 0);
        if (app.grains.spheres.places[4 * app.grains.bodies.start[b] + 3] > 0) near = Math.max(near, at); else far = Math.min(far, at);
      }
      return near <= far;
    });
    expect(order, 'stones in front were removed');
    await view.slide('section-rear', 0);
    expect((await view.state()).section.removed === 0 && await view.hash() === whole, 'all are back');
    return `${front} in front, ${rear} at the rear of ${all}`;
  });

  await check('S0-64', 'force chains: load, draw, colour by magnitude, thickness', async () => {
    await view.check('grains-show', false);
    const without = await view.count('coloured');
    await view.check('chains-show', true);
    const said = await view.run(() => trackbed.app.said);
    expect(said.includes('Loading file, please wait'), said.join());
    await view.select('solid-field', 'constant');
    await view.run(() => trackbed.app.set('frame', trackbed.histories.peakFrame()));
    await view.select('chains-map', 'blue-red');
    const state = await view.state();
    expect(state.chains.count > 100, `${state.chains.count} chains`);
    const legend = state.legends.find((l) => l.part === 'chains');
    expect(legend.unit === 'N' && legend.range[1] > 100, JSON.stringify(legend));
    await view.slide('chains-thickness', 0.05);
    const thin = await view.count('coloured');
    await view.slide('chains-thickness', 1);
    const thick = await view.count('coloured');
    expect(thick > 1.5 * thin, `${thin} and ${thick} coloured pixels`);
    // Few contacts approach the largest force: the range ends at a tenth of it.
    await view.set({ 'chains.auto': false, 'chains.min': 0, 'chains.max': 0.1 * legend.range[1] });
    const [red, blue] = [await view.count('red'), await view.count('blue')];
    expect(red > 20 && blue > 20, `${red} red and ${blue} blue pixels`);
    await view.set({ 'chains.auto': true });
    await view.slide('chains-least', 0.3);
    const strong = await view.count('blue');
    expect(strong < blue / 2, `weak ones are left out: ${blue}, then ${strong} blue pixels`);
    await view.slide('chains-least', 0);
    return `${state.chains.count} chains, ${without}, ${thin}, ${thick} coloured pixels`;
  });

  await check('S0-65', 'chains and stones together, transparency of the stones', async () => {
    await view.check('grains-show', true);
    await view.slide('grains-opacity', 1);
    const hidden = await view.count('coloured');
    await view.slide('grains-opacity', 0.2);
    const seen = await view.count('coloured');
    expect(seen > 2 * hidden, `${hidden} coloured pixels behind opaque stones, ${seen} behind glass`);
    await view.slide('grains-opacity', 1);
    await view.check('chains-show', false);
    return `${hidden} coloured pixels, ${seen} behind glass`;
  });

  await check('S2-24', 'boundary: colour and transparency of the structure', async () => {
    await view.check('solid-show', false);
    await view.check('grains-show', false);
    await (await view.control('walls-track-colour')).fill('#00ff00');
    await view.idle();
    const sleeper = await view.count('green');
    await view.slide('walls-track-opacity', 0);
    const faint = await view.count('green');
    expect(sleeper > 600 && faint < sleeper / 5, `${sleeper} green pixels, ${faint} when transparent`);
    await (await view.control('walls-track-colour')).fill('#8f959c');
    await view.slide('walls-track-opacity', 1);
    await view.check('solid-show', true);
    await view.check('grains-show', true);
    await view.select('solid-field', 'constant');
    await (await view.control('solid-constant')).fill('#ff0000');
    await view.idle();
    const solid = await view.count('red');
    expect(solid > 8000, `${solid} red pixels of the solid`);
    await (await view.control('solid-constant')).fill('#9aa7b3');
    await view.select('solid-field', 'stress_zz');
    return `sleeper ${sleeper} and ${faint}, solid ${solid} pixels`;
  });

  await check('fields', 'contours of nodal and element fields on the deformed mesh, legend with units', async () => {
    await view.run(() => trackbed.app.set('frame', trackbed.histories.peakFrame()));
    const options = await (await view.control('solid-field')).locator('option').evaluateAll((all) => all.map((o) => o.value));
    for (const field of options) {
      await view.select('solid-field', field);
      const state = await view.state();
      expect(!state.error, `${field}: ${state.error}`);
      expect(field === 'constant' || state.legends.some((l) => l.part === 'solid'), `${field} has no legend`);
    }
    await view.select('solid-field', 'displacement_z');
    const flat = await view.hash();
    await view.fill('solid-factor-number', 400);
    expect(await view.hash() !== flat && (await view.state()).solid.factor === 400, 'the factor deforms the mesh');
    await view.fill('solid-factor-number', 1);
    const total = (await view.state()).legends.at(-1);
    await view.select('reference-since', '1');
    const since = (await view.state()).legends.at(-1);
    expect(Math.abs(since.range[0]) !== Math.abs(total.range[0]) && since.note === 'since frame 0', JSON.stringify([total, since]));
    await view.select('reference-since', '');
    await view.select('grains-colour', 'displacement');
    const stones = (await view.state()).legends[0];
    expect(stones.range[1] > 1e-5 && stones.unit === 'm', JSON.stringify(stones));
    await view.select('grains-colour', 'constant');
    await view.select('solid-field', 'stress_zz');
    return `${options.length} fields; displacement ${total.range.map((v) => v.toExponential(2))}, since loading ${since.range.map((v) => v.toExponential(2))}`;
  });

  await check('S2-25', 'rotate, zoom, perspective; pictures of any moment', async () => {
    await view.select('view-side', 'front');
    await view.fill('save-time', '');
    const sizes = [];
    for (const at of [0, frames - 1]) {
      await view.run((k) => trackbed.app.set('frame', k), at);
      const [file] = await Promise.all([page.waitForEvent('download'), page.locator('#save-png').click()]);
      sizes.push((await bytesOf(file)).toString('base64'));
    }
    expect(sizes[0] !== sizes[1], 'pictures of two moments differ');
    await view.select('view-side', 'oblique');
    await view.select('view-projection', 'parallel');
    await view.select('view-projection', 'perspective');
  });

  await check('S2-26', 'the whole track: forces in the ballast at peak load and stress below', async () => {
    await view.click('preset-peak');
    await page.waitForFunction(() => !trackbed.state.solid.auto);
    await view.idle();
    const state = await view.state();
    const peak = await view.run(() => trackbed.histories.peakFrame());
    const load = await view.run(() => {
      const { histories, app } = trackbed;
      return app.state.times.map((t) => histories.loads[Math.max(histories.time.findLastIndex((s) => s <= t * (1 + 1e-6)), 0)]);
    });
    expect(state.frame === peak && load[peak] === Math.max(...load), `frame ${state.frame}, loads ${load}`);
    expect(state.legends.map((l) => l.part).join() === 'chains,solid' && state.solid.field === 'stress_zz', JSON.stringify(state.legends));
    expect(await view.count('red') > 10 && await view.count('green') > 400, 'chains and contours are seen');
    return `frame ${peak} at ${(load[peak] / 1000).toFixed(1)} kN`;
  });
}

/** Picture position and index of a visible stone. */
async function visibleStone(view) {
  return view.run(() => {
    const { app, histories } = trackbed;
    for (let b = 0; b < app.grains.count; b += 3) {
      const [x, y] = histories.picker.project(Array.from(app.grains.position.slice(3 * b, 3 * b + 3))).map(Math.round);
      if (x < 200 || y < 50 || x > 500 || y > 330) continue;
      const found = histories.picker.at(x, y, [[app.grains.spheres.meshes[1], 1], [app.solid.object, 2]]);
      if (found?.kind === 1 && app.grains.bodyOf(found.index) === b) return { at: [x, y], id: app.grains.bodies.id[b] };
    }
    throw new Error('no stone is seen');
  });
}

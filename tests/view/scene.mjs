// Checks of scenes before a run: panel, toggles, picking, reload after editing, errors, narrow screens.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { View, open, serve } from './browser.mjs';
import { check, expect } from './expect.mjs';

const SCENE = `title = "cube"
[solid]
gravity = false
block = { x = { lines = [5.0, 6.0], counts = [3] }, y = { lines = [0.0, 1.0], counts = [3] }, z = { lines = [0.0, 0.5, 1.0], counts = [2, 2] }, layer = [{ material = 1, top = 0.5 }, { material = 2 }] }
[[solid.material]]
id = 1
name = "clay"
young = "20 MPa"
poisson = 0.3
density = 1900
[[solid.material]]
id = 2
name = "sand"
young = "40 MPa"
poisson = 0.3
density = 1900
[[solid.support]]
side = "z-"
directions = ["x", "y", "z"]
[[solid.load]]
kind = "pressure"
side = "z+"
pressure = "10 kPa"
[[probe]]
name = "corner"
at = [6.0, 1.0, 1.0]
`;

/** Shot of the page for people, if KEEP names a directory. */
async function keep(view, name) {
  if (process.env.KEEP) await view.page.screenshot({ path: path.join(process.env.KEEP, `${name}.png`) });
}

export async function onScenes(browser, program, dir, faults) {
  const folder = path.join(dir, 'scene');
  fs.mkdirSync(folder);
  const file = path.join(folder, 'scene.toml');
  const save = (text) => fs.writeFileSync(file, text);
  save(SCENE);
  const server = await serve(program, folder);
  const view = new View(await open(browser, server.address, faults));
  /** Waits for the page to follow a saved file. */
  const follows = async (holds) => {
    await view.page.waitForFunction(holds, null, { timeout: 20000 });
    await view.idle();
  };

  await check('scene', 'a scene is shown with its objects by kind', async () => {
    const state = await view.state();
    expect(state.parts.model && state.title === 'cube' && !state.error, JSON.stringify(state));
    const rows = await view.run(() => [...document.querySelectorAll('#outline .item')].map((row) => row.textContent));
    expect(rows.length === 7, rows.join('; '));
    expect(rows[0] === 'clay18 elements' && rows[1] === 'sand18 elements', rows.join('; '));
    expect(rows.some((row) => row.startsWith('fixed in z')) && rows.includes('corner'), rows.join('; '));
    const drawn = (await view.run(() => trackbed.app.stage.width * trackbed.app.stage.height)) - await view.count('white');
    expect(drawn > 20000, `${drawn} pixels are drawn`);
    const hidden = await view.run(() => ['player', 'button-open', 'part-grains', 'part-section'].map((id) => document.getElementById(id).checkVisibility()));
    expect(hidden.join() === 'true,false,false,true', hidden.join());
    await view.page.waitForFunction(() => document.getElementById('check-text')?.textContent.includes('solid: '));
    await keep(view, 'cube');
    return `${rows.length} objects, ${drawn} pixels drawn`;
  });
  await check('toggles', 'kinds and objects can be hidden', async () => {
    const whole = await view.hash();
    const seen = new Set([whole]);
    for (const id of ['show-solid', 'show-0', 'show-supports', 'show-loads', 'show-probes']) {
      await view.check(id, false);
      const hash = await view.hash();
      expect(!seen.has(hash), `${id} changes nothing`);
      seen.add(hash);
      await view.check(id, true);
      expect(await view.hash() === whole, `${id} does not come back`);
    }
    await view.slide('section-front', 0.5);
    expect(!seen.has(await view.hash()), 'the section changes nothing');
    await view.set({ 'section.front': 0 });
    return `${seen.size} pictures`;
  });
  await check('picked', 'objects are picked in the picture and found from the list', async () => {
    // The ball of the probe, the last object.
    await view.run(() => {
      const [x, y, z] = trackbed.app.model.items.at(-1).balls;
      return trackbed.histories.pick(...trackbed.histories.picker.project([x, y, z]).map(Math.round));
    });
    await view.idle();
    const { picked } = await view.state();
    const rows = new Map(picked.data.map(([name, value]) => [name, value]));
    expect(rows.get('place [m]').map((x) => Number(x.toFixed(6))).join() === '6,1,1', JSON.stringify(picked));
    const before = await view.camera();
    await view.run(() => trackbed.app.fly(0));
    await view.idle();
    const after = await view.camera();
    expect((await view.state()).picked.title === 'clay' && after.target.join() !== before.target.join(), JSON.stringify(after));
    return `${picked.title}, ${rows.get('kind')}`;
  });
  await check('follows', 'the page follows the saved file, shows its errors and recovers', async () => {
    const before = await view.camera();
    await view.check('show-loads', false);
    save(SCENE.replace('"sand"', '"gravel"').replace('[5.0, 6.0]', '[7.0, 8.0]'));
    await follows(() => document.querySelector('#outline')?.textContent.includes('gravel'));
    const after = await view.camera();
    expect(!(await view.page.locator('#show-loads').isChecked()), 'what is hidden stays hidden');
    expect(Math.abs(after.target[0] - before.target[0] + 2) < 1e-3, `the eye stays: ${before.target} and ${after.target}`);
    save(SCENE.replace('"40 MPa"', '-1'));
    await follows(() => !document.getElementById('errors').hidden);
    const [text] = await view.run(() => [...document.querySelectorAll('#error-list li')].map((li) => li.textContent));
    expect(/scene\.toml:14: solid\.material\.1\.young: found /.test(text), text);
    expect((await view.run(() => document.querySelectorAll('#outline .item').length)) === 0, 'no model is listed');
    await keep(view, 'errors');
    save(SCENE.replace('"20 MPa"', '20'));
    await follows(() => document.getElementById('errors').hidden && document.querySelector('.warning'));
    await view.page.locator('.warning').first().click();
    await view.idle();
    const { picked } = await view.state();
    expect(picked?.title === 'clay', JSON.stringify(picked));
    await keep(view, 'warnings');
    return text.replace(/.*scene/, 'scene');
  });
  await check('narrow', '390 pixels wide', async () => {
    save(SCENE);
    const narrow = new View(await open(browser, server.address, faults, { width: 390, height: 780 }));
    const [stage, side, wide] = await narrow.run(() => [document.getElementById('stage').getBoundingClientRect(), document.getElementById('side').getBoundingClientRect(),
      document.documentElement.scrollWidth].map((v) => (v.toJSON ? v.toJSON() : v)));
    expect(wide <= 390 && stage.width >= 389 && stage.height > 300 && side.top >= stage.bottom && side.width >= 389, JSON.stringify([stage, side, wide]));
    const whole = await narrow.hash();
    await narrow.page.locator('#show-solid').click();
    await narrow.idle();
    expect(await narrow.hash() !== whole, 'the solid is hidden');
    await narrow.page.locator('#show-solid').click();
    await narrow.idle();
    await keep(narrow, 'narrow');
    save(SCENE.replace('"40 MPa"', '-1'));
    await narrow.page.waitForFunction(() => !document.getElementById('errors').hidden, null, { timeout: 20000 });
    expect((await narrow.run(() => document.documentElement.scrollWidth)) <= 390, 'messages fit');
    await keep(narrow, 'narrow_errors');
    await narrow.page.context().close();
  });
  await view.page.context().close();
  await server.stop();

  await check('exported', 'a scene as one file', async () => {
    const page = path.join(dir, 'scene.html');
    const track = fileURLToPath(new URL('../../inputs/track/cyclic/scene.toml', import.meta.url));
    execFileSync(program, ['view', track, '--export', page, '--set', 'grains.0.count=200']);
    const still = new View(await open(browser, pathToFileURL(page).href, faults, { width: 1100, height: 700 }));
    await still.page.context().setOffline(true);
    const kinds = await still.run(() => [...document.querySelectorAll('#outline summary')].map((s) => s.textContent.trim()));
    for (const kind of ['Solid', 'Grains', 'Filled regions', 'Sleepers', 'Rails, seat loads', 'Supports', 'Walls']) {
      expect(kinds.some((k) => k.startsWith(kind)), `${kind} in ${kinds.join('; ')}`);
    }
    const [right, places] = await still.run(() => [trackbed.app.stage.width - 180, trackbed.app.model.items.filter((item) => trackbed.app.model.shows(item, trackbed.state.model))
      .flatMap((item) => Array.from({ length: item.points.length / 3 }, (_, k) => trackbed.histories.picker.project(item.points.subarray(3 * k, 3 * k + 3))[0]))]);
    expect(places.every((x) => x > 0 && x < right), `the model ends at ${Math.max(...places)}, the legend begins at ${right}`);
    // Dense meshes have fewer marks of five points than fixed nodes.
    const [marks, nodes] = await still.run(() => trackbed.app.model.items.filter((item) => item.name === 'fixed in y')
      .map((item) => [item.points.length / 15, Number.parseInt(item.count.replace(',', ''), 10)])[0]);
    expect(marks > 50 && marks < nodes / 2, `${marks} marks of ${nodes} nodes`);
    await keep(still, 'track');
    await still.page.setViewportSize({ width: 390, height: 780 });
    await still.click('fit');
    await keep(still, 'track_narrow');
    await still.page.context().close();
    return kinds.join(', ');
  });
}

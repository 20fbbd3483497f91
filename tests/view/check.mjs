// Checks the viewer in a browser: node tests/view/check.mjs PROGRAM TRACK STONE [PICTURE.png]
//
// TRACK: short run of inputs/track/cyclic, STONE: of inputs/grains/bonded_stone. Needs Chromium (CHROMIUM, default
// /usr/bin/chromium) and playwright-core below the working directory.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { View, launch, open, serve } from './browser.mjs';
import { check, expect, sum } from './expect.mjs';
import { onPlayer } from './player.mjs';
import { onScenes } from './scene.mjs';
import { onSolid } from './solid.mjs';
import { onStart } from './start.mjs';
import { onStone } from './stone.mjs';
import { onTables } from './tables.mjs';
import { onTrack } from './track.mjs';
import { onWater } from './water.mjs';

const [program, track, stone, picture] = process.argv.slice(2);
const dir = fs.mkdtempSync(path.join(os.tmpdir(), 'trackbed_view_'));
const faults = [];
const browser = await launch();
try {
  const page = path.join(dir, 'track.html');
  console.log(execFileSync(program, ['view', track, '--export', page], { encoding: 'utf8' }).trim());

  await check('S0-72', 'no installation: one file from disk, without network', async () => {
    const view = new View(await open(browser, pathToFileURL(page).href, faults));
    await view.page.context().setOffline(true);
    const state = await view.state();
    expect(state.frames > 5 && state.parts.grains && state.parts.solid && !state.error, JSON.stringify(state));
    const seen = (await view.run(() => trackbed.app.stage.width * trackbed.app.stage.height)) - await view.count('white');
    expect(seen > 12000, `${seen} pixels are drawn`);
    await onStart(view, browser, pathToFileURL(page).href, faults);
    if (picture) await shoot(view, picture);
    await onPlayer(view, process.env.KEEP);
    await onTrack(view);
    await view.page.context().close();
    return `first picture after ${view.page.firstPicture.toFixed(1)} s, ${seen} pixels drawn`;
  });

  const server = await serve(program, track);
  await check('served', 'the same from the program', async () => {
    const view = new View(await open(browser, server.address, faults));
    expect(/only requests|127\.0\.0\.1/.test(server.line), server.line);
    await onTrack(view, ['S0-69', 'S0-64', 'S2-26']);
    await onTables(view, dir, path.join(stone, 'frames'));
    await view.page.context().close();
    return `first picture after ${view.page.firstPicture.toFixed(1)} s`;
  });
  await check('Ctrl-C', 'ends the server', async () => {
    const code = await server.stop();
    expect(code === 'SIGINT' || code === 130 || code === 0, `ended with ${code}`);
    return `${code}`;
  });

  const other = await serve(program, stone);
  await check('stone', 'a stone that breaks', async () => {
    const view = new View(await open(browser, other.address, faults));
    await onStone(view);
    await view.page.context().close();
  });
  await other.stop();

  const flight = path.join(dir, 'flight');
  const plates = fileURLToPath(new URL('../../inputs/geo/chant-sura/scene.toml', import.meta.url));
  execFileSync(program, ['run', plates, '--out', flight, '--quiet', '--set', 'time.end=0.01', '--set', 'output.frames=2']);
  const third = await serve(program, flight);
  await check('faces', 'grains with faces have the colours of their fields', async () => {
    const view = new View(await open(browser, third.address, faults));
    const plain = await view.hash();
    await view.select('grains-colour', 'speed');
    const [legend] = (await view.state()).legends;
    // Initial speeds of the groups: 17.0 to 19.3 m/s.
    expect(legend?.title === 'Grains: Speed' && legend.range[0] > 16.9 && legend.range[1] < 19.4, JSON.stringify(legend));
    const speed = await view.hash();
    await view.select('grains-colour', 'part');
    const groups = await view.hash();
    const names = (await view.state()).legends[0].swatches.map((s) => s[1]);
    expect(names.join() === 'impact1,impact2,impact3,impact4', names.join());
    await view.set({ 'grains.show': false });
    const hidden = await view.hash();
    expect(new Set([plain, speed, groups, hidden]).size === 4, 'pictures are alike');
    await view.set({ 'grains.show': true });
    return `${legend.range.map((v) => v.toFixed(2)).join(' to ')} m/s, ${names.length} groups`;
  });
  await check('faces picked', 'grains with faces are picked, and removed by the section', async () => {
    const view = new View(await open(browser, third.address, faults));
    await view.set({ frame: 0 });
    // Visible grains are picked where drawn; displacements match speeds.
    const found = await view.run(async () => {
      const { app, histories } = trackbed;
      const out = [];
      for (const [id, place] of app.walls.places) {
        if (out.filter((p) => p).length === 4) break;
        await histories.pick(...histories.picker.project(place).map(Math.round));
        const { picked } = app.state;
        const value = (name) => picked.data.find((row) => row[0] === name)?.[1];
        const way = picked && Math.hypot(...['x', 'y', 'z'].map((k) => picked.history[`displacement ${k} [m]`].y.at(-1)));
        out.push(picked && { id, title: picked.title, place: picked.place, speed: value('Speed'), extent: value('Longest extent'), way });
      }
      return out;
    });
    const seen = found.filter((p) => p);
    expect(seen.length === 4 && seen.every((p) => p.title === `Grain ${p.id}`), JSON.stringify(found));
    expect(seen.every((p) => Math.abs(p.way / (0.01 * p.speed) - 1) < 0.02 && p.extent > 1 && p.extent < 3), JSON.stringify(found));
    // Initial positions of the packings.
    const rows = [1, 2, 3, 4].flatMap((k) => fs.readFileSync(path.join(path.dirname(plates), `impact${k}.csv`), 'utf8').trim().split('\n'));
    const starts = rows.map((row) => row.split(',').slice(0, 3).map(Number));
    const off = seen.map((p) => Math.min(...starts.map((at) => Math.hypot(...at.map((x, k) => x - p.place[k])))));
    expect(Math.max(...off) < 1e-3, `${off} m from where they start`);
    const whole = await view.hash();
    await view.set({ 'section.axis': 'x', 'section.front': 0.5 });
    const { removed } = (await view.state()).section;
    expect(removed > 0 && removed < 96 && await view.hash() !== whole, `${removed} of 96 removed`);
    const picked = await view.run(async (places) => {
      const { app, histories } = trackbed;
      const out = [];
      for (const place of places) {
        await histories.pick(...histories.picker.project(place.map((x, k) => x - app.meta.origin[k])).map(Math.round));
        out.push(app.state.picked?.id ?? null);
      }
      return out;
    }, seen.map((p) => p.place));
    expect(picked.some((id, k) => id !== seen[k].id), `what is removed is not picked: ${picked}`);
    await view.set({ 'section.front': 0 });
    expect(await view.hash() === whole, 'they are back');
    // Centroid of a pyramid, different from the mean of its corners.
    const middle = await view.run(() => {
      const points = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0.5, 0.5, 1];
      const triangles = [0, 1, 2, 0, 2, 3, 0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4];
      const arrays = { points, triangles, kind: Array(6).fill(4), id: Array(6).fill(7) };
      const read = { ...arrays, points: Float32Array.from(points), id: Uint32Array.from(arrays.id) };
      return trackbed.app.walls.constructor.stoneIn({ arrays: read }, 7).place;
    });
    expect(Math.hypot(middle[0] - 0.5, middle[1] - 0.5, middle[2] - 0.25) < 1e-6, `middle of a pyramid: ${middle}`);
    await view.page.context().close();
    return `${seen.length} of ${found.length} seen and picked, ${removed} of 96 removed`;
  });
  await third.stop();
  await onSolid(browser, program, dir, faults);
  await onWater(browser, program, dir, faults);
  await onScenes(browser, program, dir, faults);
  await check('faults', 'no errors of scripts, no requests to elsewhere', () => {
    expect(faults.length === 0, faults.join('; '));
  });
} finally {
  await browser.close();
  fs.rmSync(dir, { recursive: true });
}
process.exitCode = sum() ? 0 : 1;

/** Picture for the guide. */
async function shoot(view, file) {
  const size = view.page.viewportSize();
  await view.page.setViewportSize({ width: 1000, height: 640 });
  await view.run(() => trackbed.preset('peak'));
  await view.set({ 'grains.show': true, 'grains.opacity': 0.3, 'solid.bands': true });
  await view.page.screenshot({ path: file });
  expect(fs.statSync(file).size < 300e3, `${file} has ${fs.statSync(file).size} bytes`);
  await view.page.setViewportSize(size);
  await view.page.reload();
  await view.page.waitForFunction(() => window.trackbed);
  await view.run(() => trackbed.ready.then(() => trackbed.idle()));
}

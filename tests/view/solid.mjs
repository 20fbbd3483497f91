// Checks on a run without grains: curves of history.csv, presets, curve of a node.
import { execFileSync } from 'node:child_process';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { View, open, serve } from './browser.mjs';
import { check, expect } from './expect.mjs';

export async function onSolid(browser, program, dir, faults) {
  const out = path.join(dir, 'pulse');
  const scene = fileURLToPath(new URL('../../inputs/solid/pulse.toml', import.meta.url));
  execFileSync(program, ['run', scene, '--out', out, '--quiet', '--set', 'time.end=0.03', '--set', 'output.frames=3']);
  const server = await serve(program, out);
  const view = new View(await open(browser, server.address, faults));
  await check('history', 'columns of history.csv over time', async () => {
    const first = await view.state();
    expect(first.historyQuantity === 'crest_u_z [m]', first.historyQuantity);
    expect(await view.page.locator('#plot-history').isVisible() && !(await view.page.locator('#plot-load').isVisible()), 'one plot is there');
    const names = await view.page.locator('#history-quantity option').allInnerTexts();
    expect(names.includes('solid_strain [J]') && !names.includes('grains_kinetic [J]'), names.join());
    const mark = (await view.run(() => trackbed.histories.marks.history));
    expect(/^\[(µm|mm)\]$/.test(mark.labels[1].trim()), mark.labels.join());
    await view.page.locator('#history-quantity').selectOption('solid_strain [J]');
    await view.idle();
    await view.page.keyboard.press('Escape');
    await view.set({ frame: 1 });
    const other = await view.run(() => trackbed.histories.marks.history);
    expect(/J\]$/.test(other.labels[1]) && other.line < mark.line, JSON.stringify([mark, other]));
    return `${names.length} columns`;
  });
  await check('solid presets', 'presets without grains, curve of a node', async () => {
    const ids = await view.run(() => [...document.querySelectorAll('#presets button')].map((b) => b.id));
    expect(ids.join() === 'preset-settlement,preset-stress', ids.join());
    await view.click('preset-stress');
    const node = await view.run(() => {
      const { app, histories } = trackbed;
      const { width, height } = app.stage;
      return histories.pick(Math.round(0.4 * width), Math.round(0.42 * height)).then(() => app.state.picked && [app.state.picked.title, app.state.pickedQuantity,
        app.state.picked.history?.[app.state.pickedQuantity]?.y.length]);
    });
    expect(node && /^Node/.test(node[0]) && /stress/.test(node[1]) && node[2] === 4, JSON.stringify(node));
    return node.join(', ');
  });
  await view.page.context().close();
  await server.stop();
  await onLine(browser, program, dir, faults);
}

/** Profile along a line probe. */
async function onLine(browser, program, dir, faults) {
  const out = path.join(dir, 'axle');
  const scene = fileURLToPath(new URL('../../inputs/solid/moving_load.toml', import.meta.url));
  execFileSync(program, ['run', scene, '--out', out, '--quiet', '--set', 'output.frames=6']);
  const server = await serve(program, out);
  const view = new View(await open(browser, server.address, faults));
  await check('profile', 'profile along a line probe follows the frame', async () => {
    const names = await view.page.locator('#history-quantity option').allInnerTexts();
    expect(names.includes('along crest: u_z [m]') && !names.some((name) => /^crest_\d/.test(name)), names.join());
    await view.page.locator('#history-quantity').selectOption('along crest: u_z [m]');
    const lowest = [];
    for (const frame of [2, 4]) {
      await view.set({ frame });
      lowest.push(await view.run(() => {
        const { histories, state } = trackbed;
        const row = histories.time.findLastIndex((t) => t <= state.time * (1 + 1e-6));
        const { x, y } = histories.historyAt(state.historyQuantity, row, state.time);
        return x[y.indexOf(Math.min(...y))];
      }));
    }
    // The axle runs at 50 m/s; frames are 0.06 s apart.
    expect(Math.abs(lowest[1] - lowest[0] - 6) <= 1, `deepest at ${lowest}`);
    const { labels } = await view.run(() => trackbed.histories.marks.history);
    expect(labels.join() === 'distance [m],crest [mm]' || /crest \[.m\]/.test(labels[1]), labels.join());
    return `${names.length} quantities, deepest at ${lowest.join(' and ')} m`;
  });
  await view.page.context().close();
  await server.stop();
}

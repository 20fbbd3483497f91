// Checks of the first picture: frame, fit, presets, ticks, narrow screens, themes.
import { View, open } from './browser.mjs';
import { check, expect } from './expect.mjs';

/** Extent of the visible parts in the picture, and the area left by legends, title and plots [CSS pixels]. */
const extents = (view) => view.run(() => {
  const { app, histories } = trackbed;
  const { stage } = app;
  const places = [];
  const add = (point) => places.push(histories.picker.project(point));
  for (let n = 0; n < (app.solid.skin?.node_ids.length ?? 0); n++) add(app.solid.place(n, 1));
  for (let b = 0; b < app.grains.count; b++) add(Array.from(app.grains.position.slice(3 * b, 3 * b + 3)));
  const m = app.margins();
  return { x: [0, 1].map((k) => Math[k ? 'max' : 'min'](...places.map((p) => p[0]))), y: [0, 1].map((k) => Math[k ? 'max' : 'min'](...places.map((p) => p[1]))),
    left: m.left, right: stage.width - m.right, top: m.top, bottom: stage.height - m.bottom };
});

function expectInside({ x, y, left, right, top, bottom }) {
  expect(x[0] >= left && x[1] <= right && y[0] >= top && y[1] <= bottom, `model ${x}, ${y} in ${left} to ${right}, ${top} to ${bottom}`);
  const share = Math.max((x[1] - x[0]) / (right - left), (y[1] - y[0]) / (bottom - top));
  expect(share > 0.7, `the model fills ${share} of the picture`);
}

export async function onStart(view, browser, address, faults) {
  await check('start', 'the last frame, all of it in view beside legends and plots', async () => {
    const state = await view.state();
    expect(state.frame === state.frames - 1, `frame ${state.frame} of ${state.frames}`);
    expect(state.legends.length > 0 && await view.page.locator('#plot-load').isVisible(), 'legends and plots are there');
    const wide = await extents(view);
    expect(wide.right <= 900 - 212 - 150 && wide.bottom < 500, JSON.stringify(wide));
    expectInside(wide);
    await view.page.setViewportSize({ width: 1100, height: 500 });
    await view.page.waitForTimeout(200);
    await view.idle();
    expectInside(await extents(view));
    await view.page.setViewportSize({ width: 900, height: 600 });
    await view.page.waitForTimeout(200);
    await view.idle();
    return JSON.stringify(wide);
  });

  await check('ticks', 'round steps, units by magnitude', async () => {
    const found = await view.run(async () => {
      const { figures, scaled, ticks } = await import('colours');
      const texts = (low, high, plain) => {
        const { factor, unit } = scaled(plain, Math.max(Math.abs(low), Math.abs(high)));
        return [...figures(ticks(low / factor, high / factor, 6)), unit].join(' ');
      };
      return [texts(-73534, 192, 'Pa'), texts(0, 0.00231, 'm'), texts(0, 3.1e6, 'Pa'), texts(-41e3, 0, 'N'), texts(3, 3, '')];
    });
    expect(found[0] === '−60 −40 −20 0 kPa', found[0]);
    expect(found[1] === '0.0 0.5 1.0 1.5 2.0 mm', found[1]);
    expect(found[2] === '0 1 2 3 MPa', found[2]);
    expect(found[3] === '−40 −30 −20 −10 0 kN', found[3]);
    expect(found[4].trim() === '3', found[4]);
    return found.join('; ');
  });

  await check('presets', 'buttons at the top for the fields of the run', async () => {
    const ids = await view.run(() => [...document.querySelectorAll('#presets button')].map((b) => b.id.replace('preset-', '')));
    expect(ids.join() === 'peak,settlement,stress,chains,sizes', ids.join());
    const [above, first] = await view.run(() => ['presets', 'part-grains'].map((id) => document.getElementById(id).getBoundingClientRect().top));
    expect(above < first, 'presets come before the parts');
    const parts = {};
    for (const id of ids.slice(1)) {
      await view.click(`preset-${id}`);
      parts[id] = (await view.state()).legends.map((l) => `${l.part} ${l.title}`).join(', ');
    }
    expect(/Displacement/.test(parts.settlement) && /solid Displacement z/.test(parts.settlement), parts.settlement);
    expect(parts.stress === 'solid Vertical stress σzz', parts.stress);
    expect(parts.chains === 'chains Contact force', parts.chains);
    expect(parts.sizes === 'grains Grains: Sieve size', parts.sizes);
    await view.page.reload();
    await view.page.waitForFunction(() => window.trackbed);
    await view.run(() => trackbed.ready.then(() => trackbed.idle()));
    return Object.values(parts).join('; ');
  });

  await check('narrow results', '390 pixels: model, legend and plots apart, controls on request', async () => {
    const narrow = new View(await open(browser, address, faults, { width: 390, height: 844 }));
    const { page } = narrow;
    expect((await narrow.run(() => document.documentElement.scrollWidth)) <= 390, 'the page is wider than the screen');
    expect(!(await page.locator('#side').isVisible()), 'controls are hidden');
    const at = await extents(narrow);
    expect(at.top > 60, `the legend lies at the top: ${at.top}`);
    expectInside(at);
    await narrow.click('hide-side');
    await page.waitForTimeout(200);
    await narrow.idle();
    const [stage, side] = await narrow.run(() => ['stage', 'side'].map((id) => document.getElementById(id).getBoundingClientRect().toJSON()));
    expect(side.top >= stage.bottom && side.bottom <= 845 && stage.height > 300, JSON.stringify([stage, side]));
    expectInside(await extents(narrow));
    const small = await narrow.run(() => [...document.querySelectorAll('#player button, #presets button')].filter((b) => b.checkVisibility() && b.offsetHeight < 32).length);
    expect(small === 0, `${small} buttons are too small for a finger`);
    await narrow.click('preset-peak');
    expect((await narrow.state()).chains.show, 'the preset is applied');
    await page.context().close();
    return JSON.stringify(at);
  });

  await check('theme', 'controls follow the system, or the button for the session', async () => {
    const { page } = view;
    const side = () => view.run(() => Number(/\d+/.exec(getComputedStyle(document.getElementById('side')).backgroundColor)[0]));
    const light = await side();
    await page.emulateMedia({ colorScheme: 'dark' });
    await page.waitForFunction(() => document.documentElement.dataset.theme === 'dark');
    const dark = await side();
    expect(light > 200 && dark < 60, `${light}, dark ${dark}`);
    await view.click('button-theme');
    expect(await side() === light, 'the button changes the theme');
    await page.reload();
    await page.waitForFunction(() => window.trackbed);
    await view.run(() => trackbed.ready.then(() => trackbed.idle()));
    expect(await side() === light, 'the theme is kept for the session');
    await page.emulateMedia({ colorScheme: 'light' });
    await view.run(() => sessionStorage.clear());
    return `${light}, dark ${dark}`;
  });
}

// Checks on a crushed bonded stone: fragments, walls.
import { check, expect } from './expect.mjs';

export async function onStone(view) {
  const last = (await view.state()).frames - 1;
  await check('S0-66', 'colour by part: pieces after breakage', async () => {
    await view.select('grains-colour', 'piece');
    await view.page.keyboard.press('Home');
    await view.idle();
    await view.click('fit');
    const [red, green] = [await view.count('red'), await view.count('green')];
    expect(red > 800 && green === 0, `whole: ${red} red and ${green} green pixels`);
    await view.page.locator('#frame').focus();
    await view.page.keyboard.press('End');
    await view.idle();
    await view.click('fit');
    const state = await view.state();
    expect(state.frame === last, `frame ${state.frame}`);
    const [less, more] = [await view.count('red'), await view.count('green')];
    expect(less > 20 && more > 20, `broken: ${less} red and ${more} green pixels`);
    return `${state.legends[0].swatches.map((s) => s[1]).join(', ')}`;
  });

  await check('S1-21', 'largest block red, small ones green', async () => {
    const bodies = await view.run(() => {
      const { values } = trackbed.app.grains;
      const count = values.filter((v) => v === 0).length;
      return { count, pieces: new Set(values).size, sizes: trackbed.app.pieces.map((p) => p.bodies) };
    });
    expect(bodies.count === bodies.sizes[0] && bodies.pieces > 1, JSON.stringify(bodies));
    // Visible spheres have the colour of their fragment.
    const seen = await view.run(async () => {
      const { app, histories } = trackbed;
      const out = { red: 0, green: 0, wrong: 0 };
      const canvas = new OffscreenCanvas(app.stage.canvas.width, app.stage.canvas.height);
      const g = canvas.getContext('2d');
      g.drawImage(app.stage.canvas, 0, 0);
      const ratio = app.stage.renderer.getPixelRatio();
      for (let b = 0; b < app.grains.count; b++) {
        const [x, y] = histories.picker.project(Array.from(app.grains.position.slice(3 * b, 3 * b + 3)));
        const found = histories.picker.at(Math.round(x), Math.round(y), [[app.grains.spheres.meshes[1], 1]]);
        if (found?.index !== b) continue;
        const [r, gr] = g.getImageData(Math.round(x) * ratio, Math.round(y) * ratio, 1, 1).data;
        const largest = app.grains.values[b] === 0;
        if (r > gr === largest) out[largest ? 'red' : 'green'] += 1; else out.wrong += 1;
      }
      return out;
    });
    expect(seen.red > 3 && seen.green > 3 && seen.wrong === 0, JSON.stringify(seen));
    return `${bodies.count} bodies of the largest, ${bodies.pieces - 1} others; seen ${JSON.stringify(seen)}`;
  });

  await check('S0-67', 'boundary on and off, colour, transparency', async () => {
    await view.page.keyboard.press('Home');
    await view.idle();
    await view.select('view-side', 'oblique');
    await view.click('fit');
    await view.check('walls-boundary-show', false);
    const without = await view.hash();
    await view.check('walls-boundary-show', true);
    expect(await view.hash() !== without, 'the walls are not seen');
    await (await view.control('walls-boundary-colour')).fill('#0000ff');
    await view.slide('walls-boundary-opacity', 1);
    const solid = await view.count('blue');
    await view.slide('walls-boundary-opacity', 0.1);
    const faint = await view.count('blue');
    expect(solid > 8000 && faint < solid / 10, `${solid} blue pixels, ${faint} when transparent`);
    await view.check('walls-boundary-show', false);
    expect(await view.hash() === without, 'the walls are gone');
    return `${solid} blue pixels, ${faint} when transparent`;
  });

  await check('S1-19', 'background, colours of grains, light, section, transparent boundary, play speed', async () => {
    await view.page.keyboard.press('End');
    await view.idle();
    await view.click('fit');
    const seen = [];
    const differs = async (what) => {
      const now = await view.hash();
      expect(!seen.includes(now), `${what} changes nothing`);
      seen.push(now);
    };
    await differs('the picture');
    for (const colour of ['speed', 'diameter', 'constant']) {
      await view.select('grains-colour', colour);
      await differs(`colour by ${colour}`);
    }
    for (const light of ['x', 'y', 'z']) {
      await view.select('view-light', light);
      await differs(`light along ${light}`);
    }
    await view.control('view-background');
    await view.page.locator('#view-background-33414f').click();
    await view.idle();
    await differs('the background');
    await view.slide('section-front', 0.5);
    expect((await view.state()).section.removed > 0, 'nothing is cut off');
    await view.slide('section-front', 0);
    await view.check('walls-boundary-show', true);
    await view.slide('walls-boundary-opacity', 0.5);
    await differs('a transparent boundary');
    await view.check('walls-boundary-show', false);
    await view.slide('speed', 0.5);
    expect((await view.state()).speed > 20, `${(await view.state()).speed} frames a second`);
    await view.control('view-background');
    await view.page.locator('#view-background-ffffff').click();
    await view.idle();
    return `${seen.length} different pictures`;
  });

  await check('S1-20', 'force chains with thickness and colour, transparent grains', async () => {
    await view.page.keyboard.press('Home');
    await view.idle();
    await view.click('fit');
    await view.check('chains-show', true);
    await view.select('chains-map', 'blue-red');
    expect((await view.state()).chains.count > 0, 'no chains');
    await view.slide('chains-thickness', 1);
    await view.slide('grains-opacity', 1);
    const hidden = await view.count('coloured');
    await view.slide('grains-opacity', 0.1);
    const thick = await view.count('coloured');
    await view.slide('chains-thickness', 0.05);
    const thin = await view.count('coloured');
    expect(thick > 1.5 * hidden && thick > 1.5 * thin, `${hidden} behind opaque grains, ${thick} thick, ${thin} thin`);
    await view.slide('grains-opacity', 1);
    await view.check('chains-show', false);
    return `${hidden} coloured pixels, ${thick} behind glass, ${thin} of thin ones`;
  });

  await check('S1-22', 'rotate, zoom, pan, print and save', async () => {
    const before = await view.camera();
    await view.drag([400, 200], [480, 240]);
    expect((await view.camera()).place[0] !== before.place[0], 'drag turns');
    const turned = await view.camera();
    await view.drag([400, 200], [460, 210], 'right');
    expect(Math.hypot(...(await view.camera()).target.map((v, k) => v - turned.target[k])) > 1e-4, 'right button pans');
    await view.fill('save-time', '');
    const [file] = await Promise.all([view.page.waitForEvent('download'), view.page.locator('#save-png').click()]);
    expect(/\.png$/.test(file.suggestedFilename()), file.suggestedFilename());
    await view.run(() => { window.printed = 0; window.print = () => { window.printed = document.getElementById('print-image').src.length; }; });
    await view.page.locator('#button-print').click();
    await view.page.waitForFunction(() => window.printed > 1000);
    return file.suggestedFilename();
  });
}

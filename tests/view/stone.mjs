// Checks on a bonded stone that is crushed: pieces, walls.
import { check, expect } from './expect.mjs';

export async function onStone(view) {
  const last = (await view.state()).frames - 1;
  await check('S0-66', 'colour by part: pieces after breakage', async () => {
    await view.select('grains-colour', 'piece');
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
    // Of the spheres that nothing hides, each has the colour of its piece.
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
}

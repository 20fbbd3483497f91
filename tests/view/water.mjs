// Checks of the water surface: moving waves, floating spheres on it, colour, opacity.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import path from 'node:path';
import { View, open, serve } from './browser.mjs';
import { check, expect } from './expect.mjs';

// Spheres half as dense as water float with their centres in its surface.
const SCENE = `title = "buoys"
[[material]]
name = "cork"
density = 500
stiffness = "1 MN/m"
friction = 0.3
restitution = 0.3
[[grains]]
name = "buoys"
shape = "sphere"
material = "cork"
spheres = [[0, 0, 0, 0.5], [5, 5, -0.5, 0.5], [10, 0, 0, 0.5], [10, 10, 0, 0.5]]
[water]
density = 1000
drag = 0.5
wave = { height = "1 m", length = "20 m", phase = "90 deg" }
[time]
end = "8 s"
[output]
frames = 32
`;

export async function onWater(browser, program, dir, faults) {
  const [file, out] = [path.join(dir, 'buoys.toml'), path.join(dir, 'buoys')];
  fs.writeFileSync(file, SCENE);
  execFileSync(program, ['run', file, '--out', out, '--quiet']);
  const server = await serve(program, out);
  const view = new View(await open(browser, server.address, faults));

  await check('waves', 'waves carry the floating spheres', async () => {
    const [apart, range] = await view.run(async () => {
      const { app } = trackbed;
      const [apart, heights] = [[], []];
      for (let k = 16; k < app.state.frames; k++) {
        await app.set('frame', k);
        const p = app.grains.position;
        for (let b = 0; b < p.length; b += 3) {
          const surface = app.water.level + app.water.elevation(p[b], p[b + 1], app.state.time);
          apart.push(Math.abs(p[b + 2] - surface));
          heights.push(surface);
        }
      }
      return [Math.max(...apart), Math.max(...heights) - Math.min(...heights)];
    });
    expect(range > 0.9 && apart < 0.12, `surface over ${range} m, spheres up to ${apart} m off it`);
    return `surface over ${range.toFixed(2)} m, spheres at most ${apart.toFixed(2)} m off it`;
  });

  await check('water', 'the surface moves; it has colour and opacity', async () => {
    await view.check('grains-show', false);
    await (await view.control('water-colour')).fill('#0000ff');
    await view.slide('water-opacity', 1);
    const seen = await view.count('blue');
    const first = await view.hash();
    await view.run(() => trackbed.app.set('frame', 3));
    await view.idle();
    expect((await view.hash()) !== first, 'the surface does not move');
    await view.slide('water-opacity', 0.1);
    const faint = await view.count('blue');
    await view.slide('water-opacity', 1);
    await view.check('water-show', false);
    const hidden = await view.count('blue');
    expect(seen > 10000 && faint < seen / 10 && hidden === 0, `${seen} blue pixels, ${faint} as glass, ${hidden} hidden`);
    return `${seen} blue pixels, ${faint} as glass, ${hidden} hidden`;
  });

  await server.stop();
  await view.page.context().close();
}

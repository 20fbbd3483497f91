// Checks on small particle tables with known colours.
import fs from 'node:fs';
import path from 'node:path';
import { check, expect } from './expect.mjs';

const near = (a, b, tolerance) => Math.abs(a - b) <= tolerance;

export async function onTables(view, dir, frames) {
  const { page } = view;
  const file = (name, text) => {
    const at = path.join(dir, name);
    fs.writeFileSync(at, text);
    return at;
  };
  const load = async (id, files) => {
    if (!(await page.locator('#open').evaluate((d) => d.open))) await page.locator('#button-open').click();
    await page.locator(`#${id}`).setInputFiles(files);
    await page.waitForFunction(() => !/please wait/.test(document.getElementById('open-message').textContent)
      && document.getElementById('open-message').textContent !== '' || !document.getElementById('open').open);
    await view.idle();
  };
  const row = 'x,y,z,radius,vx,vy,vz\n-1,0,0,0.2,0,0,0\n0,0,0,0.3,0,0.5,0\n1,0,0,0.4,0,0,1\n';
  const three = file('three.csv', row);

  await check('S0-57', 'open dialog: file, folder, messages; help; about', async () => {
    await page.locator('#button-open').click();
    expect(await page.locator('#open').isVisible(), 'the dialog does not open');
    await load('open-files', [file('bad.csv', 'x y z radius\n0 0 0 1\n0 zero 0 1\n')]);
    const message = await page.locator('#open-message').textContent();
    expect(message === 'bad.csv:3: found "zero", expected a number', `message: ${message}`);
    await load('open-files', [file('short.csv', '0 0 0 1\n0 0 0\n')]);
    const second = await page.locator('#open-message').textContent();
    expect(/short.csv:2: found 3 numbers, expected 4/.test(second), `message: ${second}`);
    await load('open-folder', frames);
    let state = await view.state();
    expect(state.frames > 3 && state.parts.grains && state.parts.chains && state.parts.walls, `folder: ${state.frames} frames`);
    await load('open-files', [three]);
    state = await view.state();
    expect(state.frames === 1 && (await view.run(() => trackbed.app.grains.count)) === 3, 'the table has three particles');
    await page.locator('#button-help').click();
    const help = await page.locator('#help').innerText();
    expect(/\.vtp/.test(help) && /\.csv/.test(help) && /results\.pvd/.test(help), 'formats are in the help');
    await page.locator('#help .close').click();
    await page.locator('#button-about').click();
    expect(/trackbed \d+\.\d+/.test(await page.locator('#about').innerText()), 'the version is in About');
    await page.locator('#about .close').click();
    return message;
  });

  await check('S0-59', 'colour by speed: blue slow, red fast, legend from least to most', async () => {
    await view.select('view-side', 'front');
    await view.select('grains-colour', 'speed');
    await view.select('grains-map', 'blue-red');
    const [slow, middle, fast] = [await view.pixel(...await view.bodyAt(0)), await view.pixel(...await view.bodyAt(1)), await view.pixel(...await view.bodyAt(2))];
    expect(slow[2] > 150 && slow[0] < 30, `slow is ${slow}`);
    expect(middle[1] > 150 && middle[0] < 40, `the middle one is ${middle}`);
    expect(fast[0] > 150 && fast[2] < 30, `fast is ${fast}`);
    const [legend] = (await view.state()).legends;
    expect(legend.range[0] === 0 && legend.range[1] === 1 && legend.unit === 'm/s', JSON.stringify(legend));
    return `slow ${slow}, fast ${fast}`;
  });

  await check('S0-60', 'colour by diameter', async () => {
    await view.select('grains-colour', 'diameter');
    const [small, large] = [await view.pixel(...await view.bodyAt(0)), await view.pixel(...await view.bodyAt(2))];
    expect(small[2] > 150 && large[0] > 150, `${small}, ${large}`);
    const [legend] = (await view.state()).legends;
    expect(near(legend.range[0], 0.4, 1e-6) && near(legend.range[1], 0.8, 1e-6) && legend.unit === 'm', JSON.stringify(legend));
  });

  await check('S0-61', 'a constant colour of choice', async () => {
    await view.select('grains-colour', 'constant');
    const input = await view.control('grains-constant');
    await input.fill('#00c000');
    await view.idle();
    const [r, g, b] = await view.pixel(...await view.bodyAt(1));
    expect(g > 120 && r < 20 && b < 20, `${r},${g},${b}`);
  });

  await check('S0-62', 'light along x, y, z', async () => {
    // At 0.7 radii from the centre.
    const bright = async (dx, dy) => {
      const [[x, y], [end]] = [await view.bodyAt(2), await view.run(() => {
        const [px, py, pz] = trackbed.app.grains.position.slice(6, 9);
        return trackbed.histories.picker.project([px + 0.4, py, pz]);
      })];
      return (await view.pixel(x + 0.7 * dx * Math.abs(end - x), y + 0.7 * dy * Math.abs(end - x)))[1];
    };
    await view.select('view-light', 'x');
    const [right, left] = [await bright(1, 0), await bright(-1, 0)];
    await view.select('view-light', 'z');
    const [above, below] = [await bright(0, -1), await bright(0, 1)];
    await view.select('view-light', 'y');
    const front = await bright(0, 0);
    await view.select('view-side', 'back');
    const back = await bright(0, 0);
    await view.select('view-side', 'front');
    await view.select('view-light', 'camera');
    expect(right > left + 40 && above > below + 40 && back > front + 40, `${right} ${left}, ${above} ${below}, ${back} ${front}`);
    return `right ${right} left ${left}, above ${above} below ${below}`;
  });

  await check('S2-23', 'colours: background, speed, diameter, constant, part, own quantity in the last column, legend', async () => {
    await load('open-files', [file('own.txt', '0 0 0 1 -5\n3 0 0 1 15\n')]);
    const names = await (await view.control('grains-colour')).locator('option').allInnerTexts();
    expect(names.some((n) => n === 'user quantity'), names.join());
    await view.select('view-side', 'front');
    await view.select('grains-colour', 'user quantity');
    await view.select('grains-map', 'cividis');
    const [legend] = (await view.state()).legends;
    expect(legend.range[0] === -5 && legend.range[1] === 15, JSON.stringify(legend));
    const [low, high] = [await view.pixel(...await view.bodyAt(0)), await view.pixel(...await view.bodyAt(1))];
    expect(high[0] > low[0] + 80, `${low}, ${high}`);
    await load('open-files', [file('parts.csv', 'x y z radius part\n0 0 0 1 0\n3 0 0 1 1\n')]);
    await view.select('view-side', 'front');
    await view.select('grains-colour', 'part');
    const [a, b] = [await view.pixel(...await view.bodyAt(0)), await view.pixel(...await view.bodyAt(1))];
    expect(a[0] > a[2] + 60 && b[2] > b[0] + 60, `parts are ${a}, ${b}`);
  });

  await check('S1-18', '2-D and 3-D data', async () => {
    await load('open-files', [file('plane.txt', '2D\n0 0 1\n3 1 0.5\n1.5 3 0.7\n')]);
    let state = await view.state();
    expect(state.view.flat === 'z' && state.view.projection === 'parallel', JSON.stringify(state.view));
    const before = await view.camera();
    await view.drag([300, 250], [400, 300]);
    const after = await view.camera();
    const same = (a, b) => a.every((v, k) => near(v, b[k], 1e-6));
    const turned = (c) => c.place.map((v, k) => v - c.target[k]).map((v) => v / c.distance);
    expect(same(turned(before), turned(after)), 'a plane does not turn');
    const [x, y] = await view.bodyAt(0);
    expect((await view.pixel(x, y)).some((v) => v < 240), 'a disc is drawn');
    await load('open-files', [three]);
    state = await view.state();
    expect(state.view.flat === 'y' || state.view.flat === null, JSON.stringify(state.view));
    await load('open-files', [file('space.csv', 'x y z radius\n0 0 0 1\n3 1 2 1\n1 3 4 1\n')]);
    state = await view.state();
    expect(state.view.flat === null, 'three dimensions');
    const at = await view.camera();
    await view.drag([300, 250], [400, 300]);
    expect(!same(turned(at), turned(await view.camera())), 'space turns');
  });
}

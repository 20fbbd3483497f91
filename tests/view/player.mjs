// Checks of playback, saving, printing, keys and layout.
import fs from 'node:fs';
import { check, expect } from './expect.mjs';

const bytesOf = async (download) => fs.readFileSync(await download.path());

export async function onPlayer(view, keep) {
  const { page } = view;
  const { frames, times } = await view.state();
  const frame = async () => (await view.state()).frame;
  const go = (k) => view.run((n) => trackbed.app.set('frame', n), k);

  await check('S0-68', 'play speed slider', async () => {
    const played = async (speed) => {
      await view.slide('speed', (speed - 1) / 59);
      await go(0);
      const begun = Date.now();
      await page.locator('#play').click();
      await page.waitForFunction(() => trackbed.state.frame >= 4);
      const took = Date.now() - begun;
      await page.locator('#play-pause').click();
      await view.idle();
      return took;
    };
    // Preloads the frames, so that only playback is timed.
    for (let k = 0; k < 8; k++) await go(k);
    const slow = await played(3);
    let fast = Infinity;
    for (let k = 0; k < 3 && fast >= 0.8 * slow; k++) fast = Math.min(fast, await played(30));
    expect(slow > 1000 && fast < 0.8 * slow, `4 frames in ${slow} ms at 3/s, in ${fast} ms at 30/s`);
    return `4 frames in ${slow} ms at 3/s, in ${fast} ms at 30/s`;
  });

  await check('S2-22', 'play, reset, fast back, pause, fast forward, pictures, video, turning', async () => {
    await view.slide('speed', 9 / 59);
    await go(0);
    await page.locator('#play').click();
    await page.waitForFunction(() => trackbed.state.frame >= 2);
    await page.locator('#play-pause').click();
    const paused = await frame();
    await page.waitForTimeout(400);
    expect(await frame() - paused <= 1 && (await view.state()).playing === 0, 'pause holds the frame');
    // Read immediately: playback may end soon.
    const rate = await view.run(() => { document.getElementById('play-fast').click(); return trackbed.state.playing; });
    expect(rate === 4, 'fast forward');
    await page.waitForFunction(() => trackbed.state.frame === trackbed.state.frames - 1 && !trackbed.state.playing);
    await page.locator('#play-back').click();
    await page.waitForFunction(() => trackbed.state.frame === 0 && !trackbed.state.playing);
    await go(5);
    await view.click('play-reset');
    expect(await frame() === 0, 'reset');
    const before = (await view.camera()).place;
    await page.locator('#rotate').click();
    await page.waitForTimeout(500);
    await page.locator('#rotate').click();
    await view.idle();
    const after = (await view.camera()).place;
    expect(Math.hypot(after[0] - before[0], after[1] - before[1]) > 1e-3, 'it turns by itself');
  });

  await check('S0-70', 'pictures as BMP, PNG, JPG at a time of choice; print', async () => {
    const middle = Math.floor(frames / 2);
    const magic = { png: '89504e47', jpg: 'ffd8ff', bmp: '424d' };
    const said = [];
    for (const [format, start] of Object.entries(magic)) {
      await go(0);
      await view.fill('save-time', times[middle].toFixed(4));
      const [file] = await Promise.all([page.waitForEvent('download'), page.locator(`#save-${format}`).click()]);
      const bytes = await bytesOf(file);
      expect(bytes.toString('hex').startsWith(start), `${format} begins with ${bytes.subarray(0, 4).toString('hex')}`);
      expect(file.suggestedFilename() === `trackbed_${String(middle).padStart(5, '0')}.${format}`, file.suggestedFilename());
      said.push(`${format} ${bytes.length} B`);
      if (format === 'bmp') {
        const [width, height] = [bytes.readInt32LE(18), bytes.readInt32LE(22)];
        expect(bytes.length === 54 + Math.ceil(3 * width / 4) * 4 * height && bytes.readUInt32LE(2) === bytes.length, 'size of the bitmap');
        const corner = bytes.subarray(54 + Math.ceil(3 * width / 4) * 4 * (height - 4) + 3 * 3).subarray(0, 3);
        expect(corner.every((v) => v === 255), `background of the bitmap: ${corner.toString('hex')}`);
      }
    }
    await view.fill('save-time', '');
    await view.run(() => { window.printed = 0; window.print = () => { window.printed += 1; }; });
    await page.locator('#button-print').click();
    await page.waitForFunction(() => window.printed === 1);
    await page.emulateMedia({ media: 'print' });
    const shown = await page.locator('#print-image').boundingBox();
    const menu = await page.locator('#side').isVisible();
    await page.emulateMedia({ media: 'screen' });
    expect(shown?.width > 200 && !menu, 'the picture alone is printed');
    return said.join(', ');
  });

  await check('S0-71', 'video as AVI', async () => {
    const [file] = await Promise.all([page.waitForEvent('download', { timeout: 60000 }), view.control('save-avi').then((b) => b.click())]);
    const bytes = await bytesOf(file);
    if (keep) fs.writeFileSync(`${keep}/trackbed.avi`, bytes);
    const text = (at, n) => bytes.subarray(at, at + n).toString('latin1');
    expect(text(0, 4) === 'RIFF' && text(8, 4) === 'AVI ' && bytes.readUInt32LE(4) === bytes.length - 8, 'RIFF of the right length');
    expect(bytes.readUInt32LE(48) === frames, `${bytes.readUInt32LE(48)} frames`);
    // Every index entry points to a JPEG.
    const movi = bytes.indexOf('movi');
    const index = bytes.lastIndexOf('idx1');
    let count = 0;
    for (let at = index + 8; at < bytes.length; at += 16) {
      const place = movi + bytes.readUInt32LE(at + 8);
      expect(text(place, 4) === '00dc' && bytes.readUInt16BE(place + 8) === 0xffd8, `frame ${count} at ${place}`);
      count += 1;
    }
    expect(count === frames, `${count} of ${frames} in the index`);
    await view.idle();
    return `${frames} frames, ${bytes.length} B`;
  });

  await check('keys', 'space, arrows, Home, End', async () => {
    await page.locator('#canvas').focus();
    await page.keyboard.press('Home');
    await page.keyboard.press('ArrowRight');
    await view.idle();
    await page.keyboard.press('ArrowRight');
    await view.idle();
    expect(await frame() === 2, `frame ${await frame()}`);
    await page.keyboard.press('ArrowLeft');
    await view.idle();
    expect(await frame() === 1, 'back');
    await page.keyboard.press('End');
    await view.idle();
    expect(await frame() === frames - 1, 'End');
    await page.keyboard.press('Home');
    await view.idle();
    await page.keyboard.press(' ');
    expect((await view.state()).playing === 1, 'space plays');
    await page.keyboard.press(' ');
    expect((await view.state()).playing === 0, 'space pauses');
  });

  await check('layout', 'the picture has 80 to 90 % of the page; plots with a cursor in time', async () => {
    const small = page.viewportSize();
    await page.setViewportSize({ width: 1400, height: 900 });
    const { width, height } = await page.locator('#stage').boundingBox();
    const size = page.viewportSize();
    const share = (width * height) / (size.width * size.height);
    expect(share >= 0.8 && share <= 0.92, `${(100 * share).toFixed(1)} %`);
    await page.setViewportSize(small);
    const marks = [];
    for (const k of [0, Math.floor(frames / 2)]) {
      await go(k);
      await view.idle();
      marks.push(JSON.stringify(await view.run(() => [trackbed.histories.marks.load?.mark])));
    }
    expect(await page.locator('#plot-settlement').isVisible() && await page.locator('#plot-load').isVisible(), 'both plots are there');
    expect(marks[0] !== marks[1], 'the mark moves with the frame');
    return `${(100 * share).toFixed(1)} %`;
  });
}

// Time to first picture and memory of large results: node tests/view/measure.mjs PROGRAM FOLDER…  (see generate.mjs)
import fs from 'node:fs';
import { View, launch, open, serve } from './browser.mjs';

const [program, ...folders] = process.argv.slice(2);
for (const folder of folders) {
  const server = await serve(program, folder);
  const browser = await launch();
  const faults = [];
  const view = new View(await open(browser, server.address, faults, { width: 1280, height: 800 }));
  const state = await view.state();
  const timed = async (act) => {
    const begun = Date.now();
    await act();
    await view.idle();
    return ((Date.now() - begun) / 1000).toFixed(2);
  };
  const turn = await timed(() => view.drag([400, 300], [520, 340]));
  const next = state.frames > 1 ? await timed(() => view.run(() => trackbed.app.set('frame', 1))) : '-';
  const speed = await timed(() => view.run(() => trackbed.app.set('grains.colour', 'speed')));
  // Script time leaves out what the graphics processor does; the rest is the picture itself.
  const [script, whole] = await view.run(() => {
    const { app } = trackbed;
    const gl = app.stage.renderer.getContext();
    const pixel = new Uint8Array(4);
    let [script, whole] = [0, 0];
    for (let k = 0; k < 10; k++) {
      app.stage.camera.position.applyAxisAngle(app.stage.camera.up, 0.02);
      const begun = performance.now();
      app.stage.draw();
      script += performance.now() - begun;
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      whole += performance.now() - begun;
    }
    return [script / 10, whole / 10];
  });
  const chains = state.parts.chains ? await timed(() => view.run(() => trackbed.app.set('chains.show', true))) : '-';
  const heap = await view.run(() => performance.memory.usedJSHeapSize);
  const peak = /VmHWM:\s+(\d+)/.exec(fs.readFileSync(`/proc/${server.pid}/status`, 'utf8'))[1];
  const spheres = await view.run(() => trackbed.app.grains.bodies.radius.length);
  console.log(`${folder}: ${spheres} spheres, ${state.frames} frames: first picture ${view.page.firstPicture.toFixed(1)} s, a turn ${turn} s, `
    + `next frame ${next} s, speed ${speed} s, chains ${chains} s; a picture ${script.toFixed(1)} ms of script, ${whole.toFixed(0)} ms in all; program ${(peak / 1024).toFixed(0)} MB, page ${(heap / 2 ** 20).toFixed(0)} MB`);
  if (process.env.PICTURES) await view.page.screenshot({ path: `${process.env.PICTURES}/${spheres}.png` });
  if (faults.length) console.log(faults.join('\n'));
  await browser.close();
  await server.stop();
}

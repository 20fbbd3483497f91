// Start of the page.
import { App } from 'app';
import { dialogs } from 'dialogs';
import { Histories } from 'history';
import { Outline } from 'outline';
import { Panel } from 'panel';
import { Player } from 'player';
import { apply, presetButtons, presetOf } from 'presets';
import { Avi, download, picture, print } from 'save';
import { EmbeddedSource, embeddedTexts } from 'source';
import { theme } from 'theme';

const $ = (id) => document.getElementById(id);
const { served, watch } = JSON.parse($('settings').textContent);
if (!document.createElement('canvas').getContext('webgl2')) {
  $('message').textContent = 'WebGL 2 is not available. Use a browser from 2021 or later with hardware acceleration enabled.';
  $('message').className = 'shown error';
  throw new Error('no WebGL 2');
}
const app = new App(served);
const panel = new Panel($('panel'), app);
const player = new Player(app);
const histories = new Histories(app);
const outline = new Outline(app);
dialogs(app);
theme($('button-theme'), () => app.changed());

app.listeners.push((state) => {
  panel.update(state);
  outline.update();
  $('title').textContent = state.title;
  $('subtitle').textContent = moment(state);
  const mark = state.picked?.kind === 'grain' ? app.grains.bodies.id.indexOf(state.picked.id) : -1;
  const { start } = app.grains.bodies ?? {};
  app.grains.spheres.mark(...(mark >= 0 ? [start[mark], start[mark + 1]] : [-1, -1]));
});

/** Time of the frame; a scene has none. */
function moment({ status, time }) {
  if (status === 'scene') return 'before the run';
  const unfinished = status && status !== 'done' && status !== 'opened from disk';
  return `t = ${time?.toPrecision(4) ?? '–'} s${unfinished ? ` · run: ${status}` : ''}`;
}

let first = true;
app.opened = async (meta) => {
  const { source } = app;
  // Narrow screens have no room for controls; the list of a scene is its legend.
  if (first && innerWidth <= 640) document.body.classList.toggle('bare', !meta.model && !meta.errors);
  first = false;
  outline.take(meta);
  await histories.load();
  $('presets').replaceChildren(...presetButtons(app, histories, () => player.play(0)));
  await app.changed();
  // The report takes longer than the picture.
  if (meta.model) app.checked = source.block('check').then((block) => { if (app.source === source) outline.check(block); });
};

/** Reads the scene again once its files have changed. */
async function follow() {
  try {
    const response = await fetch('/version');
    if (response.ok && await response.json() !== app.meta?.version) await app.reload();
  } catch {
    // The server has ended.
  }
  setTimeout(follow, 1000);
}

/** The picture with legends, title and time as one canvas. */
async function composed() {
  await app.idle();
  const canvas = document.createElement('canvas');
  const from = app.stage.canvas;
  [canvas.width, canvas.height] = [from.width, from.height];
  const g = canvas.getContext('2d');
  g.drawImage(from, 0, 0);
  g.drawImage($('legend'), 0, 0);
  const ratio = app.stage.renderer.getPixelRatio();
  g.scale(ratio, ratio);
  g.font = '600 13px system-ui, sans-serif';
  g.fillStyle = app.dark() ? '#f2f4f7' : '#1c2733';
  g.fillText(`${app.state.title}   ${moment(app.state)}`, 12, 22);
  return canvas;
}

/** Saves a picture: of the frame nearest the time that was typed, else of this one. */
async function savePicture(format) {
  const typed = $('save-time').value;
  if (typed !== '') {
    const { times } = app.state;
    const nearest = times.reduce((best, t, k) => (Math.abs(t - typed) < Math.abs(times[best] - typed) ? k : best), 0);
    await app.set('frame', nearest);
  }
  const canvas = await composed();
  const name = `trackbed_${String(app.state.frame).padStart(5, '0')}.${format}`;
  app.state.saved = download(name, await picture(canvas, format));
}

async function saveVideo() {
  player.play(0);
  const was = app.state.frame;
  let avi = null;
  for (let k = 0; k < app.state.frames; k++) {
    await app.set('frame', k);
    const canvas = await composed();
    avi ??= new Avi(canvas.width, canvas.height, app.state.speed);
    await avi.add(canvas);
    app.say(`Video: frame ${k + 1} of ${app.state.frames}`);
  }
  await app.set('frame', was);
  app.state.saved = download('trackbed.avi', avi.blob());
}

for (const format of ['png', 'jpg', 'bmp']) $(`save-${format}`).onclick = () => savePicture(format);
$('save-avi').onclick = saveVideo;
$('button-print').onclick = async () => print(await composed(), `${app.state.title}, ${moment(app.state)}`);

window.trackbed = { app, state: app.state, player, histories, panel, outline, composed, preset: (id) => apply(presetOf(id), app, histories), idle: () => app.idle() };
window.trackbed.ready = (async () => {
  try {
    if (!served) {
      await app.open(new EmbeddedSource(embeddedTexts(document)), '');
    } else {
      const folders = await (await fetch('/folders')).json();
      await app.openRun(folders.includes('') || !folders.length ? '' : folders[0]);
      if (watch) setTimeout(follow, 1000);
    }
  } catch (error) {
    app.state.error = error.message;
    app.say('');
  }
})();

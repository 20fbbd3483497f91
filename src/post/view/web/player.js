// Frames in time: play, pause, fast forward and back, the slider, keys.

const $ = (id) => document.getElementById(id);
/** How much faster fast is. */
const FAST = 4;

export class Player {
  constructor(app) {
    this.app = app;
    const set = (rate) => () => this.play(rate);
    $('play').onclick = () => this.toggle();
    $('play-pause').onclick = set(0);
    $('play-fast').onclick = set(FAST);
    $('play-back').onclick = set(-FAST);
    $('play-reset').onclick = () => { this.play(0); app.set('frame', 0); };
    $('frame').oninput = () => app.set('frame', $('frame').valueAsNumber);
    $('speed').oninput = () => app.set('speed', $('speed').valueAsNumber);
    $('rotate').onclick = () => app.set('view.autoRotate', !app.state.view.autoRotate);
    $('fit').onclick = () => this.fit();
    $('hide-side').onclick = () => this.hideSide();
    document.addEventListener('keydown', (event) => this.key(event));
    app.listeners.push((state) => this.update(state));
  }

  toggle() { this.play(this.app.state.playing ? 0 : 1); }

  fit() {
    this.app.look();
  }

  hideSide() {
    document.body.classList.toggle('bare');
    this.app.stage.resize();
  }

  key(event) {
    const { app } = this;
    if (event.ctrlKey || event.altKey || event.metaKey || document.querySelector('dialog[open]')) return;
    if (['SELECT', 'TEXTAREA'].includes(event.target.tagName) || (event.target.tagName === 'INPUT' && event.target.type !== 'range' && event.target.type !== 'checkbox')) return;
    const act = {
      ' ': () => this.toggle(),
      ArrowRight: () => this.step(1), ArrowLeft: () => this.step(-1),
      Home: () => app.set('frame', 0), End: () => app.set('frame', app.state.frames - 1),
      f: () => this.fit(), h: () => this.hideSide(), Escape: () => app.set('picked', null),
    }[event.key];
    if (!act) return;
    if (event.target.tagName === 'INPUT' && event.target.id !== 'frame' && event.key.startsWith('Arrow')) return;
    event.preventDefault();
    act();
  }

  step(by) {
    this.play(0);
    return this.app.set('frame', this.app.state.frame + by);
  }

  /** Plays at a rate of so many times the speed; 0 pauses. */
  play(rate) {
    const { app } = this;
    app.state.playing = rate;
    clearTimeout(this.timer);
    if (rate) {
      const end = rate > 0 ? app.state.frames - 1 : 0;
      if (app.state.frame === end) app.state.frame = rate > 0 ? 0 : app.state.frames - 1;
      this.next(performance.now());
    }
    app.changed();
  }

  next(last) {
    const { app } = this;
    const { playing, speed, frame, frames } = app.state;
    if (!playing) return;
    const due = last + 1000 / (speed * Math.abs(playing));
    this.timer = setTimeout(async () => {
      const now = performance.now();
      // Frames that could not be shown in time are left out.
      const steps = Math.max(1, Math.floor((now - last) * speed * Math.abs(playing) / 1000));
      const to = frame + Math.sign(playing) * steps;
      const at = Math.min(Math.max(to, 0), frames - 1);
      if (at !== to || at === (playing > 0 ? frames - 1 : 0)) app.state.playing = 0;
      await app.set('frame', at);
      this.next(now);
    }, Math.max(0, due - performance.now()));
  }

  update(state) {
    $('frame').max = Math.max(state.frames - 1, 0);
    $('frame').value = state.frame;
    $('time').textContent = `t = ${state.time?.toPrecision(4) ?? '–'} s, frame ${state.frame} of ${Math.max(state.frames - 1, 0)}`;
    $('speed').value = state.speed;
    $('speed-shown').textContent = `${state.speed}/s`;
    $('play').textContent = state.playing ? '❙❙' : '▶';
    $('play').classList.toggle('on', state.playing === 1);
    $('play-fast').classList.toggle('on', state.playing > 1);
    $('play-back').classList.toggle('on', state.playing < 0);
    $('rotate').classList.toggle('on', state.view.autoRotate);
  }
}

// Headless browser, server and pixel access for the viewer checks.
import { spawn } from 'node:child_process';
import { createRequire } from 'node:module';

// Installed below the working directory.
const { chromium } = createRequire(`${process.cwd()}/`)('playwright-core');

/** Software rendering, no background traffic. */
const FLAGS = [
  '--no-sandbox', '--disable-gpu', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', '--disable-quic', '--no-first-run',
  '--disable-background-networking', '--disable-component-update', '--disable-sync',
];

export function launch() {
  return chromium.launch({ executablePath: process.env.CHROMIUM ?? '/usr/bin/chromium', headless: true, args: FLAGS });
}

/** Loaded viewer page; `faults` collects script errors and external requests. */
export async function open(browser, address, faults, size = { width: 900, height: 600 }) {
  const context = await browser.newContext({ viewport: size, acceptDownloads: true });
  const page = await context.newPage();
  page.on('pageerror', (error) => faults.push(`error in the page: ${error.stack ?? error}`));
  page.on('console', (message) => {
    if (message.type() === 'error') faults.push(`console: ${message.text()}`);
  });
  page.on('request', (request) => {
    if (!/^(file|data|blob):|^http:\/\/127\.0\.0\.1:/.test(request.url())) faults.push(`request to ${request.url()}`);
  });
  const begun = Date.now();
  await page.goto(address);
  await page.waitForFunction(() => window.trackbed, null, { timeout: 60000 });
  await page.evaluate('trackbed.ready.then(() => trackbed.idle())');
  page.firstPicture = (Date.now() - begun) / 1000;
  return page;
}

/** Serves a directory at `address`; `stop` sends Ctrl-C and returns the exit code. */
export async function serve(program, dir) {
  const server = spawn(program, ['view', dir, '--no-open'], { stdio: ['ignore', 'pipe', 'inherit'] });
  const ended = new Promise((done) => server.on('exit', (code, signal) => done(signal ?? code)));
  const line = await new Promise((done, fail) => {
    server.stdout.once('data', (data) => done(String(data)));
    ended.then((code) => fail(new Error(`the server ended with ${code}`)));
  });
  const address = /http:\S+/.exec(line)[0];
  return { address, line, pid: server.pid, stop: () => { server.kill('SIGINT'); return ended; } };
}

/** Page helpers: state, pixels, grain positions. */
export class View {
  constructor(page) {
    this.page = page;
  }

  run(code, value) { return this.page.evaluate(code, value); }

  async idle() {
    await this.run(() => trackbed.idle());
  }

  state() { return this.run(() => JSON.parse(JSON.stringify(trackbed.state))); }

  async set(values) {
    await this.run((v) => trackbed.app.set(v), values);
    await this.idle();
  }

  /** Opens the panel section of a control. */
  async control(id) {
    await this.run((name) => { const part = document.getElementById(name).closest('details');
      if (part) part.open = true; }, id);
    return this.page.locator(`#${id}`);
  }

  async check(id, value) {
    await (await this.control(id)).setChecked(value);
    await this.idle();
  }

  async select(id, value) {
    await (await this.control(id)).selectOption(value);
    await this.idle();
  }

  async fill(id, value) {
    const input = await this.control(id);
    await input.fill(String(value));
    await input.dispatchEvent('change');
    await this.idle();
  }

  /** Drags a slider to a fraction. */
  async slide(id, share) {
    const input = await this.control(id);
    await input.scrollIntoViewIfNeeded();
    const { x, y, width, height } = await input.boundingBox();
    const now = await input.evaluate((i) => (i.value - i.min) / (i.max - i.min));
    const at = (s) => x + 8 + s * (width - 16);
    await this.page.mouse.move(at(now), y + height / 2);
    await this.page.mouse.down();
    await this.page.mouse.move(at((now + share) / 2), y + height / 2);
    await this.page.mouse.move(at(share), y + height / 2);
    await this.page.mouse.up();
    await this.idle();
  }

  async click(id) {
    await this.page.locator(`#${id}`).click();
    await this.idle();
  }

  /** Pixels without legends that satisfy `test`, an expression in r, g, b. */
  count(test) {
    return this.run((text) => {
      const from = trackbed.app.stage.canvas;
      const canvas = new OffscreenCanvas(from.width, from.height);
      const g = canvas.getContext('2d');
      g.drawImage(from, 0, 0);
      const { data } = g.getImageData(0, 0, from.width, from.height);
      const holds = { red: (r, g, b) => r > 1.6 * g && r > 1.6 * b && r > 60, green: (r, g, b) => g > 1.25 * r && g > 1.25 * b && g > 40,
        blue: (r, g, b) => b > 1.6 * r && b > 1.6 * g && b > 60, white: (r, g, b) => r > 250 && g > 250 && b > 250,
        coloured: (r, g, b) => Math.max(r, g, b) - Math.min(r, g, b) > 110 }[text];
      let count = 0;
      for (let k = 0; k < data.length; k += 4) count += holds(data[k], data[k + 1], data[k + 2]);
      return count;
    }, test);
  }

  /** Colour at a canvas position [CSS pixels]. */
  pixel(x, y) {
    return this.run(([px, py]) => {
      const from = trackbed.app.stage.canvas;
      const ratio = trackbed.app.stage.renderer.getPixelRatio();
      const canvas = new OffscreenCanvas(1, 1);
      const g = canvas.getContext('2d');
      g.drawImage(from, Math.round(px * ratio), Math.round(py * ratio), 1, 1, 0, 0, 1, 1);
      return [...g.getImageData(0, 0, 1, 1).data].slice(0, 3);
    }, [x, y]);
  }

  /** Hash of the picture. */
  hash() {
    return this.run(() => {
      const from = trackbed.app.stage.canvas;
      const canvas = new OffscreenCanvas(from.width, from.height);
      const g = canvas.getContext('2d');
      g.drawImage(from, 0, 0);
      const { data } = g.getImageData(0, 0, from.width, from.height);
      let h = 17;
      for (let k = 0; k < data.length; k++) h = (h * 31 + data[k]) | 0;
      return h;
    });
  }

  /** Canvas position of a body. */
  bodyAt(body) {
    return this.run((b) => trackbed.histories.picker.project(Array.from(trackbed.app.grains.position.slice(3 * b, 3 * b + 3))), body);
  }

  /** Canvas origin in the page. */
  async corner() {
    const { x, y } = await this.page.locator('#canvas').boundingBox();
    return [x, y];
  }

  async clickAt([x, y]) {
    const [left, top] = await this.corner();
    await this.page.mouse.click(left + x, top + y);
  }

  async drag(from, to, button = 'left') {
    const [left, top] = await this.corner();
    await this.page.mouse.move(left + from[0], top + from[1]);
    await this.page.mouse.down({ button });
    await this.page.mouse.move(left + (from[0] + to[0]) / 2, top + (from[1] + to[1]) / 2);
    await this.page.mouse.move(left + to[0], top + to[1]);
    await this.page.mouse.up({ button });
    await this.idle();
  }

  camera() {
    return this.run(() => {
      const { camera, control } = trackbed.app.stage;
      return { place: camera.position.toArray(), target: control.target.toArray(), zoom: camera.zoom,
        distance: camera.position.distanceTo(control.target), perspective: Boolean(camera.isPerspectiveCamera) };
    });
  }
}

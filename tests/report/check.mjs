// Checks reports in a browser: node tests/report/check.mjs PROGRAM DIR…
//
// DIR: results. Offline, every plot has axes with units and complete legends, no overlapping or clipped text; nothing is
// wider than the page. Browser as in tests/view/check.mjs.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { pathToFileURL } from 'node:url';
import { launch } from '../view/browser.mjs';
import { check, expect, sum } from '../view/expect.mjs';

const [program, ...folders] = process.argv.slice(2);
const dir = fs.mkdtempSync(path.join(os.tmpdir(), 'trackbed_report_'));
const browser = await launch();

/** Runs in the page: plots with text boxes, and errors. */
function look() {
  const box = (element) => {
    const { left, right, top, bottom } = element.getBoundingClientRect();
    return { left, right, top, bottom, text: element.textContent.trim() };
  };
  const plots = [...document.querySelectorAll('figure:not(.picture)')].map((figure) => {
    const svg = figure.querySelector(':scope > svg');
    const texts = [...svg.querySelectorAll('text')].filter((t) => t.textContent.trim()).map(box);
    const legend = [...figure.querySelectorAll('ul.legend li')].map(box);
    // Grid lines are light grey.
    const strokes = [...svg.querySelectorAll('polyline, path')].map((c) => c.getAttribute('stroke'));
    const curves = new Set(strokes.filter((c) => c && !/^#(d8){3}$|^#(ef){3}$/.test(c)));
    return { title: figure.querySelector('figcaption')?.textContent ?? '', frame: box(svg), texts, legend, curves: curves.size };
  });
  const headings = [...document.querySelectorAll('h2')].map((h) => h.textContent);
  const targets = [...document.querySelectorAll('nav a')].map((a) => a.getAttribute('href').slice(1));
  const lost = targets.filter((id) => !document.getElementById(id));
  const cells = [...document.querySelectorAll('td, th, p, li, figcaption')].map(box);
  const blank = [...document.querySelectorAll('figure.picture img')].filter((i) => i.naturalWidth < 600 || i.width < 300).length;
  return { plots, headings, lost, cells, blank, width: document.documentElement.scrollWidth, page: window.innerWidth };
}

const overlap = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left) > 1
  && Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top) > 1;

/** Axis label with unit, or of a dimensionless quantity. */
const NAMED = /\[[^\]]+\]$|^load cycle N$|^neighbours$|^(share|fraction) of|ratio D$|^porosity$|^coordination/;

async function report(folder) {
  const page = path.join(dir, `${path.basename(folder)}.html`);
  execFileSync(program, ['report', folder, '--out', page]);
  for (const width of [1280, 700]) {
    const context = await browser.newContext({ viewport: { width, height: 900 }, offline: true });
    const tab = await context.newPage();
    const faults = [];
    tab.on('pageerror', (error) => faults.push(String(error)));
    tab.on('request', (request) => { if (!/^(file|data):/.test(request.url())) faults.push(request.url()); });
    await tab.goto(pathToFileURL(page).href);
    const seen = await tab.evaluate(look);
    await context.close();
    expect(faults.length === 0, `the page asks for ${faults[0]}`);
    expect(seen.headings[0]?.startsWith('Checks and warnings'), `the first heading is ${seen.headings[0]}`);
    expect(seen.lost.length === 0, `links to ${seen.lost}`);
    expect(seen.blank === 0, `${seen.blank} pictures do not load`);
    expect(seen.width <= seen.page, `${seen.width} pixels wide on ${seen.page}`);
    expect(seen.plots.length > 0, 'no plot');
    for (const plot of seen.plots) {
      const where = `${plot.title} (${width} pixels)`;
      expect(plot.title, 'a plot without a title');
      plot.texts.forEach((a, k) => {
        const out = a.left < plot.frame.left - 1 || a.right > plot.frame.right + 1 || a.bottom > plot.frame.bottom + 1;
        expect(!out, `${where}: "${a.text}" is cut off`);
        const other = plot.texts.slice(k + 1).find((b) => overlap(a, b));
        expect(!other, `${where}: "${a.text}" lies on "${other?.text}"`);
      });
      const axes = plot.texts.filter((t) => /[a-z]{3}/i.test(t.text)).map((t) => t.text);
      expect(axes.length >= 2, `${where}: axes ${axes}`);
      axes.forEach((axis) => expect(NAMED.test(axis), `${where}: the axis "${axis}" has no unit`));
      expect(plot.curves < 2 || plot.legend.length >= plot.curves, `${where}: ${plot.curves} curves, ${plot.legend.length} names`);
      plot.legend.forEach((a, k) => {
        expect(a.text, `${where}: a name in the legend is empty`);
        const other = plot.legend.slice(k + 1).find((b) => overlap(a, b));
        expect(!other, `${where}: "${a.text}" lies on "${other?.text}" in the legend`);
      });
    }
    if (width === 700) return `${seen.plots.length} plots, ${seen.headings.length} parts`;
  }
}

try {
  for (const folder of folders) {
    await check('report', path.basename(folder), () => report(folder));
  }
} finally {
  await browser.close();
}
fs.rmSync(dir, { recursive: true });
process.exit(sum() ? 0 : 1);

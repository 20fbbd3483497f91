// Checks the site of docs/site.py in a browser: node tests/site_check.mjs [PICTURES]
//
// Five pages at two widths: equations are rendered, nothing exceeds the window, search works, no external requests.
// Browser as in tests/view/browser.mjs; PICTURES: directory for screenshots.
import path from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { launch } from './view/browser.mjs';
import { check, expect, sum } from './view/expect.mjs';

const site = fileURLToPath(new URL('../target/site/', import.meta.url));
const pages = { readme: 'index', scene: 'docs/scene', theory: 'docs/theory/contacts', verification: 'docs/guide/verification', settlement: 'docs/tutorials/settlement' };
const address = (page, anchor = '') => pathToFileURL(path.join(site, `${page}.html`)).href + anchor;
const [pictures] = process.argv.slice(2);
const faults = [];
const browser = await launch();

async function open(width, colorScheme = 'light') {
  const context = await browser.newContext({ viewport: { width, height: width < 500 ? 844 : 900 }, colorScheme });
  const page = await context.newPage();
  page.on('pageerror', (error) => faults.push(`error in the page: ${error}`));
  page.on('request', (request) => { if (!/^(file|data):/.test(request.url())) faults.push(`request to ${request.url()}`); });
  page.on('requestfailed', (request) => { if (!/ABORTED/.test(request.failure().errorText)) faults.push(`no ${request.url()}`); });
  return page;
}

try {
  for (const width of [1280, 390]) {
    const page = await open(width);
    for (const [name, file] of Object.entries(pages)) {
      await check(`${width}`, name, async () => {
        await page.goto(address(file));
        await page.evaluate(() => document.fonts.ready);
        const seen = await page.evaluate(() => ({
          wide: document.documentElement.scrollWidth - innerWidth,
          text: document.querySelector('article').innerText.length,
          heights: [...document.querySelectorAll('math')].map((m) => m.getBoundingClientRect().height),
          roots: [...document.querySelectorAll('msqrt')].map((r) => r.getBoundingClientRect().width - [...r.children].reduce((w, c) => w + c.getBoundingClientRect().width, 0)),
          broken: [...document.images].filter((i) => i.complete && !i.naturalWidth).length,
        }));
        if (pictures) await page.screenshot({ path: path.join(pictures, `${name}-${width}.png`) });
        expect(seen.wide <= 0, `${seen.wide} pixels wider than the window`);
        expect(seen.text > 500 && seen.broken === 0, `${seen.text} characters, ${seen.broken} broken pictures`);
        expect(name !== 'theory' || seen.heights.length > 40, `${seen.heights.length} formulas`);
        expect(seen.heights.every((h) => h > 3), `heights of formulas from ${Math.min(...seen.heights)}`);
        expect(seen.roots.every((w) => w > 4), `widths of root signs from ${Math.min(...seen.roots)}`);
        return `${seen.text} characters, ${seen.heights.length} formulas`;
      });
    }
    await check(`${width}`, 'search', async () => {
      await page.fill('#search', 'critical time step');
      await page.waitForSelector('#found a');
      const found = await page.$$eval('#found a', (links) => links.map((a) => a.href));
      if (pictures) await page.screenshot({ path: path.join(pictures, `search-${width}.png`) });
      const place = found.findIndex((href) => href.includes('docs/theory/motion.html#'));
      expect(place === 0 || place === 1, `the theory page has place ${place + 1} of ${found.length}`);
      await page.press('#search', 'Enter');
      await page.waitForURL(found[0]);
      return `place ${place + 1} of ${found.length}`;
    });
    await page.context().close();
  }
  await check('site', 'no errors of scripts, no requests to elsewhere', () => expect(faults.length === 0, faults.join('; ')));
} finally {
  await browser.close();
}
process.exitCode = sum() ? 0 : 1;

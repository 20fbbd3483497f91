// Menu, contents of the page, copying of code, and search in the index that docs/site.py writes.
const root = document.documentElement.dataset.root;
const byId = (id) => document.getElementById(id);

const [menu, sidebar] = [byId('menu'), byId('sidebar')];
menu.addEventListener('click', () => menu.setAttribute('aria-expanded', sidebar.classList.toggle('open')));
const current = sidebar.querySelector('[aria-current]');
if (current) sidebar.scrollTop = current.offsetTop - sidebar.clientHeight / 3;

const contents = document.querySelector('.contents');
if (contents) {
  const wide = matchMedia('(min-width: 75.01rem)');
  const fit = () => { contents.open = wide.matches; };
  wide.addEventListener('change', fit);
  fit();
  const links = [...contents.querySelectorAll('a')];
  const headings = links.map((a) => byId(decodeURIComponent(a.hash.slice(1))));
  const follow = () => {
    const here = headings.findLastIndex((h) => h.getBoundingClientRect().top < 120);
    links.forEach((a, k) => a.classList.toggle('here', k === here));
    if (wide.matches && here >= 0) {
      const { offsetTop } = links[here];
      if (offsetTop < contents.scrollTop || offsetTop > contents.scrollTop + contents.clientHeight - 40) contents.scrollTop = offsetTop - contents.clientHeight / 3;
    }
  };
  let waits = false;
  addEventListener('scroll', () => {
    if (!waits) requestAnimationFrame(() => { waits = false; follow(); });
    waits = true;
  }, { passive: true });
  follow();
}

for (const block of navigator.clipboard ? document.querySelectorAll('.code') : []) {
  const button = Object.assign(document.createElement('button'), { textContent: 'Copy' });
  button.addEventListener('click', async () => {
    await navigator.clipboard.writeText(block.querySelector('code').textContent);
    button.textContent = 'Copied';
    setTimeout(() => { button.textContent = 'Copy'; }, 1500);
  });
  block.append(button);
}

const [input, found] = [byId('search'), byId('found')];
// One character for one, so that places in the folded text are those in the text.
const fold = (text) => [...text].map((c) => c.normalize('NFD')[0].toLowerCase()).join('').replace(/[‐-–]/g, '-');
const escaped = (text) => text.replace(/[&<>]/g, (c) => `&#${c.charCodeAt(0)};`);
let index;

function load() {
  index ??= new Promise((done) => {
    const script = Object.assign(document.createElement('script'), { src: `${root}/search-index.js` });
    script.onload = () => done(INDEX.sections.map(([page, anchor, heading, text]) => {
      const [href, label] = INDEX.pages[page];
      return { href, anchor, label, heading, text, folded: [label, heading, text].map(fold) };
    }));
    document.head.append(script);
  });
  return index;
}

const count = (text, term) => text.split(term).length - 1;
const starts = (text, term) => text.startsWith(term) || /[^\p{L}\p{N}]$/u.test(text.slice(0, Math.max(0, text.indexOf(term))));

/** Score of a section: 0 unless every term is in it; those with all terms in the heading come first. */
function score({ folded: [label, heading, text] }, phrase, terms) {
  let sum = 0;
  for (const term of terms) {
    const [inLabel, inHeading, inText] = [label, heading, text].map((t) => t.includes(term));
    if (!inLabel && !inHeading && !inText) return 0;
    sum += 3 * inLabel + (inHeading && (starts(heading, term) ? 20 : 8)) + (inText && (starts(text, term) ? 3 : 1)) + Math.min(4, count(text, term));
  }
  if (terms.every((t) => heading.includes(t))) sum += 100 - Math.min(40, heading.length / 4);
  return sum + 60 * heading.includes(phrase) + 15 * text.includes(phrase);
}

function marked(text, terms) {
  const folded = fold(text);
  let made = '';
  for (let at = 0; at < text.length;) {
    const next = terms.map((t) => [folded.indexOf(t, at), t.length]).filter(([k]) => k >= 0).sort((a, b) => a[0] - b[0] || b[1] - a[1])[0];
    if (!next) return made + escaped(text.slice(at));
    made += `${escaped(text.slice(at, next[0]))}<mark>${escaped(text.slice(next[0], next[0] + next[1]))}</mark>`;
    at = next[0] + next[1];
  }
  return made;
}

function excerpt({ text, folded }, phrase, terms) {
  const places = [phrase, ...terms].map((t) => folded[2].indexOf(t)).filter((k) => k >= 0);
  const begin = text.lastIndexOf(' ', Math.max(0, (places[0] ?? 0) - 50)) + 1;
  const end = text.indexOf(' ', begin + 170);
  return (begin > 0 ? '… ' : '') + marked(text.slice(begin, end < 0 ? undefined : end), terms) + (end < 0 ? '' : ' …');
}

async function search() {
  const phrase = fold(input.value.trim());
  const terms = [...new Set(phrase.split(/\s+/).filter(Boolean))].map((t) => (/^\p{L}{4,}s$/u.test(t) && !t.endsWith('ss') ? t.slice(0, -1) : t));
  const sections = terms.length ? await load() : [];
  if (fold(input.value.trim()) !== phrase) return;
  const best = sections.map((s) => [score(s, phrase, terms), s]).filter(([n]) => n > 0).sort((a, b) => b[0] - a[0]).slice(0, 30);
  found.innerHTML = best.map(([, s]) => `<a href="${root}/${s.href}${s.anchor ? `#${s.anchor}` : ''}"><b>${escaped(s.label)}</b>`
    + `${s.heading ? ` › ${marked(s.heading, terms)}` : ''}<span>${excerpt(s, phrase, terms)}</span></a>`).join('') || '<p>Nothing found</p>';
  found.hidden = !terms.length;
  found.scrollTop = 0;
}

const close = () => { found.hidden = true; };
input.addEventListener('focus', () => { load(); if (input.value) found.hidden = false; });
input.addEventListener('input', search);
found.addEventListener('click', (event) => { if (event.target.closest('a')) close(); });
addEventListener('click', (event) => { if (!event.target.closest('[role=search]')) close(); });
addEventListener('keydown', (event) => {
  const links = [input, ...found.querySelectorAll('a')];
  const at = links.indexOf(document.activeElement);
  const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
  if (event.key === '/' && !/INPUT|TEXTAREA/.test(document.activeElement.tagName)) {
    event.preventDefault();
    input.focus();
  } else if (event.key === 'Escape') {
    close();
  } else if (step && at >= 0 && !found.hidden) {
    event.preventDefault();
    links[(at + step + links.length) % links.length].focus();
  } else if (event.key === 'Enter' && at === 0 && links[1]) {
    links[1].click();
  }
});

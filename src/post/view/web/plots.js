// Small plots below the picture, with the time of the frame marked.
import { colour, figures, limits, scaled, ticks } from 'colours';

/** Scale of values with a label such as `load [N]`: name with the unit that suits them, position, ticks as [position, text]. */
function axis(values, label, from, to) {
  const [low, high] = limits(values, 0.5);
  const [, name, plain] = /^(.*?)(?: \[(.*)\])?$/.exec(label);
  const { factor, unit } = scaled(plain ?? '', Math.max(Math.abs(low), Math.abs(high)));
  const place = (v) => from + ((v - low) / (high - low)) * (to - from);
  const whole = factor === 1 && values.every(Number.isInteger);
  const at = ticks(low / factor, high / factor, 4).filter((t) => !whole || Number.isInteger(t));
  const texts = figures(at);
  return { name: unit ? `${name} [${unit}]` : name, place, ticks: at.map((t, k) => [place(t * factor), texts[k]]) };
}

/** Draws y over x on a canvas. `line`: an x that is marked, `mark`: a point, `limit`: least and largest y if not those of y. */
export function plot(canvas, { x, y, xLabel, yLabel, line, mark, points, limit }) {
  const ratio = Math.min(window.devicePixelRatio, 2);
  const [w, h] = [canvas.clientWidth || 260, canvas.clientHeight || 150];
  [canvas.width, canvas.height] = [w * ratio, h * ratio];
  const g = canvas.getContext('2d');
  g.scale(ratio, ratio);
  g.fillStyle = colour('--paper');
  g.fillRect(0, 0, w, h);
  g.font = '11px system-ui, sans-serif';
  const [left, right, top, bottom] = [52, w - 18, 22, h - 30];
  const [across, up] = [axis(x, xLabel, left, right), axis(limit ?? y, yLabel, bottom, top)];
  const stroke = (style, width, places) => {
    Object.assign(g, { strokeStyle: style, lineWidth: width });
    g.beginPath();
    places.forEach(([px, py], k) => g[k ? 'lineTo' : 'moveTo'](px, py));
    g.stroke();
  };
  const write = (text, px, py, align, ink) => {
    Object.assign(g, { fillStyle: colour(ink), textAlign: align });
    g.fillText(text, px, py);
  };
  for (const [px, text] of across.ticks) {
    stroke(colour('--line'), 1, [[px, top], [px, bottom]]);
    write(text, px, bottom + 13, 'center', '--faint');
  }
  for (const [py, text] of up.ticks) {
    stroke(colour('--line'), 1, [[left, py], [right, py]]);
    write(text, left - 4, py + 4, 'right', '--faint');
  }
  write(up.name, 6, 12, 'left', '--ink');
  write(across.name, right, h - 4, 'right', '--ink');
  const places = Array.from(x, (v, k) => [across.place(v), up.place(y[k])]);
  stroke(colour('--accent'), 1.4, places);
  if (points) places.forEach((place) => dot(g, place, 2.4, colour('--accent')));
  const at = line === undefined || line === null ? null : across.place(line);
  if (at !== null) stroke('#d55e00', 1.4, [[at, top], [at, bottom]]);
  const marked = mark ? [across.place(mark[0]), up.place(mark[1])] : null;
  if (mark) dot(g, marked, 4, '#d55e00');
  return { line: at, mark: marked, labels: [across.name, up.name] };
}

function dot(g, [x, y], r, style) {
  g.fillStyle = style;
  g.beginPath(); g.arc(x, y, r, 0, 2 * Math.PI); g.fill();
}

/** Index of the last row whose `x` is not above `at`. */
export function rowAt(x, at) {
  let [low, high] = [0, x.length];
  while (high - low > 1) {
    const mid = (low + high) >> 1;
    if (x[mid] <= at + 1e-6 * Math.abs(at)) low = mid; else high = mid;
  }
  return low;
}

/** Number of load cycles that have ended at each row: the load has come down through its middle so often. */
export function cyclesAt(load) {
  const [low, high] = limits(load);
  const middle = 0.5 * (low + high);
  let count = 0;
  return load.map((v, k) => {
    if (k && load[k - 1] > middle && v <= middle) count += 1;
    return count;
  });
}

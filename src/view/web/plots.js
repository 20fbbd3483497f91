// Small plots beside the picture, with the time of the frame marked, and legends in the picture.
import { colourAt, figure, scaled } from 'colours';

const INK = '#1c2733';

/** Ticks at round numbers between two limits. */
export function ticks(low, high, most) {
  if (!(high > low)) return [low];
  const rough = (high - low) / most;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= rough);
  const out = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k++) out.push(k * step);
  return out;
}

/** Draws y over x on a canvas. `marks`: points that are marked, `line`: an x that is marked. */
export function plot(canvas, { x, y, xLabel, yLabel, line, mark, points }) {
  const ratio = Math.min(window.devicePixelRatio, 2);
  const [w, h] = [canvas.clientWidth || 260, canvas.clientHeight || 150];
  [canvas.width, canvas.height] = [w * ratio, h * ratio];
  const g = canvas.getContext('2d');
  g.scale(ratio, ratio);
  g.fillStyle = '#ffffff';
  g.fillRect(0, 0, w, h);
  g.font = '11px system-ui, sans-serif';
  const limits = (values) => {
    let [low, high] = [Infinity, -Infinity];
    for (const v of values) [low, high] = [Math.min(low, v), Math.max(high, v)];
    if (!(high >= low)) return [0, 1];
    return high > low ? [low, high] : [low - 0.5 * (Math.abs(low) || 1), low + 0.5 * (Math.abs(low) || 1)];
  };
  const [[x0, x1], [y0, y1]] = [limits(x), limits(y)];
  const frame = { left: 52, right: w - 10, top: 20, bottom: h - 30 };
  const px = (v) => frame.left + ((v - x0) / (x1 - x0)) * (frame.right - frame.left);
  const py = (v) => frame.bottom - ((v - y0) / (y1 - y0)) * (frame.bottom - frame.top);
  g.strokeStyle = '#dde2e8';
  g.fillStyle = '#55606d';
  g.lineWidth = 1;
  g.textAlign = 'center';
  for (const t of ticks(x0, x1, 4)) {
    g.beginPath(); g.moveTo(px(t), frame.top); g.lineTo(px(t), frame.bottom); g.stroke();
    g.fillText(figure(Number(t.toPrecision(6))), px(t), frame.bottom + 13);
  }
  g.textAlign = 'right';
  for (const t of ticks(y0, y1, 4)) {
    g.beginPath(); g.moveTo(frame.left, py(t)); g.lineTo(frame.right, py(t)); g.stroke();
    g.fillText(figure(Number(t.toPrecision(6))), frame.left - 4, py(t) + 4);
  }
  g.fillStyle = INK;
  g.textAlign = 'left';
  g.fillText(yLabel, 6, 12);
  g.textAlign = 'right';
  g.fillText(xLabel, frame.right, h - 4);
  g.strokeStyle = '#0072b2';
  g.lineWidth = 1.4;
  g.beginPath();
  for (let k = 0; k < x.length; k++) g[k ? 'lineTo' : 'moveTo'](px(x[k]), py(y[k]));
  g.stroke();
  if (points) for (let k = 0; k < x.length; k++) dot(g, px(x[k]), py(y[k]), 2.4, '#0072b2');
  if (line !== undefined && line !== null) {
    g.strokeStyle = '#d55e00';
    g.beginPath(); g.moveTo(px(line), frame.top); g.lineTo(px(line), frame.bottom); g.stroke();
  }
  if (mark) dot(g, px(mark[0]), py(mark[1]), 4, '#d55e00');
  return { line: line === undefined || line === null ? null : px(line), mark: mark ? [px(mark[0]), py(mark[1])] : null };
}

function dot(g, x, y, r, colour) {
  g.fillStyle = colour;
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
  let [low, high] = [Infinity, -Infinity];
  for (const v of load) [low, high] = [Math.min(low, v), Math.max(high, v)];
  const middle = 0.5 * (low + high);
  let count = 0;
  return load.map((v, k) => {
    if (k && load[k - 1] > middle && v <= middle) count += 1;
    return count;
  });
}

/** Draws legends, one below the other, at the right edge of a picture `width` wide; `dark`: the background is. */
export function legends(g, width, list, dark) {
  const ink = dark ? '#f2f4f7' : INK;
  let y = 14;
  g.textBaseline = 'alphabetic';
  for (const { title, unit: plain, range, map, swatches, bands } of list) {
    const { factor, unit } = scaled(plain, range ? Math.max(...range.map(Math.abs)) : 0);
    g.font = '600 12px system-ui, sans-serif';
    const rows = swatches ? swatches.length : 7;
    const size = swatches ? 18 * rows : 132;
    const wide = 156;
    const x = width - wide - 12;
    g.fillStyle = dark ? 'rgba(20,26,33,0.72)' : 'rgba(255,255,255,0.82)';
    g.beginPath(); g.roundRect(x - 8, y - 2, wide + 12, size + 42, 5); g.fill();
    g.fillStyle = ink;
    g.textAlign = 'left';
    const head = unit ? `${title} [${unit}]` : title;
    g.fillText(head.length > 25 && unit ? title : head, x, y + 13, wide - 2);
    if (head.length > 25 && unit) { g.font = '12px system-ui, sans-serif'; g.fillText(`[${unit}]`, x + 26, y + 28); }
    const top = y + 30 + (head.length > 25 && unit && !swatches ? 4 : 0);
    g.font = '12px system-ui, sans-serif';
    if (swatches) {
      swatches.forEach(([colour, text], k) => {
        g.fillStyle = colour; g.fillRect(x, top + 18 * k - 4, 14, 12);
        g.fillStyle = ink; g.fillText(text, x + 22, top + 18 * k + 6, wide - 26);
      });
    } else {
      for (let k = 0; k < size; k++) {
        let t = 1 - k / (size - 1);
        if (bands) t = (Math.floor(Math.min(t, 0.99999) * bands) + 0.5) / bands;
        g.fillStyle = `rgb(${colourAt(map, t).map((v) => Math.round(255 * v)).join(',')})`;
        g.fillRect(x, top + k, 18, 1.5);
      }
      g.strokeStyle = ink; g.lineWidth = 0.8; g.strokeRect(x, top, 18, size);
      g.fillStyle = ink;
      for (let k = 0; k < rows - 2; k++) {
        const t = k / (rows - 3);
        const at = top + (1 - t) * size;
        g.fillRect(x + 18, at - 0.5, 4, 1);
        g.fillText(figure((range[0] + t * (range[1] - range[0])) / factor), x + 27, at + 4);
      }
    }
    y += size + 52;
  }
}

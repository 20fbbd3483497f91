// Pictures and videos of the page: PNG, JPEG and BMP, AVI with JPEG frames, print.

/** Hands a file to the user; the last one is kept for whoever drives the page. */
export function download(name, blob) {
  const link = document.createElement('a');
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  return { name, size: blob.size, type: blob.type, blob };
}

const blobOf = (canvas, type, quality) => new Promise((done) => canvas.toBlob(done, type, quality));

/** A canvas as a file of a format: png, jpg or bmp. */
export async function picture(canvas, format) {
  if (format === 'bmp') return new Blob([bmp(canvas)], { type: 'image/bmp' });
  return blobOf(canvas, format === 'jpg' ? 'image/jpeg' : 'image/png', 0.93);
}

/** A canvas as a bitmap of 24 bits, rows from below, padded to four bytes. */
function bmp(canvas) {
  const { width, height } = canvas;
  const pixels = canvas.getContext('2d').getImageData(0, 0, width, height).data;
  const row = Math.ceil((3 * width) / 4) * 4;
  const bytes = new Uint8Array(54 + row * height);
  const view = new DataView(bytes.buffer);
  bytes.set([0x42, 0x4d]);
  view.setUint32(2, bytes.length, true);
  view.setUint32(10, 54, true);
  view.setUint32(14, 40, true);
  view.setInt32(18, width, true);
  view.setInt32(22, height, true);
  view.setUint16(26, 1, true);
  view.setUint16(28, 24, true);
  view.setUint32(34, row * height, true);
  for (let y = 0; y < height; y++) {
    let out = 54 + row * (height - 1 - y);
    for (let at = 4 * width * y, end = at + 4 * width; at < end; at += 4, out += 3) {
      bytes[out] = pixels[at + 2];
      bytes[out + 1] = pixels[at + 1];
      bytes[out + 2] = pixels[at];
    }
  }
  return bytes;
}

const letters = (text) => [...text].map((c) => c.charCodeAt(0));

/** Collects frames as JPEG pictures for an AVI file (RIFF, Motion JPEG, with an index). */
export class Avi {
  constructor(width, height, rate) {
    Object.assign(this, { width, height, rate, frames: [] });
  }

  async add(canvas) {
    const blob = await blobOf(canvas, 'image/jpeg', 0.9);
    this.frames.push(new Uint8Array(await blob.arrayBuffer()));
  }

  /** The file. */
  blob() {
    const { width, height, rate, frames } = this;
    const most = Math.max(...frames.map((f) => f.length), 0);
    const micro = Math.round(1e6 / rate);
    const dwords = (...values) => values.flatMap((v) => [v & 255, v >> 8 & 255, v >> 16 & 255, v >>> 24]);
    const chunk = (id, data) => [...letters(id), ...dwords(data.length), ...data];
    const list = (id, data) => chunk('LIST', [...letters(id), ...data]);
    const avih = chunk('avih', dwords(micro, most * Math.ceil(rate), 0, 0x10, frames.length, 0, 1, most, width, height, 0, 0, 0, 0));
    const strh = chunk('strh', [...letters('vidsMJPG'), ...dwords(0, 0, 0, micro, 1000000, 0, frames.length, most, 0xffffffff, 0),
      ...dwords(0, (width & 0xffff) | (height << 16))]);
    const strf = chunk('strf', [...dwords(40, width, height), 1, 0, 24, 0, ...letters('MJPG'), ...dwords(width * height * 3, 0, 0, 0, 0)]);
    const head = list('hdrl', [...avih, ...list('strl', [...strh, ...strf])]);
    const parts = [];
    const index = [];
    let at = 4;
    for (const frame of frames) {
      const pad = frame.length % 2;
      parts.push(new Uint8Array([...letters('00dc'), ...dwords(frame.length)]), frame, new Uint8Array(pad));
      index.push(...letters('00dc'), ...dwords(0x10, at, frame.length));
      at += 8 + frame.length + pad;
    }
    const idx1 = chunk('idx1', index);
    const size = 4 + head.length + 8 + at + idx1.length;
    const start = new Uint8Array([...letters('RIFF'), ...dwords(size), ...letters('AVI '), ...head, ...letters('LIST'), ...dwords(at), ...letters('movi')]);
    return new Blob([start, ...parts, new Uint8Array(idx1)], { type: 'video/x-msvideo' });
  }
}

/** Prints a picture alone. */
export async function print(canvas, caption) {
  const image = document.getElementById('print-image');
  image.src = canvas.toDataURL('image/png');
  document.getElementById('print-caption').textContent = caption;
  await image.decode();
  window.print();
}

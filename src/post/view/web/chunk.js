// Blocks of numbers from the program (src/post/view/chunk.rs): `TBV1`, length of a JSON text, the text, arrays.

/** A block as { meta, arrays: { name: typed array } }. */
export function decode(buffer) {
  const view = new DataView(buffer);
  const magic = String.fromCharCode(...new Uint8Array(buffer, 0, 4));
  if (magic !== 'TBV1') throw new Error('the data are not those of this viewer');
  const length = view.getUint32(4, true);
  const text = new TextDecoder().decode(new Uint8Array(buffer, 8, length));
  const { meta, arrays } = JSON.parse(text);
  const block = { meta, arrays: {}, bytes: buffer.byteLength };
  for (const entry of arrays) block.arrays[entry.name] = array(buffer, 8 + length + entry.offset, entry);
  return block;
}

function array(buffer, at, entry) {
  switch (entry.type) {
    case 'f32': return new Float32Array(buffer, at, entry.count);
    case 'u32': return new Uint32Array(buffer, at, entry.count);
    case 'u8': return new Uint8Array(buffer, at, entry.count);
    default: return unpacked(new Uint8Array(buffer), at, entry);
  }
}

/** Whole numbers of two or three bytes that lie in planes, as numbers between limits. */
function unpacked(bytes, at, { type, count, components, low, step }) {
  const out = new Float32Array(count);
  const planes = type === 'q24' ? 3 : 2;
  for (let k = 0, c = 0; k < count; k++, c = c + 1 === components ? 0 : c + 1) {
    let n = bytes[at + k] | (bytes[at + count + k] << 8);
    if (planes === 3) n |= bytes[at + 2 * count + k] << 16;
    out[k] = low[c] + n * step[c];
  }
  return out;
}

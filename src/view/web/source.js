// Where blocks come from: the server, the page itself, or files that the user opened. The last ones used are kept.
import { decode } from 'chunk';

/** Bytes of blocks that are kept. */
const KEPT = 600e6;

class Source {
  constructor() {
    this.kept = new Map();
    this.bytes = 0;
  }

  /** The block of a name, or null where there is none. */
  async block(name) {
    const known = this.kept.get(name);
    if (known) {
      this.kept.delete(name);
      this.kept.set(name, known);
      return known;
    }
    const loading = this.load(name);
    this.kept.set(name, loading);
    try {
      const block = await loading;
      this.keep(name, block);
      return block;
    } catch (error) {
      this.kept.delete(name);
      throw error;
    }
  }

  keep(name, block) {
    if (!this.kept.has(name)) return;
    this.bytes += block?.bytes ?? 0;
    for (const [other, value] of this.kept) {
      if (this.bytes <= KEPT) break;
      if (other === name || !value) continue;
      this.kept.delete(other);
      value.then?.((b) => { this.bytes -= b?.bytes ?? 0; });
    }
  }
}

/** Blocks from the program, by HTTP on this machine. */
export class ServedSource extends Source {
  constructor(run) {
    super();
    this.run = run;
  }

  async load(name) {
    const path = name.split('/').map(encodeURIComponent).join('/');
    const response = await fetch(`/data/${path}?run=${encodeURIComponent(this.run)}`);
    if (response.status === 404) return null;
    if (!response.ok) throw new Error(await response.text());
    return decode(await response.arrayBuffer());
  }
}

/** Blocks as deflated base64 texts, such as those within an exported page. */
export class EmbeddedSource extends Source {
  constructor(texts) {
    super();
    this.texts = texts;
  }

  async load(name) {
    const text = this.texts.get(name);
    if (text === undefined) return null;
    const packed = new Blob([bytesOf(text())]).stream().pipeThrough(new DecompressionStream('deflate'));
    return decode(await new Response(packed).arrayBuffer());
  }
}

/** Blocks made in the page from files of the user: { meta, arrays } by name, or a function that makes one. */
export class MadeSource extends Source {
  constructor(blocks) {
    super();
    this.blocks = blocks;
  }

  async load(name) {
    const block = this.blocks.get(name);
    return (typeof block === 'function' ? await block() : block) ?? null;
  }
}

/** The bytes of a base64 text. */
export function bytesOf(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let k = 0; k < letters.length; k++) bytes[k] = letters.charCodeAt(k);
  return bytes;
}

/** The texts of the blocks within this page; read from it when they are wanted. */
export function embeddedTexts(root) {
  const texts = new Map();
  for (const element of root.querySelectorAll('script[data-block]')) {
    texts.set(element.dataset.block, () => element.textContent);
  }
  return texts;
}

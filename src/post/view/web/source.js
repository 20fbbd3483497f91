// Where blocks come from: the server, the page itself, or files that the user opened. The last ones used are kept.
import { decode } from 'chunk';

/** Bytes of blocks that are kept. */
const KEPT = 600e6;

class Source {
  constructor() {
    /** By name: what is loading or loaded, and its bytes, the last used at the end. */
    this.kept = new Map();
  }

  /** The block of a name, or null where there is none. */
  async block(name) {
    const entry = this.kept.get(name) ?? { loading: this.load(name), bytes: 0 };
    this.kept.delete(name);
    this.kept.set(name, entry);
    try {
      const block = await entry.loading;
      entry.bytes = block?.bytes ?? 0;
      this.forget();
      return block;
    } catch (error) {
      this.kept.delete(name);
      throw error;
    }
  }

  /** Lets go of blocks that were not used for longest, down to the bytes that are kept. */
  forget() {
    let sum = 0;
    for (const { bytes } of this.kept.values()) sum += bytes;
    for (const [name, { bytes }] of this.kept) {
      if (sum <= KEPT) return;
      if (!bytes) continue;
      this.kept.delete(name);
      sum -= bytes;
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

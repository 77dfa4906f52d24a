// Chunks of data: deflated header and arrays; the counterpart of chunk.py.

const TYPES = { f4: Float32Array, f8: Float64Array, i4: Int32Array };

export function fromBase64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const characters = atob(text);
  const bytes = new Uint8Array(characters.length);
  for (let i = 0; i < bytes.length; i++) bytes[i] = characters.charCodeAt(i);
  return bytes;
}

export async function inflate(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Header, with `arrays`: name to { data, shape }. */
export function parse(raw) {
  const length = new DataView(raw.buffer, raw.byteOffset).getUint32(0, true);
  const header = JSON.parse(new TextDecoder().decode(raw.subarray(4, 4 + length)));
  let at = 4 + length;
  const arrays = {};
  for (const { name, type, shape } of header.arrays) {
    const count = shape.reduce((product, n) => product * n, 1);
    const width = TYPES[type].BYTES_PER_ELEMENT;
    const bytes = new Uint8Array(count * width);
    for (let plane = 0; plane < width; plane++) {
      for (let i = 0; i < count; i++) bytes[i * width + plane] = raw[at + plane * count + i];
    }
    arrays[name] = { data: new TYPES[type](bytes.buffer), shape };
    at += count * width;
  }
  header.arrays = arrays;
  return header;
}

export const openChunk = async (bytes) => parse(await inflate(bytes));

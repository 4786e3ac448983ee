// SPDX-License-Identifier: GPL-3.0-or-later
// The packed mesh of src/view/packing.cpp: gzip of byte planes, named arrays.

function from_base64(text) {
  if (Uint8Array.fromBase64) return Uint8Array.fromBase64(text);
  const letters = atob(text);
  const bytes = new Uint8Array(letters.length);
  for (let i = 0; i < bytes.length; ++i) bytes[i] = letters.charCodeAt(i);
  return bytes;
}

async function unzipped(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/// Arrays by name, as Int32Array. Names ending in "+" hold zigzag differences and lose the sign here.
export async function decode(text, arrays) {
  const bytes = await unzipped(from_base64(text.trim()));
  const out = {};
  let at = 0;
  for (const [name, count, width] of arrays) {
    const values = new Int32Array(count);
    for (let b = 0; b < width; ++b, at += count) {
      const shift = 8 * b;
      for (let i = 0; i < count; ++i) values[i] |= bytes[at + i] << shift;
    }
    if (name.endsWith("+")) {
      let last = 0;
      for (let i = 0; i < count; ++i) values[i] = last += (values[i] >>> 1) ^ -(values[i] & 1);
    }
    out[name.replace("+", "")] = values;
  }
  return out;
}

export const unzigzag = (n) => (n >>> 1) ^ -(n & 1);

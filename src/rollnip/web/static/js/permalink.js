// The whole state in the part of the address after #, packed.

import { say } from "./texts.js";

const KEY = "s=";

/** The state as an address of this page. */
export async function linkOf(state) {
  return `${location.origin}${location.pathname}#${KEY}${await pack(JSON.stringify(state))}`;
}

/** The state in an address; undefined where there is none. Throws where it cannot be read. */
export async function stateIn(hash) {
  const text = hash.replace(/^#/, "");
  if (!text.startsWith(KEY)) return undefined;
  try {
    return JSON.parse(await unpack(text.slice(KEY.length)));
  } catch {
    throw new Error(say("link.damaged"));
  }
}

async function pack(text) {
  const bytes = await through(new TextEncoder().encode(text), new CompressionStream("deflate-raw"));
  const plain = Array.from(bytes, (byte) => String.fromCharCode(byte)).join("");
  return btoa(plain).replace(/\+/g, "-").replace(/\//g, "_").replace(/=+$/, "");
}

async function unpack(text) {
  const plain = atob(text.replace(/-/g, "+").replace(/_/g, "/"));
  const bytes = Uint8Array.from(plain, (letter) => letter.charCodeAt(0));
  return new TextDecoder().decode(await through(bytes, new DecompressionStream("deflate-raw")));
}

async function through(bytes, stream) {
  const whole = new Blob([bytes]).stream().pipeThrough(stream);
  return new Uint8Array(await new Response(whole).arrayBuffer());
}

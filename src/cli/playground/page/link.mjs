/**
 * The link of a page: its state in the fragment of the address.
 *
 * Input: a state, or the fragment of an address that anybody may have written. Output: a fragment, or a state whose every field is checked.
 * A fragment that is no link is an error with a message; nothing here changes the address.
 *
 * The form is `#v1.` and the state as JSON, deflated, in base64url.
 */

import { limited } from "./camera.mjs";
import { isSize } from "./state.mjs";

/** @typedef {import("./state.mjs").State} State */

const PREFIX = "v1.";

/** Descriptions have at most 4 MiB; links are far shorter, and a small link must not inflate to a large page. */
const LONGEST = 1 << 20;

/** An error of a link, in words for the person who opened it. */
class LinkError extends Error {}

/**
 * Returns the fragment for a state, without `#`.
 * @param {State} state
 * @returns {Promise<string>}
 */
export async function encode(state) {
    const { text, scene, camera, k, uniforms, size, device } = state;
    const json = new TextEncoder().encode(JSON.stringify({ text, scene, camera, k, uniforms, size, device }));
    const stream = new Blob([json]).stream().pipeThrough(new CompressionStream("deflate-raw"));
    return PREFIX + base64url(await collect(stream, LONGEST));
}

/**
 * Returns what a fragment holds, with or without `#`; null if it is empty.
 * @param {string} fragment
 * @returns {Promise<Partial<State> | null>}
 * @throws {LinkError}
 */
export async function decode(fragment) {
    const code = fragment.replace(/^#/, "");
    if (code === "") return null;
    if (!code.startsWith(PREFIX)) throw new LinkError("The link is not one of this page: copy it again, or start from a preset.");
    let value;
    try {
        const packed = new Blob([fromBase64url(code.slice(PREFIX.length))]);
        const bytes = await collect(packed.stream().pipeThrough(new DecompressionStream("deflate-raw")), LONGEST);
        value = JSON.parse(new TextDecoder("utf-8", { fatal: true }).decode(bytes));
    } catch (error) {
        if (error instanceof LinkError) throw error;
        throw new LinkError("The link is damaged, or a part of it is missing: copy the whole address again.");
    }
    return checked(value);
}

/** Returns the fields that have the right form. The description must be one of them. */
function checked(value) {
    if (typeof value?.text !== "string") throw new LinkError("The link holds no description: copy it again.");
    // The editor has no other ends of lines.
    const fields = { text: value.text.replace(/\r\n?/g, "\n") };
    if (typeof value.scene === "string" && value.scene.length < 1000) fields.scene = value.scene;
    if (Number.isInteger(value.k) && value.k > 0) fields.k = value.k;
    if (typeof value.device === "string") fields.device = value.device;
    if (isSize(value.size)) fields.size = value.size;
    const { azimuth, elevation, zoom } = value.camera ?? {};
    if ([azimuth, elevation, zoom].every(Number.isFinite)) fields.camera = limited({ azimuth, elevation, zoom });
    const uniforms = Object.entries(value.uniforms ?? {}).filter(([, numbers]) => isValue(numbers));
    fields.uniforms = Object.fromEntries(uniforms);
    return fields;
}

function isValue(value) {
    return Array.isArray(value) ? value.length <= 4 && value.every(Number.isFinite) : Number.isFinite(value);
}

/** Reads a stream to its end. More bytes than allowed are an error, before they are all in memory. */
async function collect(stream, longest) {
    const parts = [];
    let length = 0;
    for (const reader = stream.getReader(); ;) {
        const { done, value } = await reader.read();
        if (done) break;
        length += value.length;
        if (length > longest) {
            await reader.cancel();
            throw new LinkError("The description is too long for a link: keep it in a file.");
        }
        parts.push(value);
    }
    return new Uint8Array(await new Blob(parts).arrayBuffer());
}

function base64url(bytes) {
    let text = "";
    for (const byte of bytes) text += String.fromCharCode(byte);
    return btoa(text).replaceAll("+", "-").replaceAll("/", "_").replaceAll("=", "");
}

function fromBase64url(text) {
    const binary = atob(text.replaceAll("-", "+").replaceAll("_", "/"));
    return Uint8Array.from(binary, (character) => character.charCodeAt(0));
}

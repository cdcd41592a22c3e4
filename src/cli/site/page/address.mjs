/**
 * The link of the player: its choices in the fragment of the address.
 *
 * Input: a state, or a fragment that anybody may have written. Output: a fragment, or the fields of it that have the right form. Whether a
 * technique or a scene of that name exists is not decided here.
 *
 * The form is that of a query: `#technique=kb&capacity=8&k=5&sort=walk&overflow=drop&scene=marbles&size=480x360&camera=28.81,21.52,1`.
 */

import { limited } from "./camera.mjs";
import { isSize } from "./state.mjs";

/** The names of what is chosen from lists. */
const NAMES = ["technique", "sort", "overflow", "scene"];

/** Returns the fragment for a state, without `#`. */
export function write({ technique, capacity, k, sort, overflow, scene, size, camera }) {
    const { azimuth, elevation, zoom } = camera ?? {};
    const fields = {
        technique,
        capacity,
        k,
        sort,
        overflow,
        scene,
        size: size.join("x"),
        camera: camera && [azimuth, elevation, zoom].map((value) => Number(value.toFixed(4))).join(","),
    };
    return new URLSearchParams(Object.entries(fields).filter(([, value]) => value !== null && value !== undefined)).toString();
}

/** Returns the fields of a fragment, with or without `#`. */
export function read(fragment) {
    const given = new URLSearchParams(fragment.replace(/^#/, ""));
    const fields = {};
    for (const name of NAMES) {
        const value = given.get(name);
        if (value && /^\w{1,64}$/.test(value)) fields[name] = value;
    }
    for (const name of ["capacity", "k"]) {
        const value = Number(given.get(name));
        if (Number.isInteger(value) && value > 0) fields[name] = value;
    }
    const size = /^(\d{1,4})x(\d{1,4})$/.exec(given.get("size") ?? "")?.slice(1).map(Number);
    if (isSize(size)) fields.size = size;
    const camera = (given.get("camera") ?? "").split(",").map(Number);
    const [azimuth, elevation, zoom] = camera;
    const isCamera = given.has("camera") && camera.length === 3 && camera.every(Number.isFinite);
    if (isCamera) fields.camera = limited({ azimuth, elevation, zoom });
    return fields;
}

/**
 * The values of a description's uniforms.
 *
 * Input: the uniforms that a description declares, values of before. Output: a value for each. Nothing here sends or shows one.
 */

/** @typedef {{ name: string, type: string, count?: number }} Uniform */

const COMPONENTS = { f32: 1, u32: 1, i32: 1, vec2: 2, vec3: 3, vec4: 4 };

/** The direction to the viewer in the first view of a scene. */
const VIEWER = [0.45, 0.37, 0.81];

/** Returns the number of components of a uniform. */
export function components({ type }) {
    return COMPONENTS[type] ?? 1;
}

/**
 * Returns a value for every uniform: the one of before if it has as many components, or one that shows something: half, the next whole
 * number, the direction to the viewer.
 * @param {Uniform[]} uniforms
 * @param {Record<string, number | number[]>} before
 */
export function uniformValues(uniforms, before) {
    return Object.fromEntries(
        uniforms.map((uniform, index) => [uniform.name, valueOf(uniform, index, uniforms, before[uniform.name])]),
    );
}

function valueOf(uniform, index, uniforms, before) {
    const number = components(uniform);
    if (before !== undefined && (Array.isArray(before) ? before.length : 1) === number) return before;
    if (number === 3) return [...VIEWER];
    if (number > 1) return Array(number).fill(0.5);
    if (uniform.type === "f32") return 0.5;
    return uniforms.slice(0, index).filter(({ type }) => type === uniform.type).length;
}

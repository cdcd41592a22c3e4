/**
 * The values of a description: k, and those of its uniforms.
 *
 * Input: what a description keeps and declares, values of before. Output: values that it has. Nothing here sends or shows one.
 */

/** @typedef {{ name: string, type: string, count?: number }} Uniform */

const COMPONENTS = { f32: 1, u32: 1, i32: 1, vec2: 2, vec3: 3, vec4: 4 };

/** The direction to the viewer in the first view of a scene. */
const VIEWER = [0.45, 0.37, 0.81];

/**
 * Returns the values with which a description is drawn: those of the state as far as it has them.
 * @param {{ keep: { k: number, capacity: number } | null, uniforms: Uniform[] }} description
 * @param {{ k: number | null, uniforms: Record<string, number | number[]> }} state
 */
export function valuesOf({ keep, uniforms }, state) {
    const k = keep && Math.min(state.k ?? keep.k, keep.capacity);
    return { k, uniforms: uniformValues(uniforms, state.uniforms) };
}

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
    const fits = number === 1 ? Number.isFinite(before) : Array.isArray(before) && before.length === number;
    if (fits) return before;
    if (number === 3) return [...VIEWER];
    if (number > 1) return Array(number).fill(0.5);
    if (uniform.type === "f32") return 0.5;
    return uniforms.slice(0, index).filter(({ type }) => type === uniform.type).length;
}

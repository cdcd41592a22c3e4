/**
 * The state of the page: what a link holds, and who is told when it changes.
 *
 * Input: changes. Output: calls of the listeners, with what changed. The state is plain data; nothing here knows the elements of the page.
 */

/**
 * @typedef {object} State
 * @property {string} text the description
 * @property {string} scene `NAME`, with `,parameter=value` for every parameter that differs from its default
 * @property {{ azimuth: number, elevation: number, zoom: number } | null} camera null until it moves
 * @property {number | null} k null: as many as the description keeps
 * @property {Record<string, number | number[]>} uniforms
 * @property {[number, number]} size of the picture, in pixels
 * @property {string} device
 */

/** The least and the greatest side of a picture: the server's CPU device draws the largest in seconds. */
export const SIDES = [16, 2048];

/** Returns whether a value that anybody may have written is a size of a picture. */
export function isSize(value) {
    const isSide = (side) => Number.isInteger(side) && side >= SIDES[0] && side <= SIDES[1];
    return Array.isArray(value) && value.length === 2 && value.every(isSide);
}

/** The state of a page that is opened without a link. */
export const INITIAL = Object.freeze({
    text: "",
    scene: "",
    camera: null,
    k: null,
    uniforms: {},
    size: [480, 360],
    device: "auto",
});

/**
 * Creates the store. Listeners are called with the state and the names of what changed.
 * @param {State} initial
 */
export function createStore(initial) {
    let state = initial;
    /** @type {Set<(state: State, changed: Set<string>) => void>} */
    const listeners = new Set();
    return {
        /** @returns {State} */
        get value() {
            return state;
        },
        /** @param {Partial<State>} changes */
        set(changes) {
            const changed = new Set(Object.keys(changes).filter((name) => !same(state[name], changes[name])));
            if (changed.size === 0) return;
            state = { ...state, ...changes };
            for (const listener of listeners) listener(state, changed);
        },
        subscribe(listener) {
            listeners.add(listener);
        },
    };
}

function same(left, right) {
    return left === right || JSON.stringify(left) === JSON.stringify(right);
}

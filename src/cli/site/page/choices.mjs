/**
 * The variants of a technique as a person chooses among them: the largest k, the sort, and the overflow.
 *
 * Input: the technique with its variants, and choices. Output: the variant of the choices, and for every other value of an axis whether it
 * is legal beside the others, with the reason if it is not. Nothing here shows anything.
 */

/** The axes, with what they mean. */
const AXES = [
    ["capacity", "the largest k of the passes"],
    ["sort", "how the fragments of a pixel are sorted"],
    ["overflow", "what happens to a fragment that is not kept"],
];

/** The fields of the state that choose a variant. */
export const CHOSEN = AXES.map(([axis]) => axis);

/** Returns the variant of these choices; undefined if there is none. */
export function variantOf({ variants }, choices) {
    return variants.find((variant) => CHOSEN.every((axis) => String(variant[axis]) === String(choices[axis])));
}

/** Returns the given choices if a variant has them, with those that are not given, or not legal, from the technique. */
export function legal(technique, given) {
    const { usual = {} } = technique;
    const known = Object.fromEntries(CHOSEN.map((axis) => [axis, usual[axis] === null ? null : (given[axis] ?? usual[axis] ?? null)]));
    // The last axes give way first.
    const tries = CHOSEN.map((_, index) => Object.fromEntries(CHOSEN.map((axis, at) => [axis, at < CHOSEN.length - index ? known[axis] : usual[axis]])));
    return tries.find((choices) => variantOf(technique, choices)?.text) ?? { ...usual };
}

/** Returns the axes with their values, in the form of the playground's table of axes. An edit is the change of the choices. */
export function axes(technique, choices) {
    const { reasons = [], sorts = [], overflows = [], capacities = [] } = technique;
    const kept = capacities.filter((capacity) => capacity !== null).map((capacity) => ({ key: String(capacity), summary: `passes for k up to ${capacity}` }));
    const lists = { capacity: kept, sort: sorts, overflow: overflows };
    return AXES.filter(([axis]) => lists[axis].length > 0).map(([axis, meaning]) => ({
        axis,
        meaning,
        value: String(choices[axis]),
        values: lists[axis].map(({ key, summary }) => {
            const change = { [axis]: axis === "capacity" ? Number(key) : key };
            const variant = variantOf(technique, { ...choices, ...change });
            const illegal = variant?.text ? null : (reasons[variant?.reason] ?? "This site has no passes for it.");
            return { key, summary, current: key === String(choices[axis]), illegal, edits: [change] };
        }),
    }));
}

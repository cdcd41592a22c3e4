/**
 * The host functions of a manifest. Each takes the words that its step reads, and returns the values of the symbols that it sets.
 * @module
 */
import { ExcessError } from "./errors.mjs";

/** @typedef {import("./plan.mjs").Values} Values */

/** @type {Record<string, (words: Uint32Array, values: Values) => number[]>} */
const FUNCTIONS = {
    /** The symbols are the numbers read. */
    allocate: (words) => [...words],

    /** The least k that keeps the wanted part of the fragments, or the greatest whose buffers fit into the budget. */
    predict_k(words, values) {
        const pixels = words.subarray(0, 1024);
        const kept = (k) => pixels.reduce((sum, count, index) => sum + Math.min(index + 1, k) * count, 0);
        const fragments = kept(Infinity) + (words[1024] ?? 0);
        const most = Math.min(values.symbol("capacity"), values.symbol("keep"), 1024);
        const budgeted = withinBudget(values, most, (k) => ({ k, kept: kept(k), fragments }));
        const isEnough = (k) => kept(k) * 100 >= fragments * values.symbol("HIT_PERCENT");
        return [Math.min(first(budgeted, isEnough), budgeted)];
    },

    /** The greatest k whose buffers fit into the budget, where a pixel of importance i keeps ⌈i · k / 255⌉ fragments and one at least. */
    share_k(words, values) {
        const capacity = values.symbol("capacity");
        const slots = (importance, k) => Math.max(1, Math.ceil((importance * k) / 255));
        const keptOf = (k) => (sum, pixels, at) =>
            sum + pixels * Math.min((at % capacity) + 1, slots(Math.floor(at / capacity), k));
        const kept = (k) => words.reduce(keptOf(k), 0);
        const most = Math.min(capacity, values.symbol("keep"));
        const budgeted = withinBudget(values, most, (k) => ({ k, kept: kept(k) }));
        // A smaller k with the same sum gives the same image.
        return [first(budgeted, (k) => kept(k) === kept(budgeted))];
    },
};

/** Calls the function of a host step. Returns the symbols that it sets, with their values. */
export function decide(step, words, values) {
    const call = Object.hasOwn(FUNCTIONS, step.function) ? FUNCTIONS[step.function] : undefined;
    if (!call) throw new Error(`the manifest calls the host function \`${step.function}\`: use the package of its version`);
    const results = call(words, values);
    return step.sets.map((name, index) => {
        const { least, most } = values.plan.declared.get(name);
        if (results[index] < least || results[index] > most) {
            throw new Error(
                `the host function \`${step.function}\` sets \`${name}\` to ${results[index]}, which is not from ${least} to ${most}: ` +
                    `set it yourself with \`symbols: { ${name}: … }\``,
            );
        }
        return [name, results[index]];
    });
}

/** Returns the greatest k from 1 to `most` whose buffers fit into the description's budget. */
function withinBudget(values, most, assumed) {
    const budget = values.symbol("BUDGET_MIB") * 2 ** 20;
    const exceeds = (k) => values.bytesWith(assumed(k)) > budget;
    const k = first(most, exceeds) - 1;
    if (k === 0) {
        throw new ExcessError(
            `one fragment per pixel needs ${values.bytesWith(assumed(1))} bytes, and the budget of \`allocation\` is ${budget}: ` +
                "raise it in the description, or draw a smaller frame or lower slices (`rows`)",
        );
    }
    return k;
}

/** Returns the first number from 1 to `end` that holds, or `end + 1`. No number may fail after one that holds. */
function first(end, holds) {
    let [low, high] = [1, end + 1];
    while (low < high) {
        const middle = Math.floor((low + high) / 2);
        if (holds(middle)) high = middle;
        else low = middle + 1;
    }
    return low;
}

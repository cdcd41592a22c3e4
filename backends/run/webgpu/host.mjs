/**
 * The host functions of a manifest, and the values that they set for later frames. A host function takes the words that its step reads, and
 * returns the values of the symbols that it sets.
 * @module
 */
import { ExcessError } from "./errors.mjs";

/** @typedef {import("./plan.mjs").Values} Values */

/** The frames whose greatest value a symbol that lags has. So it grows with the next frame, and shrinks after as many frames. */
const LAG_FRAMES = 8;

/** The greatest number of frames whose words are copied and not used yet. Further frames copy none. */
const MOST_COPIES = 4;

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

/** Adds values to a map, which has the greatest value of each name. */
export function raise(greatest, decided) {
    for (const [name, value] of decided) greatest.set(name, Math.max(greatest.get(name) ?? value, value));
}

/**
 * The values of host steps that take effect in a later frame. A frame decides a value in each of its slices, and the greatest one counts
 * once the frame has ended: a slice with less memory than it needs loses fragments.
 */
export class LaggedValues {
    /**
     * @param {ReturnType<typeof import("./plan.mjs").planOf>} plan
     * @param {string} readback The option `readback`.
     */
    constructor(plan, readback) {
        const steps = readback === "lag" ? plan.steps.filter((step) => step.may_lag) : [];
        /** The values of the last frames, by symbol. @type {Map<string, number[]>} */
        this.history = new Map(steps.flatMap((step) => step.sets).map((name) => [name, []]));
        /** The copied words of each frame. @type {{ step: object, words?: Uint32Array, isLost: boolean }[][]} */
        this.frames = [];
    }

    /** Whether no frame waits for a step: an earlier frame has decided every symbol that it sets. */
    covers(step) {
        return Boolean(step.may_lag) && step.sets.every((name) => this.history.get(name)?.length > 0);
    }

    /** Whether the next frame copies words: a device that is some frames behind has enough of them. */
    get copiesWords() {
        return this.frames.length < MOST_COPIES;
    }

    /** Stores the copies of a frame. */
    store(copies) {
        if (copies.length > 0) this.frames.push(copies);
    }

    /** Stores the greatest values of a frame that has ended. */
    remember(greatest) {
        for (const [name, value] of greatest) {
            const values = this.history.get(name);
            if (values) this.history.set(name, [...values, value].slice(-LAG_FRAMES));
        }
    }

    /** Decides from the words of every frame that has all of them. */
    decideArrived(values) {
        const { frames } = this;
        this.frames = frames.filter((copies) => copies.some(({ words, isLost }) => !words && !isLost));
        for (const copies of frames.filter((copies) => copies.every(({ words }) => words))) {
            const greatest = new Map();
            for (const { step, words } of copies) raise(greatest, decide(step, words, values));
            this.remember(greatest);
        }
    }

    /** Returns the symbols with the values of the next frame. */
    get current() {
        const decided = [...this.history].filter(([, values]) => values.length > 0);
        return decided.map(([name, values]) => [name, Math.max(...values)]);
    }
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

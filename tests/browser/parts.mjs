// Checks the parts of the WebGPU host that compute: formulas, host functions, what is used before k is set, slots of uniform blocks.
import { strict as assert } from "node:assert";

import { evaluate } from "../../backends/run/webgpu/formula.mjs";
import { decide } from "../../backends/run/webgpu/host.mjs";
import { UniformSlots } from "../../backends/run/webgpu/memory.mjs";
import { planOf, SCHEMA } from "../../backends/run/webgpu/plan.mjs";
import { adapter as open } from "./adapter.mjs";

const fails = (run, part) => assert.throws(run, (error) => error.message.includes(part) || assert.fail(error.message));

// Formulas.
const symbol = (name) => ({ width: 7, k: 3 })[name] ?? assert.fail(name);
const formulas = { "2 + 3 * width": 23, "(2 + 3) * k - 1": 14, "7 / 2 / 2": 1, "ceil_div(width, 2)": 4, "min(k, width) + max(1, 2)": 5,
    "pow2(k) - 1": 7, "log2_ceil(width)": 3, "log2_ceil(8)": 3, "log2_ceil(1)": 0, "4294967295 * 2": 8589934590, "10 - 2 - 3": 5 };
for (const [formula, value] of Object.entries(formulas)) assert.equal(evaluate(formula, symbol), value, formula);
for (const wrong of ["", "2 +", "(1", "min(1)", "pow(2)", "1 2", "alert(1)", "a.b", "constructor(1)", "+1"]) fails(() => evaluate(wrong, () => 1), "malformed");
fails(() => evaluate("1 - 2", symbol), "-1");
fails(() => evaluate("1 / 0", symbol), "NaN");
fails(() => evaluate("pow2(60)", symbol), "smaller frame");

/** Returns what a host function sets `k` to, if `fragments` kept fragments fill the budget of 1 MiB. */
const decided = (name, words, fragments, symbols) => {
    const values = {
        plan: { declared: new Map([["k", { least: 1, most: 1024 }]]) },
        symbol: (name) => ({ BUDGET_MIB: 1, ...symbols })[name] ?? assert.fail(name),
        bytesWith: ({ kept }) => Math.floor((kept * 2 ** 20) / fragments),
    };
    return decide({ function: name, sets: ["k"] }, new Uint32Array(words), values)[0][1];
};

// Pixels with 1, 1, 1, 1, 2, 2, 5 and 9 fragments, 22 in all: 8 of them are kept by k = 1, then 12, 14, 16, 18, 19, …, 22.
const histogram = new Array(1025).fill(0);
Object.assign(histogram, { 0: 4, 1: 2, 4: 1, 8: 1 });
const predicted = (percent, fragments, keep = 16) => decided("predict_k", histogram, fragments, { HIT_PERCENT: percent, capacity: 16, keep });
assert.deepEqual([1, 36, 37, 50, 60, 70, 82, 100].map((percent) => predicted(percent, 99)), [1, 1, 2, 2, 3, 4, 6, 9]);
assert.deepEqual([8, 11, 12, 15, 16, 21, 22].map((fragments) => predicted(100, fragments)), [1, 1, 2, 3, 4, 8, 9]);
assert.equal(predicted(100, 99, 3), 3);
fails(() => predicted(100, 7), "one fragment per pixel needs");
// The fragments beyond the 1024th of their pixels are never kept.
assert.equal(decided("predict_k", [1, ...new Array(1023).fill(0), 99], 99, { HIT_PERCENT: 100, capacity: 4, keep: 4 }), 4);

// Four pixels of full importance with 1, 2, 3 and 4 fragments; one of a third with 4; one of none with 2. They keep 6, 9, 11, and 13.
const pixels = new Array(256 * 4).fill(0);
pixels.fill(1, 255 * 4);
Object.assign(pixels, { 1: 1, [85 * 4 + 3]: 1 });
const shared = (fragments, keep = 4) => decided("share_k", pixels, fragments, { capacity: 4, keep });
assert.deepEqual([6, 8, 9, 12, 13, 99].map((fragments) => shared(fragments)), [1, 1, 2, 3, 4, 4]);
assert.equal(shared(99, 3), 3);
fails(() => shared(5), "one fragment per pixel needs");
fails(() => decide({ function: "guess", sets: [] }, [], {}), "`guess`");

// What is used before k is set, or in a loop around that step, and what is exchanged with it.
const pass = (...names) => ({ do: "pass", uses: Object.fromEntries(names.map((name) => [name, "plain"])) });
const decision = { do: "host", function: "predict_k", sets: ["k"], reads: [] };
const used = (steps, exchanges = []) => {
    const files = [{ target: "wgsl", pass: "a", path: "a.wgsl", stage: "compute" }];
    return [...planOf({ schema: SCHEMA, files, alternatives: [], symbols: [], exchanges, steps }).usedBeforeK].sort();
};
assert.deepEqual(used([pass("a"), { do: "clear", resource: "b" }, decision, pass("c")]), ["a", "b"]);
assert.deepEqual(used([{ do: "copy", from: "a", to: "b" }, decision, pass("c")], [{ resources: ["d", "b"] }]), ["a", "b", "d"]);
assert.deepEqual(used([{ do: "loop", end: 3 }, decision, pass("a"), { do: "loop_end" }, pass("b")]), ["a"]);
assert.deepEqual(used([pass("a"), pass("b")]), []);

// Slots: equal words share one, and a buffer that grows has the words of all blocks of a pass.
const device = await (await open()).requestDevice();
const slots = new UniformSlots(device, [{ bytes: 16 }, { bytes: 64 }]);
const block = (number) => new Uint32Array([number, 0, 0, 0]);
slots.begin();
assert.equal(slots.offsets([block(0)])[0], slots.offsets([block(0)])[0]);
for (let number = 0; number < 40; number++) {
    const [first, second] = slots.offsets([block(2 * number), block(2 * number + 1)]);
    assert.deepEqual(slots.offsets([block(2 * number), block(2 * number + 1)]), [first, second]);
    assert.notEqual(first, second);
    assert(Math.max(first, second) + 64 <= slots.buffer.size);
}
// Slots of old frames are written again, so that the buffer stays.
const { version } = slots;
for (let frame = 0; frame < 500; frame++) {
    slots.begin();
    slots.offsets([block(1000 + frame), block(2000 + frame)]);
}
assert.equal(slots.version, version);
console.log("the parts are right");
process.exit(0);

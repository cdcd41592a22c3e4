/**
 * Checks the times of passes: `node times.mjs FOLDER`. The folder has generated plans: `list`, and `peeling` with a
 * loop. The calls of the host for its device are recorded, and the same timestamps are read and summed a second time.
 */
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { strict as assert } from "node:assert";

import { FragmentBuffer, requirements } from "../../backends/run/webgpu/fragbuf.mjs";
import { Readback } from "../../backends/run/webgpu/readback.mjs";
import { Timestamps } from "../../backends/run/webgpu/times.mjs";
import { adapter as open } from "./adapter.mjs";

const folder = process.argv[2];
const read = (path) => readFileSync(join(folder, path), "utf8");
const manifest = (plan) => JSON.parse(read(`${plan}/manifest.json`));
const adapter = await open();
const size = [8, 6];
const options = { size, format: "rgba8unorm", onLoss: () => {} };

// The feature is requested where it is wanted and the adapter has it.
const FEATURE = "timestamp-query";
const asked = (times, features = adapter.features) =>
    requirements(manifest("list"), { limits: adapter.limits, features }, { size, times }).requiredFeatures;
assert(adapter.features.has(FEATURE), "SwiftShader has timestamps");
assert.deepEqual([asked(true), asked(false), asked(undefined), asked(true, new Set())], [[FEATURE], [], [], []]);

/** Opens a device that records query sets and the passes of its encoders. */
async function recorded(requiredFeatures) {
    // An adapter has one device.
    const device = await (await open()).requestDevice({ requiredFeatures });
    const log = { sets: [], passes: [], uncaptured: [] };
    device.addEventListener("uncapturederror", ({ error }) => log.uncaptured.push(error.message));
    const { createQuerySet, createCommandEncoder } = device;
    device.createQuerySet = (descriptor) => {
        const set = createQuerySet.call(device, descriptor);
        log.sets.push({ type: descriptor.type, set });
        return set;
    };
    device.createCommandEncoder = (descriptor) => {
        const encoder = createCommandEncoder.call(device, descriptor);
        for (const name of ["beginRenderPass", "beginComputePass"]) {
            const begin = encoder[name];
            encoder[name] = (pass) => {
                log.passes.push(pass);
                return begin.call(encoder, pass);
            };
        }
        return encoder;
    };
    const corners = [[-1, -1], [1, -1], [-1, 1], [-1, 1], [1, -1], [1, 1]];
    // Two layers: peeling repeats its passes.
    const layer = (depth) => corners.flatMap(([x, y]) => [x, y, depth, 1, 0, 0, 0.5]);
    const vertices = new Float32Array([0.5, 0.25].flatMap(layer));
    const usage = GPUBufferUsage.VERTEX | GPUBufferUsage.COPY_DST;
    const mesh = device.createBuffer({ size: vertices.byteLength, usage });
    device.queue.writeBuffer(mesh, 0, vertices);
    const target = device.createTexture({ size, format: "rgba8unorm", usage: GPUTextureUsage.RENDER_ATTACHMENT });
    const call = {
        target,
        viewProjection: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
        draw(pass) {
            pass.setVertexBuffer(0, mesh);
            pass.draw(12);
        },
    };
    const create = (plan, more) =>
        FragmentBuffer.create(device, manifest(plan), (path) => read(`${plan}/${path}`), { ...options, ...more });
    return { device, log, call, create };
}

/** Returns the milliseconds by pass of the recorded passes, from the timestamps in a set. */
async function expected(device, set, passes) {
    const readback = new Readback(device);
    const usage = GPUBufferUsage.QUERY_RESOLVE | GPUBufferUsage.COPY_SRC;
    const resolved = device.createBuffer({ size: 8 * 4096, usage });
    const resolve = (encoder) => encoder.resolveQuerySet(set, 0, 4096, resolved, 0);
    const words = await readback.first(resolved, 8 * 4096, resolve);
    const timestamps = new BigUint64Array(words.buffer);
    const sums = {};
    for (const { label, timestampWrites } of passes) {
        const { beginningOfPassWriteIndex: begin, endOfPassWriteIndex: end } = timestampWrites;
        sums[label] = (sums[label] ?? 0) + Math.max(Number(timestamps[end] - timestamps[begin]), 0) / 1e6;
    }
    return sums;
}

const timed = await recorded([FEATURE]);
const { log, call } = timed;
const names = (plan) => new Set(manifest(plan).steps.flatMap((step) => (step.do === "pass" ? [step.pass] : [])));
const timestampSets = () => log.sets.filter(({ type }) => type === "timestamp").map(({ set }) => set);
/** The passes of the plan in the log; clears without draws are none. */
const runs = (plan) => log.passes.filter(({ label }) => names(plan).has(label));

for (const [plan, more] of [["list", {}], ["list", { rows: 2 }], ["list", { readback: "none" }], ["peeling", {}]]) {
    const buffer = await timed.create(plan, { ...more, times: true });
    const set = timestampSets().at(-1);
    assert.deepEqual(await buffer.times(), { passes: {}, unmeasured: 0, reason: null });
    for (let frame = 0; frame < 2; frame++) {
        log.passes.length = 0;
        if (more.readback === "none") {
            const encoder = timed.device.createCommandEncoder();
            buffer.encode(encoder, call);
            timed.device.queue.submit([encoder.finish()]);
        } else {
            const rendered = buffer.render(call);
            await assert.rejects(buffer.times(), /a frame is still being drawn: await `render`/);
            await rendered;
        }
        const { passes, unmeasured, reason } = await buffer.times();
        assert.deepEqual([unmeasured, reason], [0, null]);
        assert.deepEqual(new Set(Object.keys(passes)), names(plan));
        for (const [name, ms] of Object.entries(passes)) assert(Number.isFinite(ms) && ms >= 0, `${name}: ${ms}`);
        // Every run has queries of its own, and the runs of a pass are summed.
        const indices = runs(plan).flatMap(({ timestampWrites: writes }) => [
            writes.beginningOfPassWriteIndex,
            writes.endOfPassWriteIndex,
        ]);
        assert.equal(new Set(indices).size, indices.length);
        assert.deepEqual(passes, await expected(timed.device, set, runs(plan)));
        const isRepeated = plan === "peeling" || more.rows === 2;
        assert.equal(runs(plan).length > names(plan).size, isRepeated, `${plan}: ${runs(plan).length} runs`);
        // They can be read again.
        assert.deepEqual((await buffer.times()).passes, passes);
    }
    // A frame that failed has no times.
    const failing = { ...call, draw: () => assert.fail("the mesh is not loaded") };
    const failed = async () => {
        if (more.readback !== "none") return buffer.render(failing);
        buffer.encode(timed.device.createCommandEncoder(), failing);
    };
    await assert.rejects(failed, /the mesh is not loaded/);
    assert.deepEqual((await buffer.times()).passes, {});
    buffer.destroy();
    await assert.rejects(buffer.times(), /it was destroyed/);
}

// Without the request nothing is allocated or written, and a caller who reads times is told how to get them.
const sets = timestampSets().length;
log.passes.length = 0;
for (const times of [undefined, false]) {
    const untimed = await timed.create("list", { times });
    await untimed.render(call);
    await assert.rejects(untimed.times(), /create the fragment buffer with `times: true`/);
}
assert.equal(timestampSets().length, sets);
assert(log.passes.length > 0 && log.passes.every(({ timestampWrites }) => timestampWrites === undefined));
await assert.rejects(timed.create("list", { times: "passes" }), /`times` is "passes": pass true or false/);

// Without the feature frames are drawn, and the reason is reported.
const lacking = await recorded([]);
const buffer = await lacking.create("list", { times: true });
await buffer.render(lacking.call);
const { passes, unmeasured, reason } = await buffer.times();
assert.deepEqual([passes, unmeasured], [{}, lacking.log.passes.filter(({ label }) => names("list").has(label)).length]);
assert.match(reason, /lacks the feature `timestamp-query`: request it as `requirements` returns it for `times: true`/);
assert.deepEqual(lacking.log.sets, []);

// Passes beyond the queries of a set are counted.
const many = new Timestamps(timed.device);
const encoder = timed.device.createCommandEncoder();
for (let pass = 0; pass < 2050; pass++) {
    const timestampWrites = many.writes(pass < 2000 ? "first" : "second");
    assert.equal(timestampWrites === undefined, pass >= 2048);
    encoder.beginComputePass({ timestampWrites }).end();
}
timed.device.queue.submit([encoder.finish()]);
many.end();
const counted = await many.read(new Readback(timed.device));
assert.deepEqual([Object.keys(counted.passes), counted.unmeasured, counted.reason], [["first", "second"], 2, null]);

assert.deepEqual([...log.uncaptured, ...lacking.log.uncaptured], []);
console.log("the times are right");
process.exit(0);

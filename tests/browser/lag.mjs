/**
 * Checks decisions of host steps that lag: `node lag.mjs FOLDER`. The folder has the generated plan `predicted`, whose host step sets `k`
 * to the fragments of the deepest pixel. Slices of a frame need different ones.
 */
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { strict as assert } from "node:assert";

import { FragmentBuffer } from "../../backends/run/webgpu/fragbuf.mjs";
import { LaggedValues } from "../../backends/run/webgpu/host.mjs";
import { adapter as open } from "./adapter.mjs";

const folder = join(process.argv[2], "predicted");
const read = (path) => readFileSync(join(folder, path), "utf8");
const manifest = JSON.parse(read("manifest.json"));
const device = await (await open()).requestDevice();
const uncaptured = [];
device.addEventListener("uncapturederror", ({ error }) => uncaptured.push(error.message));

const size = [8, 6];
/** The rows of a slice. */
const ROWS = 2;
const ALPHA = 0.25;
const format = "rgba8unorm";
const target = device.createTexture({ size, format, usage: GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC });

/** The colours of the layers, the nearest first. Neighbours differ in every channel. */
const colour = (layer) => [0, 1, 2].map((channel) => ((layer >> channel) & 1 ? 0.1 : 0.9));

/** Returns the vertices of quads over the rows of each slice, as many as it has layers. The farthest are drawn first. */
function scene(layers) {
    const corners = [[0, 0], [1, 0], [0, 1], [0, 1], [1, 0], [1, 1]];
    const quad = (slice, layer) =>
        corners.flatMap(([x, y]) => {
            const row = ROWS * (slice + y);
            return [2 * x - 1, 1 - (2 * row) / size[1], (layer + 1) / 10, ...colour(layer), ALPHA];
        });
    return layers.flatMap((count, slice) => Array.from({ length: count }, (_, layer) => quad(slice, count - 1 - layer)).flat());
}

/** Returns the red, green and blue, from 0 to 255, of a pixel over black with this many layers. */
function blended(count) {
    const channels = [0, 0, 0];
    for (let layer = count - 1; layer >= 0; layer--) {
        colour(layer).forEach((value, index) => (channels[index] = ALPHA * value + (1 - ALPHA) * channels[index]));
    }
    return channels.map((value) => 255 * value);
}

/** Draws a frame whose slices have these numbers of layers. Returns its picture. */
async function draw(buffer, layers) {
    const vertices = new Float32Array(scene(layers));
    const usage = GPUBufferUsage.VERTEX | GPUBufferUsage.COPY_DST;
    const mesh = device.createBuffer({ size: vertices.byteLength, usage });
    device.queue.writeBuffer(mesh, 0, vertices);
    await buffer.render({
        target,
        clear: [0, 0, 0, 1],
        viewProjection: [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1],
        draw(pass) {
            pass.setVertexBuffer(0, mesh);
            pass.draw(vertices.length / 7);
        },
    });
    const staging = device.createBuffer({ size: 256 * size[1], usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
    const encoder = device.createCommandEncoder();
    encoder.copyTextureToBuffer({ texture: target }, { buffer: staging, bytesPerRow: 256 }, size);
    device.queue.submit([encoder.finish()]);
    await staging.mapAsync(GPUMapMode.READ);
    const bytes = new Uint8Array(staging.getMappedRange().slice(0));
    staging.destroy();
    mesh.destroy();
    // The words that host steps of the next frame use were copied before, and arrive before the counters.
    await buffer.counters();
    const pixel = (x, y) => [...bytes.slice(256 * y + 4 * x, 256 * y + 4 * x + 3)];
    return Array.from({ length: size[0] * size[1] }, (_, index) => pixel(index % size[0], Math.floor(index / size[0])));
}

/** Whether every pixel shows all layers of its slice. */
function isRight(picture, layers) {
    return picture.every((pixel, index) => {
        const slice = Math.floor(index / size[0] / ROWS);
        return blended(layers[slice]).every((value, channel) => Math.abs(value - pixel[channel]) <= 2);
    });
}

const create = (more) => FragmentBuffer.create(device, manifest, read, { size, format, onLoss() {}, readback: "lag", ...more });

// Every slice of the first frame waits for its own decision, and every slice of a later frame has the greatest of the frame before.
for (const layers of [[1, 4, 2], [4, 2, 1], [1, 2, 4], [2, 2, 2]]) {
    const buffer = await create({ rows: ROWS });
    assert.equal(buffer.slices, 3);
    for (let frame = 0; frame < 3; frame++) {
        assert(isRight(await draw(buffer, layers), layers), `frame ${frame} of ${layers}`);
        // The first frame ends with the decision of its last slice.
        assert.equal(buffer.symbol("k"), frame === 0 ? layers[2] : Math.max(...layers));
    }
    // After a change of the size, a frame waits again.
    await buffer.resize(size);
    const others = [3, 5, 1];
    for (let frame = 0; frame < 2; frame++) assert(isRight(await draw(buffer, others), others), `frame ${frame} after ${layers}`);
    buffer.destroy();
}

// k grows in a frame after the one that needs more, and shrinks once eight frames have needed less, however many slices they have.
for (const rows of [undefined, ROWS]) {
    const buffer = await create({ rows });
    const values = async (...scenes) => {
        const values = [];
        for (const layers of scenes) {
            await draw(buffer, layers);
            values.push(buffer.symbol("k"));
        }
        return values;
    };
    assert.deepEqual(await values([1, 1, 1], [1, 3, 2], [1, 3, 2]), [1, 1, 3]);
    const less = new Array(10).fill([2, 1, 1]);
    assert.deepEqual(await values(...less), [3, 3, 3, 3, 3, 3, 3, 3, 2, 2]);
    // A frame that needs more than it has loses fragments, and only that frame.
    assert(!isRight(await draw(buffer, [1, 5, 1]), [1, 5, 1]));
    assert(isRight(await draw(buffer, [1, 5, 1]), [1, 5, 1]));
    buffer.destroy();
}

// The words of a frame count once all of them are there, and four frames whose words are not there are enough.
const step = { do: "host", function: "allocate", sets: ["fragments"], may_lag: true };
const plan = { steps: [step, { do: "pass" }], declared: new Map([["fragments", { least: 0, most: 99 }]]) };
const lagged = new LaggedValues(plan, "lag");
assert(!lagged.covers(step));
lagged.remember(new Map([["fragments", 3], ["others", 5]]));
assert(lagged.covers(step) && !lagged.covers({ ...step, may_lag: undefined }) && !new LaggedValues(plan, "all").covers(step));
const copy = (words) => ({ step, words: words && new Uint32Array([words]), isLost: false });
const frames = [[copy(), copy(7)], [copy(4), copy(6)], [copy(), copy()], [copy(), copy()]];
for (const frame of frames) {
    assert(lagged.copiesWords);
    lagged.store(frame);
}
assert(!lagged.copiesWords);
lagged.decideArrived({ plan });
assert.deepEqual([lagged.current, lagged.frames.length], [[["fragments", 6]], 3]);
Object.assign(frames[0][0], copy(9));
frames[2][0].isLost = frames[2][1].isLost = true;
lagged.decideArrived({ plan });
assert.deepEqual([lagged.current, lagged.frames.length], [[["fragments", 9]], 1]);
assert.deepEqual(lagged.history.get("fragments"), [3, 6, 9]);

assert.deepEqual(uncaptured, []);
console.log("decisions that lag are right");
process.exit(0);

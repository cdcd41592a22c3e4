/**
 * Frames by WebGPU in the page. It follows the manifest of the portable WGSL passes, which `api.mjs` gives.
 *
 * Passes are generated again when the description changes, triangles when it or the scene does. The image is read back, because a page
 * that presents no canvas also works where the browser draws in software.
 */
import { api } from "./api.mjs";
import { orbit } from "./camera.mjs";
import { lit, parseGeometry } from "./geometry.mjs";
import { countsStored } from "./statistics.mjs";
import { scoped } from "./webgpu/errors.mjs";
import { FragmentBuffer } from "./webgpu/fragbuf.mjs";

/** Linear values are blended, and sRGB is stored. */
const FORMAT = "rgba8unorm-srgb";

/** The target of the passes, and the background, linear. */
const [TARGET, BACKGROUND] = ["wgsl", [1, 1, 1, 1]];

/** The limits that a device is asked for beyond their defaults, as far as the adapter has them. */
const LIMITS = [
    "maxBufferSize",
    "maxStorageBufferBindingSize",
    "maxStorageBuffersPerShaderStage",
    "maxColorAttachmentBytesPerSample",
];

export class WebGpuFrames {
    #device;
    /** What is on the device, and the parts of the request that it was made from. */
    #buffer = { key: null };
    #mesh = { key: null };
    #target = null;
    /** The last request that cannot be drawn, with the reason: a description without passes, or one whose memory does not fit. */
    #rejected = null;

    /** Opens a device; null if the browser has none. */
    static async open() {
        // Drivers that a browser does not trust have an adapter, and no device.
        const device = await openDevice().catch(() => null);
        if (!device) return null;
        const frames = new WebGpuFrames();
        frames.#device = device;
        device.lost.then(() => (frames.isLost = true));
        return frames;
    }

    /** Draws a request. Returns an image and the statistics of the frame. */
    async draw(request) {
        if (this.#rejected?.covers(request)) throw Object.assign(this.#rejected.error, { isLost: this.isLost });
        try {
            const mesh = await this.#meshOf(request);
            const buffer = await this.#bufferOf(request);
            const begin = performance.now();
            const { viewProjection, eye } = orbit(mesh.geometry, request.size[0] / request.size[1], request.camera);
            this.#light(mesh, eye);
            const report = await buffer.render({
                target: this.#target.texture,
                clear: BACKGROUND,
                viewProjection,
                uniforms: request.uniforms,
                objects: mesh.boxes,
                draw: (pass, { objects }) => draw(pass, mesh, objects),
            });
            const read = [this.#read(request.size), buffer.counters(), buffer.times()];
            const [image, { lost, counts }, timed] = await Promise.all(read);
            const times = { frame: performance.now() - begin };
            const { losses, counts_stored } = this.#buffer;
            const causes = losses.map((name) => [name, counts[name] ?? 0]);
            const sum = { total: lost, by_counter: Object.fromEntries(causes) };
            const bytes = buffer.allocatedBytes;
            const counted = { lost: sum, counts, counts_stored };
            return { image, statistics: { mode: "webgpu", times, timed, bytes, ...counted, ...report } };
        } catch (error) {
            this.#buffer.buffer?.destroy();
            this.#buffer = { key: null };
            throw Object.assign(error, { isLost: this.isLost });
        }
    }

    async #meshOf({ text, scene }) {
        const key = JSON.stringify([text, scene]);
        if (this.#mesh.key === key) return this.#mesh;
        const geometry = parseGeometry(await api.geometry({ text, scene }));
        const create = (bytes, usage) => {
            const size = Math.max(4, bytes);
            return scoped(this.#device, "the triangles", () =>
                this.#device.createBuffer({ size, usage: usage | GPUBufferUsage.COPY_DST }),
            );
        };
        const vertices = await create(geometry.vertices.byteLength, GPUBufferUsage.VERTEX);
        const indices = await create(geometry.indices.byteLength, GPUBufferUsage.INDEX);
        this.#device.queue.writeBuffer(indices, 0, geometry.indices);
        this.#mesh.vertices?.destroy();
        this.#mesh.indices?.destroy();
        // The buffer copies boxes to the device when it gets another array.
        const boxes = geometry.objects.map(({ box }) => box);
        return (this.#mesh = { key, geometry, boxes, vertices, indices, eye: null });
    }

    /** Lights the vertices from the eye. */
    #light(mesh, eye) {
        if (mesh.eye && eye.every((value, axis) => value === mesh.eye[axis])) return;
        mesh.eye = eye;
        this.#device.queue.writeBuffer(mesh.vertices, 0, lit(mesh.geometry, eye));
    }

    async #bufferOf(request) {
        const { text, size, k } = request;
        const symbols = k === null ? {} : { k };
        if (this.#buffer.key !== text) {
            const { manifest, files } = await this.#generated(text);
            const loadFile = (path) => files.find((file) => file.path === path).text;
            this.#buffer.buffer?.destroy();
            this.#buffer = { key: null };
            const options = { size, format: FORMAT, symbols, times: true, onLoss() {} };
            const buffer = await this.#remembered(request, async () => {
                await this.#resize(size);
                return FragmentBuffer.create(this.#device, manifest, loadFile, options);
            });
            const losses = manifest.counters.filter((counter) => counter.is_loss).map(({ name }) => name);
            this.#buffer = { key: text, buffer, size, k, losses, counts_stored: countsStored(manifest) };
        }
        const { buffer } = this.#buffer;
        await this.#remembered(request, async () => {
            if ((await this.#resize(size)) || String(this.#buffer.size) !== String(size)) await buffer.resize(size);
            if (k !== null && this.#buffer.k !== k) await buffer.setSymbols(symbols);
        });
        Object.assign(this.#buffer, { size, k });
        return buffer;
    }

    /** Runs what compiles and allocates. Remembers a failure, which the same description, size and k would repeat. */
    async #remembered({ text, size, k }, run) {
        try {
            return await run();
        } catch (error) {
            const key = JSON.stringify([text, size, k]);
            const covers = (request) => JSON.stringify([request.text, request.size, request.k]) === key;
            this.#rejected = { covers, error };
            throw error;
        }
    }

    /** Returns the passes of a description, and remembers one that has none. */
    async #generated(text) {
        try {
            return await api.generate({ text, target: TARGET, form: "program" });
        } catch (error) {
            if (error.status === 422) this.#rejected = { covers: (request) => request.text === text, error };
            throw error;
        }
    }

    /** Creates the texture of the image if its size has changed; returns whether it has. */
    async #resize(size) {
        if (this.#target && String(this.#target.size) === String(size)) return false;
        this.#target?.texture.destroy();
        this.#target?.staging.destroy();
        this.#target = null;
        const bytesPerRow = 256 * Math.ceil((4 * size[0]) / 256);
        const usage = GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC;
        const bytes = { size: bytesPerRow * size[1], usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST };
        const create = () => [this.#device.createTexture({ size, format: FORMAT, usage }), this.#device.createBuffer(bytes)];
        const [texture, staging] = await scoped(this.#device, "the image", create);
        this.#target = { size: [...size], texture, staging, bytesPerRow };
        return true;
    }

    async #read([width, height]) {
        const { texture, staging, bytesPerRow } = this.#target;
        const encoder = this.#device.createCommandEncoder();
        encoder.copyTextureToBuffer({ texture }, { buffer: staging, bytesPerRow }, [width, height]);
        this.#device.queue.submit([encoder.finish()]);
        await staging.mapAsync(GPUMapMode.READ);
        const mapped = new Uint8Array(staging.getMappedRange());
        const image = new ImageData(width, height);
        for (let row = 0; row < height; row++)
            image.data.set(mapped.subarray(row * bytesPerRow, row * bytesPerRow + 4 * width), 4 * row * width);
        staging.unmap();
        return image;
    }
}

/** Draws the objects with these numbers, or all of them. */
function draw(pass, { geometry, vertices, indices }, objects) {
    pass.setVertexBuffer(0, vertices);
    pass.setIndexBuffer(indices, "uint32");
    if (!objects) return pass.drawIndexed(geometry.indices.length);
    for (const number of objects) pass.drawIndexed(geometry.objects[number].count, 1, geometry.objects[number].first);
}

/** Opens a device with the limits and features of the adapter, or with the default ones. */
async function openDevice() {
    const adapter = await navigator.gpu?.requestAdapter();
    if (!adapter) return null;
    const requiredLimits = Object.fromEntries(LIMITS.map((name) => [name, adapter.limits[name]]));
    try {
        return await adapter.requestDevice({ requiredLimits, requiredFeatures: [...adapter.features] });
    } catch {
        // An adapter has one device: another adapter for the second.
        return (await navigator.gpu.requestAdapter())?.requestDevice();
    }
}

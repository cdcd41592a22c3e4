/**
 * Runs the passes that `fragbuf generate --target wgsl` writes, on your WebGPU device, as `manifest.json` specifies. You own the device,
 * the queue, the order of passes and the draw calls. This package has no dependencies, and knows no technique by its name.
 *
 * @example
 * const device = await adapter.requestDevice(requirements(manifest, adapter, { size }));
 * const buffer = await FragmentBuffer.create(device, manifest, loadFile, { size, format: "rgba8unorm" });
 * await buffer.render({ target: view, viewProjection, draw: (pass) => { pass.setVertexBuffer(0, mesh); pass.draw(36); } });
 * @module
 */
import { cameraWords, checkedDraw, checkedOptions, viewOf } from "./arguments.mjs";
import { Boxes, isDecidable } from "./boxes.mjs";
import { DeviceError, ExcessError, scoped } from "./errors.mjs";
import { Frame } from "./frame.mjs";
import { LaggedValues } from "./host.mjs";
import { Memory, UniformSlots } from "./memory.mjs";
import { compile, interleaved } from "./passes.mjs";
import { planOf, SCHEMA, Values } from "./plan.mjs";
import { MOST_QUERIES, Readback } from "./readback.mjs";
import { check, checkedSize, requirements } from "./requirements.mjs";
import { Timestamps } from "./times.mjs";
import { UniformBlock } from "./uniforms.mjs";

export { requirements, SCHEMA };

/** A fragment buffer on a device, for frames of one size. */
export class FragmentBuffer {
    #state;
    #device;
    #uniforms;
    #readback;
    /** Why no further frame can be drawn. */
    #end;
    /** The method that changes memory or draws, until it ends. */
    #running;
    /** Whether the device has rejected memory: it is allocated again before the next frame. */
    #isStale = false;
    #unread = false;

    /**
     * Compiles every pass and allocates memory.
     * @param {GPUDevice} device
     * @param {import("./fragbuf.d.ts").Manifest} manifest The parsed `manifest.json`.
     * @param {(path: string) => string | Promise<string>} loadFile Returns the text of a file; `path` is relative to `manifest.json`.
     * @param {import("./fragbuf.d.ts").Options} options
     * @returns {Promise<FragmentBuffer>}
     */
    static async create(device, manifest, loadFile, options) {
        if (typeof device?.createShaderModule !== "function") throw new Error("the first argument is no GPUDevice: pass that of `requestDevice`");
        if (typeof loadFile !== "function") throw new Error("`loadFile` is no function: pass one that returns the text of a file");
        const settings = checkedOptions(options);
        const plan = planOf(manifest);
        const counts = settings.readback === "all" || settings.readback === "lag";
        const values = new Values(plan, settings.size, { perPixel: settings.perPixel, counts });
        for (const [name, value] of Object.entries(settings.symbols)) values.assign(name, value);
        check(plan, values, device, settings.format, "device");
        const buffer = new FragmentBuffer();
        buffer.#device = device;
        FragmentBuffer.#closeWhenLost(device, buffer);
        const passes = await compile(device, plan, values, loadFile, settings);
        buffer.#assertOpen();
        buffer.#uniforms = new UniformBlock(plan.uniform_blocks.find((block) => block.name === "uniforms"));
        buffer.#readback = new Readback(device);
        const counted = plan.steps.flatMap((step) => (step.until?.no_samples ? [step.until.no_samples] : []));
        buffer.#state = {
            device, plan, values, passes, options: settings,
            memory: new Memory(device, plan),
            groups: new Map(),
            queries: { passes: [...new Set(counted)], count: 0 },
            flipped: plan.exchanges.map(() => false),
            apply: (decided) => buffer.#apply(decided),
            setRows: (rows) => buffer.#setRows(rows),
            copyOf: (encoder, reads) => buffer.#readback.copy(encoder, reads),
        };
        try {
            await buffer.#scoped("the uniform blocks, or the queries of `times`", () => {
                buffer.#state.slots = new UniformSlots(device, plan.uniform_blocks);
                if (settings.times) buffer.#state.timestamps = new Timestamps(device);
            });
            await buffer.#reallocate(settings.size, values.set);
        } catch (error) {
            buffer.#free();
            throw error;
        }
        return buffer;
    }

    /** Closes a fragment buffer when its device is lost. The device refers to it weakly, so that an unused one can be collected. */
    static #closeWhenLost(device, buffer) {
        const weak = new WeakRef(buffer);
        // Engines may keep every variable that a closure of the same function uses: no closure here uses `buffer`.
        device.lost.then(({ message }) => weak.deref()?.#close(`the device was lost (${message || "no reason given"})`));
    }

    /** The vertex buffer layout of passes that draw the scene, unless `vertexBuffers` replaces it: one vertex after the other. */
    get vertexLayout() {
        return interleaved(this.#state.plan);
    }

    /** The number of slices in which the frame is drawn, so that it fits into the device's limits and the budget. */
    get slices() {
        return Math.ceil(this.#state.size[1] / this.#state.rows);
    }

    /** Returns the value of a symbol: what was set, decided or computed. */
    symbol(name) {
        return this.#state.values.symbol(name);
    }

    /** The bytes of the plan's buffers and textures. */
    get allocatedBytes() {
        const { memory, values, plan } = this.#state;
        const textures = plan.resources.filter((resource) => memory.textures.has(resource.name));
        const whole = values.withRows(this.#state.size[1]);
        const texels = textures.reduce((sum, resource) => sum + whole.value(resource.bytes), 0);
        return [...memory.buffers.values()].reduce((sum, buffer) => sum + buffer.size, texels);
    }

    /** Resizes the frame to `[width, height]` pixels. External textures must be supplied again. */
    async resize(size) {
        await this.#alone("resize", async () => {
            await this.#reallocate(checkedSize(size), this.#state.values.set);
            this.#state.memory.external.clear();
        });
    }

    /** Sets symbols, such as `k`, from the next frame on. Reallocates memory where they need more or less. */
    async setSymbols(symbols) {
        await this.#alone("setSymbols", () => this.#setSymbols(symbols));
    }

    async #setSymbols(symbols) {
        const values = this.#state.values.withRows(this.#state.rows);
        values.set = new Map(values.set);
        for (const [name, value] of Object.entries(symbols)) values.assign(name, value);
        const isChanged = [...values.set].some(([name, value]) => this.#state.values.set.get(name) !== value);
        if (isChanged) await this.#reallocate(this.#state.size, values.set);
    }

    /**
     * Draws a frame, and submits it. Resolves once everything is submitted.
     * @param {import("./fragbuf.d.ts").Call} call
     * @returns {Promise<import("./fragbuf.d.ts").FrameReport>}
     */
    async render(call) {
        return this.#alone("render", () => this.#render(call));
    }

    async #render(call) {
        if (this.#isStale) await this.#reallocate(this.#state.size, this.#state.values.set);
        if (call?.symbols) await this.#setSymbols(call.symbols);
        let frame, run, answer;
        try {
            for (;;) {
                // Nothing waits before the first part of a frame is submitted: a texture of a canvas is usable until then.
                const { done, value } = await this.#scoped("the frame", () => {
                    if (!frame) {
                        this.#applyLagged();
                        frame = this.#begin(call);
                        run = frame.run();
                    }
                    const part = run.next(answer);
                    if (!part.done) this.#readback.record(frame.encoder, part.value);
                    this.#device.queue.submit([frame.encoder.finish()]);
                    return part;
                });
                if (done) break;
                answer = await this.#readback.read(value).catch((error) => this.#fail(error));
                frame.encoder = this.#device.createCommandEncoder({ label: `fragbuf ${this.#state.plan.name}` });
            }
        } catch (error) {
            frame?.abandon();
            throw error;
        }
        const { lagged, timestamps } = this.#state;
        lagged.remember(frame.decided);
        lagged.store(frame.copies.map(({ step, staging }) => this.#readback.arriving(step, staging)));
        this.#unread = true;
        timestamps?.end();
        this.#reportLosses();
        return { loops: frame.loops };
    }

    /**
     * Records a frame into your encoder, for `readback: "none"`: it waits for nothing. Submit the encoder before you record the next frame,
     * which reports the losses of this one.
     * @param {GPUCommandEncoder} encoder
     * @param {import("./fragbuf.d.ts").Call} call
     */
    encode(encoder, call) {
        this.#assertUsable();
        if (this.#state.options.readback !== "none") {
            throw new Error("this frame waits for the device: create the fragment buffer with `readback: \"none\"`, or call `render`");
        }
        if (call?.symbols) throw new Error("`encode` takes no symbols: call `setSymbols` before it");
        if (this.#unread) this.#reportLosses();
        const frame = this.#begin(call);
        frame.encoder = encoder;
        frame.run().next();
        this.#unread = true;
        this.#state.timestamps?.end();
    }

    /**
     * Reads the counters of the last submitted frame, summed over its slices.
     * @returns {Promise<import("./fragbuf.d.ts").Counters>}
     */
    async counters() {
        this.#assertOpen();
        const { counterStore, plan } = this.#state;
        this.#unread = false;
        const { bytes, slices, buffer } = counterStore;
        const words = await this.#readback.first(buffer, bytes * slices).catch((error) => this.#fail(error));
        const stride = bytes / 4;
        const counts = {};
        for (const { name, index } of plan.counters) {
            counts[name] = 0;
            for (let at = index; at < words.length; at += stride) counts[name] += words[at];
        }
        const lost = plan.counters.filter((counter) => counter.is_loss).reduce((sum, { name }) => sum + counts[name], 0);
        return { lost, counts };
    }

    /**
     * Reads the times of the passes of the last submitted frame, with `times: true`. No frame waits for them.
     * @returns {Promise<import("./fragbuf.d.ts").PassTimes>}
     */
    async times() {
        this.#assertUsable();
        const { timestamps } = this.#state;
        if (!timestamps) throw new Error("the passes are not measured: create the fragment buffer with `times: true`");
        return timestamps.read(this.#readback).catch((error) => this.#fail(error));
    }

    /** Frees all memory. The device stays yours. */
    destroy() {
        this.#close("it was destroyed");
        this.#free();
    }

    /** Frees what has been created so far. */
    #free() {
        const { memory, slots, queries, counterStore, boxes, timestamps } = this.#state;
        const owned = [memory, slots?.buffer, queries.set, counterStore?.buffer, boxes, timestamps, this.#readback];
        owned.forEach((object) => object?.destroy());
    }

    /** Checks the caller's arguments and prepares a frame. */
    #begin(call) {
        const { memory, plan, size, slots, options, queries } = this.#state;
        const hasBoxes = plan.steps.some((step) => step.objects === "boxes");
        const objects = hasBoxes && call?.objects?.length > 0 ? call.objects : undefined;
        const draw = checkedDraw(call);
        for (const [name, texture] of Object.entries(call.textures ?? {})) memory.supply(name, texture, size);
        plan.resources.filter((resource) => resource.init === "external").forEach((resource) => memory.texture(resource.name));
        slots.begin();
        this.#state.timestamps?.begin();
        if (objects) this.#setObjects(objects);
        const count = queries.passes.length + (objects?.length ?? 0);
        if (count > MOST_QUERIES) throw new Error(`${count} objects are more than ${MOST_QUERIES} queries: group several meshes into one object`);
        if (count > queries.count) {
            queries.set?.destroy();
            queries.set = this.#device.createQuerySet({ type: "occlusion", count });
            queries.count = count;
        }
        const camera = cameraWords(plan, call.viewProjection);
        return new Frame(this.#state, {
            draw,
            view: viewOf(call.target, size, options.format),
            clear: call.clear,
            camera,
            uniforms: this.#uniforms.words(call.uniforms ?? {}),
            objects,
            isDecidable: objects?.map((object) => isDecidable(object, camera, size)),
        });
    }

    #setObjects(objects) {
        if (objects === this.#state.boxes?.objects) return;
        this.#state.boxes?.destroy();
        this.#state.boxes = new Boxes(this.#device, objects, this.vertexLayout);
    }

    /** Allocates memory for another size or other symbols. After an error, the next frame has the former ones. */
    async #reallocate(size, set) {
        const { plan, memory, options } = this.#state;
        const values = new Values(plan, size, this.#state.values.reserve, set);
        check(plan, values, this.#device, options.format, "device");
        if (plan.whole_frame && options.rows < size[1]) {
            throw new Error(`\`rows\` is at least ${size[1]}, the rows of the frame: closures read images of the description at other pixels`);
        }
        const rows = Math.min(options.rows ?? memory.fittingRows(values, size, options.memory), size[1]);
        const sliced = values.withRows(rows);
        const excess = memory.excess(sliced, size[0], size[1], options.memory);
        if (excess) throw new ExcessError(excess);
        if (this.#isStale) memory.destroy();
        await this.#scoped("the memory of the frame", () => {
            memory.allocate(sliced, size);
            const bytes = memory.buffers.get("counters")?.size ?? 0;
            this.#state.counterStore?.buffer.destroy();
            const usage = GPUBufferUsage.COPY_SRC | GPUBufferUsage.COPY_DST;
            // Slices may become as low as one row.
            const descriptor = { label: "fragbuf all counters", size: Math.max(bytes, 4) * size[1], usage };
            this.#state.counterStore = { bytes, slices: 0, buffer: this.#device.createBuffer(descriptor) };
        });
        Object.assign(this.#state, { size, rows, values: sliced });
        this.#isStale = false;
        this.#state.lagged = new LaggedValues(plan, options.readback);
    }

    /** Sets what a host step has decided, and allocates memory for it. */
    #apply(decided) {
        const { values, memory, size, options } = this.#state;
        const former = values.decided;
        values.decided = new Map([...former, ...decided]);
        const excess = memory.excess(values, size[0], size[1], options.memory);
        if (excess) {
            values.decided = former;
            throw new ExcessError(excess);
        }
        memory.allocate(values, size);
    }

    /** Draws lower slices from now on. Memory for higher ones stays. */
    #setRows(rows) {
        const { values } = this.#state;
        Object.assign(this.#state, { rows, values: values.withRows(rows) });
    }

    /** Sets the symbols that lag to what earlier frames have decided: each to the greatest value that a slice of the last frames needed. */
    #applyLagged() {
        const { lagged, values } = this.#state;
        lagged.decideArrived(values);
        const { current } = lagged;
        if (current.every(([name, value]) => values.decided.get(name) === value)) return;
        for (;;) {
            try {
                return this.#apply(current);
            } catch (error) {
                if (!(error instanceof ExcessError) || this.#state.rows === 1 || this.#state.plan.whole_frame) throw error;
                this.#setRows(Math.ceil(this.#state.rows / 2));
            }
        }
    }

    /** Reads the counters and reports losses, without making the frame wait. */
    #reportLosses() {
        const report = (counters) => counters.lost > 0 && this.#state.options.onLoss(counters);
        // If the device is lost, the next call says so.
        this.counters().then(report, () => {});
    }

    /** Runs calls of WebGPU in error scopes, and throws what they report. */
    async #scoped(what, run) {
        try {
            const result = await scoped(this.#device, what, run);
            this.#assertOpen();
            return result;
        } catch (error) {
            this.#isStale ||= error instanceof DeviceError;
            throw error;
        }
    }

    #close(reason) {
        this.#end ??= reason;
    }

    /** Throws an error of the device, or why the device is lost. */
    async #fail(error) {
        const patience = new Promise((elapsed) => setTimeout(elapsed, 100));
        await Promise.race([this.#device.lost, patience]);
        this.#assertOpen();
        throw error;
    }

    #assertOpen() {
        if (this.#end) throw new Error(`this fragment buffer cannot be used: ${this.#end}. Create another one, on a new device if it is lost`);
    }

    #assertUsable() {
        this.#assertOpen();
        if (!this.#running) return;
        const what = this.#running === "render" ? "a frame is still being drawn" : "memory is still being allocated";
        throw new Error(`${what}: await \`${this.#running}\` before you call this fragment buffer again`);
    }

    /** Runs a method that changes memory or draws. Another one that begins meanwhile is an error. */
    async #alone(name, run) {
        this.#assertUsable();
        this.#running = name;
        try {
            return await run();
        } finally {
            this.#running = undefined;
        }
    }
}

/**
 * Records the steps of a frame: clears, copies, passes, loops, exchanges and host steps.
 *
 * A frame is a generator. It records into `encoder` and yields where the host must read words that the device computes; the caller
 * submits the encoder, reads them, sets a new encoder and resumes it with the words.
 * @module
 */
import { ExcessError } from "./errors.mjs";
import { decide, raise } from "./host.mjs";

/** One frame. */
export class Frame {
    /**
     * @param {object} state What the fragment buffer keeps between frames: device, plan, values, memory, passes, and so on.
     * @param {object} call The caller's arguments, checked.
     */
    constructor(state, call) {
        this.state = state;
        this.call = call;
        this.encoder = state.device.createCommandEncoder({ label: `fragbuf ${state.plan.name}` });
        this.isOutputWritten = false;
        /** Clears of textures that have not been recorded: the next pass with the texture as attachment begins with its clear. */
        this.clears = new Map();
        /** How loops with a condition ended. @type {import("./fragbuf.d.ts").LoopReport[]} */
        this.loops = [];
        /** Copies of the words of host steps that lag, of all slices. */
        this.copies = [];
        /** The greatest values that the slices have decided. @type {Map<string, number>} */
        this.decided = new Map();
        /** Whether host steps that lag copy their words. Either every slice does, or none. */
        this.copiesWords = state.lagged.copiesWords;
    }

    /** Records the frame, slice by slice. A slice whose fragments do not fit is drawn again, with half of its rows. */
    *run() {
        const { size, plan, memory, counterStore } = this.state;
        const base = this.state.flipped;
        let flipped = base;
        this.firstRow = 0;
        for (let slice = 0; this.firstRow < size[1]; ) {
            const { rows } = this.state;
            const copied = this.copies.length;
            try {
                yield* this.#slice();
            } catch (error) {
                if (!(error instanceof ExcessError) || rows === 1 || this.isSliceWritten || plan.whole_frame) throw error;
                this.state.setRows(Math.ceil(rows / 2));
                this.#dropCopies(copied);
                continue;
            }
            raise(this.decided, this.sliceDecided);
            flipped = plan.exchanges.map((pair, index) => this.#isOdd(pair) !== base[index]);
            // The next slice clears the counters.
            const { bytes, buffer } = counterStore;
            if (bytes > 0) this.encoder.copyBufferToBuffer(memory.buffers.get("counters"), 0, buffer, slice * bytes, bytes);
            this.firstRow += rows;
            counterStore.slices = ++slice;
        }
        this.state.flipped = flipped;
    }

    /** Drops the copies of a frame that is not drawn. */
    abandon() {
        this.#dropCopies(0);
    }

    #dropCopies(first) {
        this.copies.splice(first).forEach(({ staging }) => staging.destroy());
    }

    *#slice() {
        /** The loops around the step, the innermost last. */
        this.around = [];
        /** The finished iterations of each loop, by the index of its first step. */
        this.finished = new Map();
        /** The objects that queries have dropped, by the name of the query's pass. */
        this.dropped = new Map();
        /** The query of boxes whose result has not been read. */
        this.boxQuery = undefined;
        /** What host steps have decided in this slice. */
        this.sliceDecided = new Map();
        /** Whether the slice has written the caller's target. */
        this.isSliceWritten = false;
        const { steps } = this.state.plan;
        let at = 0;
        while (at < steps.length) {
            const next = yield* this.#step(steps[at], at);
            at = next ?? at + 1;
        }
    }

    /** Runs a step. Returns the index of the next one if it is not the following. */
    *#step(step, at) {
        switch (step.do) {
            case "clear":
                return this.#clear(step);
            case "copy":
                return this.#copy(step);
            case "pass":
                return yield* this.#pass(step);
            case "loop":
                if (this.#value(step.max_iterations) === 0) return step.end + 1;
                this.around.push({ begin: at, iteration: 0, most: this.#value(step.max_iterations) });
                return undefined;
            case "loop_end":
                return yield* this.#loopEnd(step);
            case "host":
                return yield* this.#host(step);
            default:
                throw new Error(`the manifest has the step \`${step.do}\`: use the package of its version`);
        }
    }

    get #iteration() {
        return this.around.at(-1)?.iteration ?? 0;
    }

    #value(formula) {
        return this.state.values.value(formula, { iteration: this.#iteration, first_row: this.firstRow });
    }

    #isOdd({ loops, odd }) {
        const finished = loops.reduce((sum, begin) => sum + (this.finished.get(begin) ?? 0), 0);
        return (finished + Number(odd)) % 2 === 1;
    }

    /** Returns the resource that a name means in this step: one of an exchanged pair means the other one. */
    #physical(name, step) {
        const { plan, flipped } = this.state;
        const index = plan.exchanges.findIndex((pair) => pair.resources.includes(name));
        if (index < 0) return name;
        const { resources } = plan.exchanges[index];
        const now = step.exchanged?.find((pair) => pair.resources[0] === resources[0]);
        const isSwapped = (now ? this.#isOdd(now) : false) !== flipped[index];
        return isSwapped ? resources[1 - resources.indexOf(name)] : name;
    }

    #clear(step) {
        const name = this.#physical(step.resource, step);
        if (step.texel) this.clears.set(name, step.texel);
        else this.state.memory.clear(this.encoder, name, step.value);
    }

    #copy(step) {
        const { memory } = this.state;
        const [from, to] = [this.#physical(step.from, step), this.#physical(step.to, step)];
        this.#clearNow(from);
        this.clears.delete(to);
        const texture = memory.texture(from);
        if (texture) {
            const { width, height } = texture;
            return this.encoder.copyTextureToTexture({ texture }, { texture: memory.texture(to) }, [width, height]);
        }
        const [source, target] = [memory.buffers.get(from), memory.buffers.get(to)];
        this.encoder.copyBufferToBuffer(source, 0, target, 0, Math.min(source.size, target.size));
    }

    *#pass(step) {
        const { passes, options } = this.state;
        const pass = passes.get(step);
        const { objects } = this.call;
        if (step.objects === "boxes" && (!objects || options.readback === "none")) return;
        if (step.kind === "compute") return this.#dispatch(pass, step);
        const query = step.objects?.visible_in;
        // The result of the last query decides what is drawn, and its numbers are used again.
        if ((query || step.objects === "boxes") && this.boxQuery) yield* this.#wait([]);
        const isDropped = (index) => this.dropped.get(query ?? step.pass)?.has(index);
        const visible = objects && (query || step.objects === "boxes") ? [...objects.keys()].filter((index) => !isDropped(index)) : null;
        this.#render(pass, step, visible);
    }

    #dispatch(pass, step) {
        const timestampWrites = this.state.timestamps?.writes(step.pass);
        const compute = this.encoder.beginComputePass({ label: step.pass, timestampWrites });
        compute.setPipeline(pass.pipelines.get(undefined));
        this.#bind(compute, pass, step);
        const indirect = this.#indirect(step);
        if (indirect) compute.dispatchWorkgroupsIndirect(indirect, 0);
        else compute.dispatchWorkgroups(...step.groups.map((groups) => this.#value(groups)));
        compute.end();
    }

    #render(pass, step, visible) {
        const { size, rows, boxes, queries, timestamps } = this.state;
        const queried = queries.passes.indexOf(step.pass);
        const isBoxes = step.objects === "boxes";
        const descriptor = this.#attachments(pass, step);
        descriptor.timestampWrites = timestamps?.writes(step.pass);
        if (queried >= 0 || isBoxes) descriptor.occlusionQuerySet = queries.set;
        const render = this.encoder.beginRenderPass(descriptor);
        const mask = step.state.samples && this.#value(step.state.samples.mask);
        render.setPipeline(pass.pipelines.get(mask));
        if (step.state.stencil) render.setStencilReference(this.#value(step.state.stencil.reference));
        this.#bind(render, pass, step);
        // There is no memory beyond the slice.
        render.setScissorRect(0, this.firstRow, size[0], Math.min(rows, size[1] - this.firstRow));
        if (queried >= 0) render.beginOcclusionQuery(queried);
        if (isBoxes) {
            for (let object = 0; object < this.call.objects.length; object++) {
                render.beginOcclusionQuery(queries.passes.length + object);
                if (visible.includes(object)) boxes.draw(render, object);
                render.endOcclusionQuery();
            }
            this.boxQuery = step.pass;
        } else if (step.kind === "geometry") {
            this.call.draw(render, { pass: step.pass, objects: visible });
        } else if (this.#indirect(step)) {
            render.drawIndirect(this.#indirect(step), 0);
        } else {
            render.draw(step.vertices);
        }
        if (queried >= 0) render.endOcclusionQuery();
        render.end();
    }

    #indirect(step) {
        const name = Object.keys(step.uses).find((name) => step.uses[name] === "indirect");
        return name && this.state.memory.buffers.get(this.#physical(name, step));
    }

    /** Sets the bind group of a pass, and the slots of its uniform blocks. */
    #bind(encoder, pass, step) {
        const { device, slots, memory, groups } = this.state;
        const blocks = pass.bindings.filter(({ block }) => block).map(({ block }) => this.#words(block));
        const offsets = slots.offsets(blocks);
        const version = `${memory.version} ${slots.version}`;
        if (groups.version !== version) groups.clear();
        groups.version = version;
        const names = pass.bindings.map(({ name }) => this.#physical(name, step));
        const key = `${step.pass}: ${names}`;
        if (!groups.has(key)) {
            const resource = ({ block, aspect }, index) => {
                if (block) return { buffer: slots.buffer, size: block.bytes };
                return memory.texture(names[index])?.createView({ aspect }) ?? { buffer: memory.buffers.get(names[index]) };
            };
            const entries = pass.bindings.map((one, index) => ({ binding: one.entry.binding, resource: resource(one, index) }));
            groups.set(key, device.createBindGroup({ label: `fragbuf ${step.pass}`, layout: pass.layout, entries }));
        }
        encoder.setBindGroup(pass.group, groups.get(key), offsets);
    }

    /** Returns the words of a uniform block in this step. */
    #words(block) {
        if (block.name === "camera") return this.call.camera;
        if (block.name === "uniforms") return this.call.uniforms;
        const words = new Uint32Array(block.bytes / 4);
        for (const { name, offset } of block.fields) {
            const value = this.#value(name);
            if (value > 0xffff_ffff) throw new Error(`\`${name}\` is ${value}, which exceeds 32 bits: use a smaller frame`);
            words[offset / 4] = value;
        }
        return words;
    }

    /** Returns the attachments of a pass. It begins with the pending clears of them. */
    #attachments(pass, step) {
        const { memory, size } = this.state;
        for (const name of Object.keys(step.uses).filter((name) => step.uses[name] === "sampled")) {
            this.#clearNow(this.#physical(name, step));
        }
        const { colors, depthStencil } = pass.attachments;
        const colorAttachments = colors.map((name) => {
            if (name !== "output") return this.#color(this.#physical(name, step));
            const clearValue = this.isOutputWritten ? undefined : this.call.clear;
            this.isOutputWritten = true;
            this.isSliceWritten = true;
            return { view: this.call.view(), loadOp: clearValue ? "clear" : "load", clearValue, storeOp: "store" };
        });
        if (colors.length === 0 && !depthStencil) {
            const view = memory.placeholder(pass.sampleCount, size);
            colorAttachments.push({ view, loadOp: "clear", storeOp: "discard" });
        }
        const descriptor = { label: step.pass, colorAttachments };
        if (depthStencil) {
            const isReadOnly = !step.state.stencil && step.state.depth?.write === false;
            descriptor.depthStencilAttachment = this.#depth(this.#physical(depthStencil, step), isReadOnly);
        }
        return descriptor;
    }

    #color(name) {
        const view = this.state.memory.texture(name).createView();
        const texel = this.clears.get(name);
        this.clears.delete(name);
        const clearValue = texel && [0, 1, 2, 3].map((channel) => texel[channel] ?? 0);
        return { view, loadOp: texel ? "clear" : "load", clearValue, storeOp: "store" };
    }

    #depth(name, isReadOnly) {
        const texture = this.state.memory.texture(name);
        const texel = this.clears.get(name);
        this.clears.delete(name);
        const hasStencil = texture.format.endsWith("stencil8");
        const view = texture.createView();
        // A shader may read a texture whose attachment is read-only.
        if (isReadOnly && !texel) return { view, depthReadOnly: true, ...(hasStencil && { stencilReadOnly: true }) };
        const loadOp = texel ? "clear" : "load";
        const depth = { depthLoadOp: loadOp, depthStoreOp: "store", depthClearValue: texel?.depth };
        const stencil = { stencilLoadOp: loadOp, stencilStoreOp: "store", stencilClearValue: texel?.stencil ?? 0 };
        return { view, ...depth, ...(hasStencil && stencil) };
    }

    /** Records the pending clear of a texture, if there is one, in a pass without draws. */
    #clearNow(name) {
        const texel = this.clears.get(name);
        if (!texel) return;
        const isColor = Array.isArray(texel);
        const colorAttachments = isColor ? [this.#color(name)] : [];
        const depthStencilAttachment = isColor ? undefined : this.#depth(name, false);
        this.encoder.beginRenderPass({ label: `clear ${name}`, colorAttachments, depthStencilAttachment }).end();
    }

    /** Ends an iteration. Returns the index of the next step if the loop continues. */
    *#loopEnd(step) {
        const loop = this.around.at(-1);
        const isKnown = this.state.options.readback !== "none";
        const isMet = step.until && isKnown && (yield* this.#isMet(step));
        loop.iteration++;
        this.finished.set(step.begin, (this.finished.get(step.begin) ?? 0) + 1);
        if (!isMet && loop.iteration < loop.most) return step.begin + 1;
        this.around.pop();
        if (step.until) this.loops.push({ until: step.until, iterations: loop.iteration, isMet: isKnown ? Boolean(isMet) : null });
        return undefined;
    }

    /** Whether the condition is met that ends a loop. */
    *#isMet(step) {
        const { memory, queries } = this.state;
        if (step.until.word_is_zero) {
            const buffer = memory.buffers.get(this.#physical(step.until.word_is_zero, step));
            const { words } = yield* this.#wait([{ buffer, offset: 0, size: 4 }]);
            return words[0] === 0;
        }
        const query = queries.passes.indexOf(step.until.no_samples);
        const { samples } = yield* this.#wait([], query);
        return samples[query] === 0;
    }

    /** Waits for words of buffers, and for the results of queries. */
    *#wait(reads, query = -1) {
        const { queries } = this.state;
        const isQueried = query >= 0 || this.boxQuery !== undefined;
        const { words, samples } = yield { reads, queries: isQueried ? queries : undefined };
        if (this.boxQuery !== undefined) {
            const dropped = this.dropped.get(this.boxQuery) ?? new Set();
            this.dropped.set(this.boxQuery, dropped);
            this.call.objects.forEach((_, object) => {
                const isHidden = samples[queries.passes.length + object] === 0;
                if (isHidden && this.call.isDecidable[object]) dropped.add(object);
            });
            this.boxQuery = undefined;
        }
        return { words, samples };
    }

    /** Runs a host step, or copies its words for a later frame if earlier frames have decided. */
    *#host(step) {
        const { values, lagged } = this.state;
        if (!values.reserve.counts || step.sets.some((name) => values.set.has(name))) return;
        const reads = step.reads.map(({ resource, first, count }) => {
            const buffer = this.state.memory.buffers.get(this.#physical(resource, step));
            return { buffer, offset: 4 * this.#value(first), size: 4 * this.#value(count) };
        });
        if (lagged.covers(step)) {
            if (this.copiesWords) this.copies.push({ step, staging: this.state.copyOf(this.encoder, reads) });
            return;
        }
        const { words } = yield* this.#wait(reads);
        const decided = decide(step, words, values);
        this.state.apply(decided);
        raise(this.sliceDecided, decided);
    }
}

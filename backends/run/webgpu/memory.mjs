/**
 * The buffers and textures of a plan, the rows of a slice that fit into the device's limits, and the uniform blocks.
 * @module
 */
import { ExcessError } from "./errors.mjs";

/** The bytes of a buffer that clears copy from. */
const PATTERN_BYTES = 2 ** 20;

/** The memory of one plan on a device. */
export class Memory {
    constructor(device, plan) {
        this.device = device;
        this.plan = plan;
        /** @type {Map<string, GPUBuffer>} */
        this.buffers = new Map();
        /** @type {Map<string, GPUTexture>} */
        this.textures = new Map();
        /** Textures that the caller supplies. @type {Map<string, GPUTexture>} */
        this.external = new Map();
        this.patterns = new Map();
        this.placeholders = new Map();
        /** Grows with every replaced buffer or texture: bind groups of an earlier version are stale. */
        this.version = 0;
    }

    /** Returns the most rows of a slice that fit, from 1 to the height of the frame. Throws if one row does not fit. */
    fittingRows(values, [, height], budget) {
        const excess = (rows) => this.excess(values.withRows(rows), values.size[0], height, budget);
        // A frame whose passes read other pixels is not divided.
        if (this.plan.whole_frame) return height;
        const problem = excess(1);
        if (problem) throw new ExcessError(problem);
        let [fits, tooMany] = excess(height) ? [1, height] : [height, height + 1];
        while (tooMany - fits > 1) {
            const middle = Math.floor((fits + tooMany) / 2);
            if (excess(middle)) tooMany = middle;
            else fits = middle;
        }
        return fits;
    }

    /** Returns what does not fit, as a sentence; `undefined` if everything fits. */
    excess(values, width, height, budget) {
        const { maxStorageBufferBindingSize, maxBufferSize } = this.device.limits;
        const most = Math.min(maxStorageBufferBindingSize, maxBufferSize);
        let total = 0;
        for (const resource of this.plan.resources) {
            const bytes = resource.texture ? values.withRows(height).value(resource.bytes) : values.bytes(resource);
            if (!resource.texture && bytes > most) {
                return (
                    `\`${resource.name}\` needs ${bytes} bytes for ${values.size[1]} rows of ${width} pixels, and the device allows ` +
                    `${most}: request its adapter's limits (\`requirements\`), reserve less, or draw lower slices (\`rows\`)`
                );
            }
            if (resource.init !== "external") total += bytes;
        }
        if (total <= budget) return undefined;
        return (
            `the frame needs ${total} bytes for ${values.size[1]} rows of ${width} pixels, and the budget \`memory\` is ${budget}: ` +
            "raise it, or keep fewer fragments"
        );
    }

    /** Allocates every buffer and texture that does not have its size yet. Buffers up to twice as large as needed are kept. */
    allocate(values, size) {
        for (const resource of this.plan.resources) {
            if (resource.init === "external") continue;
            if (resource.texture) this.#allocateTexture(resource, values.value(resource.texture.samples), size);
            else this.#allocateBuffer(resource.name, values.bytes(resource));
        }
    }

    #allocateBuffer(name, size) {
        const present = this.buffers.get(name);
        if (present && size <= present.size && present.size <= 2 * size) return;
        const { STORAGE, COPY_SRC, COPY_DST, INDIRECT } = GPUBufferUsage;
        const usage = STORAGE | COPY_SRC | COPY_DST | INDIRECT;
        this.buffers.set(name, this.device.createBuffer({ label: `fragbuf ${name}`, size, usage }));
        present?.destroy();
        this.version++;
    }

    #allocateTexture({ name, texture: { format } }, sampleCount, size) {
        const present = this.textures.get(name);
        if (present && present.width === size[0] && present.height === size[1]) return;
        const { RENDER_ATTACHMENT, TEXTURE_BINDING, STORAGE_BINDING, COPY_SRC, COPY_DST } = GPUTextureUsage;
        const isStored = this.plan.steps.some(({ bindings }) => bindings?.some((one) => one.name === name && one.type === "storage-texture"));
        // WebGPU copies no multisampled texture.
        const usage =
            RENDER_ATTACHMENT | TEXTURE_BINDING | (sampleCount === 1 ? COPY_SRC | COPY_DST : 0) | (isStored ? STORAGE_BINDING : 0);
        this.textures.set(name, this.device.createTexture({ label: `fragbuf ${name}`, size, format, sampleCount, usage }));
        present?.destroy();
        this.version++;
    }

    /** Uses a texture of the caller for an external resource, or for the texture that the description calls `name`. */
    supply(name, texture, size) {
        const described = this.plan.resources.find((known) => known.texture?.described === name);
        if (described) return this.#supplyDescribed(described, texture);
        const resource = this.plan.resources.find((known) => known.name === name && known.init === "external");
        if (!resource) throw new Error(`the plan has no external texture \`${name}\`: remove it from \`textures\``);
        const [width, height] = size;
        if (texture?.format !== resource.texture.format || texture.width !== width || texture.height !== height) {
            throw new Error(
                `the texture \`${name}\` is ${texture?.width} × ${texture?.height} of \`${texture?.format}\`: ` +
                    `it must be ${width} × ${height}, as the frame, of \`${resource.texture.format}\``,
            );
        }
        if (this.external.get(name) !== texture) {
            this.external.set(name, texture);
            this.version++;
        }
    }

    /** Uses a texture of the caller for a texture of the description: of any size and any format of floats. */
    #supplyDescribed({ name, texture: { described, view_dimension: dimension } }, texture) {
        const isFlat = dimension === "3d" || texture?.depthOrArrayLayers === 1;
        if (texture?.dimension !== dimension || !isFlat || texture.sampleCount !== 1) {
            throw new Error(
                `the texture \`${described}\` is ${texture?.dimension} with ${texture?.depthOrArrayLayers} layers and ` +
                    `${texture?.sampleCount} samples: it must be ${dimension} with one sample, and a format of floats`,
            );
        }
        if (this.external.get(name) !== texture) {
            this.external.set(name, texture);
            this.version++;
        }
    }

    /** Returns the texture of a resource; `undefined` for a buffer. */
    texture(name) {
        const texture = this.textures.get(name) ?? this.external.get(name);
        if (!texture && this.plan.resources.some((resource) => resource.name === name && resource.init === "external")) {
            const known = this.plan.resources.find((resource) => resource.name === name).texture.described ?? name;
            throw new Error(`the plan reads the external texture \`${known}\`: pass it in \`textures: { ${known}: … }\``);
        }
        return texture;
    }

    /** Records a clear of a buffer. */
    clear(encoder, name, value) {
        const buffer = this.buffers.get(name);
        if (value === 0) return encoder.clearBuffer(buffer);
        if (!this.patterns.has(value)) {
            const usage = GPUBufferUsage.COPY_SRC;
            const pattern = this.device.createBuffer({ label: "fragbuf pattern", size: PATTERN_BYTES, usage, mappedAtCreation: true });
            new Uint32Array(pattern.getMappedRange()).fill(value);
            pattern.unmap();
            this.patterns.set(value, pattern);
        }
        for (let at = 0; at < buffer.size; at += PATTERN_BYTES) {
            encoder.copyBufferToBuffer(this.patterns.get(value), 0, buffer, at, Math.min(PATTERN_BYTES, buffer.size - at));
        }
    }

    /** Returns an attachment for passes that write only buffers, because WebGPU rejects a pass without attachments. */
    placeholder(sampleCount, size) {
        const present = this.placeholders.get(sampleCount);
        if (present && present.width === size[0] && present.height === size[1]) return present.createView();
        present?.destroy();
        const usage = GPUTextureUsage.RENDER_ATTACHMENT;
        const texture = this.device.createTexture({ label: "fragbuf no target", size, format: PLACEHOLDER_FORMAT, sampleCount, usage });
        this.placeholders.set(sampleCount, texture);
        return texture.createView();
    }

    destroy() {
        for (const map of [this.buffers, this.textures, this.patterns, this.placeholders]) {
            map.forEach((object) => object.destroy());
            map.clear();
        }
    }
}

/** The format of attachments that nothing is written to. */
export const PLACEHOLDER_FORMAT = "r8unorm";

/**
 * The uniform blocks, in slots of one buffer. A slot is found by its content, so that equal blocks share one, and is not written again
 * while a frame that may not have been submitted uses it.
 */
export class UniformSlots {
    constructor(device, blocks) {
        const alignment = device.limits.minUniformBufferOffsetAlignment;
        const greatest = Math.max(...blocks.map((block) => block.bytes), 16);
        this.device = device;
        this.stride = Math.ceil(greatest / alignment) * alignment;
        this.version = 0;
        this.frame = 0;
        this.#create(16);
    }

    #create(count) {
        const usage = GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST;
        // The former buffer is not destroyed: commands of this frame may use it.
        this.buffer = this.device.createBuffer({ label: "fragbuf uniforms", size: count * this.stride, usage });
        this.slots = Array.from({ length: count }, () => ({ key: undefined, frame: -Infinity }));
        this.known = new Map();
        this.next = 0;
        this.version++;
    }

    /** Begins a frame: slots of the frame before the former one may be written again. */
    begin() {
        this.frame++;
    }

    /** Returns the offsets of slots with the words of these blocks, all in the present buffer. */
    offsets(blocks) {
        const { version } = this;
        const offsets = blocks.map((words) => this.#offset(words));
        return version === this.version ? offsets : this.offsets(blocks);
    }

    #offset(words) {
        const key = words.join();
        let index = this.known.get(key);
        if (index === undefined) {
            if (this.slots[this.next].frame >= this.frame - 1) this.#create(2 * this.slots.length);
            index = this.next;
            this.next = (this.next + 1) % this.slots.length;
            this.known.delete(this.slots[index].key);
            this.known.set(key, index);
            this.slots[index].key = key;
            this.device.queue.writeBuffer(this.buffer, index * this.stride, words);
        }
        this.slots[index].frame = this.frame;
        return index * this.stride;
    }
}

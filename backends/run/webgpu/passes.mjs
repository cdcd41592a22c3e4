/**
 * Creates the pipelines of a plan, with an explicit bind group layout per pass as the manifest declares it.
 * @module
 */
import { scoped } from "./errors.mjs";
import { PLACEHOLDER_FORMAT } from "./memory.mjs";
import { TARGET } from "./plan.mjs";

/**
 * Compiles every pass of a plan. Returns a map from steps to their pipelines.
 * @param {GPUDevice} device
 * @param {ReturnType<typeof import("./plan.mjs").planOf>} plan
 * @param {import("./plan.mjs").Values} values
 * @param {(path: string) => string | Promise<string>} loadFile
 * @param {import("./fragbuf.d.ts").Options} options
 */
export async function compile(device, plan, values, loadFile, options) {
    const modules = new Map();
    const module = (file, step) => {
        if (!modules.has(file)) modules.set(file, load(device, file, step, loadFile, options));
        return modules.get(file);
    };
    const steps = plan.steps.map((step, at) => ({ step, at })).filter(({ step }) => step.do === "pass");
    const passes = steps.map(async ({ step, at }) => {
        const file = plan.files.get(step.pass);
        if (!file) throw new Error(`the manifest has no file of the pass \`${step.pass}\`: generate it again`);
        const code = await module(file, step);
        return [step, await createPass(device, plan, values, { step, at, code }, options)];
    });
    return new Map(await Promise.all(passes));
}

/** Loads and compiles the file of a pass. */
async function load(device, file, step, loadFile, options) {
    let text;
    try {
        text = await loadFile(file.path);
    } catch (error) {
        throw new Error(`the file \`${file.path}\` was not loaded (${error.message}): deploy it beside manifest.json`, { cause: error });
    }
    if (typeof text !== "string") {
        throw new Error(`\`loadFile\` returned ${typeof text} for \`${file.path}\`: return the text of the file`);
    }
    let code = { code: text, vertex: file.vertex, fragment: file.fragment, compute: file.compute };
    if (file.module) {
        if (!options.material) {
            throw new Error(`\`${file.path}\` is in module form: pass \`material\`, which adds your entry points to it`);
        }
        code = { ...code, ...options.material({ pass: step.pass, code: text, entry: file.module }) };
    }
    const descriptor = { label: `fragbuf ${step.pass}`, code: code.code };
    // The message of the error names the line.
    const module = await scoped(device, `\`${file.path}\``, () => device.createShaderModule(descriptor));
    return { ...code, module };
}

/** Creates the layout and the pipelines of one pass. */
async function createPass(device, plan, values, { step, at, code }, options) {
    const group = plan.uniform_blocks[0].group;
    const bindings = bindingsOf(plan, step);
    const entries = bindings.map(({ entry }) => entry);
    const label = `fragbuf ${step.pass}`;
    const [layout, pipelineLayout] = await scoped(device, `the bindings of the pass \`${step.pass}\``, () => {
        const layout = device.createBindGroupLayout({ label, entries });
        const empty = device.createBindGroupLayout({ entries: [] });
        const others = code.bindGroupLayouts ?? [];
        const at = (index) => (index === group ? layout : (others[index] ?? empty));
        const bindGroupLayouts = Array.from({ length: Math.max(group + 1, others.length) }, (_, index) => at(index));
        return [layout, device.createPipelineLayout({ label, bindGroupLayouts })];
    });
    const pipeline = { label, layout: pipelineLayout };
    const pass = { step, group, bindings, layout, pipelines: new Map() };
    if (step.kind === "compute") {
        const compute = { module: code.module, entryPoint: code.compute };
        pass.pipelines.set(undefined, await created(device.createComputePipelineAsync({ ...pipeline, compute }), step));
        return pass;
    }
    pass.attachments = attachmentsOf(plan, step);
    pass.sampleCount = sampleCount(plan, values, step);
    const buffers = step.kind !== "geometry" ? [] : (code.vertexBuffers ?? vertexBuffers(plan, step, options));
    const targets = targetsOf(pass, plan, options);
    const base = {
        ...pipeline,
        vertex: { module: code.module, entryPoint: code.vertex, buffers },
        fragment: { module: code.module, entryPoint: code.fragment, targets },
        primitive: step.kind === "geometry" && step.objects !== "boxes" ? (options.primitive ?? {}) : {},
        depthStencil: depthStencil(plan, step, pass.attachments.depthStencil),
    };
    for (const mask of masks(plan, values, step, at)) {
        const multisample = { count: pass.sampleCount, mask };
        pass.pipelines.set(mask, await created(device.createRenderPipelineAsync({ ...base, multisample }), step));
    }
    return pass;
}

/** Waits for a pipeline. */
async function created(pipeline, step) {
    try {
        return await pipeline;
    } catch (error) {
        throw new Error(`the pipeline of the pass \`${step.pass}\` was not created: ${error.message}`, { cause: error });
    }
}

/** Returns the bindings of a pass, in the order of their numbers: layout entries, and what is bound. */
function bindingsOf(plan, step) {
    const declared = step.bindings_of?.[TARGET] ?? step.bindings;
    const bits = { vertex: GPUShaderStage.VERTEX, fragment: GPUShaderStage.FRAGMENT, compute: GPUShaderStage.COMPUTE };
    const bindings = declared.map((one) => {
        const { type, sample_type: sampleType, view_dimension: viewDimension, multisampled, access, format } = one;
        const block = plan.uniform_blocks.find((block) => block.name === one.name);
        const entry = { binding: one.binding, visibility: one.stages.reduce((all, stage) => all | bits[stage], 0) };
        if (type === "texture") entry.texture = { sampleType, viewDimension, multisampled };
        else if (type === "storage-texture") entry.storageTexture = { access, format, viewDimension };
        else entry.buffer = { type, hasDynamicOffset: block !== undefined, minBindingSize: block?.bytes };
        return { entry, name: one.name, block, aspect: one.aspect ?? "all" };
    });
    return bindings.sort((a, b) => a.entry.binding - b.entry.binding);
}

/** Returns the names of a pass's attachments: colours in their order, and depth with stencil. */
function attachmentsOf(plan, { uses, state }) {
    const isDepth = (name) => /^depth/.test(plan.resources.find((resource) => resource.name === name)?.texture?.format);
    const attached = Object.keys(uses).filter((name) => uses[name] === "attachment");
    const targets = state.targets.map((target) => target.resource);
    const depthStencil = state.depth?.resource ?? state.stencil?.resource ?? attached.find(isDepth);
    const others = attached.filter((name) => name !== depthStencil && !targets.includes(name));
    return { colors: [...targets, ...others], depthStencil };
}

/** Returns the samples per pixel of a pass: those of its state, or of its attachments. */
function sampleCount(plan, values, { uses, state }) {
    const attached = plan.resources.find((resource) => resource.texture && uses[resource.name] === "attachment");
    return values.value(state.samples?.count ?? attached?.texture.samples ?? "1");
}

/** Returns the sample masks that a pass has in the iterations of the loop around it. */
function masks(plan, values, { state, per_iteration: perIteration }, at) {
    const mask = state.samples?.mask;
    if (mask === undefined) return [undefined];
    const isAround = (step, begin) => step.do === "loop" && begin < at && at < step.end;
    const loop = plan.steps.filter(isAround).at(-1);
    const iterations = loop && perIteration?.includes("state.samples.mask") ? values.value(loop.max_iterations) : 1;
    return [...new Set(Array.from({ length: iterations }, (_, iteration) => values.value(mask, { iteration })))];
}

/** Returns the colour targets of a pipeline. */
function targetsOf(pass, plan, options) {
    const { colors, depthStencil } = pass.attachments;
    if (colors.length === 0 && !depthStencil) return [{ format: PLACEHOLDER_FORMAT, writeMask: 0 }];
    return colors.map((name, index) => {
        const resource = plan.resources.find((resource) => resource.name === name);
        const format = name === "output" ? options.format : resource.texture.format;
        const blend = pass.step.state.targets[index]?.blend;
        if (blend === undefined) return { format, writeMask: 0 };
        if (blend === null) return { format };
        const component = { srcFactor: blend.source, dstFactor: blend.destination, operation: blend.operation };
        return { format, blend: { color: component, alpha: component } };
    });
}

/** Returns the depth and stencil state of a pipeline. A test that fails on depth keeps the stencil. */
function depthStencil(plan, { state }, name) {
    if (!name) return undefined;
    const { format } = plan.resources.find((resource) => resource.name === name).texture;
    const result = { format, depthCompare: state.depth?.compare ?? "always", depthWriteEnabled: state.depth?.write ?? false };
    if (state.stencil) {
        const { compare, fail, pass } = state.stencil;
        result.stencilFront = { compare, failOp: fail, depthFailOp: "keep", passOp: pass };
        result.stencilBack = result.stencilFront;
    }
    return result;
}

/** Returns the vertex buffers of the caller, or one with the inputs of a vertex behind one another. Boxes have the latter. */
function vertexBuffers(plan, step, options) {
    if (options.vertexBuffers && step.objects !== "boxes") return options.vertexBuffers;
    return [interleaved(plan)];
}

/** Returns the layout of a vertex buffer with all inputs behind one another, in their order. */
export function interleaved(plan) {
    let arrayStride = 0;
    const attributes = (plan.vertex_inputs ?? []).map(({ location, type }) => {
        const offset = arrayStride;
        const count = Number(/^vec(\d)/.exec(type)?.[1] ?? 1);
        const component = /u32/.test(type) ? "uint32" : /i32/.test(type) ? "sint32" : "float32";
        arrayStride += 4 * count;
        return { shaderLocation: location, offset, format: count > 1 ? `${component}x${count}` : component };
    });
    return { arrayStride, attributes };
}

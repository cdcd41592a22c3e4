/**
 * Computes what a device must offer for a plan, and says in words what an adapter or device lacks.
 * @module
 */
import { planOf, TARGET, Values } from "./plan.mjs";
import { TIMESTAMP_FEATURE } from "./times.mjs";

/** Sample counts of WebGPU. */
const SAMPLE_COUNTS = [1, 4];

/** Limits that a frame in slices meets although the whole frame would exceed them. */
const SLICED = ["maxStorageBufferBindingSize", "maxBufferSize"];

/**
 * Returns what to request of `adapter` for frames of this size: pass it to `requestDevice`.
 * @param {import("./fragbuf.d.ts").Manifest} manifest
 * @param {GPUAdapter} adapter
 * @param {import("./fragbuf.d.ts").RequirementOptions} options
 * @returns {{ requiredLimits: Record<string, number>, requiredFeatures: GPUFeatureName[] }}
 */
export function requirements(manifest, adapter, { size, symbols = {}, perPixel = 8, format, times } = {}) {
    const plan = planOf(manifest);
    const values = new Values(plan, checkedSize(size), { perPixel, counts: false });
    for (const [name, value] of Object.entries(symbols)) values.assign(name, value);
    check(plan, values, adapter, format, "adapter");
    const requiredLimits = {};
    for (const { name, needed, usual } of limitsOf(plan, values)) {
        if (needed > usual) requiredLimits[name] = Math.min(needed, adapter.limits[name]);
    }
    // A frame is drawn without times where an adapter has no timestamps.
    const timed = times && adapter.features.has(TIMESTAMP_FEATURE) ? [TIMESTAMP_FEATURE] : [];
    return { requiredLimits, requiredFeatures: [...featuresOf(plan, format), ...timed] };
}

/** Throws an error that names everything that `owner`, an adapter or a device, lacks for a plan. */
export function check(plan, values, owner, format, kind) {
    const request = kind === "device" ? ": request it as `requirements` returns it" : "";
    const missing = [];
    for (const { name, needed } of limitsOf(plan, values)) {
        const present = owner.limits[name];
        if (present !== undefined && needed > present && !SLICED.includes(name)) {
            missing.push(`the limit \`${name}\` must be ${needed}, and the ${kind} has ${present}${request}`);
        }
    }
    for (const feature of featuresOf(plan, format)) {
        if (!owner.features.has(feature)) missing.push(`the feature \`${feature}\` is missing${request}`);
    }
    for (const [what, count] of sampleCounts(plan, values)) {
        if (!SAMPLE_COUNTS.includes(count)) {
            missing.push(`${what} has ${count} samples per pixel, and WebGPU has 1 and 4: generate with \`--set k=4\``);
        }
    }
    if (missing.length > 0) throw new Error(`\`${plan.name}\` does not run on this ${kind}: ${missing.join("; ")}`);
}

/** Returns the limits of WebGPU that a plan names, for the size of `values`. */
function limitsOf(plan, values) {
    const limits = plan.limits.filter((limit) => limit.webgpu);
    return limits.map((limit) => ({
        name: limit.webgpu,
        needed: typeof limit.needed === "number" ? limit.needed : values.value(limit.needed),
        usual: limit.webgpu_default,
    }));
}

/** Returns the features of WebGPU that a plan needs, and those for blending over a target of this format. */
function featuresOf(plan, format) {
    const blending = /32float$/.test(format ?? "") ? ["float32-blendable"] : [];
    return [...new Set([...plan.requires[TARGET].features, ...blending])];
}

/** Returns the textures and passes with several samples, and the counts of their samples. */
function sampleCounts(plan, values) {
    const textures = plan.resources.filter((resource) => resource.texture);
    const passes = plan.steps.filter((step) => step.state?.samples);
    return [
        ...textures.map(({ name, texture }) => [`the texture \`${name}\``, values.value(texture.samples)]),
        ...passes.map(({ pass, state }) => [`the pass \`${pass}\``, values.value(state.samples.count)]),
    ];
}

/** Returns a size, or throws if it is none. */
export function checkedSize(size) {
    const isSize = size?.length === 2 && [...size].every((extent) => Number.isInteger(extent) && extent > 0);
    if (!isSize) throw new Error(`the size is ${JSON.stringify(size)}: pass \`size: [width, height]\`, whole pixels, 1 at least`);
    return [size[0], size[1]];
}

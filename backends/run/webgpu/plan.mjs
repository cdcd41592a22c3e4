/**
 * Reads a manifest: checks its schema, selects the plan of portable WGSL, and computes the values of symbols.
 * @module
 */
import { evaluate } from "./formula.mjs";

/** The schema that this package follows. */
export const SCHEMA = "fragbuf-manifest/4";

/** The target of portable WGSL. */
export const TARGET = "wgsl";

/**
 * Returns the plan of portable WGSL, with the files of each pass by stage.
 * @param {import("./fragbuf.d.ts").Manifest} manifest
 */
export function planOf(manifest) {
    if (typeof manifest !== "object" || manifest === null || typeof manifest.schema !== "string") {
        throw new Error("the manifest is no object with a `schema`: pass the parsed JSON of manifest.json");
    }
    if (manifest.schema !== SCHEMA) {
        throw new Error(
            `the manifest has the schema \`${manifest.schema}\`, and this package follows \`${SCHEMA}\`: ` +
                "use the package and the `fragbuf` of one version",
        );
    }
    const files = new Map();
    for (const file of manifest.files.filter((file) => file.target === TARGET)) {
        files.set(file.pass, { ...files.get(file.pass), path: file.path, [file.stage]: file.entry_point });
    }
    if (files.size === 0) {
        const reason = manifest.unsupported?.[TARGET];
        throw new Error(
            reason
                ? `\`${manifest.name}\` does not run on WebGPU: ${reason}`
                : `the manifest has no files of the target \`${TARGET}\`: generate it with \`--target ${TARGET}\``,
        );
    }
    const plan = manifest.alternatives.find((other) => other.targets.includes(TARGET)) ?? manifest;
    const hostSets = new Set(plan.steps.flatMap((step) => step.sets ?? []));
    const declared = new Map(plan.symbols.map((symbol) => [symbol.name, symbol]));
    return { ...plan, name: manifest.name, files, declared, hostSets, usedBeforeK: usedBeforeK(plan) };
}

/**
 * Returns the resources that are used before a host step sets `k`. They have memory for the greatest k, so that it keeps its content.
 */
function usedBeforeK(plan) {
    const decision = plan.steps.findIndex((step) => step.do === "host" && step.sets.includes("k"));
    const around = plan.steps.filter((step, at) => step.do === "loop" && at < decision && decision < step.end);
    const end = Math.max(decision, ...around.map((loop) => loop.end));
    const used = new Set(plan.steps.slice(0, Math.max(end, 0)).flatMap(resourcesOf));
    for (const { resources } of plan.exchanges) if (resources.some((name) => used.has(name))) resources.forEach((name) => used.add(name));
    return used;
}

/** Returns the names of the resources that a step uses. */
function resourcesOf(step) {
    if (step.do === "copy") return [step.from, step.to];
    return step.do === "clear" ? [step.resource] : Object.keys(step.uses ?? {});
}

/** The values of a plan's symbols for frames of one size. */
export class Values {
    /**
     * @param {ReturnType<typeof planOf>} plan
     * @param {[number, number]} size The width of the frame, and the height of a slice of it.
     * @param {{ perPixel: number, counts: boolean }} reserve For how many fragments per pixel memory is reserved where no host step
     *   counts them, and whether host steps run.
     */
    constructor(plan, [width, height], reserve, set = new Map()) {
        this.plan = plan;
        this.size = [width, height];
        this.reserve = reserve;
        /** What the caller has set. @type {Map<string, number>} */
        this.set = set;
        /** What host steps have decided. @type {Map<string, number>} */
        this.decided = new Map();
        this.lookup = (name) => this.symbol(name);
    }

    /** Returns the same values for slices of another height. */
    withRows(rows) {
        const values = new Values(this.plan, [this.size[0], rows], this.reserve, this.set);
        values.decided = this.decided;
        return values;
    }

    /** Returns the value of a formula, where the symbols in `local` have other values. */
    value(formula, local) {
        return evaluate(formula, local ? (name) => local[name] ?? this.symbol(name, local) : this.lookup);
    }

    /** Returns the value of a symbol. */
    symbol(name, local) {
        if (name === "width") return this.size[0];
        if (name === "height") return this.size[1];
        const declared = this.plan.declared.get(name);
        const known = this.set.get(name) ?? this.decided.get(name) ?? this.plan.constants[name] ?? declared?.value;
        if (known !== undefined) return known;
        const isCounted = this.reserve.counts && this.plan.hostSets.has(name);
        // Memory for more is allocated once a host step has decided.
        if (isCounted) return name === "k" ? 1 : 0;
        if (declared?.default !== undefined) return this.value(declared.default, local);
        if (declared?.when === "readback") return Math.ceil(this.reserve.perPixel * this.size[0] * this.size[1]);
        if (declared?.when === "iteration") return 0;
        throw new Error(`the symbol \`${name}\` has no value: set it with \`symbols: { ${name}: … }\``);
    }

    /** Sets a symbol for the caller. */
    assign(name, value) {
        const settable = this.plan.symbols.filter((symbol) => symbol.set_by === "host" || symbol.set_by === "caller");
        const names = settable.map((symbol) => symbol.name).filter((known) => known !== "width" && known !== "height");
        const declared = settable.find((symbol) => symbol.name === name);
        if (!names.includes(name)) {
            throw new Error(`no symbol \`${name}\` can be set: the plan has ${names.map((known) => `\`${known}\``).join(", ")}`);
        }
        if (!Number.isInteger(value) || value < declared.least || value > declared.most) {
            throw new Error(`\`${name}\` is ${value}: set it to a whole number from ${declared.least} to ${declared.most}`);
        }
        this.set.set(name, value);
    }

    /** Returns the bytes of a buffer. */
    bytes(resource) {
        const needsMost = this.reserve.counts && this.plan.usedBeforeK.has(resource.name) && !this.set.has("k");
        return this.value(resource.bytes, needsMost ? { k: this.symbol("capacity") } : undefined);
    }

    /** Returns the bytes of all buffers if symbols had these values. */
    bytesWith(assumed) {
        const values = this.withRows(this.size[1]);
        values.decided = new Map([...this.decided, ...Object.entries(assumed)]);
        const buffers = this.plan.resources.filter((resource) => !resource.texture);
        return buffers.reduce((sum, resource) => sum + values.bytes(resource), 0);
    }
}

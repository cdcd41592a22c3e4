/**
 * The block of the description's uniforms.
 * @module
 */

/** The values of the uniforms so far. */
export class UniformBlock {
    /** @param {{ bytes: number, fields: { name: string, uniform: string, type: string, offset: number }[] } | undefined} block */
    constructor(block) {
        this.block = block;
        // By their names in the description: in the text a name that WGSL reserves is another one.
        this.fields = (block?.fields ?? []).map((field) => ({ ...field, name: field.uniform }));
        this.values = new Map();
    }

    /** Sets uniforms by name, and returns the words of the block. A uniform keeps its value until it is set again. */
    words(values) {
        const { fields } = this;
        for (const [name, value] of Object.entries(values)) {
            const field = fields.find((field) => field.name === name);
            if (!field) {
                const known = fields.map((field) => `\`${field.name}\``).join(", ") || "none";
                throw new Error(`the description has no uniform \`${name}\`; its uniforms: ${known}`);
            }
            this.values.set(name, checked(field, value));
        }
        if (!this.block) return undefined;
        const words = new Uint32Array(this.block.bytes / 4);
        for (const { name, type, offset } of fields) {
            if (!this.values.has(name)) throw new Error(`the uniform \`${name}\` has no value: pass \`uniforms: { ${name}: … }\` (${type})`);
            const View = /u32/.test(type) ? Uint32Array : /i32/.test(type) ? Int32Array : Float32Array;
            new View(words.buffer).set(this.values.get(name), offset / 4);
        }
        return words;
    }
}

/** Returns the components of a value, or throws if it has another number of them than the type of the field. */
function checked({ name, type }, value) {
    const components = typeof value === "number" ? [value] : [...(value ?? [])];
    const count = Number(/^vec(\d)/.exec(type)?.[1] ?? 1);
    if (components.length !== count || !components.every((component) => typeof component === "number")) {
        throw new Error(`the uniform \`${name}\` is ${JSON.stringify(value)}: pass ${count === 1 ? "a number" : `${count} numbers`} (${type})`);
    }
    return components;
}

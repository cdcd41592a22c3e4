/**
 * Checks the arguments of a caller. Each mistake is an error that says what to pass.
 * @module
 */
import { checkedSize } from "./requirements.mjs";

const READBACKS = ["all", "lag", "loops", "none"];
const OPTIONS = [
    "size", "format", "symbols", "perPixel", "readback", "memory", "rows", "vertexBuffers", "primitive", "material", "onLoss",
    "times",
];
const CALL = ["target", "clear", "viewProjection", "draw", "uniforms", "symbols", "textures", "objects"];

/** Returns the caller's options with the defaults. */
export function checkedOptions(options = {}) {
    checkNames(options, OPTIONS, "option");
    const { format, readback = "all", perPixel = 8, memory = 2 ** 31, rows, symbols = {}, times = false } = options;
    if (typeof format !== "string") throw new Error("`format` is missing: pass the texture format of your target, such as \"rgba8unorm\"");
    if (!READBACKS.includes(readback)) throw new Error(`\`readback\` is ${JSON.stringify(readback)}: pass one of ${READBACKS.join(", ")}`);
    if (!(perPixel > 0)) throw new Error("`perPixel` is a number of fragments above 0");
    if (rows !== undefined && !(Number.isInteger(rows) && rows > 0)) throw new Error("`rows` is a whole number of rows above 0");
    if (typeof times !== "boolean") throw new Error(`\`times\` is ${JSON.stringify(times)}: pass true or false`);
    const onLoss = options.onLoss ?? warnOfLosses();
    const size = checkedSize(options.size);
    return { ...options, size, format, readback, perPixel, memory, rows, symbols, times, onLoss };
}

/** Checks the arguments of a frame that no other function checks, and returns the function that draws the scene. */
export function checkedDraw(call) {
    if (typeof call?.draw !== "function") throw new Error("`draw` is no function: pass one that records the draws of your scene");
    checkNames(call, CALL, "argument of a frame");
    const { clear, draw } = call;
    const channels = clear && (Array.isArray(clear) ? clear : [clear.r, clear.g, clear.b, clear.a]);
    if (clear !== undefined && !(channels?.length === 4 && channels.every(Number.isFinite))) {
        throw new Error(`\`clear\` is ${JSON.stringify(clear)}: pass four numbers, red, green, blue and alpha`);
    }
    return (pass, about) => {
        const drawn = draw.call(call, pass, about);
        if (typeof drawn?.then === "function") throw new Error("`draw` is asynchronous: record the draws before it returns");
    };
}

function checkNames(values, known, what) {
    const unknown = Object.keys(values).find((name) => !known.includes(name));
    if (unknown !== undefined) throw new Error(`there is no ${what} \`${unknown}\`; there are ${known.join(", ")}`);
}

/** Returns a function that prints a warning the first time that fragments are lost. */
function warnOfLosses() {
    let isWarned = false;
    return ({ lost, counts }) => {
        if (!isWarned) console.warn(`fragbuf: ${lost} fragments are missing from the image or in the wrong order:`, counts);
        isWarned = true;
    };
}

/** Returns a function that returns the view of the caller's target. */
export function viewOf(target, size, format) {
    if (typeof target === "function") return () => checkedView(target(), size, format);
    const view = checkedView(target, size, format);
    return () => view;
}

function checkedView(target, [width, height], format) {
    if (typeof target?.createView !== "function") {
        if (!target) throw new Error("`target` is missing: pass a GPUTexture or GPUTextureView of `format`, or a function that returns one");
        return target;
    }
    if (target.format !== format || target.width !== width || target.height !== height) {
        throw new Error(
            `\`target\` is ${target.width} × ${target.height} of \`${target.format}\`, and the frame ${width} × ${height} of \`${format}\`: ` +
                "call `resize` when your target changes its size, and create the fragment buffer for its format",
        );
    }
    return target.createView();
}

/** Returns the words of the block `camera`. */
export function cameraWords(plan, matrix) {
    if (!plan.uniform_blocks.some((block) => block.name === "camera")) return undefined;
    if (matrix?.length !== 16 || ![...matrix].every(Number.isFinite)) {
        throw new Error("`viewProjection` is no matrix of 16 numbers, column by column: pass the identity if positions are in clip space");
    }
    return new Uint32Array(new Float32Array(matrix).buffer);
}

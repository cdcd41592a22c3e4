/**
 * Small plots as SVG: times of the last frames, and a histogram with k.
 *
 * Input: numbers. Output: drawings with a text for those who do not see them. Colours are classes of costs.css and variables of base.css.
 */
import { count, element, fill, milliseconds, percent, svg } from "./dom.mjs";

const FRAMES = 60;
const SIZE = { width: 360, height: 96 };

/** Colours of passes in costs.css, `.series-0` and on. */
const SERIES = 8;

/**
 * Creates the plot of milliseconds per pass: a bar per frame, with the passes stacked in it.
 * @param {HTMLElement} parent
 */
export function createTimes(parent) {
    /** @type {Record<string, number>[]} */
    let frames = [];
    const drawing = svg("svg", { viewBox: `0 0 ${SIZE.width} ${SIZE.height}`, class: "plot", role: "img" });
    const legend = element("ul", { className: "legend" });
    fill(parent, drawing, legend);
    const draw = () => {
        const passes = [...new Set(frames.flatMap(Object.keys))];
        const totals = frames.map((frame) => Object.values(frame).reduce((sum, ms) => sum + ms, 0));
        const most = ceiling(Math.max(...totals, 0));
        const width = SIZE.width / FRAMES;
        const bars = frames.map((frame, index) => bar(frame, passes, most, (FRAMES - frames.length + index) * width, width));
        drawing.replaceChildren(...lines(most, milliseconds), ...bars.flat());
        const last = frames.at(-1) ?? {};
        const text = passes.map((pass) => `${pass} ${milliseconds(last[pass] ?? 0)}`).join(", ");
        drawing.setAttribute(
            "aria-label",
            frames.length ? `Milliseconds of the last ${frames.length} frames; the last one: ${text}` : "No frame yet",
        );
        fill(
            legend,
            passes.map((pass, index) => legendItem(pass, last[pass], index)),
        );
    };
    draw();
    return {
        /** @param {Record<string, number | null> | null} ms by pass */
        add(ms) {
            if (!ms) return;
            const timed = Object.entries(ms).filter(([, value]) => Number.isFinite(value));
            frames = [...frames, Object.fromEntries(timed)].slice(-FRAMES);
            draw();
        },
        /** Forgets the frames of another description. */
        clear() {
            frames = [];
            draw();
        },
    };
}

function bar(frame, passes, most, x, width) {
    let top = SIZE.height;
    return passes.map((pass, index) => {
        const height = ((frame[pass] ?? 0) / most) * (SIZE.height - 6);
        top -= height;
        return svg("rect", { x: x + 0.5, y: top, width: width - 1, height, class: `series-${index % SERIES}` });
    });
}

function legendItem(pass, ms, index) {
    const mark = element("span", { className: `mark series-${index % SERIES}`, "aria-hidden": "true" });
    return element(
        "li",
        {},
        mark,
        element("span", { className: "name" }, pass),
        element("span", { className: "figure" }, milliseconds(ms ?? 0)),
    );
}

/** Returns the lines of a scale: its top and its middle, with labels. */
function lines(most, label) {
    return [1, 0.5].flatMap((part) => {
        const y = SIZE.height - part * (SIZE.height - 6);
        return [
            svg("line", { x1: 0, x2: SIZE.width, y1: y, y2: y, class: "scale" }),
            svg("text", { x: 2, y: y + 11, class: "scale-text" }, label(most * part)),
        ];
    });
}

/** Returns the next of 1, 2, 5, 10, 20, … */
function ceiling(value) {
    if (!(value > 0)) return 1;
    const power = 10 ** Math.floor(Math.log10(value));
    return [1, 2, 5, 10].map((step) => step * power).find((step) => step >= value * 0.999) ?? value;
}

/**
 * Draws how many pixels have how many fragments, with k. The heights are logarithms, because few deep pixels decide.
 * @param {HTMLElement} parent
 * @param {number[]} histogram pixels by their number of fragments, from 1
 * @param {number | null} k null: every fragment is kept
 * @param {boolean} [repeats] iterations keep k fragments each, until none is left
 */
export function drawHistogram(parent, histogram, k, repeats = false) {
    const covered = [...histogram];
    while (covered.length > 1 && covered.at(-1) === 0) covered.pop();
    const group = Math.max(1, Math.ceil(covered.length / 90));
    const groups = Math.max(Math.ceil(covered.length / group), 8);
    const pixels = Array.from({ length: groups }, (_, index) => sum(covered.slice(index * group, (index + 1) * group)));
    const most = Math.max(...pixels, 1);
    const width = SIZE.width / groups;
    const height = (value) => (value > 0 ? ((0.4 + Math.log10(value)) / (0.4 + Math.log10(most))) * (SIZE.height - 22) : 0);
    const bars = pixels.map((value, index) => {
        const first = index * group + 1;
        const kept = k === null || repeats || first <= k;
        const tall = Math.max(height(value), 0);
        const rect = { x: index * width + 0.5, y: SIZE.height - 14 - tall, width: Math.max(width - 1, 0.5), height: tall };
        const title = svg(
            "title",
            {},
            `${group > 1 ? `${first} to ${first + group - 1}` : first} fragments: ${count(value)} pixels`,
        );
        return svg("rect", { ...rect, class: kept ? "within" : "beyond" }, title);
    });
    const axis = [1, Math.ceil(groups / 2), groups].map((index) =>
        svg(
            "text",
            {
                x: Math.min((index - 0.5) * width, SIZE.width - 10),
                y: SIZE.height - 2,
                class: "scale-text",
                "text-anchor": index === 1 ? "start" : "middle",
            },
            (index - 1) * group + 1,
        ),
    );
    const text = summary(covered, k, repeats);
    const drawing = svg(
        "svg",
        { viewBox: `0 0 ${SIZE.width} ${SIZE.height}`, class: "plot", role: "img", "aria-label": text },
        ...bars,
        ...axis,
    );
    const at = k === null ? null : (k / group) * width;
    if (at !== null && at <= SIZE.width) {
        const end = at > SIZE.width - 60;
        drawing.append(
            svg("line", { x1: at, x2: at, y1: 0, y2: SIZE.height - 14, class: "k-line" }),
            svg("text", { x: end ? at - 4 : at + 4, y: 10, class: "k-text", "text-anchor": end ? "end" : "start" }, `k = ${k}`),
        );
    }
    fill(parent, drawing, element("p", { className: "note" }, text));
}

const sum = (values) => values.reduce((total, value) => total + value, 0);

function summary(covered, k, repeats) {
    const pixels = sum(covered);
    const fragments = covered.reduce((total, value, index) => total + value * (index + 1), 0);
    if (pixels === 0) return "No pixel has a fragment.";
    const whole = `${count(fragments)} fragments in ${count(pixels)} covered pixels, at most ${count(covered.length)} in one`;
    if (k === null) return `${whole}. Every fragment is kept.`;
    if (repeats) return `${whole}. With k = ${k}, an iteration draws the scene for the next ${k} of each pixel, until none is left.`;
    const within = sum(covered.slice(0, k));
    const kept = covered.reduce((total, value, index) => total + value * Math.min(index + 1, k), 0);
    return `${whole}. With k = ${k}, ${percent(within, pixels)} of the pixels and ${percent(kept, fragments)} of the fragments are kept whole.`;
}

/**
 * What a description costs: memory, passes, times, fragments, the histogram of depth complexity, and the tier per target.
 *
 * Input: an analysis, the statistics of each frame, the histogram on demand. Output: figures. Nothing here computes a cost of its own,
 * except for sums and parts of what the server counted.
 */
import { button, bytes, count, element, fill, percent } from "./dom.mjs";
import { inline } from "./markdown.mjs";
import { createTimes, drawHistogram } from "./plot.mjs";

/**
 * Creates the panel.
 * @param {Record<"figures" | "times" | "fragments" | "histogram" | "predict" | "tiers", any>} elements
 * @param {{ predict(): Promise<{ histogram: number[] }>, check(target: string): void, failed(error: Error): void }} server
 */
export function createCosts(elements, { predict, check, failed }) {
    const times = createTimes(elements.times);
    /** @type {number[] | null} */
    let histogram = null;
    /** Counts changes of what a histogram is of. */
    let changes = 0;
    let k = null;
    let description = null;
    let frame = null;
    const showHistogram = () => {
        if (histogram) drawHistogram(elements.histogram, histogram, k, description?.keep?.repeats);
    };
    const forgetHistogram = () => {
        histogram = null;
        const text = "The picture changed. Count again to see its histogram.";
        fill(elements.histogram, element("p", { className: "note" }, text));
    };
    /** Shows why this description has no histogram. */
    const explain = (message) => {
        histogram = null;
        fill(elements.histogram, element("p", { className: "note" }, message.replace(/^-: /, "")));
    };
    elements.predict.addEventListener("click", async () => {
        elements.predict.disabled = true;
        const before = changes;
        try {
            histogram = (await predict()).histogram;
            if (changes === before) showHistogram();
            else forgetHistogram();
        } catch (error) {
            if (error.status === 422) explain(error.message);
            else failed(error);
        } finally {
            elements.predict.disabled = false;
        }
    });
    const showFigures = () => fill(elements.figures, figures(description, frame));
    return {
        /** Shows the plan of a description without errors. */
        describe(/** @type {any} */ analysed) {
            description = analysed;
            if (!analysed.keep) k = null;
            showFigures();
            fill(
                elements.tiers,
                analysed.targets.map((target) => tier(target, check)),
            );
            showHistogram();
        },
        /** Shows the statistics of a frame. */
        frame(/** @type {any} */ statistics) {
            frame = statistics;
            times.add(statistics.ms);
            showFigures();
            fill(elements.fragments, ...fragments(statistics));
        },
        /** Frames of another description are no longer compared. */
        clearTimes: () => times.clear(),
        setK(value) {
            k = value;
            showHistogram();
        },
        /** The description, its uniforms, the scene, its camera or the size changed: the histogram is of another picture. */
        outdate() {
            changes += 1;
            if (histogram) forgetHistogram();
        },
    };
}

function figures(description, frame) {
    if (!description) return [];
    const passes = description.passes ?? [];
    const drawn = passes.reduce((sum, { draws }) => sum + (Number(draws) || 0), 0);
    return [
        figure("words per pixel", description.words_per_pixel),
        figure("this frame", Number.isFinite(frame?.bytes) ? bytes(frame.bytes) : null),
        description.bytes !== undefined && figure("at 1920 × 1080", sizeOf(description.bytes)),
        figure("passes", count(passes.length), passes.map(({ name }) => name).join(", ")),
        // Loops that end on a condition count with their limit.
        figure(`draws of the scene${frame?.loops?.length > 0 ? ", at most" : ""}`, description.draws ?? count(drawn)),
        figure("hit ratio", Number.isFinite(frame?.hit_ratio) ? percent(frame.hit_ratio, 1) : null),
    ];
}

function figure(name, value, title) {
    const text = String(value ?? "—");
    // Formulas are longer than numbers.
    const className = text.length > 12 ? "long" : "";
    return element("div", { className: "figure-card", title }, element("dt", {}, name), element("dd", { className }, text));
}

/** The size is a number of bytes, or a formula where it depends on the scene. */
function sizeOf(value) {
    if (Number.isFinite(value)) return bytes(value);
    if (Number.isFinite(value?.bytes)) return bytes(value.bytes);
    return typeof value === "string" ? value : (value?.formula ?? "—");
}

/** Returns a bar of what happened to the generated fragments, and its figures. */
function fragments({ fragments: counted, lost, loops = [] }) {
    const { generated } = counted ?? {};
    if (!Number.isFinite(generated)) {
        return [
            element(
                "p",
                { className: "note" },
                "This description counts no fragments. Set ",
                element("code", {}, "counters: all"),
                " to see them.",
            ),
            ...(lost?.total > 0 ? losses(lost) : []),
            ...limits(loops),
        ];
    }
    const parts = [
        ["stored", counted.stored, "stored"],
        ["displaced", counted.displaced, "displaced"],
        ["culled", counted.culled, "culled"],
        ["lost", lost?.total, "lost"],
    ].filter(([, value]) => Number.isFinite(value));
    const whole = Math.max(
        generated,
        parts.reduce((sum, [, value]) => sum + value, 0),
        1,
    );
    const bar = parts.map(([, value, kind]) => element("span", { className: kind, style: `flex-grow:${value / whole}` }));
    const all = [["generated", generated, ""], ...parts, ["occluded", counted.occluded ?? 0, ""]];
    const item = ([name, value, kind]) =>
        element(
            "li",
            {},
            element("span", { className: `mark ${kind}`, "aria-hidden": "true" }),
            element("span", { className: "name" }, name),
            element("span", { className: "figure" }, count(value)),
        );
    return [
        element("div", { className: "share", "aria-hidden": "true" }, bar),
        element("ul", { className: "legend" }, all.map(item)),
        ...losses(lost),
        ...limits(loops),
    ];
}

/** Returns a warning for each loop that ended before its work was done. */
function limits(loops) {
    const text = ({ iterations }) => `A loop ended at its limit of ${iterations} iterations: work is left undone.`;
    return loops.filter(({ end }) => end === "limit").map((loop) => element("p", { className: "warn" }, text(loop)));
}

function losses(lost) {
    if (!(lost?.total > 0)) return [element("p", { className: "fine" }, "No fragment is lost.")];
    const causes = Object.entries(lost.by_counter ?? {}).filter(([, value]) => value > 0);
    return [
        element(
            "p",
            { className: "warn" },
            `${count(lost.total)} fragments are lost: `,
            causes.map(([name, value]) => `${name} ${count(value)}`).join(", "),
        ),
    ];
}

function tier({ name, tier, meaning, unsupported }, check) {
    const mark = element(
        "span",
        { className: `tier ${unsupported ? "no" : String(tier).toLowerCase()}` },
        unsupported ? "—" : tier,
    );
    const run = unsupported
        ? null
        : button("Check it", () => check(name), { className: "quiet", "aria-label": `Check it on ${name}` });
    const cells = [element("td", {}, mark), element("td", {}, inline(unsupported ?? meaning ?? "")), element("td", {}, run)];
    return element("tr", {}, element("th", { scope: "row" }, name), cells);
}

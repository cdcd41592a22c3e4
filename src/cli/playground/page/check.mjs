/**
 * The checker: runs the fragments of one pixel in every interleaving, in the background, and shows the verdict.
 *
 * Input: a target, numbers of fragments and k, a memory model. Output: the verdict, and a failing schedule step by step with a column per
 * fragment. A run ends when the person cancels it.
 */
import { count, element, fill } from "./dom.mjs";

/**
 * Creates the form and its result.
 * @param {Record<"form" | "target" | "fragments" | "k" | "model" | "run" | "cancel" | "result", any>} elements
 * @param {{ check(body: object, signal: AbortSignal): Promise<any>, lines(text: string): Promise<Map<string, string>>, text(): string }} server `lines`
 *     returns the texts of the templates' lines by their places, as far as the server maps them
 */
export function createCheck(elements, { check, lines, text }) {
    const { form, target, fragments, k, model, run, cancel, result } = elements;
    /** @type {AbortController | null} */
    let running = null;
    let checked = "";
    let newest = "";
    /** A verdict is about the text that was checked. */
    const mark = () => result.classList.toggle("outdated", checked !== "" && checked !== newest);
    const busy = (is) => {
        run.disabled = is;
        cancel.disabled = !is;
    };
    form.addEventListener("submit", async (event) => {
        event.preventDefault();
        // A button of the table of tiers starts a check, too.
        running?.abort();
        const own = (running = new AbortController());
        busy(true);
        const begin = performance.now();
        const seconds = () => ((performance.now() - begin) / 1000).toFixed(1);
        const waiting = element("span", { "aria-hidden": "true" }, "");
        fill(result, element("p", { className: "verdict running" }, "Running the fragments in every interleaving … ", waiting));
        const clock = setInterval(() => (waiting.textContent = `${seconds()} s`), 100);
        try {
            checked = text();
            mark();
            const body = {
                text: checked,
                target: target.value,
                fragments: Number(fragments.value),
                k: Number(k.value),
                model: model.value,
            };
            const report = await check(body, own.signal);
            const took = seconds();
            if (report.failure) report.failure = withLines(report.failure, await lines(body.text));
            if (own !== running) return;
            fill(result, ...shown(report, took));
        } catch (error) {
            if (own !== running) return;
            const cancelled = error.name === "AbortError";
            fill(
                result,
                element(
                    "p",
                    { className: `verdict ${cancelled ? "" : "fails"}` },
                    cancelled ? "Cancelled: nothing is decided." : error.message,
                ),
            );
        } finally {
            clearInterval(clock);
            if (own === running) {
                running = null;
                const isFocused = document.activeElement === cancel;
                busy(false);
                if (isFocused) run.focus();
            }
        }
    });
    cancel.addEventListener("click", () => running?.abort());
    busy(false);
    return {
        /** @param {{ name: string, unsupported: string | null }[]} targets */
        describe(targets) {
            const before = target.value;
            const usable = targets.filter(({ unsupported }) => !unsupported).map(({ name }) => name);
            if (usable.join() === [...target.options].map(({ value }) => value).join()) return;
            fill(
                target,
                usable.map((name) => element("option", { value: name }, name)),
            );
            if (usable.includes(before)) target.value = before;
        },
        /** Checks on a target. The focus is on the button that cancels it: the one that was pressed may be hidden now. */
        start(name) {
            target.value = name;
            form.requestSubmit();
            if (running) cancel.focus();
        },
        /** The text changed. */
        outdate(now) {
            newest = now;
            mark();
        },
    };
}

/** Returns the elements of a report: the JSON of `fragbuf check --json`. */
function shown(report, seconds) {
    if (report.not_applicable) return [element("p", { className: "verdict" }, "Not applicable: ", report.not_applicable)];
    const [kind, verdict] = verdictOf(report);
    const cases = `${count(report.cases)} ${report.cases === 1 ? "case" : "cases"}, ${count(report.states ?? 0)} states, ${seconds} s`;
    const k = [report.k ?? []].flat().join(", ");
    const what = [`${report.on}, ${report.model}`, k && `k = ${k}`, cases].filter(Boolean);
    return [
        element("p", { className: `verdict ${kind}` }, verdict),
        element("p", { className: "note" }, what.join("; ")),
        ...(report.notes ?? []).map((note) => element("p", { className: "note" }, note)),
        report.hazards?.length > 0 &&
            element(
                "ul",
                { className: "reasons" },
                report.hazards.map(({ name, description }) => element("li", {}, element("code", {}, name), " ", description)),
            ),
        ...(report.failure ? schedule(report.failure) : []),
    ];
}

function verdictOf({ holds, exhaustive, declared_hazard: declared, failure }) {
    if (failure && declared) return ["declared", "Fails with declared hazards: the schedule shows one of them."];
    if (failure) return ["fails", "Fails: a schedule leads to a wrong state."];
    if (holds && exhaustive) return ["holds", "Holds: no failure in any interleaving."];
    if (holds) return ["holds", "No failure in the interleavings that were run."];
    return ["", "Undecided: the search ended before it had seen every state."];
}

/** Returns the steps of a failing schedule as a table: a column per fragment, and the line of the template below each step. */
function schedule({ case: name, initial_fragments: initial, fragments, steps, violation, race }) {
    const names = [...new Set([...fragments.map(({ name }) => name), ...steps.map(({ fragment }) => fragment)])];
    const headings = ["step", ...names].map((text) => element("th", { scope: "col" }, text));
    const rows = (step, index) => {
        const lane = (name) => {
            const isIt = name === step.fragment;
            return element("td", { className: isIt ? `lane lane-${names.indexOf(name) % 4}` : "" }, isIt ? step.action : "");
        };
        const number = element("td", { className: "number", rowSpan: 2 }, index + 1);
        const line = element("td", { className: "location", colSpan: names.length }, location(step));
        return [element("tr", {}, number, names.map(lane)), element("tr", {}, line)];
    };
    const words = fragments.map(({ name, words }) => element("li", {}, element("code", {}, `${name}: ${words}`)));
    return [
        element("p", { className: "violation" }, violation),
        element("p", { className: "note" }, name, initial?.length > 0 && `; initially ${[initial].flat().join(", ")}`),
        element("ul", { className: "reasons" }, words),
        race &&
            element(
                "p",
                { className: "note" },
                `data race on ${race.word}: ${race.first.action} (${race.first.location}) and ${race.second.action} (${race.second.location})`,
            ),
        element(
            "div",
            { className: "schedule", tabIndex: 0, role: "region", "aria-label": "Failing schedule" },
            element("table", {}, element("thead", {}, element("tr", {}, headings)), element("tbody", {}, steps.flatMap(rows))),
        ),
    ];
}

/** Returns a schedule whose steps have the text of their lines. */
function withLines(failure, texts) {
    return { ...failure, steps: failure.steps.map((step) => ({ ...step, line: step.line ?? texts.get(step.location) })) };
}

/** A step's place, and the text of its line where the server sends it. */
function location({ location, line }) {
    return [element("span", {}, location), line && element("code", {}, String(line).trim())];
}

/**
 * The table of axes: for every axis its current value and the others, those that are illegal here with the reason.
 *
 * Input: the axes of an analysis, and its text. Output: edits, as the server gives them, with the text that they are about, when a value is
 * chosen. Nothing here knows an axis.
 */
import { element, fill } from "./dom.mjs";
import { inline } from "./markdown.mjs";

/** @typedef {{ key: string, summary: string, current: boolean, illegal: string | null, edits: object[] }} AxisValue */
/** @typedef {{ axis: string, value: string, meaning: string, from?: number, values?: AxisValue[] }} Axis */

/**
 * Creates the table.
 * @param {HTMLElement} parent
 * @param {(edits: object[], about: string) => boolean | unknown} apply returns false if it refuses the edits
 */
export function createAxes(parent, apply) {
    let before = "";
    let newest = "";
    const choose = (edits) => {
        const isApplied = apply(edits, newest) !== false;
        // The table shows the choice now: the next one to show may be equal to the one of before.
        if (isApplied) before = "";
        return isApplied;
    };
    return {
        /**
         * @param {Axis[]} axes
         * @param {string} [about] the text of which their edits are
         */
        show(axes, about = "") {
            newest = about;
            const now = JSON.stringify(axes);
            if (now === before) return;
            before = now;
            const focused = document.activeElement?.id;
            const open = new Set([...parent.querySelectorAll("details[open]")].map((details) => details.id));
            fill(
                parent,
                axes.map((axis) => row(axis, open, choose)),
            );
            if (focused?.startsWith("axis-")) document.getElementById(focused)?.focus();
        },
    };
}

function row({ axis, value, meaning, values = [] }, open, choose) {
    const select = element(
        "select",
        { id: `axis-${axis}`, "aria-label": axis, "aria-describedby": `meaning-${axis}` },
        options(value, values),
    );
    let current = select.value;
    select.addEventListener("change", () => {
        const chosen = values.find(({ key }) => key === select.value);
        // The table shows what the text has.
        if (chosen && choose(chosen.edits)) current = select.value;
        else select.value = current;
    });
    const summary = values.find(({ current }) => current)?.summary ?? meaning;
    return element(
        "div",
        { className: "axis" },
        element("label", { htmlFor: `axis-${axis}` }, axis),
        select,
        element("p", { className: "note", id: `meaning-${axis}` }, inline(summary ?? "")),
        reasons(axis, values, open),
    );
}

function options(value, values) {
    if (values.length === 0) return [element("option", { value }, value)];
    // A value may be no row: several with `else`, or a user file.
    const own = values.some(({ current }) => current) ? [] : [element("option", { value: "", selected: true }, value)];
    const option = ({ key, summary, current, illegal }) =>
        element(
            "option",
            { value: key, selected: current, disabled: Boolean(illegal), title: illegal ?? summary },
            illegal ? `${key} — not here` : key,
        );
    return [...own, ...values.map(option)];
}

function reasons(axis, values, open) {
    const illegal = values.filter((value) => value.illegal);
    if (illegal.length === 0) return null;
    const id = `reasons-${axis}`;
    const items = illegal.map(({ key, illegal }) => element("li", {}, element("code", {}, key), " ", inline(illegal)));
    const summary =
        illegal.length === 1 ? "1 value cannot be used here: why?" : `${illegal.length} values cannot be used here: why?`;
    return element(
        "details",
        { id, open: open.has(id) },
        element("summary", {}, summary),
        element("ul", { className: "reasons" }, items),
    );
}

/**
 * The table of axes: for every axis its current value and the others, those that are illegal here with the reason.
 *
 * Input: the axes of an analysis. Output: edits of the text, as the server gives them, when a value is chosen. Nothing here knows an axis.
 */
import { element, fill } from "./dom.mjs";
import { inline } from "./markdown.mjs";

/** @typedef {{ key: string, summary: string, current: boolean, illegal: string | null, edits: object[] }} AxisValue */
/** @typedef {{ axis: string, value: string, meaning: string, from?: number, values?: AxisValue[] }} Axis */

/**
 * Creates the table.
 * @param {HTMLElement} parent
 * @param {(edits: object[]) => boolean | unknown} choose
 */
export function createAxes(parent, choose) {
    let before = "";
    return {
        /** @param {Axis[]} axes */
        show(axes) {
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
    select.addEventListener("change", () => {
        const chosen = values.find(({ key }) => key === select.value);
        // The table shows what the text has.
        if (chosen && choose(chosen.edits) === false) select.value = value;
    });
    const current = values.find(({ current }) => current)?.summary ?? meaning;
    return element(
        "div",
        { className: "axis" },
        element("label", { htmlFor: `axis-${axis}` }, axis),
        select,
        element("p", { className: "note", id: `meaning-${axis}` }, inline(current ?? "")),
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

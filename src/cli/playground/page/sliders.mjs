/**
 * A slider with a number beside it, for one value.
 *
 * Input: a range and a value. Output: calls of `changed` with every value in the range of what it means. The slider's range grows with the
 * number; a number that cannot be read changes nothing. `show` shows a value from elsewhere, and leaves what is typed as it is.
 */
import { element } from "./dom.mjs";

/**
 * @param {object} options
 * @param {string} options.label the visible name, and with `what` the accessible one
 * @param {string} [options.what] what the value belongs to
 * @param {number} options.value
 * @param {number} options.least @param {number} options.most of the slider
 * @param {boolean} [options.whole] whether only whole numbers are values
 * @param {[number, number]} [options.bounds] of the number; without them every number is a value
 * @param {(value: number) => void} options.changed
 */
export function createSlider({ label, what = "", value, least, most, whole = false, bounds, changed }) {
    const name = what ? `${what} ${label}` : label;
    const step = whole ? 1 : "any";
    const range = element("input", {
        type: "range",
        min: least,
        max: most,
        step: whole ? 1 : (most - least) / 200,
        "aria-label": name,
    });
    const limits = bounds ? { min: bounds[0], max: bounds[1] } : {};
    const number = element("input", { type: "number", step, ...limits, "aria-label": `${name}, as a number` });
    const include = (value) => {
        if (value < Number(range.min)) range.min = String(value);
        if (value > Number(range.max)) range.max = String(value);
    };
    const show = (value) => {
        include(value);
        if (rounded(Number(range.value)) !== value) range.value = String(value);
        // "1.0" and "1" are the same value: a person may not have typed all of it.
        if (number.valueAsNumber !== value) number.value = String(rounded(value));
    };
    range.addEventListener("input", () => {
        const value = rounded(Number(range.value));
        number.value = String(value);
        changed(value);
    });
    number.addEventListener("input", () => {
        const value = number.valueAsNumber;
        if (
            !Number.isFinite(value) ||
            (whole && !Number.isInteger(value)) ||
            (bounds && (value < bounds[0] || value > bounds[1]))
        )
            return;
        include(value);
        range.value = String(value);
        changed(value);
    });
    show(value);
    const row = element(
        "div",
        { className: "slider" },
        element("span", { className: "name", "aria-hidden": "true" }, label),
        range,
        number,
    );
    return { row, show };
}

/** Sliders have steps of a 200th of their range: more digits would be noise. */
function rounded(value) {
    return Number(value.toPrecision(6));
}

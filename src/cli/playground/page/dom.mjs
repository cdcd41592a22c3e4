/**
 * Elements of the page, and numbers as people read them.
 *
 * Input: names, properties and children; numbers. Output: elements and text. Nothing here reads or keeps the state of the page, and no
 * text becomes markup.
 */

/** @typedef {Node | string | number | null | undefined | false} Child */

/**
 * Creates an element. Properties that begin with `on` are listeners; `class`, `data-…`, `aria-…`, `role` and the like are attributes; the
 * others are properties of the element. Children that are null or false are left out.
 * @param {string} tag
 * @param {Record<string, any>} [properties]
 * @param {...(Child | Child[])} children
 * @returns {any}
 */
export function element(tag, properties = {}, ...children) {
    const created = document.createElement(tag);
    apply(created, properties);
    append(created, children);
    return created;
}

/** Creates an element of SVG; properties are attributes. */
export function svg(tag, attributes = {}, ...children) {
    const created = document.createElementNS("http://www.w3.org/2000/svg", tag);
    for (const [name, value] of Object.entries(attributes)) created.setAttribute(name, String(value));
    append(created, children);
    return created;
}

function apply(target, properties) {
    for (const [name, value] of Object.entries(properties)) {
        if (value === undefined || value === null) continue;
        if (name.startsWith("on")) target.addEventListener(name.slice(2), value);
        else if (name in target && !name.includes("-") && name !== "list" && name !== "form") target[name] = value;
        else if (value !== false) target.setAttribute(name === "className" ? "class" : name, value === true ? "" : String(value));
    }
}

function append(parent, children) {
    for (const child of children.flat()) {
        if (child === null || child === undefined || child === false) continue;
        parent.append(typeof child === "object" ? child : String(child));
    }
}

/** Replaces the children of an element. */
export function fill(parent, ...children) {
    parent.replaceChildren();
    append(parent, children);
    return parent;
}

/** Returns the element with this id; the page has it. */
export function byId(id) {
    const found = document.getElementById(id);
    if (!found) throw new Error(`index.html has no element with the id ${id}`);
    return found;
}

/** Returns a button with a visible name. */
export function button(name, onclick, properties = {}) {
    return element("button", { type: "button", onclick, ...properties }, name);
}

const GROUPED = new Intl.NumberFormat("en", { maximumFractionDigits: 0 });

/** Returns a whole number with separators of thousands. */
export function count(value) {
    return GROUPED.format(value);
}

/** Returns a number of bytes in the unit that keeps it below 1024. */
export function bytes(value) {
    const units = ["B", "KiB", "MiB", "GiB", "TiB"];
    let unit = 0;
    while (value >= 1024 && unit < units.length - 1) {
        value /= 1024;
        unit += 1;
    }
    return `${digits(value, unit === 0 ? 0 : 3)} ${units[unit]}`;
}

/** Returns milliseconds with three significant digits. */
export function milliseconds(value) {
    return `${digits(value, 3)} ms`;
}

/** Returns a part of a whole in per cent. */
export function percent(part, whole) {
    if (!(whole > 0)) return "0 %";
    const share = (100 * part) / whole;
    return share > 0 && share < 0.1 ? "< 0.1 %" : `${digits(share, 3)} %`;
}

function digits(value, significant) {
    if (significant === 0 || value >= 1000) return GROUPED.format(value);
    return String(Number(value.toPrecision(significant)));
}

/** Returns a function that runs `action` once per turn, however often it is called. */
export function coalesced(action) {
    let isWaiting = false;
    return () => {
        if (isWaiting) return;
        isWaiting = true;
        queueMicrotask(() => {
            isWaiting = false;
            action();
        });
    };
}

/** Returns a function that runs `action` once, `delay` milliseconds after its last call. */
export function debounced(delay, action) {
    let timer = 0;
    return (...values) => {
        clearTimeout(timer);
        timer = setTimeout(() => action(...values), delay);
    };
}

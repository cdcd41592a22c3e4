/**
 * Tabs as the ARIA practices describe them: one tab stop, arrow keys between the tabs.
 *
 * Input: a list of tabs and a function. Output: calls of the function with the tab that is chosen. Nothing here knows what panels hold.
 */
import { element } from "./dom.mjs";

/**
 * Makes a tab list.
 * @param {HTMLElement} list the element that gets the tabs
 * @param {(key: string) => void} chosen called when the person chooses another tab
 */
export function createTabs(list, chosen) {
    list.setAttribute("role", "tablist");
    /** @type {Map<string, HTMLElement>} */
    const tabs = new Map();
    let current = "";

    const select = (key) => {
        current = key;
        for (const [name, tab] of tabs) {
            tab.setAttribute("aria-selected", String(name === key));
            tab.tabIndex = name === key ? 0 : -1;
        }
    };
    const choose = (key, focus) => {
        if (focus) tabs.get(key)?.focus();
        if (key === current) return;
        select(key);
        chosen(key);
    };
    list.addEventListener("keydown", (event) => {
        const keys = [...tabs.keys()];
        const at = keys.indexOf(current);
        const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: keys.length - 1 }[event.key];
        if (to === undefined || keys.length === 0) return;
        event.preventDefault();
        choose(keys[(to + keys.length) % keys.length], true);
    });
    return {
        get current() {
            return current;
        },
        /**
         * Replaces the tabs. Keeps the current one if it is still there.
         * @param {{ key: string, label: string, title?: string, panel?: string }[]} items
         * @param {string} [preferred]
         */
        set(items, preferred) {
            const focused = list.contains(document.activeElement);
            tabs.clear();
            list.replaceChildren();
            for (const { key, label, title, panel } of items) {
                const properties = { type: "button", role: "tab", title, id: panel && `tab-${panel}`, "aria-controls": panel };
                const tab = element("button", { ...properties, onclick: () => choose(key, false) }, label);
                tabs.set(key, tab);
                list.append(tab);
            }
            const key = [preferred, current].find((key) => key && tabs.has(key)) ?? items[0]?.key ?? "";
            select(key);
            if (focused) tabs.get(key)?.focus();
            return key;
        },
        select,
    };
}

/**
 * Makes the tabs of panels that are elements of the page: only that of the chosen tab is shown.
 * @param {HTMLElement} list
 * @param {{ key: string, label: string, panel: HTMLElement }[]} items
 * @param {(key: string) => void} shown
 */
export function createPanels(list, items, shown) {
    const show = (key) => {
        for (const item of items) item.panel.hidden = item.key !== key;
        shown(key);
    };
    const tabs = createTabs(list, show);
    for (const { panel } of items) {
        panel.setAttribute("role", "tabpanel");
        panel.setAttribute("aria-labelledby", `tab-${panel.id}`);
        panel.tabIndex = 0;
    }
    const first = tabs.set(items.map(({ key, label, panel }) => ({ key, label, panel: panel.id })));
    for (const item of items) item.panel.hidden = item.key !== first;
    return {
        get current() {
            return tabs.current;
        },
        show(key) {
            tabs.select(key);
            show(key);
        },
    };
}

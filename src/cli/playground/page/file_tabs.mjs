/**
 * Files as tabs: one of them is shown, read-only, and copied.
 *
 * Input: files. Output: tabs, the text of the chosen file, and copies of it. Nothing here generates a file.
 */
import { codeView } from "./code_view.mjs";
import { bytes, element, fill } from "./dom.mjs";
import { createTabs } from "./tabs.mjs";

/**
 * @typedef {object} File
 * @property {string} path
 * @property {string} [text] without it the file is binary
 * @property {string} [pass] what it is the text of: its tab has this name, unless another file has it, too
 * @property {string} [label] the name of its tab
 * @property {number} [bytes] @property {string} [base64] of a binary file
 */

/**
 * Creates the tabs.
 * @param {Record<"files" | "view" | "copy", any>} elements
 * @param {object} options
 * @param {(line: number) => void} [options.go] is called with a line of the description that a line comes from
 * @param {(origin: string) => void} [options.at] is called with where the line of the cursor comes from
 * @param {(message: string) => void} options.say
 * @param {(error: Error) => void} options.failed
 */
export function createFileTabs({ files, view, copy }, { go = () => {}, at = () => {}, say, failed }) {
    /** @type {File[]} */
    let shown = [];
    let code = null;
    const find = (path) => shown.find((file) => file.path === path);
    const show = (path) => {
        const file = find(path);
        const isText = typeof file?.text === "string";
        code?.destroy();
        code = isText ? codeView(fill(view), file, go, at) : null;
        copy.disabled = !isText;
        at("");
        if (!isText) fill(view, file && element("p", { className: "note padded" }, binary(file)));
    };
    const tabs = createTabs(files, show);
    copy.disabled = true;
    copy.addEventListener("click", async () => {
        const { path, text } = find(tabs.current);
        try {
            await navigator.clipboard.writeText(text);
            say(`Copied ${path}.`);
        } catch {
            failed(new Error("The browser does not allow the page to copy: select the text and copy it with the keyboard."));
        }
    });
    return {
        /**
         * Shows files in place of those of before. The chosen tab stays, if there is still one for it.
         * @param {File[]} list
         * @param {string} [pass] whose file is shown first
         */
        show(list, pass) {
            shown = list;
            const name = ({ label, pass, path }) => label ?? pass ?? path;
            const isTwice = (file) => list.filter((other) => name(other) === name(file)).length > 1;
            const items = list.map((file) => ({ key: file.path, label: isTwice(file) ? file.path : name(file), title: file.path }));
            const first = list.find((file) => pass && file.pass === pass) ?? list.find((file) => file.pass);
            show(tabs.set(items, tabs.current ? undefined : first?.path));
        },
    };
}

function binary({ path, bytes: size, base64 = "" }) {
    return `${path} is binary, ${bytes(size ?? Math.floor((base64.length * 3) / 4))}: it is in the download.`;
}

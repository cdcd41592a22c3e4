/**
 * The files of a variant: its description, the WGSL of every pass, and the manifest, each to read and copy.
 *
 * Input: a variant. Output: tabs with one file each, read-only. Files are those that draw the picture.
 */
import { codeView } from "./code_view.mjs";
import { fill } from "./dom.mjs";
import { createTabs } from "./tabs.mjs";

/** The tabs that are no passes. */
const [DESCRIPTION, MANIFEST] = ["description", "manifest.json"];

/**
 * @param {Record<"files" | "view" | "copy" | "note", any>} elements
 * @param {object} options
 * @param {{ generate(body: object): Promise<{ manifest: object, files: any[] }> }} options.api
 * @param {(message: string) => void} options.say
 * @param {(error: Error) => void} options.failed
 */
export function createPasses({ files, view, copy, note }, { api, say, failed }) {
    /** @type {{ key: string, label: string, path: string, text: string }[]} */
    let shown = [];
    let code = null;
    let newest = null;
    const show = (key) => {
        const file = shown.find((file) => file.key === key);
        code?.destroy();
        code = null;
        fill(view);
        copy.disabled = !file;
        if (!file) return;
        code = codeView(view, file, () => {}, () => {});
    };
    const tabs = createTabs(files, show);
    copy.addEventListener("click", async () => {
        const file = shown.find(({ key }) => key === tabs.current);
        try {
            await navigator.clipboard.writeText(file.text);
            say(`Copied ${file.path}.`);
        } catch {
            failed(new Error("The browser does not allow the page to copy: select the text and copy it with the keyboard."));
        }
    });
    return {
        /** Shows the files of a description; `reason` is why it has none. */
        async show({ text }, reason) {
            newest = text;
            note.textContent = reason ?? "";
            const description = { key: DESCRIPTION, label: DESCRIPTION, path: "description.fragbuf", text };
            if (reason) {
                shown = [description];
                return show(tabs.set(shown));
            }
            const generated = await api.generate({ text });
            // An answer about an earlier variant is dropped.
            if (newest !== text) return;
            const label = ({ pass, path }) => pass ?? path;
            const passes = generated.files.map((file) => ({ key: file.path, label: label(file), ...file }));
            const twice = ({ label }) => passes.filter((other) => other.label === label).length > 1;
            const named = passes.map((file) => (twice(file) ? { ...file, label: file.path } : file));
            const whole = `${JSON.stringify(generated.manifest, null, 2)}\n`;
            shown = [description, ...named, { key: MANIFEST, label: "manifest", path: MANIFEST, text: whole }];
            // The pass that stores fragments is what most people look for.
            const stores = generated.manifest.steps.find(({ kind }) => kind === "geometry")?.pass;
            const first = named.find(({ pass }) => pass === stores) ?? named[0];
            show(tabs.set(shown, tabs.current ? undefined : first?.key));
        },
    };
}

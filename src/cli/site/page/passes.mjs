/**
 * The files of a variant: its description, the WGSL of every pass, and the manifest, each to read and copy.
 *
 * Input: a variant. Output: tabs with one file each, read-only. Files are those that draw the picture.
 */
import { createFileTabs } from "./file_tabs.mjs";

/**
 * @param {Record<"files" | "view" | "copy" | "note", any>} elements
 * @param {object} options
 * @param {{ generate(body: object): Promise<{ manifest: object, files: any[] }> }} options.api
 * @param {(message: string) => void} options.say
 * @param {(error: Error) => void} options.failed
 */
export function createPasses({ note, ...elements }, { api, say, failed }) {
    let newest = null;
    const tabs = createFileTabs(elements, { say, failed });
    return {
        /** Shows the files of a description; `reason` is why it has none. */
        async show({ text }, reason) {
            newest = text;
            note.textContent = reason ?? "";
            const description = { path: "description.fragbuf", label: "description", text };
            if (reason) return tabs.show([description]);
            const { manifest, files } = await api.generate({ text });
            // An answer about an earlier variant is dropped.
            if (newest !== text) return;
            const whole = { path: "manifest.json", label: "manifest", text: `${JSON.stringify(manifest, null, 2)}\n` };
            // The pass that stores fragments is what most people look for.
            tabs.show([description, ...files, whole], manifest.steps.find(({ kind }) => kind === "geometry")?.pass);
        },
    };
}

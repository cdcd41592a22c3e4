/**
 * The generated text: every target's passes, read-only, with the line of the description that a line came from.
 *
 * Input: a description, its targets. Output: the files that the server generates, copied or downloaded on demand. Text is generated only
 * while the panel is shown.
 */
import { latest } from "./api.mjs";
import { element, fill } from "./dom.mjs";
import { createFileTabs } from "./file_tabs.mjs";

/**
 * @param {Record<"target" | "form" | "files" | "view" | "copy" | "download" | "note" | "where", any>} elements
 * @param {object} options
 * @param {typeof import("./api.mjs").api} options.api
 * @param {{ name: string, language: string }[]} options.targets
 * @param {(line: number) => void} options.go moves the cursor of the description to a line
 * @param {(message: string) => void} options.say
 * @param {(error: Error) => void} options.failed
 */
export function createText(elements, { api, targets, go, say, failed }) {
    const { target, form, files, view, copy, download, note, where } = elements;
    let text = null;
    let first;
    let visible = false;
    let shownFor = "";
    fill(
        target,
        targets.map(({ name, language, summary }) =>
            element("option", { value: name, title: summary }, language ? `${name} · ${language}` : name),
        ),
    );

    const shown = createFileTabs({ files, view, copy }, { go, at: (origin) => (where.textContent = origin), say, failed });
    const generate = latest((signal, text, target, form) => api.generate({ text, target, form }, signal), {
        done(answer) {
            note.textContent = "";
            shown.show(answer.files, first);
            view.classList.remove("outdated");
        },
        failed(error) {
            // A target that cannot have the description is no failure of the page.
            note.textContent = error.message;
            shownFor = "";
            shown.show([]);
            view.classList.remove("outdated");
        },
    });
    const update = () => {
        const key = JSON.stringify([text, target.value, form.value]);
        if (!visible || text === null || key === shownFor) return;
        shownFor = key;
        view.classList.add("outdated");
        generate(text, target.value, form.value);
    };
    target.addEventListener("change", update);
    form.addEventListener("change", update);
    download.addEventListener("click", async () => {
        download.disabled = true;
        try {
            save(await api.download({ text, targets: targets.map(({ name }) => name), form: form.value }), "fragbuf.zip");
            say("Downloaded fragbuf.zip: the passes of every target that supports the description, with their manifest.");
        } catch (error) {
            failed(error);
        } finally {
            download.disabled = false;
        }
    });
    return {
        /** Generates the text of a description without errors, now or when the panel is shown. */
        describe(described, passes) {
            text = described;
            // The pass that stores fragments is what most people look for.
            first = passes?.find(({ kind }) => kind === "geometry")?.name;
            update();
        },
        setVisible(is) {
            visible = is;
            update();
        },
    };
}

/** Lets the browser save a file. */
function save(blob, name) {
    const address = URL.createObjectURL(blob);
    const link = element("a", { href: address, download: name });
    link.click();
    setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

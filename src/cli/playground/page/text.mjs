/**
 * The generated text: every target's passes, read-only, with the line of the description that a line came from.
 *
 * Input: a description, its targets. Output: the files that the server generates, copied or downloaded on demand. Text is generated only
 * while the panel is shown.
 */
import { latest } from "./api.mjs";
import { codeView } from "./code_view.mjs";
import { bytes, element, fill } from "./dom.mjs";
import { createTabs } from "./tabs.mjs";

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
    /** @type {any[]} */
    let generated = [];
    let code = null;
    fill(
        target,
        targets.map(({ name, language, summary }) =>
            element("option", { value: name, title: summary }, language ? `${name} · ${language}` : name),
        ),
    );

    const show = (path) => {
        const file = generated.find((file) => file.path === path);
        code?.destroy();
        code = null;
        where.textContent = "";
        if (!file) return fill(view);
        copy.disabled = typeof file.text !== "string";
        if (typeof file.text !== "string") {
            const size = file.bytes ?? Math.floor(((file.base64?.length ?? 0) * 3) / 4);
            return fill(
                view,
                element("p", { className: "note padded" }, `${file.path} is binary, ${bytes(size)}: it is in the download.`),
            );
        }
        fill(view);
        code = codeView(view, file, go, (origin) => (where.textContent = origin));
        return view;
    };
    const tabs = createTabs(files, show);
    const generate = latest((signal, text, target, form) => api.generate({ text, target, form }, signal), {
        done(answer) {
            generated = answer.files;
            const label = (file) => file.pass ?? file.path;
            const twice = (file) => generated.filter((other) => label(other) === label(file)).length > 1;
            const items = generated.map((file) => ({
                key: file.path,
                label: twice(file) ? file.path : label(file),
                title: file.path,
            }));
            note.textContent = "";
            show(tabs.set(items, generated.find(({ pass }) => !tabs.current && pass === first)?.path));
            view.classList.remove("outdated");
        },
        failed(error) {
            // A target that cannot have the description is no failure of the page.
            note.textContent = error.message;
            generated = [];
            shownFor = "";
            view.classList.remove("outdated");
            show(tabs.set([]));
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
    copy.addEventListener("click", async () => {
        const file = generated.find((file) => file.path === tabs.current);
        try {
            await navigator.clipboard.writeText(file.text);
            say(`Copied ${file.path}.`);
        } catch {
            failed(new Error("The browser does not allow the page to copy: select the text and copy it with the keyboard."));
        }
    });
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
export function save(blob, name) {
    const address = URL.createObjectURL(blob);
    const link = element("a", { href: address, download: name });
    link.click();
    setTimeout(() => URL.revokeObjectURL(address), 60_000);
}

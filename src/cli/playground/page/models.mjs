/**
 * Models of the person at the page: dropped on the picture, or opened by a button.
 *
 * Input: a file. Output: a row of the list of scenes, after the server has read the file without errors. The file goes to this server alone,
 * and files that it names are not read.
 */
import { count } from "./dom.mjs";

/** The server refuses larger models. */
const MOST_BYTES = 64 * 1024 * 1024;

/**
 * Returns the row of a model in the list of scenes. It has no parameters.
 * @param {{ scene: string, name: string, triangles: number, warnings: string[] }} model
 */
export function modelRow({ scene, name, triangles, warnings }) {
    const summary = [`Your model ${name}, ${count(triangles)} triangles`, ...warnings].join("; ");
    return { name: scene, label: name, summary, parameters: [] };
}

/**
 * Listens for models.
 * @param {Record<"area" | "input" | "open", any>} elements the area for drops, the file picker, and its button
 * @param {object} options
 * @param {typeof import("./api.mjs").api} options.api
 * @param {(row: object, message: string) => void} options.opened
 * @param {(error: Error) => void} options.failed
 */
export function createModels({ area, input, open }, { api, opened, failed }) {
    let newest = 0;
    const send = async (file) => {
        const own = (newest += 1);
        open.disabled = true;
        try {
            if (file.size > MOST_BYTES) throw new Error(`${file.name} has ${count(file.size)} bytes: a model has at most 64 MiB.`);
            const model = await api.model(file);
            // Of two models that are opened at the same time, the later choice is shown.
            if (own !== newest) return;
            opened(modelRow(model), `Opened ${model.name}.`);
        } catch (error) {
            if (own === newest) failed(error);
        } finally {
            if (own === newest) open.disabled = false;
        }
    };
    open.addEventListener("click", () => input.click());
    input.addEventListener("change", () => {
        const [file] = input.files;
        // The same file may be opened again after a change.
        if (file) send(file).finally(() => (input.value = ""));
    });
    const hasFiles = (event) => [...(event.dataTransfer?.types ?? [])].includes("Files");
    area.addEventListener("dragover", (event) => {
        if (!hasFiles(event)) return;
        event.preventDefault();
        event.dataTransfer.dropEffect = "copy";
        area.classList.add("dropping");
    });
    area.addEventListener("dragleave", (event) => area.contains(event.relatedTarget) || area.classList.remove("dropping"));
    area.ondrop = (event) => {
        area.classList.remove("dropping");
        if (!hasFiles(event)) return;
        event.preventDefault();
        const { files } = event.dataTransfer;
        if (files.length === 1) send(files[0]);
        else failed(new Error("Drop one model at a time: the files that it names are not read. A GLB holds all of its parts."));
    };
}

/**
 * The controls of the picture: scene with its parameters, size, device, k and uniforms; and the presets of the description.
 *
 * Input: what the server lists at the start, and the description as far as it has no errors. Output: changes of the store. The text of the
 * description is changed through the editor alone.
 */
import { element, fill } from "./dom.mjs";
import { parseScene, sceneName } from "./scenes.mjs";
import { createSlider } from "./sliders.mjs";
import { components, uniformValues } from "./uniforms.mjs";

/** @typedef {import("./state.mjs").State} State */

/** Sides of pictures: the server's CPU device draws the largest in seconds. */
const SIDES = [16, 2048];

/**
 * Fills the picker of presets.
 * @param {HTMLSelectElement} select
 * @param {HTMLElement} note what the preset is
 * @param {{ techniques: any[], examples: any[] }} start
 * @param {(text: string) => void} chosen
 */
export function createPresets(select, note, { techniques, examples }, chosen) {
    const own = element("option", { value: "" }, "Your own description");
    const group = (label, kind, presets) =>
        element(
            "optgroup",
            { label },
            presets.map(({ key, title }, index) => element("option", { value: `${kind}${index}` }, name(key, title))),
        );
    fill(select, own, group("Examples", "e", examples), group("Techniques", "t", techniques));
    const presets = new Map();
    examples.forEach((preset, index) => presets.set(`e${index}`, preset));
    techniques.forEach((preset, index) => presets.set(`t${index}`, preset));
    const describe = (preset) => {
        const summary = preset && (preset.summary ?? comment(preset.text) ?? preset.title);
        note.textContent = [summary, preset?.paper].filter(Boolean).join(" — ");
        note.title = note.textContent;
    };
    select.addEventListener("change", () => {
        const preset = presets.get(select.value);
        if (preset) chosen(preset.text);
    });
    return {
        /** Shows which preset a text is. */
        show(text) {
            const found = [...presets].find(([, preset]) => preset.text === text);
            select.value = found ? found[0] : "";
            own.hidden = Boolean(found);
            describe(found?.[1]);
        },
        /** Returns the text of a technique. */
        technique: (key) => techniques.find((technique) => technique.key === key)?.text,
    };
}

/** Returns the comment that a description begins with. */
function comment(text) {
    const lines = /^(?:\/\/.*\n)*/.exec(text)[0];
    return (
        lines
            .replaceAll(/^\/\/ ?/gm, "")
            .replaceAll("\n", " ")
            .trim() || null
    );
}

function name(key, title) {
    return title && title.toLowerCase() !== key.toLowerCase() ? `${key} · ${title}` : key;
}

/**
 * Fills the pickers of scene, size and device.
 * @param {Record<"scene" | "parameters" | "note" | "width" | "height" | "device", any>} elements
 * @param {{ scenes: any[], devices: string[] }} start
 * @param {ReturnType<typeof import("./state.mjs").createStore>} store
 */
export function createView(elements, { scenes, devices }, store) {
    const { scene, parameters, note, width, height, device } = elements;
    const listScenes = () =>
        fill(
            scene,
            scenes.map(({ name, label, summary }) => element("option", { value: name, title: summary }, label ?? name)),
        );
    listScenes();
    fill(
        device,
        ["auto", ...devices.filter((name) => name !== "auto")].map((name) => element("option", { value: name }, name)),
    );
    scene.addEventListener("change", () => {
        const row = scenes.find(({ name }) => name === scene.value);
        store.set({ scene: sceneName(row), camera: null });
    });
    device.addEventListener("change", () => store.set({ device: device.value }));
    for (const side of [width, height]) {
        Object.assign(side, { min: SIDES[0], max: SIDES[1] });
        side.addEventListener("change", () => store.set({ size: [sideOf(width), sideOf(height)] }));
    }
    const showScene = (name) => {
        const parsed = parseScene(scenes, name);
        if (!parsed) return;
        scene.value = parsed.scene.name;
        note.textContent = parsed.scene.summary;
        note.title = parsed.scene.summary;
        const focused = document.activeElement?.id;
        fill(
            parameters,
            parsed.scene.parameters.map((parameter) => parameterInput(parsed, parameter, store)),
        );
        if (focused) document.getElementById(focused)?.focus();
    };
    const show = (/** @type {State} */ state) => {
        showScene(state.scene);
        [width.value, height.value] = state.size.map(String);
        device.value = state.device;
        if (device.selectedIndex < 0) device.value = "auto";
    };
    show(store.value);
    store.subscribe((state, changed) => {
        if (["scene", "size", "device"].some((name) => changed.has(name))) show(state);
    });
    return {
        /** Adds a scene to the list, in place of one of the same name, and shows it. */
        open(row) {
            const index = scenes.findIndex(({ name }) => name === row.name);
            scenes.splice(index < 0 ? scenes.length : index, 1, row);
            listScenes();
            store.set({ scene: row.name, camera: null });
            show(store.value);
        },
    };
}

function sideOf(input) {
    const value = Math.round(Number(input.value)) || 256;
    return Math.min(Math.max(value, SIDES[0]), SIDES[1]);
}

function parameterInput({ scene, values }, { name }, store) {
    const changed = (event) => {
        const value = event.target.valueAsNumber;
        if (Number.isInteger(value) && value >= 0) store.set({ scene: sceneName(scene, { ...values, [name]: value }) });
    };
    const input = element("input", {
        type: "number",
        min: 0,
        step: 1,
        value: values[name],
        id: `parameter-${name}`,
        onchange: changed,
    });
    return element("label", { className: "field" }, element("span", {}, name), input);
}

/**
 * The sliders of k and of the uniforms. They are built again only if the description declares others.
 * @param {{ k: HTMLElement, uniforms: HTMLElement }} elements
 * @param {ReturnType<typeof import("./state.mjs").createStore>} store
 */
export function createValues(elements, store) {
    let built = "";
    /** The k of the description that was shown last. */
    let described = null;
    /** Whether the next description is another one, with values of its own. */
    let fresh = false;
    return {
        /** @param {{ keep: { k: number, capacity: number } | null, uniforms: Uniform[] }} description */
        show({ keep, uniforms }) {
            const key = JSON.stringify([keep, uniforms]);
            if (key === built) return;
            built = key;
            if (fresh) store.set({ k: null, uniforms: {} });
            fresh = false;
            // Another k in the text is the person's newest choice.
            if (described !== null && described !== keep?.k) store.set({ k: null });
            described = keep?.k ?? null;
            showK(elements.k, keep, store);
            const values = uniformValues(uniforms, store.value.uniforms);
            store.set({ uniforms: values });
            fill(
                elements.uniforms,
                uniforms.map((uniform) => uniformSliders(uniform, values, store)),
            );
        },
        /** Builds the sliders again at the next description, with the values of the store, or of a preset with values of its own. */
        forget({ values }) {
            built = "";
            described = null;
            fresh = !values;
        },
    };
}

function showK(parent, keep, store) {
    if (!keep) {
        store.set({ k: null });
        fill(parent, element("p", { className: "note" }, "Keeps every fragment: no k to choose."));
        return;
    }
    const { capacity } = keep;
    const k = Math.min(store.value.k ?? keep.k, capacity);
    store.set({ k });
    if (capacity <= 1) {
        fill(parent, element("p", { className: "note" }, "Keeps one fragment per pixel."));
        return;
    }
    const slider = createSlider({
        label: "k",
        value: k,
        least: 1,
        most: capacity,
        bounds: [1, capacity],
        whole: true,
        changed: (k) => store.set({ k }),
    });
    fill(parent, slider.row, element("p", { className: "note" }, `fragments kept per pixel, of at most ${capacity}`));
}

/** @typedef {import("./uniforms.mjs").Uniform} Uniform */

function uniformSliders(uniform, values, store) {
    const { name, type } = uniform;
    const number = components(uniform);
    const whole = type === "u32" || type === "i32";
    const least = type === "i32" ? -16 : number === 3 ? -1 : 0;
    const change = (index, value) => {
        const before = store.value.uniforms[name];
        const values = Array.isArray(before) ? before.with(index, value) : value;
        store.set({ uniforms: { ...store.value.uniforms, [name]: values } });
    };
    const slider = (index) =>
        createSlider({
            label: number === 1 ? name : "xyzw"[index],
            what: number === 1 ? "" : name,
            value: number === 1 ? values[name] : values[name][index],
            least,
            most: whole ? 16 : 1,
            whole,
            bounds: type === "u32" ? [0, 4294967295] : undefined,
            changed: (value) => change(index, value),
        }).row;
    const sliders = Array.from({ length: number }, (_, index) => slider(index));
    if (number === 1) return sliders[0];
    return element(
        "div",
        { className: "vector", role: "group", "aria-label": name },
        element("span", { className: "name" }, `${name}: ${type}`),
        sliders,
    );
}

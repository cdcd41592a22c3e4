/**
 * The controls of the picture: scene with its parameters, size, device, k and uniforms; and the presets of the description.
 *
 * Input: what the server lists at the start, and the description as far as it has no errors. Output: changes of the store. The text of the
 * description is changed through the editor alone.
 */
import { element, fill } from "./dom.mjs";
import { parseScene, sceneName } from "./scenes.mjs";
import { createSlider } from "./sliders.mjs";
import { SIDES } from "./state.mjs";
import { components, uniformValues, valuesOf } from "./uniforms.mjs";

/** @typedef {import("./state.mjs").State} State */

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
 * The sliders of k and of the uniforms. They show the values of the store, and are built again only if the description declares others.
 * @param {{ k: HTMLElement, uniforms: HTMLElement }} elements
 * @param {ReturnType<typeof import("./state.mjs").createStore>} store
 */
export function createValues(elements, store) {
    let built = "";
    /** What the description that was shown last keeps and declares. */
    let described = null;
    /** The k of that description, unless the next one has a k of its own. */
    let usual = null;
    /** Whether the next description is another one, with values of its own. */
    let fresh = false;
    /** Functions that show values. */
    let shows = [];
    const showValues = () => {
        const values = valuesOf(described, store.value);
        for (const show of shows) show(values);
    };
    store.subscribe((_, changed) => {
        if (described && (changed.has("k") || changed.has("uniforms"))) showValues();
    });
    return {
        /** @param {{ keep: { k: number, capacity: number, repeats?: boolean } | null, uniforms: Uniform[] }} description */
        show({ keep, uniforms }) {
            const key = JSON.stringify([keep, uniforms]);
            const isOther = key !== built;
            if (isOther) {
                if (fresh) store.set({ k: null, uniforms: {} });
                fresh = false;
                // Another k in the text is the person's newest choice.
                if (usual !== null && usual !== keep?.k) store.set({ k: null });
                built = key;
                described = { keep, uniforms };
                usual = keep?.k ?? null;
                shows = [];
            }
            store.set(valuesOf(described, store.value));
            if (!isOther) return;
            const change = (changes) => store.set(changes);
            shows = [kSlider(elements.k, keep, change), ...uniformSliders(elements.uniforms, uniforms, store)];
            showValues();
        },
        /** Builds the sliders again at the next description, with the values of the store, or of a preset with values of its own. */
        forget({ values }) {
            built = "";
            usual = null;
            fresh = !values;
        },
    };
}

/** Fills the group of k. Returns what shows its value. */
function kSlider(parent, keep, change) {
    const capacity = keep?.capacity ?? 0;
    const where = keep?.repeats ? " and iteration" : "";
    if (capacity <= 1) {
        const text = keep ? `Keeps one fragment per pixel${where}.` : "Keeps every fragment: no k to choose.";
        fill(parent, element("p", { className: "note" }, text));
        return () => {};
    }
    const slider = createSlider({
        label: "k",
        value: keep.k,
        least: 1,
        most: capacity,
        bounds: [1, capacity],
        whole: true,
        changed: (k) => change({ k }),
    });
    fill(parent, slider.row, element("p", { className: "note" }, `fragments kept per pixel${where}, of at most ${capacity}`));
    return ({ k }) => slider.show(k);
}

/** @typedef {import("./uniforms.mjs").Uniform} Uniform */

/** Fills the group of uniforms. Returns what shows the value of each. */
function uniformSliders(parent, uniforms, store) {
    const groups = uniforms.map((uniform) => uniformSlider(uniform, store));
    fill(
        parent,
        groups.map(({ row }) => row),
    );
    return groups.map(({ show }) => show);
}

function uniformSlider(uniform, store) {
    const { name, type } = uniform;
    const number = components(uniform);
    const whole = type === "u32" || type === "i32";
    const least = type === "i32" ? -16 : number === 3 ? -1 : 0;
    const change = (index, value) => {
        const { uniforms } = store.value;
        const before = uniformValues([uniform], uniforms)[name];
        store.set({ uniforms: { ...uniforms, [name]: Array.isArray(before) ? before.with(index, value) : value } });
    };
    const slider = (index) =>
        createSlider({
            label: number === 1 ? name : "xyzw"[index],
            what: number === 1 ? "" : name,
            value: [store.value.uniforms[name]].flat()[index],
            least,
            most: whole ? 16 : 1,
            whole,
            bounds: type === "u32" ? [0, 4294967295] : undefined,
            changed: (value) => change(index, value),
        });
    const sliders = Array.from({ length: number }, (_, index) => slider(index));
    const show = ({ uniforms }) => sliders.forEach((slider, index) => slider.show([uniforms[name]].flat()[index]));
    if (number === 1) return { row: sliders[0].row, show };
    const row = element(
        "div",
        { className: "vector", role: "group", "aria-label": name },
        element("span", { className: "name" }, `${name}: ${type}`),
        sliders.map((slider) => slider.row),
    );
    return { row, show };
}

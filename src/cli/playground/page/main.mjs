/**
 * The page of the playground: creates its parts and passes what changes from one to the others.
 *
 * Input: the state of a link, typing, controls. Output: requests, and what the parts show of their answers. Each part is a module that
 * knows its own elements only; the order of what follows from a change is here.
 */
import { api, latest } from "./api.mjs";
import { createAxes } from "./axes.mjs";
import { AUTO } from "./camera.mjs";
import { createCheck } from "./check.mjs";
import { createCompare } from "./compare.mjs";
import { createPresets, createValues, createView } from "./controls.mjs";
import { createCosts } from "./costs.mjs";
import { byId, coalesced, count, debounced, milliseconds } from "./dom.mjs";
import { createEditor } from "./editor.mjs";
import { decode, encode } from "./link.mjs";
import { createModels, modelRow } from "./models.mjs";
import { createPicture } from "./picture.mjs";
import { createProblems } from "./problems.mjs";
import { parseScene, sceneName } from "./scenes.mjs";
import { ServerFrames } from "./server_frames.mjs";
import { createStatus } from "./status.mjs";
import { INITIAL, createStore } from "./state.mjs";
import { frameOf } from "./statistics.mjs";
import { createPanels } from "./tabs.mjs";
import { createText } from "./text.mjs";
import { createTheme } from "./theme.mjs";
import { valuesOf } from "./uniforms.mjs";

/** How long typing must rest before the text is analysed. */
const TYPING = 10;

createTheme(byId("theme"));
const status = createStatus(byId("status"));
const failed = (error) => status.fail(error, "analysis");

/** Returns what shows errors of one source, until it succeeds. */
const failing = (source) => (error) => status.fail(error, source);

/** Returns the elements whose ids begin with a prefix, by the rest of their names. */
const elements = (prefix, names) => Object.fromEntries(names.map((name) => [name, byId(prefix + name)]));

async function run() {
    const start = await api.start();
    start.scenes.push(...start.models.map(modelRow));
    byId("about").textContent = `fragbuf ${start.version}`;
    const link = await readLink(start);
    showMissing([start.devices_problem, ...link.problems]);
    const scene = start.scenes.find(({ name }) => name === "marbles") ?? start.scenes[0];
    const text = (start.examples[0] ?? start.techniques[0]).text;
    const store = createStore({ ...INITIAL, text, scene: sceneName(scene), ...link.fields });
    const page = await createPage(start, store);
    window.addEventListener("hashchange", async () => {
        const { fields, problems } = await readLink(start);
        showMissing(problems);
        if (fields.text !== undefined) page.restore(fields);
    });
    page.analyse(store.value.text);
}

/** Returns the state of the address as far as this page has it, and in words what it does not have. A damaged link is no state. */
async function readLink({ scenes, devices }) {
    try {
        const fields = (await decode(location.hash)) ?? {};
        const problems = [];
        const { scene, device } = fields;
        if (scene && !parseScene(scenes, scene)) {
            delete fields.scene;
            problems.push(
                scene.startsWith("model:")
                    ? "The link shows a model of its sender: open the model here to see it."
                    : `The link names the scene ${scene}, which this version does not have.`,
            );
        }
        if (device && ![INITIAL.device, ...devices].includes(device)) {
            delete fields.device;
            problems.push(`The link names the device ${device}, which the server does not list: choose another one.`);
        }
        return { fields, problems };
    } catch (error) {
        return { fields: {}, problems: [error.message] };
    }
}

/** Shows in the status line what is missing, in place of what the link before missed. */
function showMissing(sentences) {
    const given = sentences.filter(Boolean);
    if (given.length > 0) status.fail(new Error(given.join(" ")), "link");
    else status.recovered("link");
}

async function createPage(start, store) {
    /** The newest text without errors, and its description: what the panels show. */
    let valid = { text: "", description: null };
    let picture = null;
    /** Whether the values of a link wait for the analysis of its text. */
    let isRestoring = false;

    const editor = createEditor(byId("editor"), {
        text: store.value.text,
        api,
        failed,
        changed: (text) => store.set({ text }),
        outdated: () => status.say("The text changed meanwhile: try again when the problems are up to date."),
    });
    editor.setNames(start.techniques.map(({ key }) => key));
    const heading = byId("problems-heading");
    const problems = createProblems({ list: byId("problems-list"), heading }, editor);
    /** Marks that the problems are those of an earlier text. */
    const setBusy = (is) => heading.setAttribute("aria-busy", String(is));
    const presets = createPresets(byId("preset"), byId("preset-note"), start, (text) => {
        values.forget({ values: false });
        editor.replace(text);
    });
    presets.show(store.value.text);
    const view = createView({ ...elements("", ["scene", "parameters", "width", "height", "device"]), note: byId("scene-note") }, start, store);
    createModels(
        { area: byId("picture-pane"), input: byId("model-input"), open: byId("model-open") },
        {
            api,
            opened(row, message) {
                view.open(row);
                status.say(message);
            },
            failed: failing("model"),
        },
    );
    const values = createValues(elements("", ["k", "uniforms"]), store);

    /** Returns a request of the picture. Values that the description does not have are those of a text with errors. */
    const request = () => {
        const { scene, size, camera, device } = store.value;
        const values = valuesOf(valid.description ?? { keep: null, uniforms: [] }, store.value);
        return { text: valid.text, scene, size, camera: camera ?? picture?.camera, device, ...values };
    };
    const costs = createCosts(elements("", ["figures", "times", "fragments", "histogram", "predict", "tiers"]), {
        async predict() {
            const { text, scene, size, camera, uniforms } = request();
            const prediction = await api.predict({ text, scene, size, camera, uniforms });
            status.recovered("predict");
            return prediction;
        },
        check: (target) => {
            panels.show("check");
            check.start(target);
        },
        failed: failing("predict"),
    });
    const axes = createAxes(byId("axes"), editor.apply);
    const check = createCheck(elements("check-", ["form", "target", "fragments", "k", "model", "run", "cancel", "result"]), {
        check: api.check,
        lines: (text) => templateLines(text, start.targets[0].name),
        text: () => valid.text,
    });
    const text = createText(
        { ...elements("text-", ["target", "form", "files", "view", "copy", "note", "where"]), download: byId("download") },
        {
            api,
            targets: start.targets,
            go: (line) => editor.go({ line }),
            say: status.say,
            failed,
        },
    );
    const compare = createCompare(elements("compare-", ["preset", "own", "first", "second", "difference", "summary", "grid"]), {
        api,
        presets: [...start.examples, ...start.techniques],
        request,
        failed,
    });

    const showAxes = latest(async (signal, text) => ({ text, answer: await api.analyse({ text, axes: true }, signal) }), {
        done: ({ text, answer: { description } }) => description && axes.show(description.axes ?? [], text),
        failed,
    });
    const panels = createPanels(
        byId("tabs"),
        ["costs", "axes", "check", "text", "compare"].map((key) => ({ key, label: LABELS[key], panel: byId(`panel-${key}`) })),
        (key) => {
            text.setVisible(key === "text");
            compare.setVisible(key === "compare");
            if (key === "axes") showAxes(valid.text);
        },
    );

    picture = await createPicture(byId("picture"), { report, fallback: new ServerFrames() });
    function report(result) {
        if (result.error) return showError(typeof result.error === "string" ? result.error : result.error.message);
        showError(null);
        const frame = frameOf(result);
        byId("frame").textContent = frameLine(frame);
        byId("frame").title = frame.messages.join("\n");
        costs.frame(frame);
        if (picture?.camera && store.value.camera !== picture.camera) store.set({ camera: { ...picture.camera } });
    }
    const draw = coalesced(() => {
        if (!valid.description || isRestoring) return;
        const { camera, ...changes } = request();
        if (restored) changes.camera = restored;
        restored = null;
        const { size } = changes;
        const [width, height] = size;
        byId("stage").style.setProperty("--aspect", String(width / height));
        Promise.resolve(picture.set(changes)).catch((error) => showError(error.message));
    });
    let restored = store.value.camera;

    const analyse = latest(async (signal, text) => ({ text, answer: await api.analyse({ text }, signal) }), {
        done({ text: about, answer }) {
            if (!editor.show(answer.diagnostics, about)) return;
            const isRestored = isRestoring;
            isRestoring = false;
            status.recovered("start");
            status.recovered("analysis");
            problems.show(answer.diagnostics, about);
            setBusy(false);
            const { description } = answer;
            document.body.dataset.text = description ? "valid" : "invalid";
            check.outdate(about);
            // The last description without errors is drawn with the scene and the size of a link whose text has errors.
            if (!description) return void (isRestored && draw());
            if (about !== valid.text) costs.outdate();
            if (description.technique !== valid.description?.technique || description.name !== valid.description?.name)
                costs.clearTimes();
            valid = { text: about, description };
            values.show(description);
            costs.describe(description);
            costs.setK(request().k);
            check.describe(description.targets);
            text.describe(about, description.passes);
            if (panels.current === "axes") showAxes(about);
            draw();
            compare.update();
        },
        failed(error) {
            isRestoring = false;
            setBusy(false);
            failing("analysis")(error);
        },
    });
    const analyseRested = debounced(TYPING, analyse);
    const analyseSoon = (text) => {
        setBusy(true);
        analyseRested(text);
    };
    const writeLink = debounced(300, async () => {
        const fragment = await encode(store.value).catch(() => null);
        // A description that is too long for a link leaves the address without one.
        history.replaceState(null, "", fragment ? `#${fragment}` : location.pathname);
    });
    const compareSoon = debounced(120, () => compare.update());

    store.subscribe((state, changed) => {
        if (changed.has("text")) {
            presets.show(state.text);
            analyseSoon(state.text);
        }
        if (["scene", "uniforms", "k", "size", "device"].some((name) => changed.has(name))) draw();
        if (changed.has("k")) costs.setK(request().k);
        if (["scene", "camera", "size", "uniforms"].some((name) => changed.has(name))) costs.outdate();
        if (!changed.has("text")) compareSoon();
        writeLink();
    });
    byId("share").addEventListener("click", () => share(store.value));

    return {
        analyse: analyseSoon,
        /** Shows the state of another link: its values are drawn with its text. */
        restore(changes) {
            isRestoring = true;
            values.forget({ values: true });
            restored = changes.camera ?? AUTO;
            store.set({ k: null, camera: null, uniforms: {}, ...changes });
            editor.replace(changes.text);
            analyseSoon(changes.text);
        },
    };
}

/** Returns the texts of the templates' lines in the passes of a description, by their places. Without them, a schedule has places alone. */
async function templateLines(text, target) {
    const texts = new Map();
    const { files } = await api.generate({ text, target, form: "program" }).catch(() => ({ files: [] }));
    for (const { text, templates } of files) {
        const lines = text?.split("\n") ?? [];
        templates?.forEach((place, index) => place && texts.set(place, lines[index]));
    }
    return texts;
}

const LABELS = { costs: "Costs", axes: "Axes", check: "Check it", text: "Text", compare: "Side by side" };

async function share(state) {
    try {
        const address = `${location.origin}${location.pathname}#${await encode(state)}`;
        history.replaceState(null, "", address);
        await navigator.clipboard.writeText(address);
        status.say("Copied the link: it holds the description, scene, camera, k and uniforms.");
    } catch (error) {
        failed(
            error.name === "NotAllowedError"
                ? new Error("The browser does not allow the page to copy: the link is in the address bar.")
                : error,
        );
    }
}

/** Shows why there is no picture, over the last one. */
function showError(message) {
    const overlay = byId("overlay");
    overlay.hidden = !message;
    overlay.textContent = message ?? "";
}

/** Returns a frame's statistics in a line. */
function frameLine({ device, target, ms, frame_ms: whole, fragments, lost, triangles, k }) {
    // Preparing passes and triangles is no part of a frame.
    const times = whole === null ? Object.values(ms) : [whole];
    const parts = [
        device,
        target,
        times.length > 0 && milliseconds(times.reduce((sum, value) => sum + value, 0)),
        Number.isFinite(triangles) && `${count(triangles)} triangles`,
        fragments && `${count(fragments.generated)} fragments`,
        lost?.total > 0 && `${count(lost.total)} fragments are lost`,
        Number.isFinite(k) && `k = ${k}`,
    ];
    return parts.filter(Boolean).join(" · ");
}

run().catch(failed);

/**
 * The player: a technique, a scene, k, a sort and an overflow are chosen, and WebGPU draws the picture by passes that the site has.
 *
 * Input: the files of the site, the fragment of the address, and controls. Output: the picture, what it costs, and the passes beside it. The
 * order of what follows from a change is here; each part is a module that has its own elements only.
 */
import { read, write } from "./address.mjs";
import { api } from "./api.mjs";
import { createAxes } from "./axes.mjs";
import { CHOSEN, axes, legal, variantOf } from "./choices.mjs";
import { createValues, createView } from "./controls.mjs";
import { byId, bytes, coalesced, count, debounced, element, fill, milliseconds } from "./dom.mjs";
import { inline } from "./markdown.mjs";
import { createPasses } from "./passes.mjs";
import { createPicture } from "./picture.mjs";
import { PrerenderedFrames } from "./prerendered.mjs";
import { createStore } from "./state.mjs";
import { frameOf } from "./statistics.mjs";
import { createStatus } from "./status.mjs";
import { createTheme } from "./theme.mjs";

const NO_WEBGPU =
    "This browser gives the page no WebGPU. The player needs a current Chrome, Edge, Safari or Firefox with a graphics driver, and a page " +
    "that comes by HTTPS or from this machine. The picture was drawn by the CPU device when the site was generated: its scene, camera and " +
    "k do not change.";

const status = createStatus(byId("status"));
const failed = (error) => status.fail(error, "player");

async function run() {
    createTheme(byId("theme"));
    byId("overlay").hidden = true;
    const site = await api.site();
    byId("about").textContent = `fragbuf ${site.version}`;
    const first = site.techniques.find(({ drawn }) => drawn) ?? site.techniques[0];
    const store = createStore({
        technique: first.key,
        capacity: null,
        sort: null,
        overflow: null,
        scene: site.scenes[0].name,
        size: [640, 480],
        camera: null,
        k: null,
        uniforms: {},
        device: "auto",
    });
    await createPlayer(site, store);
}

async function createPlayer(site, store) {
    let technique = null;
    /** Counts choices of techniques: only the newest is shown. */
    let newest = 0;
    const select = byId("technique");
    const option = ({ key, title, drawn }) => {
        const name = title.toLowerCase() === key.toLowerCase() ? key : `${key} · ${title}`;
        return element("option", { value: key }, drawn ? name : `${name} (picture alone)`);
    };
    fill(select, site.techniques.map(option));
    select.addEventListener("change", () => tryChoice({ ...chosen(store.value), technique: select.value, k: null }));
    const view = { scene: byId("scene"), note: byId("scene-note"), width: byId("width"), height: byId("height") };
    // Generated scenes have their default parameters, and WebGPU is the only device.
    const unused = { parameters: element("div"), device: element("select") };
    createView({ ...view, ...unused }, { scenes: site.scenes, devices: [] }, store);
    const values = createValues({ k: byId("k"), uniforms: element("div") }, store);
    const table = createAxes(byId("axes"), ([change]) => tryChoice({ ...chosen(store.value), ...change }));
    const passes = createPasses(
        { files: byId("files"), view: byId("view"), copy: byId("copy"), note: byId("passes-note") },
        { api, say: status.say, failed },
    );
    const picture = await createPicture(byId("picture"), { report, fallback: new PrerenderedFrames() });

    /** Shows a technique with these choices, as far as it has them. */
    async function choose(given) {
        const turn = (newest += 1);
        const row = site.techniques.find(({ key }) => key === given.technique);
        const found = await api.technique(row);
        if (turn !== newest) return;
        technique = found;
        select.value = technique.key;
        const choices = technique.unsupported ? { capacity: null, sort: null, overflow: null } : legal(technique, given);
        const { k = null, scene = store.value.scene, size = store.value.size } = given;
        store.set({ technique: technique.key, ...choices, k, scene, size });
        show();
    }

    /** Shows a technique as `choose` does. What cannot be read is reported, and the pickers show again what is drawn. */
    function tryChoice(given) {
        const turn = newest + 1;
        choose(given).catch((error) => {
            if (turn !== newest) return;
            failed(error);
            select.value = store.value.technique;
            showAxes();
        });
    }

    function showAxes() {
        const isDrawn = technique && !technique.unsupported;
        table.show(isDrawn ? axes(technique, store.value) : []);
    }

    /** Shows the variant of the state, and draws it. */
    function show() {
        const state = store.value;
        const variant = technique.unsupported ? { text: technique.text } : variantOf(technique, state);
        describe(technique, variant);
        showAxes();
        values.show({ keep: variant.keep ?? null, uniforms: [] });
        for (const id of ["k", "cost", "size"]) byId(id).hidden = Boolean(technique.unsupported);
        passes.show(variant, technique.unsupported).then(() => status.recovered("player"), failed);
        status.recovered("start");
        draw();
    }

    /** The camera of a link, until it is drawn. */
    let restored = null;
    const draw = coalesced(() => {
        const { scene, size, k } = store.value;
        const text = technique.unsupported ? technique.text : variantOf(technique, store.value).text;
        if (byId("frame").textContent.trim() === "") byId("frame").textContent = "drawing …";
        byId("stage").style.setProperty("--aspect", String(size[0] / size[1]));
        picture.set({ text, scene, size, k, ...(restored && { camera: restored }) }).catch(failed);
        restored = null;
    });

    function report(result) {
        if (result.error) return note(result.error, true);
        const isDrawn = result.mode === "webgpu";
        note(isDrawn ? "" : (result.reason ?? technique.unsupported ?? NO_WEBGPU), false);
        document.body.dataset.drawn = result.mode;
        const frame = frameOf(result);
        fill(byId("frame"), isDrawn ? line(frame, store.value) : "drawn by the CPU device when the site was generated");
        byId("bytes").textContent = isDrawn && Number.isFinite(frame.bytes) ? bytes(frame.bytes) : "—";
        byId("lost").textContent = isDrawn ? count(frame.lost?.total ?? 0) : "—";
        if (isDrawn && store.value.camera !== picture.camera) store.set({ camera: { ...picture.camera } });
    }

    const writeLink = debounced(300, () => history.replaceState(null, "", `#${write(store.value)}`));
    store.subscribe((_, changed) => {
        if (["scene", "size", "k"].some((name) => changed.has(name)) && technique) draw();
        writeLink();
    });
    const restore = async () => {
        const given = read(location.hash);
        status.recovered("link");
        const { techniques, scenes } = site;
        const has = (list, field, name) => given[name] === undefined || list.some((row) => row[field] === given[name]);
        for (const [list, field, name] of [
            [techniques, "key", "technique"],
            [scenes, "name", "scene"],
        ]) {
            if (has(list, field, name)) continue;
            status.fail(new Error(`This site has no ${name} ${given[name]}: choose another one.`), "link");
            delete given[name];
        }
        values.forget({ values: true });
        restored = given.camera ?? null;
        if (restored) store.set({ camera: restored });
        await choose({ technique: store.value.technique, ...given });
    };
    window.addEventListener("hashchange", () => restore().catch(failed));
    byId("share").addEventListener("click", () => share(store.value));
    await restore();
}

/** Returns the fields of the state that a technique keeps when another one is chosen. */
const chosen = (state) => Object.fromEntries(["technique", ...CHOSEN, "k"].map((name) => [name, state[name]]));

/** Shows what a technique and a variant are. */
function describe({ key, title, summary, paper }, { words_per_pixel: words, tier, meaning }) {
    document.title = `${key} · fragbuf player`;
    fill(byId("summary"), element("strong", {}, title), ": ", inline(summary), paper ? ` — ${paper}` : "");
    byId("page").href = `../techniques/${key}.html`;
    byId("page").textContent = `About ${key}`;
    byId("words").textContent = words ?? "—";
    byId("tier").textContent = tier ?? "—";
    fill(byId("meaning"), inline(meaning ?? ""));
}

/** Returns a frame's statistics in a line. */
function line({ frame_ms: whole, bytes: size, lost, loops }, { k }) {
    const causes = Object.entries(lost?.by_counter ?? {}).filter(([, value]) => value > 0);
    const named = causes.map(([name, value]) => `${name} ${count(value)}`).join(", ");
    return [
        "WebGPU",
        Number.isFinite(whole) && milliseconds(whole),
        Number.isFinite(size) && bytes(size),
        Number.isFinite(k) && `k = ${k}`,
        lost?.total > 0 ? `${count(lost.total)} fragments are lost (${named})` : "no fragment is lost",
        loops.some(({ end }) => end === "limit") && "a loop ended at its limit",
    ]
        .filter(Boolean)
        .join(" · ");
}

/** Shows a note below the picture; an error is over it. */
function note(message, isError) {
    const [overlay, below] = [byId("overlay"), byId("picture-note")];
    const text = message.charAt(0).toUpperCase() + message.slice(1);
    overlay.hidden = !isError;
    fill(overlay, isError ? inline(text) : "");
    below.hidden = isError || !message;
    fill(below, isError ? "" : inline(text));
}

async function share(state) {
    try {
        const link = `${location.origin}${location.pathname}#${write(state)}`;
        history.replaceState(null, "", link);
        await navigator.clipboard.writeText(link);
        status.say("Copied the link: it holds the technique, its choices, the scene, the size and the camera.");
    } catch {
        failed(new Error("The browser does not allow the page to copy: the link is in the address bar."));
    }
}

run().catch(failed);

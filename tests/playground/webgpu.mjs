/**
 * Scenarios with WebGPU in the page, on SwiftShader: the same picture as a device of the server draws.
 */
import assert from "node:assert/strict";
import { assertPicture, cpuPicture, drawn, heading, openTab, pixels, settled, write } from "./page.mjs";

const DESCRIPTIONS = [
    "buffer Mine from kplus_array {\n    keep 4;\n}\n",
    "buffer Mine from ab_ll {\n}\n",
    "buffer Mine from kplus_heap {\n    keep 8 least |f| f.depth - 0.25 * f.color.w;\n    where |f| f.depth > 0.2;\n}\n",
];

/** The picture that WebGPU draws is the one of the CPU device, except for pixels on edges. */
export async function webgpu_draws_what_the_cpu_device_draws(page) {
    assert.match(await page.locator("#frame").textContent(), /WebGPU/);
    let before = await pixels(page);
    for (const text of DESCRIPTIONS) {
        await write(page, text);
        await heading(page, "No problems");
        before = await drawn(page, before);
        assert.match(await page.locator("#frame").textContent(), /WebGPU/, text);
        await assertPicture(page, await cpuPicture(page), text);
    }
}

/** A device of the server draws where a person chooses it, also with WebGPU in the page. */
export async function a_device_of_the_server_is_chosen(page) {
    const device = page.getByRole("combobox", { name: "device" });
    const frame = page.locator("#frame");
    await device.selectOption("cpu");
    await frame.filter({ hasText: /^cpu/ }).waitFor();
    await device.selectOption("auto");
    await frame.filter({ hasText: /^WebGPU/ }).waitFor();
}

/** Lost fragments are shown with the picture, also if the description counts nothing else. */
export async function lost_fragments_are_shown(page) {
    await write(page, "buffer Mine from ab_ll {\n    sort: insertion { layers: 2 };\n}\n");
    await page.locator("#frame").filter({ hasText: /fragments are lost/ }).waitFor();
    await openTab(page, "Costs");
    await page.locator(".warn").filter({ hasText: /fragments are lost: \w+ / }).waitFor();
}

/** The plot shows the time of each pass by its name in the manifest, also of passes in a loop. */
export async function webgpu_times_are_shown_by_pass(page) {
    await openTab(page, "Costs");
    // Each description has other passes than the one before it.
    for (const text of ["buffer Peeled from f2b_ll {\n}\n", "buffer Listed from ab_ll {\n}\n"]) {
        const passes = await page.evaluate(passesOf, text);
        await write(page, text);
        const shown = await page.waitForFunction(timesOf, passes.sort(), { polling: 50 });
        const { times, label } = await shown.jsonValue();
        for (const [name, time] of Object.entries(times)) assert.match(time, /^\d[\d.,]* ms$/, name);
        for (const pass of passes) assert.ok(label.includes(`${pass} ${times[pass]}`), label);
        assert.match(await page.locator("#frame").textContent(), /^WebGPU.* ms/);
    }
}

/** Runs in the page. Returns the legend of the plot and its text, if the legend has exactly these passes. */
function timesOf(passes) {
    const part = (item, name) => item.querySelector(name).textContent;
    const items = [...document.querySelectorAll("#times .legend li")];
    const times = Object.fromEntries(items.map((item) => [part(item, ".name"), part(item, ".figure")]));
    if (Object.keys(times).sort().join() !== passes.join()) return false;
    return { times, label: document.querySelector("#times svg").getAttribute("aria-label") };
}

/** Where the browser has no timestamps, the plot shows the time of the whole frame. */
export async function webgpu_without_timestamps_shows_the_time_of_the_frame(page) {
    await page.addInitScript(() => {
        const { requestDevice } = GPUAdapter.prototype;
        GPUAdapter.prototype.requestDevice = function (descriptor) {
            const requiredFeatures = descriptor.requiredFeatures.filter((name) => name !== "timestamp-query");
            return requestDevice.call(this, { ...descriptor, requiredFeatures });
        };
    });
    await page.reload();
    await page.locator("#frame").filter({ hasText: /^WebGPU.* ms/ }).waitFor();
    await openTab(page, "Costs");
    const names = await page.locator("#times .legend .name").allTextContents();
    assert.deepEqual(names, ["frame"]);
}

/** Descriptions that count their fragments, and whether the counters say how many of them are stored. */
const COUNTED = [
    ["buffer Mine from kplus_array {\n    keep 2;\n    counters: all;\n}\n", true],
    // Iterations displace what a later one keeps.
    ["buffer Mine from f2b_ll {\n    counters: all;\n}\n", false],
];

/** The numbers of fragments are those of the CPU device. A number that the counters do not give is left out. */
export async function fragments_are_those_that_the_cpu_device_counts(page) {
    await openTab(page, "Costs");
    for (const [text, isStored] of COUNTED) {
        const before = await page.locator("#fragments").textContent();
        await write(page, text);
        await heading(page, "No problems");
        await page.waitForFunction((before) => document.querySelector("#fragments").textContent !== before, before);
        await settled(page);
        const shown = await page.evaluate(fragmentsOf);
        const { fragments } = await page.evaluate(countsOf, text);
        assert.ok(fragments.generated > 1000, `${fragments.generated} fragments`);
        assert.equal("stored" in shown, isStored, text);
        for (const [name, value] of Object.entries(shown)) {
            if (!(name in fragments)) continue;
            // Devices differ in few pixels, on edges.
            const difference = Math.abs(value - fragments[name]);
            assert.ok(difference <= fragments.generated / 100, `${name}: ${value}, not ${fragments[name]}: ${text}`);
        }
        const ratio = await page.locator("#figures div").filter({ hasText: "hit ratio" }).locator("dd").textContent();
        assert.match(ratio, isStored ? /^[\d.]+ %$/ : /^—$/);
    }
}

/** Runs in the page. Returns the numbers of fragments that it shows, by their names. */
function fragmentsOf() {
    const part = (item, name) => item.querySelector(name).textContent;
    const items = [...document.querySelectorAll("#fragments .legend li")];
    return Object.fromEntries(items.map((item) => [part(item, ".name"), Number(part(item, ".figure").replaceAll(",", ""))]));
}

/** Runs in the page. Returns the statistics of the CPU device for a description, in the first view. */
async function countsOf(text) {
    const [{ INITIAL }, { AUTO }, { api }] = await Promise.all(
        ["/state.mjs", "/camera.mjs", "/api.mjs"].map((path) => import(path)),
    );
    const { statistics } = await api.render({ ...INITIAL, text, scene: "marbles", camera: AUTO, device: "cpu" });
    return statistics;
}

/** A frame that another scene replaces while it is drawn is not shown: it would be a picture of the earlier scene. */
export async function a_frame_of_an_earlier_scene_is_not_shown(page) {
    const before = await pixels(page);
    await page.evaluate(() => {
        const { mapAsync } = GPUBuffer.prototype;
        window.isMapping = false;
        window.hold = new Promise((resolve) => (window.release = resolve));
        GPUBuffer.prototype.mapAsync = async function (...values) {
            window.isMapping = true;
            await window.hold;
            return mapAsync.apply(this, values);
        };
        const { putImageData } = CanvasRenderingContext2D.prototype;
        window.shown = 0;
        CanvasRenderingContext2D.prototype.putImageData = function (...values) {
            if (this.canvas.id === "picture") window.shown += 1;
            return putImageData.apply(this, values);
        };
    });
    const scene = page.getByRole("combobox", { name: "scene" });
    await scene.selectOption("slabs");
    await page.waitForFunction(() => window.isMapping);
    await scene.selectOption("cubes");
    await page.evaluate(() => window.release());
    await drawn(page, before);
    assert.equal(await page.evaluate(() => window.shown), 1);
    assert.match(await page.locator("#frame").textContent(), /^WebGPU/);
    await assertPicture(page, await cpuPicture(page), "cubes");
}

/** Runs in the page. Returns the names of the passes in the manifest of a description. */
async function passesOf(text) {
    const { api } = await import("/api.mjs");
    const { manifest } = await api.generate({ text, target: "wgsl", form: "program" });
    return [...new Set(manifest.steps.flatMap((step) => (step.do === "pass" ? [step.pass] : [])))];
}

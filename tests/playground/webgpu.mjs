/**
 * Scenarios with WebGPU in the page, on SwiftShader: the same picture as a device of the server draws.
 */
import assert from "node:assert/strict";
import { drawn, heading, pixels, write } from "./page.mjs";

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
        const { different, covered, all } = await page.evaluate(compare, text);
        assert.ok(covered > all / 20, `${covered} of ${all} pixels are covered`);
        assert.ok(different < all / 200, `${different} of ${all} pixels differ: ${text}`);
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
    await page.getByRole("tab", { name: "Costs" }).click();
    await page.locator(".warn").filter({ hasText: /fragments are lost: \w+ / }).waitFor();
}

/** The plot shows the time of each pass by its name in the manifest, also of passes in a loop. */
export async function webgpu_times_are_shown_by_pass(page) {
    await page.getByRole("tab", { name: "Costs" }).click();
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
    await page.getByRole("tab", { name: "Costs" }).click();
    const names = await page.locator("#times .legend .name").allTextContents();
    assert.deepEqual(names, ["frame", "prepare"]);
}

/** Runs in the page. Returns the names of the passes in the manifest of a description. */
async function passesOf(text) {
    const { api } = await import("/api.mjs");
    const { manifest } = await api.generate({ text, target: "wgsl", form: "program" });
    return [...new Set(manifest.steps.flatMap((step) => (step.do === "pass" ? [step.pass] : [])))];
}

/** Runs in the page. Returns the number of pixels that differ from the server's by more than 2 of 255. */
async function compare(text) {
    const { decode } = await import("/link.mjs");
    // The address has the state of the page, some time after the last change.
    await new Promise((resolve) => setTimeout(resolve, 600));
    const { scene, size, camera, uniforms, k } = await decode(location.hash);
    const { api } = await import("/api.mjs");
    const { png } = await api.render({ text, scene, size, camera, uniforms, k, device: "cpu" });
    const bytes = Uint8Array.from(atob(png), (character) => character.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }), { colorSpaceConversion: "none" });
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const context = canvas.getContext("2d");
    context.drawImage(bitmap, 0, 0);
    const expected = context.getImageData(0, 0, canvas.width, canvas.height).data;
    const shown = document.querySelector("#picture");
    const found = shown.getContext("2d").getImageData(0, 0, shown.width, shown.height).data;
    if (found.length !== expected.length)
        throw new Error(`${shown.width} × ${shown.height}, not ${canvas.width} × ${canvas.height}`);
    let [different, covered] = [0, 0];
    for (let at = 0; at < found.length; at += 4) {
        const largest = Math.max(...[0, 1, 2].map((channel) => Math.abs(found[at + channel] - expected[at + channel])));
        different += largest > 2 ? 1 : 0;
        covered += [0, 1, 2].some((channel) => expected[at + channel] !== expected[channel]) ? 1 : 0;
    }
    return { different, covered, all: found.length / 4 };
}

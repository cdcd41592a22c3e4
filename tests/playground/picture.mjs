/**
 * Scenarios of the picture, its controls and what it costs.
 */
import assert from "node:assert/strict";
import { close, drawn, heading, open, pixels, text, write } from "./page.mjs";

const PLANE = "buffer Mine from kplus_array {\n    uniform { plane: f32 }\n    keep 6;\n    where |f, u| f.depth > u.plane;\n}\n";

/** Every slider changes the picture: k, and a uniform. */
export async function sliders_change_the_picture(page) {
    const first = await pixels(page);
    await write(page, PLANE);
    await heading(page, "No problems");
    await page.getByRole("slider", { name: "plane" }).waitFor();
    let before = await drawn(page, first);
    await page.getByRole("spinbutton", { name: "plane, as a number" }).fill("0");
    before = await drawn(page, before);
    await page.getByRole("slider", { name: "k", exact: true }).focus();
    await page.keyboard.press("Home");
    const one = await drawn(page, before);
    assert.equal(await page.getByRole("spinbutton", { name: "k, as a number" }).inputValue(), "1");
    await page.keyboard.press("End");
    await drawn(page, one);
    // Passes may have room for more than the description keeps.
    assert.ok(Number(await page.getByRole("spinbutton", { name: "k, as a number" }).inputValue()) >= 6);
}

/** Scene and size change the picture, and its size is that of the canvas. */
export async function scene_and_size_change_the_picture(page) {
    const before = await pixels(page);
    await page.getByRole("combobox", { name: "scene" }).selectOption("cubes");
    const cubes = await drawn(page, before);
    await page.getByRole("spinbutton", { name: "Width in pixels" }).fill("200");
    await page.getByRole("spinbutton", { name: "Height in pixels" }).fill("100");
    await page.keyboard.press("Enter");
    await page.waitForFunction(() => {
        const { width, height } = document.querySelector("#picture");
        return width === 200 && height === 100;
    });
    await drawn(page, cubes);
}

/** A preset is the text of a technique or an example. */
export async function a_preset_replaces_the_description(page) {
    const before = await pixels(page);
    const preset = page.getByRole("combobox", { name: "Start from" });
    const label = await preset
        .locator("option", { hasText: /^ab_ll\b/ })
        .first()
        .textContent();
    await preset.selectOption({ label });
    await heading(page, "No problems");
    assert.match(await text(page), /from ab_ll \{/);
    await drawn(page, before);
    assert.match(await page.locator("#k").textContent(), /every fragment/);
    await write(page, PLANE);
    assert.equal(await preset.locator("option:checked").textContent(), "Your own description");
}

/** Costs are figures of this frame: memory, passes, times, fragments. */
export async function costs_are_those_of_the_frame(page) {
    const before = await pixels(page);
    await write(page, "buffer Mine from kplus_array {\n    keep 2;\n    counters: all;\n}\n");
    await heading(page, "No problems");
    await drawn(page, before);
    const figures = page.locator("#figures");
    assert.match(await figures.textContent(), /words per pixel.*\d/);
    assert.match(await figures.textContent(), /this frame[\d.]+ [KM]iB/);
    const generated = await page.locator("#fragments li", { hasText: "generated" }).textContent();
    assert.match(generated, /[\d,]{4,}/);
    await page.getByRole("button", { name: "Count" }).click();
    const histogram = page.getByRole("img", { name: /covered pixels/ });
    await histogram.waitFor();
    // The histogram counts the same fragments as the frame.
    const counted = (await histogram.getAttribute("aria-label")).match(/^([\d,]+) fragments/)[1];
    assert.equal(generated.replace("generated", "").trim(), counted);
    assert.match(await histogram.getAttribute("aria-label"), /With k = 2, /);
    const rows = await page.locator("#tiers tr").count();
    assert.ok(rows >= 5, `${rows} targets`);
    assert.match(await page.locator("#tiers tr", { hasText: "spirv" }).textContent(), /T\d/);
}

/** The table of axes: an illegal value is greyed and its reason can be read; a legal one edits the description. */
export async function an_axis_is_chosen_in_the_table(page) {
    await write(page, "buffer Mine from kplus_array {\n    keep 4;\n}\n");
    await heading(page, "No problems");
    await page.getByRole("tab", { name: "Axes" }).click();
    const storage = page.getByRole("combobox", { name: "storage" });
    await storage.locator("option:not([disabled])").nth(1).waitFor({ state: "attached" });
    const illegal = storage.locator("option[disabled]").first();
    assert.notEqual(await illegal.getAttribute("title"), "");
    await page.locator("#reasons-storage summary").click();
    assert.ok((await page.locator("#reasons-storage li").count()) >= 1);
    // The table is shown again when the new text is analysed: its edits are those of that text.
    const meaning = page.locator("#meaning-storage");
    const before = await meaning.textContent();
    await storage.selectOption("max_heap");
    await page.waitForFunction((before) => document.querySelector("#meaning-storage").textContent !== before, before);
    await heading(page, "No problems");
    assert.match(await text(page), /storage: max_heap/);
    const sort = page.getByRole("combobox", { name: "sort", exact: true });
    const other = await sort.locator("option:not([disabled]):not(:checked)").first().getAttribute("value");
    await sort.selectOption(other);
    await heading(page, "No problems");
    assert.match(await text(page), new RegExp(`sort: ${other}`));
}

/** The checker finds the race of a technique that has one, and shows the schedule. */
export async function the_checker_shows_a_failing_schedule(page) {
    await write(page, "buffer Mine from kb {\n    keep 2;\n}\n");
    await heading(page, "No problems");
    await page.getByRole("tab", { name: "Check it" }).click();
    await page.getByRole("button", { name: "Check it", exact: true }).click();
    await page.locator("#check-result .verdict", { hasText: "declared hazards" }).waitFor();
    const steps = page.locator("#check-result tbody tr");
    assert.ok((await steps.count()) >= 4);
    assert.match(await steps.first().textContent(), /^1reads /);
    assert.match(await steps.nth(1).textContent(), /^storage\/sorted_array\.wgsl:\d+/);
    assert.match(await page.locator("#check-result").textContent(), /lost-update/);
}

/** A search that takes long ends when the person says so. */
export async function a_check_can_be_cancelled(page) {
    await write(page, "buffer Mine from kplus_array {\n    keep 4;\n}\n");
    await heading(page, "No problems");
    await page.getByRole("tab", { name: "Check it" }).click();
    await page.getByRole("spinbutton", { name: "fragments" }).fill("4");
    await page.getByRole("spinbutton", { name: "k", exact: true }).last().fill("3");
    await page.getByRole("button", { name: "Check it", exact: true }).click();
    await page.locator("#check-result .running").waitFor();
    await page.getByRole("button", { name: "Cancel" }).click();
    await page.locator("#check-result .verdict", { hasText: "Cancelled" }).waitFor();
    assert.ok(await page.getByRole("button", { name: "Check it", exact: true }).isEnabled());
}

/** A check that another one replaces does not show its verdict. */
export async function the_newest_check_counts(page) {
    await write(page, "buffer Mine from kplus_array {\n    keep 4;\n}\n");
    await heading(page, "No problems");
    const start = (name) => page.getByRole("button", { name: `Check it on ${name}`, exact: true });
    await page.getByRole("tab", { name: "Costs" }).click();
    await start("glsl").click();
    await page.locator("#check-result .running").waitFor();
    await page.getByRole("tab", { name: "Costs" }).click();
    await start("spirv").click();
    await page.locator("#check-result .verdict:not(.running)").waitFor();
    assert.match(await page.locator("#check-result").textContent(), /spirv/);
    assert.ok(await page.getByRole("button", { name: "Check it", exact: true }).isEnabled());
}

/** Two descriptions side by side: equal ones have no difference, others a heat map. */
export async function two_descriptions_are_compared(page) {
    await write(page, "buffer Mine from kplus_array {\n    keep 4;\n}\n");
    await heading(page, "No problems");
    await page.getByRole("tab", { name: "Side by side" }).click();
    await page.getByRole("button", { name: "Keep this description" }).click();
    const summary = page.locator("#compare-summary");
    await summary.filter({ hasText: "No pixel differs" }).waitFor();
    await write(page, "buffer Mine from kplus_array {\n    keep 1;\n}\n");
    await summary.filter({ hasText: /\d+ pixels .* differ/ }).waitFor();
    const hot = await page.evaluate(() => {
        const canvas = document.querySelector("#compare-difference");
        const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        let hot = 0;
        for (let at = 0; at < data.length; at += 4) hot += data[at] > 0 ? 1 : 0;
        return hot;
    });
    assert.ok(hot > 100, `${hot} pixels of the heat map`);
}

const TRIANGLES = "mtllib none.mtl\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nv 0 -1 1\nf 1 2 3\nf 1 4 3\n";

/** A model is opened by the button or dropped, and drawn; what was not read of it is said, and a file without a model is explained. */
export async function a_model_is_opened_and_dropped(page, { address, browser }) {
    const scene = page.getByRole("combobox", { name: "scene" });
    const shown = () => scene.locator("option:checked").textContent();
    const first = await pixels(page);
    const chooser = page.waitForEvent("filechooser");
    await page.getByRole("button", { name: "Open model" }).click();
    await (await chooser).setFiles({ name: "two triangles.obj", mimeType: "text/plain", buffer: Buffer.from(TRIANGLES) });
    const model = await drawn(page, first);
    assert.equal(await shown(), "two_triangles.obj");
    assert.match(await page.locator("#scene-note").textContent(), /2 triangles; two_triangles\.obj:1: files that the model names are not read: `none\.mtl`/);
    assert.match(await page.locator("#frame").textContent(), /\b2 triangles/);
    const drop = async (files) => {
        const data = await page.evaluateHandle((files) => {
            const data = new DataTransfer();
            for (const [name, text] of files) data.items.add(new File([text], name));
            return data;
        }, files);
        await page.locator("#stage").dispatchEvent("drop", { dataTransfer: data });
    };
    await drop([["one.obj", TRIANGLES.replace("f 1 4 3\n", "")]]);
    await drawn(page, model);
    assert.equal(await shown(), "one.obj");
    const status = (words) => page.locator("#status").filter({ hasText: words }).waitFor();
    await drop([["page.obj", "<!doctype html>"]]);
    await status("page.obj: the file is a page in HTML");
    await drop([["a.obj", TRIANGLES], ["b.obj", TRIANGLES]]);
    await status("Drop one model at a time");
    assert.equal(await shown(), "one.obj");
    // A page of the same server has the models, too.
    await page.getByRole("button", { name: "Copy link" }).click();
    await status("Copied the link");
    const other = await open(browser, address, { hash: await page.evaluate(() => location.hash) });
    assert.equal(await other.getByRole("combobox", { name: "scene" }).locator("option:checked").textContent(), "one.obj");
    await close(other);
}

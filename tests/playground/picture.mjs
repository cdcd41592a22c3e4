/**
 * Scenarios of the picture and its controls.
 */
import assert from "node:assert/strict";
import { assertPicture, close, copyLink, cpuPicture, drawn, heading, open, pixels, status, text, write } from "./page.mjs";

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
    await assertPicture(page, await cpuPicture(page), "200 × 100");
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
    await drop([["page.obj", "<!doctype html>"]]);
    await status(page, "page.obj: the file is a page in HTML");
    await drop([["a.obj", TRIANGLES], ["b.obj", TRIANGLES]]);
    await status(page, "Drop one model at a time");
    assert.equal(await shown(), "one.obj");
    // A page of the same server has the models, too.
    const { hash } = new URL(await copyLink(page));
    const other = await open(browser, address, { hash });
    assert.equal(await other.getByRole("combobox", { name: "scene" }).locator("option:checked").textContent(), "one.obj");
    await close(other);
}

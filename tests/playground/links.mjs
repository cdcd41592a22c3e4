/**
 * Scenarios of links: what they restore, in a page of their own and in a page that is open, and what a page does not have.
 */
import assert from "node:assert/strict";
import { PATIENCE, close, copyLink, drawn, heading, open, pixels, settled, status, text, write } from "./page.mjs";

const PLANE = "buffer Mine from kplus_array {\n    uniform { plane: f32 }\n    keep 6;\n    where |f, u| f.depth > u.plane;\n}\n";

/** The number beside a slider. */
const number = (page, name) => page.getByRole("spinbutton", { name: `${name}, as a number` });

/** Returns what the sliders of `PLANE` show. */
const values = async (page) => ({ plane: await number(page, "plane").inputValue(), k: await number(page, "k").inputValue() });

/** A link holds description, scene, camera, k and uniforms. */
export async function a_link_restores_the_page(page, { browser, address }) {
    const first = await pixels(page);
    await write(page, `// über\n${PLANE}`);
    await heading(page, "No problems");
    let before = await drawn(page, first);
    await page.getByRole("combobox", { name: "scene" }).selectOption("cubes");
    before = await drawn(page, before);
    await number(page, "plane").fill("0.125");
    await number(page, "k").fill("2");
    await page.locator("#picture").focus();
    await page.keyboard.press("ArrowRight");
    await settled(page);
    const last = await pixels(page);
    const link = await copyLink(page);
    assert.ok(link.startsWith(`${address}#v1.`), link);
    const other = await open(browser, address, { hash: link.slice(address.length) });
    assert.equal(await text(other), await text(page));
    assert.deepEqual(await values(other), { plane: "0.125", k: "2" });
    assert.equal(await other.getByRole("combobox", { name: "scene" }).inputValue(), "cubes");
    await other.waitForFunction((last) => document.querySelector("#picture").toDataURL() === last, last, { timeout: PATIENCE });
    await close(other);
}

/** A damaged link is reported, and the page works without it. */
export async function a_damaged_link_is_reported(page, { browser, address }) {
    for (const hash of ["#v1.AAAA", "#v1.%", "#nothing", "#v1.q1YqLVZSKi1OLVKyUjIwUtJRKkmtKFGyMgUA"]) {
        const other = await open(browser, address, { hash });
        assert.match(await other.getByRole("status").textContent(), /link/i, hash);
        assert.match(await text(other), /buffer/);
        await close(other);
    }
}

/** A link that is opened in a page with the same description has its values there: sliders, camera and picture are those of the link. */
export async function a_link_in_an_open_page_replaces_its_values(page, { address }) {
    let before = await pixels(page);
    await write(page, PLANE);
    await heading(page, "No problems");
    const first = await drawn(page, before);
    const usual = (await copyLink(page)).slice(address.length);
    await number(page, "plane").fill("0");
    before = await drawn(page, first);
    await number(page, "k").fill("2");
    before = await drawn(page, before);
    await page.locator("#picture").focus();
    await page.keyboard.press("ArrowRight");
    const changed = await drawn(page, before);
    const other = (await copyLink(page)).slice(address.length);
    for (const [hash, expected, picture] of [
        [usual, { plane: "0.5", k: "6" }, first],
        [other, { plane: "0", k: "2" }, changed],
    ]) {
        before = await pixels(page);
        await page.evaluate((hash) => (location.hash = hash), hash);
        assert.ok((await drawn(page, before)) === picture, `the picture is not that of the link: ${JSON.stringify(expected)}`);
        assert.deepEqual(await values(page), expected);
        assert.equal(await page.getByRole("slider", { name: "k", exact: true }).inputValue(), expected.k);
        assert.equal(await page.getByRole("slider", { name: "plane" }).inputValue(), expected.plane);
    }
    // What the link does not have is as in a new page.
    await page.evaluate(goTo, { text: PLANE });
    assert.ok((await drawn(page, changed)) === first, "the picture is not that of a new page");
    assert.deepEqual(await values(page), { plane: "0.5", k: "6" });
    // With a text that has errors, the last description without errors is drawn with the values of the link.
    await page.evaluate(goTo, { text: PLANE.replace("kplus_array", "kplus_aray"), k: 1, uniforms: { plane: 0.25 } });
    await heading(page, "1 error");
    await drawn(page, first);
    assert.deepEqual(await values(page), { plane: "0.25", k: "1" });
}

/** A link that names what this page does not have is reported; the rest of it is shown. */
export async function a_link_that_names_what_is_missing_is_reported(page) {
    const device = page.getByRole("combobox", { name: "device" });
    const usual = await device.inputValue();
    await page.evaluate(goTo, { text: PLANE, device: "no such device", scene: "cubes", k: 2 });
    await status(page, "no such device");
    await heading(page, "No problems");
    await settled(page);
    assert.equal(await device.inputValue(), usual);
    assert.equal(await text(page), PLANE);
    assert.equal(await number(page, "k").inputValue(), "2");
    assert.equal(await page.getByRole("combobox", { name: "scene" }).inputValue(), "cubes");
    assert.ok(await page.locator("#overlay").isHidden(), await page.locator("#overlay").textContent());
    await page.evaluate(goTo, { text: PLANE, scene: "no_such_scene" });
    await status(page, "no_such_scene");
    // A link that names nothing else ends the message.
    await page.evaluate(goTo, { text: PLANE, scene: "cubes", device: usual });
    await status(page, /^Ready$/);
}

/** Without a list of devices the page says why, and draws all the same. */
export async function a_list_of_devices_that_fails_is_reported(page) {
    await page.route("**/api/start", async (route) => {
        const response = await route.fetch();
        const json = { ...(await response.json()), devices: [], devices_problem: "the driver ended the list of devices" };
        await route.fulfill({ response, json });
    });
    await page.reload();
    await status(page, "the driver ended the list of devices");
    await drawn(page);
    assert.deepEqual(await page.getByRole("combobox", { name: "device" }).locator("option").allTextContents(), ["auto"]);
    await page.unroute("**/api/start");
}

/** Runs in the page. Opens the link of a state. */
async function goTo(state) {
    const { encode } = await import("/link.mjs");
    location.hash = await encode(state);
}

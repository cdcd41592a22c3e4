/**
 * Scenarios of a site's player with WebGPU, on SwiftShader. The environment variable FRAGBUF names the program that draws the expected
 * pictures on its CPU device.
 */
import assert from "node:assert/strict";
import { execFile } from "node:child_process";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { PATIENCE, assertPicture, close, compare, copyLink, drawn, open, pixels, settled, status, tabTo } from "./page.mjs";

/** Choices, as a link holds them. */
const CHOICES = [
    "technique=kplus_array&capacity=8&k=3",
    "technique=kplus_array&capacity=4&sort=shell&overflow=weighted_tail&camera=70,35,1.4",
    "technique=ab_ll&scene=cubes",
];

/** The picture that WebGPU draws is the one of the CPU device, except for pixels on edges. */
export async function the_player_draws_what_the_cpu_device_draws(page, { address }) {
    for (const choices of CHOICES) {
        const before = await pixels(page);
        await page.goto(`${address}play/index.html#${choices}`);
        await drawn(page, before);
        assert.match(await page.locator("#frame").textContent(), /^WebGPU · [\d.,]+ ms · /, choices);
        await assertPicture(page, await expected(page), choices);
    }
}

/** A larger k and another technique change the picture; another sort does not. */
export async function choices_change_the_picture_or_keep_it(page, { address }) {
    await page.goto(`${address}play/index.html#technique=kplus_array&scene=slabs&capacity=8&k=8`);
    await chosen(page, "scene=slabs");
    const eight = await pixels(page);
    await page.getByRole("combobox", { name: "sort" }).selectOption("shell");
    await chosen(page, "sort=shell");
    assert.ok(await isSame(page, eight), "another sort is another picture");
    const sorted = await pixels(page);
    await page.getByRole("slider", { name: "k", exact: true }).focus();
    await page.keyboard.press("Home");
    const one = await drawn(page, sorted);
    await chosen(page, "k=1");
    assert.ok(!(await isSame(page, eight)), "another k is the same picture");
    await page.getByRole("combobox", { name: "capacity" }).selectOption("32");
    await chosen(page, "capacity=32");
    const most = await drawn(page, one);
    await page.getByRole("combobox", { name: "technique" }).selectOption("ab_ll");
    await chosen(page, "technique=ab_ll");
    assert.match(await page.locator("#k").textContent(), /every fragment/);
    assert.ok(await isSame(page, most), "every fragment, and the 32 nearest, are other pictures");
}

/** An illegal combination cannot be chosen, and the page says why. */
export async function an_illegal_choice_has_its_reason(page, { address }) {
    await page.goto(`${address}play/index.html#technique=ab_ll`);
    await chosen(page, "technique=ab_ll");
    const overflow = page.getByRole("combobox", { name: "overflow" });
    const illegal = overflow.locator("option[disabled]");
    assert.ok((await illegal.count()) > 0);
    assert.match(await illegal.first().getAttribute("title"), /\w+ \w+/);
    await page.locator("#reasons-overflow summary").click();
    assert.ok((await page.locator("#reasons-overflow li").count()) > 0);
}

/** The passes and the manifest are shown and copied. */
export async function passes_are_shown_and_copied(page) {
    const files = page.getByRole("tablist", { name: "Files of the variant" });
    await files.getByRole("tab", { name: "store", exact: true }).click();
    await page.locator("#view .cm-content").filter({ hasText: "fn" }).waitFor();
    await page.getByRole("button", { name: "Copy", exact: true }).click();
    await status(page, "Copied");
    const copied = await page.evaluate(() => navigator.clipboard.readText());
    assert.match(copied, /fn store_fragment|@fragment/);
    await files.getByRole("tab", { name: "manifest" }).click();
    await page.locator("#view .cm-content").filter({ hasText: "fragbuf-manifest" }).waitFor();
}

/** Everything can be done by the keyboard alone. */
export async function the_player_works_by_keyboard_alone(page) {
    let before = await pixels(page);
    await tabTo(page, /^technique/);
    await tabTo(page, /^scene/);
    await page.keyboard.press("ArrowDown");
    before = await drawn(page, before);
    await tabTo(page, /^Picture of the scene/);
    await page.keyboard.press("ArrowRight");
    before = await drawn(page, before);
    await page.keyboard.press("+");
    before = await drawn(page, before);
    await tabTo(page, "k");
    await page.keyboard.press("Home");
    await drawn(page, before);
    await tabTo(page, "capacity");
    await tabTo(page, "sort");
    await tabTo(page, "overflow");
    await tabTo(page, "Copy");
    await page.keyboard.press("Enter");
    await status(page, "Copied");
}

/** A link holds the technique, its choices, the scene, the size and the camera. */
export async function a_link_restores_the_player(page, { browser, address }) {
    await page.goto(`${address}play/index.html#technique=kplus_array&capacity=16&sort=shell&scene=cubes`);
    await chosen(page, "scene=cubes");
    const before = await pixels(page);
    await page.getByRole("spinbutton", { name: "k, as a number" }).fill("2");
    const two = await drawn(page, before);
    await page.locator("#picture").focus();
    await page.keyboard.press("ArrowRight");
    const last = await drawn(page, two);
    const link = await copyLink(page);
    const other = await open(browser, address, { hash: link.slice(address.length) });
    await other.waitForFunction((last) => document.querySelector("#picture").toDataURL() === last, last, { timeout: PATIENCE });
    assert.equal(await other.getByRole("spinbutton", { name: "k, as a number" }).inputValue(), "2");
    assert.equal(await other.getByRole("combobox", { name: "sort" }).inputValue(), "shell");
    await close(other);
}

/** A technique whose file cannot be read is reported, and the picker shows the one that is drawn. */
export async function a_technique_that_cannot_be_read_is_reported(page) {
    const technique = page.getByRole("combobox", { name: "technique" });
    const usual = await technique.inputValue();
    await page.route("**/data/ab_ll.json", (route) => route.fulfill({ status: 503, body: "" }));
    await technique.selectOption("ab_ll");
    await status(page, "has no file data/ab_ll.json (status 503)");
    assert.equal(await technique.inputValue(), usual);
    await page.unroute("**/data/ab_ll.json");
    await technique.selectOption("ab_ll");
    await chosen(page, "technique=ab_ll");
    await status(page, /^Ready$/);
}

/** Waits until the link has a choice, and the picture is drawn. */
async function chosen(page, choice) {
    await page.waitForFunction((choice) => location.hash.slice(1).split("&").includes(choice), choice, { timeout: PATIENCE });
    await settled(page);
}

/** Returns the picture that the CPU device draws with the description, k, scene and camera of the player, as a data URL. */
async function expected(page) {
    const { hash } = new URL(await copyLink(page));
    const { text, scene, size, camera, k } = await page.evaluate(async (hash) => {
        const { read } = await import(new URL("address.js", location.href));
        const { api } = await import(new URL("api.js", location.href));
        const { CHOSEN, variantOf } = await import(new URL("choices.js", location.href));
        const state = { capacity: null, ...read(hash) };
        const { techniques } = await api.site();
        const technique = await api.technique(techniques.find(({ key }) => key === state.technique));
        const choices = Object.fromEntries(CHOSEN.map((axis) => [axis, state[axis]]));
        return { ...state, text: variantOf(technique, choices).text };
    }, hash);
    const folder = await mkdtemp(join(tmpdir(), "fragbuf-player-"));
    const out = join(folder, "expected.png");
    const { azimuth, elevation, zoom } = camera;
    const options = [`--scene=builtin:${scene}`, `--size=${size.join("x")}`, `--camera=orbit:${azimuth},${elevation},zoom:${zoom}`];
    const set = k ? ["--set", `k=${k}`] : [];
    await new Promise((resolve, reject) => {
        const done = (error, _, errors) => (error ? reject(new Error(`${error.message}\n${errors}`)) : resolve());
        const child = execFile(process.env.FRAGBUF, ["render", "-", "--device=cpu", ...options, ...set, "--out", out], done);
        child.stdin.end(text);
    });
    const bytes = await readFile(out);
    await rm(folder, { recursive: true });
    return `data:image/png;base64,${bytes.toString("base64")}`;
}

/** Returns whether the picture has the pixels of a data URL, except for few. */
async function isSame(page, url) {
    const { different, all } = await page.evaluate(compare, url);
    return different < all / 200;
}

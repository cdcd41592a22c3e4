/**
 * Scenarios of a site in a browser without WebGPU: the pages with text, and what the player shows instead of its picture.
 */
import assert from "node:assert/strict";
import { assertContrast } from "./contrast.mjs";
import { close, open, status } from "./page.mjs";

/** A page of each kind, with what shows that it is loaded. */
const PAGES = [
    ["index.html", "h1"],
    ["techniques/index.html", "table"],
    ["techniques/kplus_array.html", "table"],
    ["play/index.html#technique=kplus_array", ".cm-content"],
];

/** Without WebGPU the player says what it needs, and shows the picture that the technique has. */
export async function without_webgpu_the_player_says_so(page) {
    await page.getByRole("note").filter({ hasText: "WebGPU" }).waitFor();
    assert.match(await page.locator("#frame").textContent(), /when the site was generated/);
    const size = await page.evaluate(() => {
        const { width, height } = document.querySelector("#picture");
        return [width, height];
    });
    assert.deepEqual(size, [320, 240]);
}

/** A technique that browsers cannot run has the reason, its description and its picture. */
export async function a_technique_for_other_targets_has_its_picture(page, { browser, address }) {
    const other = await open(browser, address, { hash: "play/index.html#technique=kb_mdt64" });
    await other.getByRole("note").filter({ hasText: "browsers cannot run it" }).waitFor();
    assert.match(await other.locator("#view .cm-content").textContent(), /buffer Mine from kb_mdt64/);
    await close(other);
    assert.match(await page.getByRole("combobox", { name: "technique" }).locator("option[value=kb_mdt64]").textContent(), /picture alone/);
}

/** Every picture of the gallery is loaded, and every technique leads to its page and to the player. */
export async function the_gallery_leads_to_pages_and_player(page, { browser, address }) {
    const other = await open(browser, address, { hash: "index.html", ready: "h1", drawn: false });
    const images = await other.locator("img").all();
    // The site of these tests has three techniques, with a picture each.
    assert.ok(images.length >= 3, `${images.length} pictures`);
    for (const image of images) {
        await image.scrollIntoViewIfNeeded();
        await other.waitForFunction((image) => image.complete && image.naturalWidth > 0, await image.elementHandle());
    }
    await other.getByRole("link", { name: "ab_ll", exact: false }).first().click();
    await other.getByRole("heading", { level: 1, name: /ab_ll/ }).waitFor();
    await other.getByRole("link", { name: "Try it" }).click();
    await other.locator("#view .cm-content").filter({ hasText: "buffer" }).or(other.locator("#files [role=tab]")).first().waitFor();
    await other.waitForFunction(() => document.querySelector("#technique").value === "ab_ll");
    await close(other);
}

/** Windows from 360 pixels on: nothing is wider than the window. */
export async function every_page_fits_every_window(_, { browser, address }) {
    for (const [hash, ready] of PAGES) {
        const page = await open(browser, address, { hash, ready, drawn: false });
        for (const [width, height] of [
            [360, 740],
            [760, 900],
            [1000, 800],
            [1200, 800],
            [1600, 1000],
        ]) {
            await page.setViewportSize({ width, height });
            await page.waitForTimeout(60);
            const found = await page.evaluate(() => document.documentElement.scrollWidth);
            assert.ok(found <= width, `${hash} is ${found} wide in a window of ${width}`);
        }
        await close(page);
    }
}

/** Light and dark follow the system, and all text has the contrast of WCAG AA. The button changes them on every page. */
export async function every_page_is_light_and_dark(_, { browser, address }) {
    for (const [hash, ready] of PAGES) {
        const page = await open(browser, address, { hash, ready, drawn: false });
        const ground = () => page.evaluate(() => getComputedStyle(document.documentElement).backgroundColor);
        const grounds = [];
        for (const colorScheme of ["light", "dark"]) {
            await page.emulateMedia({ colorScheme });
            grounds.push(await ground());
            await assertContrast(page, { least: 15, what: `${hash}, ${colorScheme}` });
        }
        assert.notEqual(grounds[0], grounds[1]);
        await page.getByRole("button", { name: /^Colours/ }).click();
        assert.equal(await ground(), grounds[0]);
        await close(page);
    }
}

/** A link that names what the site does not have is reported, and the player works without it. */
export async function a_link_of_another_site_is_reported(_, { browser, address }) {
    const page = await open(browser, address, { hash: "play/index.html#technique=nothing&k=1e9&camera=a,b&size=0x0" });
    await status(page, "no technique nothing");
    assert.ok(await page.locator("#view .cm-content").count());
    await close(page);
}

/**
 * Scenarios of the whole page: by keyboard alone, in every window, light and dark, texts that leave the page.
 */
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { assertContrast } from "./contrast.mjs";
import { PANELS, PATIENCE, close, drawn, editor, heading, open, openTab, pixels, status, tabTo, text, write } from "./page.mjs";

/** Everything by keyboard alone: no pointer is used here. */
export async function everything_works_by_keyboard_alone(page) {
    await tabTo(page, "Skip to the description");
    await page.keyboard.press("Enter");
    await tabTo(page, "Description of the fragment buffer");
    await page.keyboard.press("Control+a");
    await page.keyboard.insertText("buffer Mine from kplus_aray {\n    keep 4;\n}\n");
    await heading(page, "1 error");
    await page.keyboard.press("F8");
    await page.locator(".cm-tooltip.problem", { hasText: "unknown technique" }).waitFor();
    await page.keyboard.press("Alt+Enter");
    await heading(page, "No problems");
    assert.match(await text(page), /from kplus_array/);
    // Tab indents; Escape and Tab leave.
    await page.keyboard.press("Control+Home");
    await page.keyboard.press("Tab");
    assert.match(await text(page), /^ {4}buffer/);
    await page.keyboard.press("Shift+Tab");
    await page.keyboard.press("Escape");
    await page.keyboard.press("Tab");
    assert.equal(await editor(page).evaluate((element) => element === document.activeElement), false);
    await tabTo(page, /^Picture of the scene/);
    let before = await pixels(page);
    await page.keyboard.press("ArrowRight");
    before = await drawn(page, before);
    await tabTo(page, "k");
    await page.keyboard.press("Home");
    await drawn(page, before);
    await tabTo(page, "Costs");
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.getByRole("tab", { selected: true, name: "Axes" }).count(), 1);
    await page.keyboard.press("ArrowRight");
    await tabTo(page, "Check it");
    await page.keyboard.press("Enter");
    await page.locator("#check-result .verdict:not(.running)").waitFor({ timeout: PATIENCE });
}

/** Whatever has the focus shows it. */
export async function the_focus_is_visible(page) {
    await page.evaluate(() => (window.judged = new Set()));
    const invisible = [];
    for (let press = 0; press < 45; press += 1) {
        await page.keyboard.press("Tab");
        if (await page.evaluate(() => document.activeElement.classList.contains("cm-content"))) {
            await page.keyboard.press("Escape");
            continue;
        }
        const seen = await page.evaluate(() => {
            const element = document.activeElement;
            if (element === document.body) return null;
            window.judged.add(element);
            const style = getComputedStyle(element);
            const visible = style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 1;
            return visible ? null : element.outerHTML.slice(0, 120);
        });
        if (seen) invisible.push(seen);
    }
    assert.deepEqual(invisible, []);
    // The buttons at the top, the pickers and sliders of the picture, the tabs, and what the first panel has.
    const judged = await page.evaluate(() => window.judged.size);
    assert.ok(judged >= 20, `${judged} elements had the focus`);
}

/** Every control has a name. */
export async function every_control_has_a_name(page) {
    for (const tab of PANELS) {
        await openTab(page, tab);
        const [unnamed, all] = await page.evaluate(() => {
            const controls = [...document.querySelectorAll("button, select, input, canvas, [role=textbox], [role=img]")];
            const name = (element) =>
                element.getAttribute("aria-label") ||
                element.labels?.[0]?.textContent ||
                element.textContent ||
                element.getAttribute("title");
            const visible = controls.filter((element) => element.checkVisibility());
            const unnamed = visible.filter((element) => !name(element)?.trim());
            return [unnamed.map((element) => element.outerHTML), visible.length];
        });
        assert.deepEqual(unnamed, [], tab);
        assert.ok(all >= 20, `${all} controls: ${tab}`);
    }
}

/** Windows from 360 pixels on: nothing is wider than the window; panes are stacked, or side by side without scrolling the page. */
export async function every_window_has_a_layout(page) {
    for (const [width, height] of [
        [360, 740],
        [390, 844],
        [760, 900],
        [1000, 800],
        [1199, 800],
        [1200, 800],
        [1600, 1000],
    ]) {
        await page.setViewportSize({ width, height });
        await page.waitForTimeout(100);
        const layout = await page.evaluate(() => {
            const box = (id) => document.getElementById(id).getBoundingClientRect();
            const panes = ["editor-pane", "picture-pane", "panels"].map(box);
            const { scrollWidth, scrollHeight } = document.documentElement;
            return { panes: panes.map(({ x, y, width, height }) => ({ x, y, width, height })), scrollWidth, scrollHeight };
        });
        const [edit, picture, panels] = layout.panes;
        const name = `${width} × ${height}: ${JSON.stringify(layout)}`;
        assert.ok(layout.scrollWidth <= width, name);
        assert.ok(
            layout.panes.every((pane) => pane.width >= 320 && pane.height >= 300),
            name,
        );
        if (width < 760)
            assert.ok(edit.x === picture.x && picture.x === panels.x && picture.y > edit.y && panels.y > picture.y, name);
        if (width >= 760) assert.ok(edit.y === picture.y && picture.x > edit.x, name);
        if (width >= 1200) assert.ok(panels.x > picture.x && panels.y === edit.y && layout.scrollHeight <= height, name);
        for (const tab of PANELS) {
            await openTab(page, tab);
            assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= width, `${tab} at ${width}`);
        }
        await openTab(page, "Costs");
    }
}

/** Fills a panel with what it can show of a description. Returns the least number of texts that it has then. */
const FILLED = {
    async Costs(panel) {
        await panel.getByRole("button", { name: "Count" }).click();
        await panel.getByRole("img", { name: /covered pixels/ }).waitFor();
        return 40;
    },
    async Axes(panel) {
        await panel.locator("#reasons-storage summary").click();
        await panel.locator("#reasons-storage li").first().waitFor();
        return 20;
    },
    async "Check it"(panel) {
        await panel.getByRole("button", { name: "Check it", exact: true }).click();
        await panel.getByRole("region", { name: "Failing schedule" }).waitFor();
        return 20;
    },
    async Text(panel) {
        await panel.locator("#text-view:not(.outdated) .cm-line").first().waitFor();
        return 20;
    },
    async "Side by side"(panel) {
        await panel.getByRole("button", { name: "Keep this description" }).click();
        await panel.getByText("No pixel differs").waitFor();
        return 5;
    },
};

/** Light and dark follow the system and the button; all text has the contrast of WCAG AA, in every panel and beside a mistake. */
export async function light_and_dark_have_contrast(page) {
    await write(page, "buffer Mine from kb {\n    // a comment\n    keep 2;\n}\n");
    await heading(page, "No problems");
    const schemes = ["light", "dark"];
    for (const tab of PANELS) {
        const panel = await openTab(page, tab);
        const least = await FILLED[tab](panel);
        await page.mouse.move(0, 0);
        for (const colorScheme of schemes) {
            await page.emulateMedia({ colorScheme });
            await assertContrast(page, { within: `#${await panel.getAttribute("id")}`, least, what: `${tab}, ${colorScheme}` });
        }
    }
    await write(page, "buffer Mine from kplus_aray {\n    // a comment\n    keep 4 least |f| f.depth;\n}\n");
    await heading(page, "1 error");
    const grounds = [];
    const ground = () => page.evaluate(() => getComputedStyle(document.documentElement).backgroundColor);
    for (const colorScheme of schemes) {
        await page.emulateMedia({ colorScheme });
        grounds.push(await ground());
        await assertContrast(page, { within: "#problems-list", least: 4, what: `a mistake, ${colorScheme}` });
    }
    assert.notEqual(grounds[0], grounds[1]);
    const toggle = page.getByRole("button", { name: /^Colours/ });
    await toggle.click();
    assert.equal(await ground(), grounds[0]);
    await toggle.click();
    assert.equal(await ground(), grounds[1]);
    await page.reload();
    await page.locator(".cm-content").first().waitFor();
    await page.emulateMedia({ colorScheme: "light" });
    assert.equal(await ground(), grounds[1]);
}

/** The text of every pass can be read, copied and downloaded. */
export async function text_is_shown_copied_and_downloaded(page) {
    await write(page, "buffer Mine from kplus_array {\n    keep 4 least |f| f.depth - f.color.w;\n}\n");
    await heading(page, "No problems");
    await openTab(page, "Text");
    const files = page.getByRole("tablist", { name: "Passes" });
    await files.getByRole("tab", { name: "store", exact: true }).click();
    const code = page.locator("#text-view .cm-content");
    await code.filter({ hasText: "fn" }).waitFor();
    await page.getByRole("button", { name: "Copy", exact: true }).click();
    await status(page, "Copied");
    const copied = await page.evaluate(() => navigator.clipboard.readText());
    assert.match(copied, /fn /);
    assert.ok(copied.startsWith((await code.locator(".cm-line").first().textContent()).trimEnd()));
    const target = page.getByRole("combobox", { name: "target" });
    const names = await target.locator("option").evaluateAll((options) => options.map(({ value }) => value));
    assert.ok(names.length >= 5, names.join());
    await target.selectOption(names.find((name) => name.startsWith("glsl")));
    await code.filter({ hasText: "#version" }).waitFor();
    const waiting = page.waitForEvent("download");
    await page.getByRole("button", { name: "Download" }).click();
    const download = await waiting;
    assert.match(download.suggestedFilename(), /\.zip$/);
    const zip = await readFile(await download.path());
    assert.equal(zip.subarray(0, 2).toString(), "PK");
    assert.ok(zip.includes("manifest.json") && zip.includes(".wgsl") && zip.includes(".spv"));
}

/** An error of a request is in the status line, in words, and the page goes on. */
export async function an_error_of_a_request_is_shown(page) {
    await page.route("**/api/predict", (route) =>
        route.fulfill({
            status: 503,
            contentType: "application/json",
            body: '{"error": "out of memory: choose a smaller size"}',
        }),
    );
    await page.getByRole("button", { name: "Count" }).click();
    await status(page, "choose a smaller size");
    await page.unroute("**/api/predict");
    await page.getByRole("button", { name: "Count" }).click();
    await page.getByRole("img", { name: /covered pixels/ }).waitFor();
}

/** Two pages at once have states of their own. */
export async function two_pages_work_at_once(page, { browser, address }) {
    const other = await open(browser, address);
    await write(page, "buffer Mine from kplus_aray {\n}\n");
    await write(other, "buffer Mine from kplus_array {\n    keep 3;\n}\n");
    await heading(page, "1 error");
    await heading(other, "No problems");
    assert.match(await text(page), /kplus_aray/);
    assert.equal(await other.getByRole("spinbutton", { name: "k, as a number" }).inputValue(), "3");
    await close(other);
}

/** A line of generated text leads to the line of the description that it came from. */
export async function a_generated_line_leads_to_its_origin(page) {
    await write(page, "buffer Mine from kplus_array {\n    keep 4 least |f| f.depth - f.color.w;\n}\n");
    await heading(page, "No problems");
    await openTab(page, "Text");
    await page.getByRole("tablist", { name: "Passes" }).getByRole("tab", { name: "store", exact: true }).click();
    const origin = page.locator("#text-view .origin").first();
    for (let scroll = 0; scroll < 200 && (await origin.count()) === 0; scroll += 1) {
        await page.locator("#text-view .cm-scroller").evaluate((scroller) => scroller.scrollBy(0, 150));
        await page.waitForTimeout(30);
    }
    assert.equal(await origin.textContent(), "2");
    const active = page.locator("#editor .cm-activeLine", { hasText: /^ {4}keep 4 least \|f\| f\.depth - f\.color\.w;$/ });
    // A view that is shown again between press and release gets no click.
    for (let press = 0; press < 20 && (await active.count()) === 0; press += 1) {
        await origin.click();
        await page.waitForTimeout(100);
    }
    await active.waitFor();
}


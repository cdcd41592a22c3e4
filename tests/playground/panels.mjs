/**
 * Scenarios of the panels: costs, axes, the checker, two descriptions side by side.
 */
import assert from "node:assert/strict";
import { drawn, heading, openTab, pixels, status, text, write } from "./page.mjs";

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
    await openTab(page, "Axes");
    const storage = page.getByRole("combobox", { name: "storage" });
    await storage.locator("option:not([disabled])").nth(1).waitFor({ state: "attached" });
    const illegal = storage.locator("option[disabled]").first();
    assert.match(await illegal.getAttribute("title"), /\w+ \w+/);
    await page.locator("#reasons-storage summary").click();
    assert.ok((await page.locator("#reasons-storage li").count()) >= 1);
    // The table is shown again when the new text is analysed: its edits are those of that text.
    const meaning = page.locator("#meaning-storage");
    const before = await meaning.textContent();
    await storage.focus();
    await storage.selectOption("max_heap");
    await heading(page, "No problems");
    assert.match(await text(page), /storage: max_heap/);
    await page.waitForFunction((before) => document.querySelector("#meaning-storage").textContent !== before, before);
    // A person at the keyboard goes on in the table.
    assert.ok(await storage.evaluate((select) => select === document.activeElement));
    const sort = page.getByRole("combobox", { name: "sort", exact: true });
    const other = await sort.locator("option:not([disabled]):not(:checked)").first().getAttribute("value");
    await sort.selectOption(other);
    await heading(page, "No problems");
    assert.match(await text(page), new RegExp(`sort: ${other}`));
}

/** A choice in a table of an earlier text changes nothing: its edits would change other places. */
export async function an_axis_of_an_earlier_text_is_not_chosen(page) {
    const before = "buffer Mine from kplus_array {\n    keep 4;\n}\n";
    await write(page, before);
    await heading(page, "No problems");
    await openTab(page, "Axes");
    const storage = page.getByRole("combobox", { name: "storage" });
    await storage.locator("option", { hasText: "max_heap" }).waitFor({ state: "attached" });
    const usual = await storage.inputValue();
    let release = null;
    const held = new Promise((resolve) => (release = resolve));
    // The page may abort a request meanwhile.
    await page.route("**/api/analyse", (route) => held.then(() => route.continue()).catch(() => {}));
    const typed = `// one more line\n${before}`;
    await write(page, typed);
    await storage.selectOption("max_heap");
    await status(page, "The text changed meanwhile");
    assert.equal(await text(page), typed);
    assert.equal(await storage.inputValue(), usual);
    release();
    await heading(page, "No problems");
    // The table may still be that of the earlier text when the problems are those of this one.
    await page.waitForFunction(() => {
        const select = document.querySelector("#axis-storage");
        select.value = "max_heap";
        select.dispatchEvent(new Event("change"));
        return select.value === "max_heap";
    });
    await heading(page, "No problems");
    assert.match(await text(page), /^\/\/ one more line\nbuffer Mine from kplus_array \{\n[^]*storage: max_heap/);
    await page.unroute("**/api/analyse");
}

/** The checker finds the race of a technique that has one, and shows the schedule. */
export async function the_checker_shows_a_failing_schedule(page) {
    await write(page, "buffer Mine from kb {\n    keep 2;\n}\n");
    await heading(page, "No problems");
    await openTab(page, "Check it");
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
    await openTab(page, "Check it");
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
    await openTab(page, "Costs");
    await start("glsl").click();
    await page.locator("#check-result .running").waitFor();
    await openTab(page, "Costs");
    await start("spirv").click();
    await page.locator("#check-result .verdict:not(.running)").waitFor();
    assert.match(await page.locator("#check-result").textContent(), /spirv/);
    assert.ok(await page.getByRole("button", { name: "Check it", exact: true }).isEnabled());
}

/** A verdict is marked as one about an earlier text for as long as the text is another one. */
export async function a_verdict_about_another_text_is_marked(page) {
    const checked = "buffer Mine from kb {\n    keep 2;\n}\n";
    const outdated = page.locator("#check-result.outdated");
    await write(page, checked);
    await heading(page, "No problems");
    const panel = await openTab(page, "Check it");
    const check = async () => {
        await panel.getByRole("button", { name: "Check it", exact: true }).click();
        await panel.locator(".verdict:not(.running)").waitFor();
    };
    await check();
    assert.equal(await outdated.count(), 0);
    // Also if the text has no meaning.
    for (const other of [checked.replace("2", "3"), checked.replace("kb", "kbb")]) {
        await write(page, other);
        await outdated.waitFor();
        await write(page, checked);
        await outdated.waitFor({ state: "detached" });
    }
    await write(page, checked.replace("2", "3"));
    await outdated.waitFor();
    await check();
    assert.equal(await outdated.count(), 0);
}

/** A check that is started from the table of tiers by the keyboard leaves the focus in its form. */
export async function a_check_from_the_table_keeps_the_focus(page) {
    await write(page, "buffer Mine from kb {\n    keep 2;\n}\n");
    await heading(page, "No problems");
    await page.getByRole("button", { name: "Check it on spirv", exact: true }).focus();
    await page.keyboard.press("Enter");
    await page.locator("#check-result .verdict:not(.running)").waitFor();
    const run = page.getByRole("button", { name: "Check it", exact: true });
    assert.ok(await run.evaluate((button) => button === document.activeElement));
}

/** A histogram whose picture changed while it was counted is not shown. */
export async function a_histogram_of_an_earlier_picture_is_not_shown(page) {
    let release = null;
    const held = new Promise((resolve) => (release = resolve));
    await page.route("**/api/predict", (route) => held.then(() => route.continue()));
    const panel = await openTab(page, "Costs");
    const count = panel.getByRole("button", { name: "Count" });
    await count.click();
    const before = await pixels(page);
    await page.getByRole("combobox", { name: "scene" }).selectOption("cubes");
    await drawn(page, before);
    release();
    await panel.getByText("The picture changed.").waitFor();
    const histogram = panel.getByRole("img", { name: /covered pixels/ });
    assert.equal(await histogram.count(), 0);
    await count.click();
    await histogram.waitFor();
    await page.unroute("**/api/predict");
}

/** A description without k says why it has no histogram, and peeling that it repeats until no fragment is left. */
export async function depth_complexity_is_explained_without_k(page) {
    const panel = await openTab(page, "Costs");
    const count = panel.getByRole("button", { name: "Count" });
    await write(page, "buffer Mine from ab_ll {\n}\n");
    await heading(page, "No problems");
    await count.click();
    await panel.getByText(/^it keeps every fragment, so it has no k/).waitFor();
    assert.notEqual(await page.getByRole("status").getAttribute("data-state"), "error");
    await write(page, "buffer Mine from k_peeling {\n    keep 2;\n}\n");
    await heading(page, "No problems");
    await count.click();
    await panel.getByRole("img", { name: /an iteration draws the scene for the next 2 of each pixel/ }).waitFor();
    await page.getByText("fragments kept per pixel and iteration, of at most 2").waitFor();
    assert.equal(await panel.locator("rect.beyond").count(), 0);
    await write(page, "buffer Mine from kplus_array {\n    keep 2;\n}\n");
    await heading(page, "No problems");
    await count.click();
    await panel.getByRole("img", { name: /With k = 2, .* of the pixels and/ }).waitFor();
    assert.ok((await panel.locator("rect.beyond").count()) > 0);
}

/** Two descriptions side by side: equal ones have no difference, others a heat map. */
export async function two_descriptions_are_compared(page) {
    await write(page, "buffer Mine from kplus_array {\n    keep 4;\n}\n");
    await heading(page, "No problems");
    await openTab(page, "Side by side");
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

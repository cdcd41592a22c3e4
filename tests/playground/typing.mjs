/**
 * Scenarios of the editor: mistakes and their ways out, hovers, completions, answers that come too late.
 */
import assert from "node:assert/strict";
import { editor, heading, text, write } from "./page.mjs";

const MISTAKE = "buffer Mine from kplus_array {\n    keep 4 least |f| f.depth - f.colour.w;\n}\n";

/** A mistake shows its message at its place, and the way out repairs it. */
export async function a_mistake_shows_its_message_and_its_way_out_repairs_it(page) {
    await write(page, MISTAKE);
    await heading(page, "1 error");
    const mark = page.locator("#editor .cm-lintRange-error");
    assert.equal(await mark.textContent(), "colour");
    const problem = page.getByRole("listitem").filter({ hasText: "no attribute `colour`".replaceAll("`", "") });
    assert.match(await problem.textContent(), /unknown-field/);
    assert.equal(await problem.getByRole("button").first().textContent(), "2:34");
    // At its place, too: under the pointer.
    await mark.hover();
    const tooltip = page.locator(".cm-tooltip .cm-diagnostic");
    await tooltip.waitFor();
    assert.match(await tooltip.textContent(), /no attribute colour/);
    await problem.locator("button.fix").first().click();
    await heading(page, "No problems");
    assert.equal(await text(page), MISTAKE.replace("colour", "color").replaceAll("\n", "\n"));
    assert.equal(await page.locator("#editor .cm-lintRange-error").count(), 0);
}

/** The place of a problem is a button that moves the cursor there. */
export async function the_place_of_a_problem_leads_to_it(page) {
    await write(page, MISTAKE);
    await heading(page, "1 error");
    await page.getByRole("button", { name: "Go to line 2, column 34" }).click();
    await page.keyboard.press("Shift+End");
    await page.keyboard.insertText("color.w;");
    await heading(page, "No problems");
    assert.match(await text(page), /f\.depth - f\.color\.w;/);
}

/** An answer about an earlier text is dropped: it would mark other characters. */
export async function an_answer_that_comes_too_late_is_dropped(page) {
    let release = null;
    const held = new Promise((resolve) => (release = resolve));
    await page.route("**/api/analyse", async (route) => {
        if (route.request().postData().includes("colour")) await held;
        // The page may have aborted the request meanwhile.
        await route.continue().catch(() => {});
    });
    await write(page, MISTAKE);
    await page.waitForTimeout(200);
    await write(page, "// one more line\n" + MISTAKE.replace("colour", "color"));
    await heading(page, "No problems");
    release();
    await page.waitForTimeout(500);
    assert.equal(await page.locator("#editor .cm-lintRange-error").count(), 0);
    await heading(page, "No problems");
    await page.unroute("**/api/analyse");
}

/** Typing moves nothing but the text. */
export async function nothing_moves_while_text_is_typed(page) {
    await page.evaluate(() => {
        window.moved = [];
        const observer = new PerformanceObserver((list) => {
            // A shift of less is that of a word in its line.
            for (const entry of list.getEntries().filter(({ value }) => value > 0.0002)) {
                const nodes = entry.sources.map(({ node }) => node?.id || node?.className || node?.nodeName);
                window.moved.push(`${entry.value.toFixed(4)}: ${nodes.join(", ")}`);
            }
        });
        observer.observe({ type: "layout-shift", buffered: false });
    });
    await write(page, MISTAKE);
    await heading(page, "1 error");
    await write(page, "");
    await page.keyboard.type("buffer Mine from kb { keep 4 }", { delay: 15 });
    await page.waitForTimeout(500);
    // What is inside the editor and the list of problems belongs there.
    const moved = (await page.evaluate(() => window.moved)).filter((line) => !/cm-|problem|place|message|help|ways/.test(line));
    assert.deepEqual(moved, []);
}

/** Hover and Alt-I explain a name. */
export async function a_name_is_explained_by_pointer_and_keyboard(page) {
    await write(page, "buffer Mine from kplus_array {\n    keep 4 least |f| f.depth;\n}\n");
    await heading(page, "No problems");
    const word = page.locator("#editor .cm-line").nth(1).getByText("depth");
    await word.hover();
    await page.locator(".cm-tooltip.hover, .cm-tooltip .hover").waitFor();
    assert.match(await page.locator(".cm-tooltip.hover, .cm-tooltip .hover").textContent(), /f32/);
    await page.mouse.move(0, 0);
    await page.locator(".cm-tooltip.hover, .cm-tooltip .hover").waitFor({ state: "detached" });
    await editor(page).focus();
    await page.keyboard.press("Control+Home");
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("End");
    await page.keyboard.press("ArrowLeft");
    await page.keyboard.press("ArrowLeft");
    await page.keyboard.press("Alt+i");
    await page.locator(".cm-tooltip.hover, .cm-tooltip .hover").waitFor();
}

/** Completion lists the values of an axis; those that are illegal here are greyed, with the reason. */
export async function completion_greys_what_is_illegal_with_its_reason(page) {
    await write(page, "buffer Mine from kplus_array {\n    sync: \n}\n");
    await page.keyboard.press("Control+Home");
    await page.keyboard.press("ArrowDown");
    await page.keyboard.press("End");
    await page.keyboard.press("Control+Space");
    const list = page.locator(".cm-tooltip-autocomplete");
    await list.waitFor();
    const legal = list.locator("li:not(.illegal)", { hasText: "spin_lock" }).first();
    await legal.waitFor();
    const illegal = list.locator("li.illegal").first();
    await illegal.waitFor();
    assert.match(await illegal.textContent(), /not here: ./);
    assert.notEqual(await color(illegal), await color(legal));
    await page.keyboard.type("spin_l");
    await page.waitForTimeout(300);
    await page.keyboard.press("Enter");
    assert.match(await text(page), /sync: spin_lock/);
}

const color = (locator) => locator.evaluate((element) => getComputedStyle(element).color);

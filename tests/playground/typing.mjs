/**
 * Scenarios of the editor: mistakes and their ways out, hovers, completions, answers that come too late.
 */
import assert from "node:assert/strict";
import { editor, heading, status, text, write } from "./page.mjs";

const MISTAKE = "buffer Mine from kplus_array {\n    keep 4 least |f| f.depth - f.colour.w;\n}\n";
const REPAIRED = MISTAKE.replace("colour", "color");

/** A mistake shows its message at its place, and the way out repairs it. */
export async function a_mistake_shows_its_message_and_its_way_out_repairs_it(page) {
    await write(page, MISTAKE);
    await heading(page, "1 error");
    const mark = page.locator("#editor .cm-lintRange-error");
    assert.equal(await mark.textContent(), "colour");
    const problem = page.getByRole("listitem").filter({ hasText: "no attribute colour" });
    assert.match(await problem.textContent(), /unknown-field/);
    assert.equal(await problem.getByRole("button").first().textContent(), "2:34");
    // At its place, too: under the pointer.
    await mark.hover();
    const tooltip = page.locator(".cm-tooltip .cm-diagnostic");
    await tooltip.waitFor();
    assert.match(await tooltip.textContent(), /no attribute colour/);
    await problem.locator("button.fix").first().click();
    await heading(page, "No problems");
    assert.equal(await text(page), REPAIRED);
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

/** An answer about an earlier text is dropped, whether the newer text is not sent yet or answered already: it would mark other characters. */
export async function an_answer_that_comes_too_late_is_dropped(page) {
    await page.evaluate(holdAnalyses);
    const answers = (...numbers) => page.evaluate(deliver, numbers);
    const marks = page.locator("#editor .cm-lintRange-error");
    await write(page, MISTAKE);
    await waiting(page, 1);
    // The text changes, and the answer comes in the same turn.
    await page.evaluate(async () => {
        document.execCommand("insertText", false, "// typed meanwhile");
        window.held[0]();
        for (let frame = 0; frame < 2; frame += 1) await new Promise(requestAnimationFrame);
    });
    assert.equal(await marks.count(), 0);
    assert.equal(await page.locator("#problems-heading").getAttribute("aria-busy"), "true");
    await waiting(page, 2);
    await write(page, `// one more line\n${REPAIRED}`);
    await waiting(page, 3);
    await answers(2);
    await heading(page, "No problems");
    await answers(1);
    assert.equal(await marks.count(), 0);
    await heading(page, "No problems");
}

/** Runs in the page. Holds the answers of analyses, also of those that the page aborts: `held` has a function for each that delivers it. */
function holdAnalyses() {
    const { fetch } = window;
    window.held = [];
    window.fetch = async (path, { signal, ...options }) => {
        if (path !== "/api/analyse") return fetch(path, { signal, ...options });
        const answer = await (await fetch(path, options)).text();
        await new Promise((resolve) => window.held.push(resolve));
        return new Response(answer);
    };
}

/** Waits until as many answers came as `number`. */
const waiting = (page, number) => page.waitForFunction((number) => window.held.length === number, number);

/** Runs in the page. Delivers the held answers of these numbers, and returns when the page has used or dropped them. */
async function deliver(numbers) {
    for (const number of numbers) window.held[number]();
    for (let frame = 0; frame < 2; frame += 1) await new Promise(requestAnimationFrame);
}

/** Fixes of an earlier text are not applied, wherever they are shown: their places are others now. */
export async function fixes_of_an_earlier_text_are_not_applied(page) {
    await write(page, MISTAKE);
    await heading(page, "1 error");
    const mark = page.locator("#editor .cm-lintRange-error");
    await mark.hover();
    await page.locator(".cm-tooltip .cm-diagnostic button.fix").first().waitFor();
    const problem = page.getByRole("listitem").filter({ hasText: "no attribute colour" });
    await page.evaluate(holdAnalyses);
    // Shorter than the mark: what was marked and what is marked overlap.
    const line = "//\n";
    const typed = `${line}${MISTAKE}`;
    await page.keyboard.press("Control+Home");
    await page.keyboard.insertText(line);
    // The fix at the mark, which has moved with its text.
    await page.mouse.move(0, 0);
    await mark.hover();
    await page.locator(".cm-tooltip .cm-diagnostic button.fix").first().click();
    await status(page, "The text changed meanwhile");
    assert.equal(await text(page), typed);
    await problem.locator("button.fix").first().click();
    assert.equal(await text(page), typed);
    await page.keyboard.press("Alt+Enter");
    assert.equal(await text(page), typed);
    // F8 goes to the mark, and shows no message of an earlier text.
    await page.keyboard.press("F8");
    await page.evaluate(deliver, []);
    assert.equal(await page.locator(".cm-tooltip.problem").count(), 0);
    // Answers about the newest text are applied, also one with the same diagnostics as the answer before it.
    await waiting(page, 1);
    await page.evaluate(deliver, [0]);
    await heading(page, "1 error");
    await page.keyboard.press("Control+End");
    await page.keyboard.insertText("// the end");
    await waiting(page, 2);
    await page.evaluate(deliver, [1]);
    await heading(page, "1 error");
    await problem.locator("button.fix").first().click();
    assert.equal(await text(page), `${line}${REPAIRED}// the end`);
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
    // The table of tiers may be below what is seen: other meanings leave its columns where they are.
    const columns = () => page.locator("#panel-costs thead th").evaluateAll((cells) => cells.map((cell) => cell.getBoundingClientRect().x));
    for (const technique of ["kb", "ab_ll"]) {
        const before = await columns();
        await write(page, `buffer Mine from ${technique} {\n}\n`);
        await heading(page, "No problems");
        assert.deepEqual(await columns(), before, technique);
    }
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

/**
 * The contrast of what a page shows.
 *
 * Input: a page. Output: failures of texts that are too faint. What is hidden, disabled or outdated has no contrast to keep.
 */
import assert from "node:assert/strict";

/** Fails if a text of the page is too faint, or if fewer than `least` texts within the elements of a selector were judged. */
export async function assertContrast(page, { within = "body", least, what }) {
    const { found, judged } = await page.evaluate(faint, within);
    assert.deepEqual(found, [], what);
    assert.ok(judged >= least, `${judged} texts of ${within} were judged: ${what}`);
}

/**
 * Runs in the page. Returns visible texts whose contrast with their ground is less than 4.5, and the number of those in the elements of a
 * selector that were judged.
 */
function faint(selector) {
    const canvas = new OffscreenCanvas(1, 1).getContext("2d", { willReadFrequently: true });
    const rgba = (color) => {
        canvas.clearRect(0, 0, 1, 1);
        canvas.fillStyle = color;
        canvas.fillRect(0, 0, 1, 1);
        const [r, g, b, a] = canvas.getImageData(0, 0, 1, 1).data;
        return [r, g, b, a / 255];
    };
    const over = (top, bottom) => top.slice(0, 3).map((value, index) => value * top[3] + bottom[index] * (1 - top[3]));
    const ground = (element) => {
        if (!element) return rgba(getComputedStyle(document.documentElement).backgroundColor).slice(0, 3);
        const color = rgba(getComputedStyle(element).backgroundColor);
        return color[3] === 1 ? color.slice(0, 3) : over(color, ground(element.parentElement));
    };
    const luminance = (color) => {
        const [r, g, b] = color.map((value) =>
            value / 255 <= 0.04045 ? value / 255 / 12.92 : ((value / 255 + 0.055) / 1.055) ** 2.4,
        );
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const found = [];
    let judged = 0;
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
        const element = walker.currentNode.parentElement;
        if (!walker.currentNode.textContent.trim() || !element.checkVisibility({ visibilityProperty: true })) continue;
        // What cannot be used, and what is about an earlier text, is exempt.
        if (
            element.closest(
                ":disabled, .outdated, option, svg, noscript, .skip, .unseen, [aria-hidden=true], body[data-text=invalid] .panel",
            )
        )
            continue;
        if (element.closest(selector)) judged += 1;
        const back = ground(element);
        const [light, dark] = [luminance(over(rgba(getComputedStyle(element).color), back)), luminance(back)].sort(
            (a, b) => b - a,
        );
        const contrast = (light + 0.05) / (dark + 0.05);
        if (contrast < 4.5)
            found.push(`${contrast.toFixed(2)}: ${element.className} ${walker.currentNode.textContent.slice(0, 40)}`);
    }
    return { found, judged };
}

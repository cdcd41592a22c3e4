/**
 * What a person sees and does at the page, for the scenarios.
 *
 * Input: the address of a server, of the playground or of a site. Output: pages in Chromium, and what they show. Everything is found by what a person perceives: roles,
 * names, text; or by the places of CodeMirror's marks.
 */
import assert from "node:assert/strict";
import { chromium } from "playwright-core";

/** Chromium has no sandbox for the user root. Without an adapter for WebGPU the page shows frames of the server. */
const FLAGS = [
    "--headless=new",
    "--no-sandbox",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
];

/** Flags that give the page SwiftShader as its adapter. */
export const WEBGPU = ["--enable-unsafe-webgpu", "--use-webgpu-adapter=swiftshader", "--enable-features=Vulkan"];

/** A machine that runs other tests at the same time needs a multiple of the usual seconds. */
export const PATIENCE = Number(process.env.PATIENCE ?? 60_000);

export async function launch(flags = []) {
    const options = { args: [...FLAGS, ...flags], headless: true, timeout: PATIENCE };
    try {
        return await chromium.launch({ executablePath: "/usr/bin/chromium", ...options });
    } catch (error) {
        throw new Error(`Chromium must be installed, Debian's package is \`chromium\`: ${error.message}`);
    }
}

/** Opens the page, and waits until the first description is analysed and drawn. Errors of the page fail the scenario at its end. */
export async function open(browser, address, options = {}) {
    const { hash = "", width = 1400, height = 900, dark = false, drawn: waits = true, ready = ".cm-content" } = options;
    const context = await browser.newContext({
        viewport: { width, height },
        colorScheme: dark ? "dark" : "light",
        permissions: ["clipboard-read", "clipboard-write"],
        acceptDownloads: true,
    });
    const page = await context.newPage();
    page.setDefaultTimeout(PATIENCE);
    page.problems = [];
    page.on("pageerror", (error) => page.problems.push(`error in the page: ${error.stack ?? error.message}`));
    page.on("console", (message) => message.type() === "error" && page.problems.push(`console: ${message.text()}`));
    page.on("request", (request) => {
        if (!request.url().startsWith(address) && !/^(blob|data):/.test(request.url()))
            page.problems.push(`a request to ${request.url()}`);
    });
    page.on("response", (response) => {
        if (response.status() >= 400) page.problems.push(`status ${response.status()} of ${response.url()}`);
    });
    await page.goto(address + hash);
    await page.locator(ready).first().waitFor();
    if (waits) await drawn(page);
    return page;
}

/** Closes the page. Fails if it had an error, or asked another server. */
export async function close(page, { expected = [] } = {}) {
    const problems = page.problems.filter((problem) => !expected.some((pattern) => pattern.test(problem)));
    await page.context().close();
    assert.deepEqual(problems, []);
}

export const editor = (page) => page.getByRole("textbox", { name: "Description of the fragment buffer" });

/** The whole text of the editor, including lines that are scrolled out of sight. */
export const text = (page) =>
    page.evaluate(() => {
        const content = document.querySelector("#editor .cm-content");
        return [...content.querySelectorAll(".cm-line")].map((line) => line.textContent).join("\n");
    });

/** Replaces the text of the editor, as a person does: select all, and paste. */
export async function write(page, value) {
    await editor(page).focus();
    await page.keyboard.press("Control+a");
    await page.keyboard.insertText(value);
}

/** Waits until the diagnostics of the newest text are shown: their number of errors and warnings, in words. */
export async function heading(page, expected) {
    await page.locator("#problems-heading").filter({ hasText: expected }).waitFor();
}

/** Waits until a picture is drawn whose pixels differ from `before`. Returns its pixels. */
export async function drawn(page, before = "") {
    const found = await page.waitForFunction(
        (before) => {
            const canvas = document.querySelector("#picture");
            const frame = document.querySelector("#frame").textContent.trim();
            if (!frame || canvas.width < 2) return false;
            const pixels = canvas.toDataURL();
            return pixels !== before && pixels;
        },
        before,
        { timeout: PATIENCE, polling: 50 },
    );
    return found.jsonValue();
}

/** Returns the pixels of the picture as they are. */
export const pixels = (page) => page.evaluate(() => document.querySelector("#picture").toDataURL());

/** Presses a key until an element with this accessible name has the focus. */
export async function tabTo(page, name, { key = "Tab", most = 80 } = {}) {
    const passed = [];
    for (let press = 0; press < most; press += 1) {
        await page.keyboard.press(key);
        const focused = await page.evaluate(() => {
            const element = document.activeElement;
            const label = element?.labels?.[0]?.textContent;
            return element?.getAttribute("aria-label") ?? label ?? element?.textContent ?? "";
        });
        if (typeof name === "string" ? focused.trim() === name : name.test(focused.trim())) return;
        passed.push(focused.trim().slice(0, 30));
    }
    assert.fail(`Tab never reaches ${name}; it passes ${passed.join(" | ")}`);
}

/** Runs in the page. Returns visible texts whose contrast with their ground is less than 4.5. */
export function faint() {
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
        const back = ground(element);
        const [light, dark] = [luminance(over(rgba(getComputedStyle(element).color), back)), luminance(back)].sort(
            (a, b) => b - a,
        );
        const contrast = (light + 0.05) / (dark + 0.05);
        if (contrast < 4.5)
            found.push(`${contrast.toFixed(2)}: ${element.className} ${walker.currentNode.textContent.slice(0, 40)}`);
    }
    return found;
}

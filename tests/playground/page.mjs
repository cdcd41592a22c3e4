/**
 * What a person sees and does at the page, for the scenarios.
 *
 * Input: the address of a server, of the playground or of a site. Output: pages in Chromium, and what they show. Everything is found by what a
 * person perceives: roles, names, text; or by the places of CodeMirror's marks.
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
    await page.locator("#problems-heading[aria-busy=false]").filter({ hasText: expected }).waitFor();
}

/** The names of the panels' tabs. */
export const PANELS = ["Costs", "Axes", "Check it", "Text", "Side by side"];

/** Opens a panel by its tab. Returns it. */
export async function openTab(page, name) {
    await page.getByRole("tab", { name, exact: true }).click();
    const panel = page.getByRole("tabpanel", { name, exact: true });
    await panel.waitFor();
    return panel;
}

/** Waits until the status line has these words. */
export const status = (page, words) => page.getByRole("status").filter({ hasText: words }).waitFor();

/** Copies the link, which has the state that the page has now. Returns it. */
export async function copyLink(page) {
    await page.evaluate(() => navigator.clipboard.writeText(""));
    await page.getByRole("button", { name: "Copy link" }).click();
    // The status line may still have the message about the copy before.
    await status(page, "Copied the link");
    const link = await page.evaluate(async () => {
        for (let tries = 0; tries < 100; tries += 1) {
            const copied = await navigator.clipboard.readText();
            if (copied) return copied;
            await new Promise(requestAnimationFrame);
        }
        return "";
    });
    assert.match(link, /^http.*#/);
    return link;
}

/** Waits until the newest picture is drawn, and its pixels differ from `before`. Returns its pixels. */
export async function drawn(page, before = "") {
    const found = await page.waitForFunction(
        (before) => {
            const canvas = document.querySelector("#picture");
            const frame = document.querySelector("#frame").textContent.trim();
            if (!frame || canvas.width < 2 || canvas.getAttribute("aria-busy") !== "false") return false;
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

/** Waits until nothing is drawn. */
export const settled = (page) => page.locator("#picture[aria-busy=false]").waitFor();

/** Runs in the page. Returns the number of its picture's pixels that differ from those of a data URL by more than 2 of 255. */
export async function compare(url) {
    const letters = atob(url.split(",")[1]);
    const bytes = Uint8Array.from(letters, (letter) => letter.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], { type: "image/png" }), { colorSpaceConversion: "none" });
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const context = canvas.getContext("2d");
    context.drawImage(bitmap, 0, 0);
    const expected = context.getImageData(0, 0, canvas.width, canvas.height).data;
    const shown = document.querySelector("#picture");
    const found = shown.getContext("2d").getImageData(0, 0, shown.width, shown.height).data;
    if (found.length !== expected.length)
        throw new Error(`${shown.width} × ${shown.height}, not ${canvas.width} × ${canvas.height}`);
    let [different, covered] = [0, 0];
    for (let at = 0; at < found.length; at += 4) {
        const largest = Math.max(...[0, 1, 2].map((channel) => Math.abs(found[at + channel] - expected[at + channel])));
        different += largest > 2 ? 1 : 0;
        covered += [0, 1, 2].some((channel) => expected[at + channel] !== expected[channel]) ? 1 : 0;
    }
    return { different, covered, all: found.length / 4 };
}

/** Fails unless the picture has the pixels of a data URL, except for few on edges, and covers a part of the canvas. */
export async function assertPicture(page, url, what) {
    const { different, covered, all } = await page.evaluate(compare, url);
    assert.ok(covered > all / 20, `${covered} of ${all} pixels are covered: ${what}`);
    assert.ok(different < all / 200, `${different} of ${all} pixels differ: ${what}`);
}

/** Returns the picture that the CPU device of the server draws of the state that the page has now, as a data URL. */
export async function cpuPicture(page) {
    const { hash } = new URL(await copyLink(page));
    return page.evaluate(async (hash) => {
        const [{ decode }, { api }] = await Promise.all(["/link.mjs", "/api.mjs"].map((path) => import(path)));
        const { png } = await api.render({ ...(await decode(hash)), device: "cpu" });
        return `data:image/png;base64,${png}`;
    }, hash);
}

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

/**
 * Runs the scenarios against a server: `node drive.mjs ADDRESS|FOLDER [NAME…]`.
 *
 * Input: the address that `fragbuf playground` prints, or the folder that `fragbuf site` wrote, which is then served. Output: a line per
 * scenario; the exit status is 1 if one failed. Every scenario has a page of its own.
 */
import * as links from "./links.mjs";
import { WEBGPU, close, launch, open } from "./page.mjs";
import * as panels from "./panels.mjs";
import * as picture from "./picture.mjs";
import * as player from "./player.mjs";
import * as site from "./site.mjs";
import { serve } from "./static_server.mjs";
import * as typing from "./typing.mjs";
import * as webgpu from "./webgpu.mjs";
import * as whole from "./whole.mjs";

const [given, ...names] = process.argv.slice(2);
const served = given.startsWith("http:") ? null : await serve(given);
const address = served?.address ?? (given.endsWith("/") ? given : `${given}/`);
const all = served ? { ...site, ...player } : { ...typing, ...picture, ...panels, ...links, ...whole, ...webgpu };
/** The scenarios of a site begin at the player. */
const first = served ? { hash: "play/index.html" } : {};
const unknown = names.filter((name) => !(name in all));
if (unknown.length > 0) throw new Error(`no scenario ${unknown.join(", ")}`);

/** Errors that a scenario causes on purpose. */
const EXPECTED = {
    an_error_of_a_request_is_shown: [/503/],
    a_model_is_opened_and_dropped: [/422/],
    depth_complexity_is_explained_without_k: [/422/],
    a_technique_that_cannot_be_read_is_reported: [/503/],
};

/** The browsers with and without WebGPU, opened when they are needed. */
const browsers = new Map();

async function browserFor(name) {
    const key = name in webgpu || name in player;
    if (!browsers.has(key)) browsers.set(key, await launch(key ? WEBGPU : []));
    return browsers.get(key);
}

let failures = 0;
for (const [name, scenario] of Object.entries(all)) {
    if (names.length > 0 && !names.includes(name)) continue;
    const begin = performance.now();
    let page = null;
    try {
        const browser = await browserFor(name);
        page = await open(browser, address, first);
        await scenario(page, { browser, address });
        await close(page, { expected: EXPECTED[name] });
        console.log(`ok      ${name} (${Math.round(performance.now() - begin)} ms)`);
    } catch (error) {
        failures += 1;
        console.log(`FAILED  ${name}: ${error.stack ?? error}`);
        if (process.env.SCREENSHOTS) await page?.screenshot({ path: `${process.env.SCREENSHOTS}/${name}.png` }).catch(() => {});
        for (const problem of page?.problems ?? []) console.log(`        ${problem}`);
        await page
            ?.context()
            .close()
            .catch(() => {});
    }
}
for (const browser of browsers.values()) await browser.close();
served?.close();
process.exit(failures === 0 ? 0 : 1);

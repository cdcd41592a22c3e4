/**
 * The statistics of a frame in one form, whoever drew it.
 *
 * Input: what the picture reports: the JSON of `fragbuf render --json` for a frame of the server, times and counters for one of WebGPU.
 * Output: the same fields for both; what was not counted or timed is null. Nothing is shown here.
 */
import { count } from "./dom.mjs";

/**
 * @typedef {object} Frame
 * @property {string} device who drew it
 * @property {string | null} target
 * @property {Record<string, number>} ms by pass, or by part of the frame where no pass is timed
 * @property {number | null} frame_ms of the whole frame: from drawing to the image, with what the page waits for
 * @property {number | null} bytes
 * @property {number | null} triangles
 * @property {number | null} k
 * @property {{ generated: number, stored: number | null, culled: number, displaced: number, occluded: number } | null} fragments
 * @property {{ total: number, by_counter: Record<string, number> } | null} lost
 * @property {number | null} hit_ratio
 * @property {{ iterations: number, end: string }[]} loops
 * @property {string[]} messages warnings about the frame
 */

/** @returns {Frame} */
export function frameOf(reported) {
    const { bytes = null, triangles = null, k = null, target = null, loops } = reported;
    const lost = lossesOf(reported);
    const fragments = fragmentsOf(reported, lost);
    const isCounted = fragments?.generated > 0 && Number.isFinite(fragments.stored);
    const ratio = isCounted ? fragments.stored / fragments.generated : null;
    return {
        device: reported.mode === "webgpu" ? "WebGPU in this page" : (reported.device ?? ""),
        target,
        ms: timesOf(reported),
        frame_ms: reported.times?.frame ?? null,
        bytes,
        triangles,
        k,
        fragments,
        lost,
        hit_ratio: reported.hit_ratio ?? ratio,
        loops: (Array.isArray(loops) ? loops : []).map(loopOf),
        messages: messagesOf(reported),
    };
}

/** Devices of the server time passes, WebGPU where the browser has timestamps. Without them there is the time of the frame alone. */
function timesOf({ ms, times, timed }) {
    const passes = ms ?? timed?.passes ?? {};
    const shown = Object.keys(passes).length > 0 ? passes : { frame: times?.frame };
    return Object.fromEntries(Object.entries(shown).filter(([, value]) => Number.isFinite(value)));
}

/** A loop of WebGPU says whether its condition was met; null if nothing has waited for it. */
function loopOf({ iterations, end, isMet }) {
    return { iterations, end: end ?? (isMet === false ? "limit" : "condition") };
}

function lossesOf({ lost }) {
    return Number.isFinite(lost?.total) ? lost : null;
}

/**
 * Returns whether the counters of a frame give the number of its stored fragments: those generated, less those that were culled,
 * displaced or lost. The server computes it from capabilities of the plan, which a manifest does not have. These manifests are left out:
 *
 * * A loop that draws the scene and resolves it, too, peels: an iteration counts as displaced what a later one keeps. Loops that draw
 *   alone, such as those that write again until nothing changes, count every fragment once.
 * * A pass over the scene with render targets stores by the depth or stencil test, which count nothing.
 */
export function countsStored({ steps }) {
    const isDrawing = (step) => step.kind === "geometry";
    const isPeeling = (step, index) => {
        if (step.do !== "loop") return false;
        const body = steps.slice(index, step.end);
        return body.some(isDrawing) && body.some(({ kind }) => kind === "fullscreen");
    };
    return !steps.some(isPeeling) && !steps.some((step) => isDrawing(step) && step.state.targets.length > 0);
}

function fragmentsOf({ fragments, counts, counts_stored: isExact }, lost) {
    if (Number.isFinite(fragments?.generated)) return fragments;
    // With `counters: losses` the other counters of WebGPU are 0.
    if (!(counts?.generated > 0)) return null;
    const { generated, culled = 0, displaced = 0, occluded = 0 } = counts;
    const stored = isExact ? Math.max(generated - culled - displaced - (lost?.total ?? 0), 0) : null;
    return { generated, culled, displaced, occluded, stored };
}

function messagesOf({ messages, reason, timed }) {
    const texts = (messages ?? []).map((message) => (typeof message === "string" ? message : message?.message));
    const rest = timed?.unmeasured ?? 0;
    // Without timestamps the time of the frame is shown.
    if (rest > 0 && !timed.reason) texts.push(`Of the passes of this frame, ${count(rest)} are not in its times.`);
    return [...texts, reason && `Drawn by the server: ${reason}`].filter(Boolean);
}

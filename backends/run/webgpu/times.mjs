/**
 * Measures the passes of a frame, with timestamps that the device writes where they begin and end.
 * @module
 */
import { MOST_QUERIES, QUERY_BYTES } from "./readback.mjs";

/** The optional feature of WebGPU that has timestamps. */
export const TIMESTAMP_FEATURE = "timestamp-query";

/** Nanoseconds in a millisecond. */
const NANOSECONDS = 1e6;

/** What a caller does about a missing feature. */
const REQUEST = "request it as `requirements` returns it for `times: true`, which omits it if the adapter lacks it too";

/** The timestamps of one frame. A device without the feature has none, and passes are only counted. */
export class Timestamps {
    /** @param {GPUDevice} device */
    constructor(device) {
        this.begin();
        if (!device.features.has(TIMESTAMP_FEATURE)) return;
        this.set = device.createQuerySet({ label: "fragbuf times", type: "timestamp", count: MOST_QUERIES });
        const usage = GPUBufferUsage.QUERY_RESOLVE | GPUBufferUsage.COPY_SRC;
        this.resolved = device.createBuffer({ label: "fragbuf times", size: QUERY_BYTES * MOST_QUERIES, usage });
    }

    /** Begins a frame, whose passes use the queries again. */
    begin() {
        /** The names of measured passes. Pass `n` has the queries `2 n` and `2 n + 1`. @type {string[]} */
        this.names = [];
        this.unmeasured = 0;
        this.isComplete = false;
    }

    /** Returns the timestamps that a pass writes; `undefined` if there is no query for it. */
    writes(name) {
        const beginningOfPassWriteIndex = 2 * this.names.length;
        if (!this.set || beginningOfPassWriteIndex + 2 > MOST_QUERIES) {
            this.unmeasured++;
            return undefined;
        }
        this.names.push(name);
        const endOfPassWriteIndex = beginningOfPassWriteIndex + 1;
        return { querySet: this.set, beginningOfPassWriteIndex, endOfPassWriteIndex };
    }

    /** Ends a frame. Queries of a frame that was not submitted as a whole are not read. */
    end() {
        this.isComplete = true;
    }

    /**
     * Reads the times of the last frame, after everything that has been submitted.
     * @param {import("./readback.mjs").Readback} readback
     * @returns {Promise<import("./fragbuf.d.ts").PassTimes>}
     */
    async read(readback) {
        const reason = this.set ? null : `the device lacks the feature \`${TIMESTAMP_FEATURE}\`: ${REQUEST}`;
        if (!this.isComplete) return { passes: {}, unmeasured: 0, reason };
        // The next frame may begin while this one is read.
        const { names, unmeasured, set, resolved } = this;
        const count = 2 * names.length;
        const resolve = (encoder) => encoder.resolveQuerySet(set, 0, count, resolved, 0);
        const words = await readback.first(resolved, QUERY_BYTES * count, resolve);
        return { passes: summed(names, new BigUint64Array(words.buffer)), unmeasured, reason };
    }

    destroy() {
        this.set?.destroy();
        this.resolved?.destroy();
    }
}

/** Returns the milliseconds of all runs of each pass, by its name. */
function summed(names, timestamps) {
    const passes = {};
    names.forEach((name, index) => {
        const nanoseconds = timestamps[2 * index + 1] - timestamps[2 * index];
        // A device may reset its clock between two timestamps.
        passes[name] = (passes[name] ?? 0) + Math.max(Number(nanoseconds), 0) / NANOSECONDS;
    });
    return passes;
}

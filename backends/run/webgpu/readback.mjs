/**
 * Copies words from the device to the host.
 * @module
 */

/** The bytes of a query's result. */
export const QUERY_BYTES = 8;

/** The greatest number of queries in a set. */
export const MOST_QUERIES = 4096;

/** Reads words. One request of a frame is under way at a time. */
export class Readback {
    constructor(device) {
        this.device = device;
    }

    /** Records the copies for a request of a frame. */
    record(encoder, request) {
        const queryBytes = request.queries ? QUERY_BYTES * request.queries.count : 0;
        const wordBytes = request.reads.reduce((sum, read) => sum + read.size, 0);
        request.wordBytes = wordBytes;
        if (this.staging === undefined || this.staging.size < wordBytes + queryBytes) {
            this.staging?.destroy();
            this.staging = this.#buffer(Math.max(wordBytes + queryBytes, 256));
        }
        copyWords(encoder, request.reads, this.staging);
        if (!request.queries) return;
        if (this.resolved === undefined || this.resolved.size < queryBytes) {
            this.resolved?.destroy();
            const usage = GPUBufferUsage.QUERY_RESOLVE | GPUBufferUsage.COPY_SRC;
            this.resolved = this.device.createBuffer({ label: "fragbuf queries", size: queryBytes, usage });
        }
        encoder.resolveQuerySet(request.queries.set, 0, request.queries.count, this.resolved, 0);
        encoder.copyBufferToBuffer(this.resolved, 0, this.staging, wordBytes, queryBytes);
    }

    /** Waits for the words of a request, and the samples of each query: 0 if none passed. */
    async read({ wordBytes, queries }) {
        await this.staging.mapAsync(GPUMapMode.READ);
        const bytes = this.staging.getMappedRange();
        const words = new Uint32Array(bytes.slice(0, wordBytes));
        const halves = queries ? new Uint32Array(bytes.slice(wordBytes, wordBytes + QUERY_BYTES * queries.count)) : [];
        this.staging.unmap();
        const samples = Array.from({ length: halves.length / 2 }, (_, index) => halves[2 * index] | halves[2 * index + 1]);
        return { words, samples };
    }

    /** Records copies into a buffer of their own, for a host step of a later frame. */
    copy(encoder, reads) {
        const staging = this.#buffer(reads.reduce((sum, read) => sum + read.size, 0));
        copyWords(encoder, reads, staging);
        return staging;
    }

    /** Returns an object that gets `words` once the copies have been made. */
    arriving(step, staging) {
        const copy = { step, words: undefined, isLost: false };
        const arrive = () => {
            copy.words = new Uint32Array(staging.getMappedRange().slice(0));
            staging.destroy();
        };
        staging.mapAsync(GPUMapMode.READ).then(arrive, () => (copy.isLost = true));
        return copy;
    }

    /** Reads the first bytes of a buffer, after everything that has been submitted and what `record` records. */
    async first(buffer, size, record) {
        if (size === 0) return new Uint32Array();
        const encoder = this.device.createCommandEncoder();
        record?.(encoder);
        const staging = this.copy(encoder, [{ buffer, offset: 0, size }]);
        this.device.queue.submit([encoder.finish()]);
        await staging.mapAsync(GPUMapMode.READ);
        const words = new Uint32Array(staging.getMappedRange().slice(0));
        staging.destroy();
        return words;
    }

    destroy() {
        this.staging?.destroy();
        this.resolved?.destroy();
    }

    #buffer(size) {
        const usage = GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST;
        return this.device.createBuffer({ label: "fragbuf readback", size, usage });
    }
}

/** Records copies of ranges one behind the other. */
function copyWords(encoder, reads, target) {
    let at = 0;
    for (const { buffer, offset, size } of reads) {
        if (size > 0) encoder.copyBufferToBuffer(buffer, offset, target, at, size);
        at += size;
    }
}

/**
 * Turns what WebGPU reports asynchronously into errors that the caller can catch.
 * @module
 */

/** An error that the device reports. What it was to create may be unusable. */
export class DeviceError extends Error {}

/** Something does not fit. Lower slices of the frame need less. */
export class ExcessError extends Error {}

const SCOPES = ["validation", "out-of-memory", "internal"];

/**
 * Runs calls of WebGPU in error scopes, and returns their result. Throws what the device reports.
 * @template T
 * @param {GPUDevice} device
 * @param {string} what The object of the sentence in the message.
 * @param {() => T} run Must not wait: the scopes of others could be opened meanwhile.
 * @returns {Promise<T>}
 */
export async function scoped(device, what, run) {
    SCOPES.forEach((scope) => device.pushErrorScope(scope));
    let result, thrown;
    try {
        result = run();
    } catch (error) {
        thrown = { error };
    }
    // A lost device reports no errors: the promise `lost` does.
    const pop = () => device.popErrorScope().catch(() => null);
    const [internal, memory, validation] = await Promise.all(SCOPES.map(pop));
    if (thrown) throw thrown.error;
    const found = memory ?? internal ?? validation;
    if (found) {
        const help = memory ? ". Use a smaller frame, lower slices (`rows`), or keep fewer fragments" : "";
        throw new DeviceError(`WebGPU rejects ${what}: ${found.message}${help}`);
    }
    return result;
}

/**
 * The requests to the server of the page.
 *
 * Input: bodies as the server expects them. Output: what it answers, or an `ApiError` that says what to do. Nothing here shows anything,
 * and no address leaves the server that sent the page.
 */

/** An error of a request, in words for the person at the page. */
export class ApiError extends Error {
    /** @param {string} message @param {number} status 0 if no answer came */
    constructor(message, status) {
        super(message);
        this.name = "ApiError";
        this.status = status;
    }
}

/**
 * Sends a request. Returns the response, whose status is a success.
 * @param {string} path
 * @param {object | Blob | null} body null for GET
 * @param {AbortSignal} [signal]
 */
async function request(path, body, signal) {
    const options = { signal, cache: "no-store" };
    if (body instanceof Blob)
        Object.assign(options, { method: "POST", headers: { "content-type": "application/octet-stream" }, body });
    else if (body)
        Object.assign(options, { method: "POST", headers: { "content-type": "application/json" }, body: JSON.stringify(body) });
    let response;
    try {
        response = await fetch(path, options);
    } catch (error) {
        if (error.name === "AbortError") throw error;
        throw new ApiError(
            "The server does not answer. Start `fragbuf playground` again, and reload the page at the address that it prints.",
            0,
        );
    }
    if (!response.ok) throw new ApiError(await reason(response), response.status);
    return response;
}

async function reason(response) {
    const text = await response.text().catch(() => "");
    try {
        const { error } = JSON.parse(text);
        if (typeof error === "string" && error) return error;
    } catch {
        // The answer is no JSON: its text is all there is.
    }
    return text.trim().slice(0, 400) || `The server answered with the status ${response.status}.`;
}

/** Sends a request by its name, as `analyse`. Returns its answer as parsed JSON. Without a body it is a GET. */
async function json(name, body, signal) {
    return (await request(`/api/${name}`, body, signal)).json();
}

/** The requests, each a function of its body and a signal that aborts it. */
export const api = {
    start: (signal) => json("start", null, signal),
    analyse: (body, signal) => json("analyse", body, signal),
    hover: (body, signal) => json("hover", body, signal),
    complete: (body, signal) => json("complete", body, signal),
    generate: (body, signal) => json("generate", body, signal),
    geometry: async (body, signal) => (await request("/api/geometry", body, signal)).arrayBuffer(),
    download: async (body, signal) => (await request("/api/download", body, signal)).blob(),
    render: (body, signal) => json("render", body, signal),
    predict: (body, signal) => json("predict", body, signal),
    check: (body, signal) => json("check", body, signal),
    /** @param {File} file */
    model: (file, signal) => json(`model?name=${encodeURIComponent(file.name)}`, file, signal),
};

/**
 * Returns a function that runs `action` and drops the answers of earlier calls: the newest call aborts the one before. An answer that is
 * too late is never passed on.
 * @template T
 * @param {(signal: AbortSignal, ...values: any[]) => Promise<T>} action
 * @param {{ done(result: T): void, failed(error: Error): void }} receiver
 */
export function latest(action, { done, failed }) {
    /** @type {AbortController | null} */
    let running = null;
    return async (...values) => {
        running?.abort();
        const own = (running = new AbortController());
        try {
            const result = await action(own.signal, ...values);
            if (own === running) done(result);
        } catch (error) {
            if (own === running && error.name !== "AbortError") failed(error);
        } finally {
            if (own === running) running = null;
        }
    };
}

/**
 * The line at the bottom of the page: what happened, and errors of requests until the same request succeeds or something else happens.
 *
 * Input: messages and errors. Output: text with the role `status`, which screen readers announce.
 */

/** @param {HTMLElement} line */
export function createStatus(line) {
    let clear = 0;
    let failing = "start";
    const show = (message, state) => {
        clearTimeout(clear);
        line.dataset.state = state;
        if (line.textContent !== message) line.textContent = message;
    };
    return {
        /** Shows a message for some seconds. */
        say(message) {
            failing = "";
            show(message, "");
            clear = setTimeout(() => show("Ready", ""), 6000);
        },
        /**
         * Shows an error.
         * @param {Error} error
         * @param {string} [source] what failed: `recovered` with the same name ends the message
         */
        fail(error, source = "request") {
            failing = source;
            show(error.message, "error");
        },
        /** What failed before succeeds again. */
        recovered(source) {
            if (failing !== source) return;
            failing = "";
            show("Ready", "");
        },
    };
}

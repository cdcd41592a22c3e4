/**
 * The list of diagnostics below the editor.
 *
 * Input: diagnostics of the server. Output: an entry for each, whose place is a button that moves the cursor there, and a button per fix.
 */
import { button, element, fill } from "./dom.mjs";
import { problemBody } from "./editor.mjs";

/**
 * Creates the list.
 * @param {{ list: HTMLElement, heading: HTMLElement }} elements
 * @param {{ go(place: { offset: number }): void, fix(edits: object[], about: string): void }} editor
 */
export function createProblems({ list, heading }, editor) {
    let before = "";
    /** The text of the diagnostics. */
    let newest = "";
    const apply = (edits) => editor.fix(edits, newest);
    return {
        /**
         * @param {import("./editor.mjs").Diagnostic[]} diagnostics
         * @param {string} about their text
         */
        show(diagnostics, about) {
            newest = about;
            // Equal diagnostics leave the list as it is, with the focus of its buttons. Edits of fixes are part of them.
            const now = JSON.stringify(diagnostics);
            if (now === before) return;
            before = now;
            heading.textContent = title(diagnostics);
            heading.dataset.state = diagnostics.some(isError) ? "error" : diagnostics.length > 0 ? "warning" : "good";
            fill(
                list,
                diagnostics.map((diagnostic) => entry(diagnostic, editor.go, apply)),
            );
        },
    };
}

const isError = ({ severity }) => severity === "error";

function title(diagnostics) {
    const errors = diagnostics.filter(isError).length;
    const warnings = diagnostics.length - errors;
    const number = (count, word) => count > 0 && `${count} ${word}${count === 1 ? "" : "s"}`;
    return [number(errors, "error"), number(warnings, "warning")].filter(Boolean).join(", ") || "No problems";
}

function entry(diagnostic, go, apply) {
    const { line, column, from, severity, file } = diagnostic;
    // A place in a file that the description names is not in the editor.
    const place = file
        ? element("span", { className: "place" }, `${file.split("/").pop()}:${line}:${column}`)
        : button(`${line}:${column}`, () => go({ offset: from }), {
              className: "place",
              "aria-label": `Go to line ${line}, column ${column}`,
          });
    return element(
        "li",
        { className: `problem ${severity}` },
        place,
        element("div", {}, ...problemBody(diagnostic, apply)),
    );
}

/**
 * A generated file, read-only, with the lines of the description that its lines come from.
 *
 * Input: a file. Output: an editor of CodeMirror that shows it, and calls when a person follows a line to its origin. Nothing here changes a
 * text.
 */
import {
    EditorState,
    EditorView,
    GutterMarker,
    gutter,
    highlightSelectionMatches,
    keymap,
    lineNumbers,
    searchKeymap,
} from "./vendor/codemirror.mjs";
import { codeStyle } from "./code_style.mjs";
import { button } from "./dom.mjs";
import { shaderLanguage } from "./language.mjs";

/**
 * Shows a file in an element. Returns its editor.
 * @param {HTMLElement} parent
 * @param {{ path: string, text: string, lines?: (number | null)[], templates?: (string | null)[] }} file
 * @param {(line: number) => void} go is called with a line of the description
 * @param {(origin: string) => void} at is called with where the line of the cursor comes from
 */
export function codeView(parent, file, go, at) {
    const lines = file.lines ?? [];
    const origins = gutter({
        class: "cm-origin",
        lineMarker(view, block) {
            const line = lines[view.state.doc.lineAt(block.from).number - 1];
            return line ? new Origin(line) : null;
        },
        // Of the gutter: a marker may be drawn again between press and release, and would get no click.
        domEventHandlers: {
            click(view, block) {
                const line = lines[view.state.doc.lineAt(block.from).number - 1];
                if (line) go(line);
                return Boolean(line);
            },
        },
    });
    const index = (state) => state.doc.lineAt(state.selection.main.head).number - 1;
    const enter = (view) => {
        const line = lines[index(view.state)];
        if (line) go(line);
        return Boolean(line);
    };
    return new EditorView({
        parent,
        state: EditorState.create({
            doc: file.text,
            extensions: [
                ...(lines.some(Boolean) ? [origins] : []),
                lineNumbers(),
                EditorState.readOnly.of(true),
                highlightSelectionMatches(),
                keymap.of([{ key: "Enter", run: enter }, ...searchKeymap]),
                EditorView.contentAttributes.of({ "aria-label": `${file.path}, read-only`, "aria-readonly": "true" }),
                EditorView.updateListener.of((update) => update.selectionSet && at(origin(file, index(update.state)))),
                shaderLanguage,
                codeStyle,
            ],
        }),
    });
}

class Origin extends GutterMarker {
    constructor(line) {
        super();
        this.line = line;
    }
    eq(other) {
        return other.line === this.line;
    }
    toDOM() {
        // Not a tab stop: Enter on the line does the same, and a text may have hundreds of them.
        const title = `From line ${this.line} of the description: go there`;
        return button(`${this.line}`, undefined, { title, tabIndex: -1, className: "origin" });
    }
}

/** Returns in words where a line of a file comes from; counted from 0. */
function origin({ lines = [], templates = [] }, index) {
    if (lines[index]) return `from line ${lines[index]} of the description`;
    return templates[index] ? `from ${templates[index]}` : "";
}

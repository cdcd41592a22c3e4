/**
 * Wrapped lines of an editor continue below their own indentation.
 *
 * Input: the lines that are in sight. Output: a style per line. Nothing here changes the text.
 */
import { Decoration, EditorView, RangeSetBuilder, ViewPlugin } from "./vendor/codemirror.mjs";

/** Columns by which the rest of a line is indented further than its beginning. */
const FURTHER = 4;

/** No indentation takes more of a narrow window than this. */
const MOST = 24;

function decorations(view) {
    const builder = new RangeSetBuilder();
    for (const { from, to } of view.visibleRanges) {
        for (let position = from; position <= to;) {
            const line = view.state.doc.lineAt(position);
            const columns = Math.min(/^ */.exec(line.text)[0].length + FURTHER, MOST);
            // The padding is that of the lines in code_style.mjs, 6 pixels, and the columns.
            const style = `text-indent: -${columns}ch; padding-left: calc(6px + ${columns}ch)`;
            builder.add(line.from, line.from, Decoration.line({ attributes: { style } }));
            position = line.to + 1;
        }
    }
    return builder.finish();
}

const indented = ViewPlugin.fromClass(
    class {
        constructor(view) {
            this.decorations = decorations(view);
        }
        update(update) {
            if (update.docChanged || update.viewportChanged) this.decorations = decorations(update.view);
        }
    },
    { decorations: (plugin) => plugin.decorations },
);

/** The extensions that wrap lines. */
export const wrapping = [EditorView.lineWrapping, indented];

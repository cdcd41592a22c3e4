/**
 * The look of CodeMirror: colours and sizes from the variables of base.css, so that light and dark need no other theme.
 */
import { EditorView, HighlightStyle, syntaxHighlighting, tags } from "./vendor/codemirror.mjs";

const highlighting = HighlightStyle.define([
    { tag: tags.keyword, color: "var(--code-keyword)" },
    { tag: tags.typeName, color: "var(--code-type)" },
    { tag: tags.atom, color: "var(--code-atom)" },
    { tag: tags.number, color: "var(--code-number)" },
    { tag: tags.string, color: "var(--code-string)" },
    { tag: tags.comment, color: "var(--code-comment)", fontStyle: "italic" },
    { tag: tags.propertyName, color: "var(--code-property)" },
    { tag: tags.function(tags.variableName), color: "var(--code-function)" },
    { tag: tags.operator, color: "var(--code-operator)" },
    { tag: tags.punctuation, color: "var(--code-operator)" },
]);

const theme = EditorView.theme({
    "&": { height: "100%", color: "var(--ink)", backgroundColor: "var(--code-ground)", fontSize: "var(--code-size)" },
    "&.cm-focused": { outline: "none" },
    ".cm-scroller": { fontFamily: "var(--mono)", lineHeight: "1.6" },
    ".cm-content": { caretColor: "var(--accent)", padding: "10px 0" },
    ".cm-line": { padding: "0 14px 0 6px" },
    ".cm-cursor": { borderLeftColor: "var(--accent)", borderLeftWidth: "2px" },
    ".cm-gutters": { backgroundColor: "var(--code-ground)", color: "var(--faint)", border: "none" },
    ".cm-lineNumbers .cm-gutterElement": { minWidth: "2.4em", padding: "0 6px 0 8px" },
    ".cm-activeLine": { backgroundColor: "var(--code-line)" },
    ".cm-activeLineGutter": { backgroundColor: "var(--code-line)", color: "var(--ink)" },
    "&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground": {
        backgroundColor: "var(--code-selection) !important",
    },
    ".cm-matchingBracket, &.cm-focused .cm-matchingBracket": {
        backgroundColor: "var(--code-selection)",
        outline: "1px solid var(--line)",
    },
    ".cm-selectionMatch": { backgroundColor: "var(--code-match)" },
    ".cm-panels": { backgroundColor: "var(--panel)", color: "var(--ink)", borderColor: "var(--line)" },
    ".cm-tooltip": {
        backgroundColor: "var(--raised)",
        color: "var(--ink)",
        border: "1px solid var(--line)",
        borderRadius: "8px",
        boxShadow: "var(--shadow)",
        maxWidth: "min(46em, 92vw)",
    },
    ".cm-tooltip.cm-tooltip-autocomplete > ul": { fontFamily: "var(--mono)", maxHeight: "15em" },
    ".cm-tooltip.cm-tooltip-autocomplete > ul > li": { padding: "3px 10px" },
    ".cm-tooltip-autocomplete ul li[aria-selected]": { backgroundColor: "var(--accent-ground)", color: "var(--ink)" },
    ".cm-completionInfo": { padding: "8px 12px", maxWidth: "26em" },
    ".cm-completionDetail": { color: "var(--muted)", fontStyle: "normal", marginLeft: "1.2em" },
    ".cm-diagnostic": { borderLeft: "none", padding: "10px 12px" },
    ".cm-lintRange": {
        backgroundImage: "none",
        textDecoration: "underline wavy 1.5px",
        textUnderlineOffset: "4px",
        textDecorationSkipInk: "none",
    },
    ".cm-lintRange-error": { textDecorationColor: "var(--error)" },
    ".cm-lintRange-warning": { textDecorationColor: "var(--warning)" },
    ".cm-lintRange-info": { textDecorationColor: "var(--accent)" },
    ".cm-lint-marker": { width: "9px", height: "9px", borderRadius: "50%", margin: "4px 0 0 3px", content: "none" },
    ".cm-lint-marker-error": { backgroundColor: "var(--error)" },
    ".cm-lint-marker-warning": { backgroundColor: "var(--warning)" },
    ".cm-gutter-lint": { width: "15px" },
    ".cm-origin": { color: "var(--accent)", cursor: "pointer", padding: "0 8px 0 2px", textAlign: "right" },
});

/** The extensions that give an editor the look of the page. */
export const codeStyle = [theme, syntaxHighlighting(highlighting)];

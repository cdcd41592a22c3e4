/**
 * The editor of the description: CodeMirror with the diagnostics, hovers and completions of the server.
 *
 * Input: text, what the server answered about it. Output: calls of `changed` with every new text. An answer about another text than the one
 * shown is never used: diagnostics and edits come with the text that they are about. What is wrong and how to fix it comes from the server
 * alone.
 */
import {
    Compartment,
    EditorState,
    EditorView,
    StateEffect,
    StateField,
    acceptCompletion,
    autocompletion,
    bracketMatching,
    closeBrackets,
    closeBracketsKeymap,
    completionKeymap,
    defaultKeymap,
    drawSelection,
    highlightActiveLine,
    highlightActiveLineGutter,
    highlightSelectionMatches,
    history,
    historyKeymap,
    hoverTooltip,
    indentOnInput,
    indentUnit,
    indentWithTab,
    keymap,
    lineNumbers,
    lintGutter,
    lintKeymap,
    nextDiagnostic,
    searchKeymap,
    setDiagnostics,
    showTooltip,
} from "./vendor/codemirror.mjs";
import { codeStyle } from "./code_style.mjs";
import { button, element } from "./dom.mjs";
import { descriptionLanguage } from "./language.mjs";
import { inline, markdown } from "./markdown.mjs";
import { wrapping } from "./wrapping.mjs";

/** @typedef {{ from: number, to: number, insert: string }} Edit */
/** @typedef {{ title: string, edits: Edit[] }} Fix */
/**
 * @typedef {object} Diagnostic
 * @property {"error" | "warning"} severity
 * @property {string} code @property {string} message @property {string | null} help
 * @property {number} from @property {number} to @property {number} line @property {number} column
 * @property {{ from: number, to: number, text: string }[]} labels
 * @property {Fix[]} fixes
 */

/**
 * Creates the editor.
 * @param {HTMLElement} parent
 * @param {object} options
 * @param {string} options.text
 * @param {typeof import("./api.mjs").api} options.api
 * @param {(text: string) => void} options.changed
 * @param {() => void} options.outdated edits were not applied, because the text is another one than theirs
 * @param {(error: Error) => void} options.failed an error of a request
 */
export function createEditor(parent, { text, api, changed, outdated, failed }) {
    const language = new Compartment();
    /** @type {{ diagnostics: Diagnostic[], about: string }} */
    let shown = { diagnostics: [], about: "" };
    const current = () => view.state.doc.toString();
    /** Applies edits of an answer about `about`. Returns false, without a change, if the text is another one by now. */
    const apply = (edits, about) => {
        if (about !== current()) {
            outdated();
            return false;
        }
        view.dispatch({ changes: edits.map(({ from, to, insert }) => ({ from, to, insert })), userEvent: "input.fix" });
        return true;
    };
    /** Applies the edits of a fix, as `apply`, and moves the focus to the text. */
    const fix = (edits, about) => {
        if (apply(edits, about)) view.dispatch({ scrollIntoView: true });
        view.focus();
    };
    /** Returns the function that applies fixes of an answer about `about`. */
    const fixing = (about) => (edits) => fix(edits, about);
    const view = new EditorView({
        parent,
        state: EditorState.create({
            doc: text,
            extensions: [
                lintGutter(),
                lineNumbers(),
                highlightActiveLine(),
                highlightActiveLineGutter(),
                history(),
                drawSelection(),
                bracketMatching(),
                closeBrackets(),
                indentOnInput(),
                indentUnit.of("    "),
                EditorState.tabSize.of(4),
                highlightSelectionMatches(),
                language.of(descriptionLanguage([])),
                codeStyle,
                wrapping,
                autocompletion({ override: [completionSource(api, failed)], icons: false, optionClass, interactionDelay: 40 }),
                hoverTooltip((view, offset) => hover(api, view, offset), { hoverTime: 250 }),
                keyboardHover,
                keymap.of([
                    { key: "Alt-i", run: (view) => showHover(api, view, failed) },
                    { key: "F8", run: (view) => goToProblem(view, shown, fixing(shown.about)) },
                    { key: "Alt-Enter", run: () => fixAtCursor(view, shown.diagnostics, fixing(shown.about)) },
                    { key: "Escape", run: closeHover },
                    { key: "Tab", run: acceptCompletion },
                    indentWithTab,
                    ...closeBracketsKeymap,
                    ...completionKeymap,
                    ...lintKeymap,
                    ...searchKeymap,
                    ...historyKeymap,
                    ...defaultKeymap,
                ]),
                EditorView.contentAttributes.of({
                    "aria-label": "Description of the fragment buffer",
                    "aria-describedby": "editor-keys",
                    spellcheck: "false",
                    autocapitalize: "off",
                }),
                EditorView.updateListener.of((update) => update.docChanged && changed(update.state.doc.toString())),
            ],
        }),
    });
    return {
        apply,
        fix,
        /** Replaces the whole text; one step to undo. */
        replace(text) {
            if (text === current()) return;
            view.dispatch({
                changes: { from: 0, to: view.state.doc.length, insert: text },
                selection: { anchor: 0 },
                scrollIntoView: true,
            });
        },
        /** Names that the server lists, for the colours. */
        setNames(names) {
            view.dispatch({ effects: language.reconfigure(descriptionLanguage(names)) });
        },
        /** Shows diagnostics of an answer about `about`; drops them if the text is another one by now. */
        show(/** @type {Diagnostic[]} */ diagnostics, about) {
            if (about !== current()) return false;
            shown = { diagnostics, about };
            const length = view.state.doc.length;
            const marks = diagnostics.map((diagnostic) => mark(diagnostic, length, fixing(about))).sort((a, b) => a.from - b.from);
            view.dispatch(setDiagnostics(view.state, marks));
            return true;
        },
        /** Moves the cursor to a line or an offset, and the focus with it. */
        go({ line, offset }) {
            const doc = view.state.doc;
            const position = line ? doc.line(Math.min(Math.max(line, 1), doc.lines)).from : Math.min(offset ?? 0, doc.length);
            view.dispatch({ selection: { anchor: position }, effects: EditorView.scrollIntoView(position, { y: "center" }) });
            view.focus();
        },
    };
}

/** Returns the mark of a diagnostic in the text, and what its tooltip shows. */
function mark(diagnostic, length, apply) {
    const from = Math.min(diagnostic.from, length);
    // An empty range has no underline: the mark covers the character before it, or after it.
    const to = Math.min(Math.max(diagnostic.to, from), length);
    const [start, end] = to > from ? [from, to] : [Math.max(from - 1, 0), Math.min(Math.max(to, 1), length)];
    return {
        from: start,
        to: end,
        severity: diagnostic.severity,
        message: diagnostic.message,
        renderMessage: () => element("div", { className: "problem" }, ...problemBody(diagnostic, apply)),
    };
}

/**
 * Returns the content of a diagnostic: message, help, code and a button per fix.
 * @param {Diagnostic} diagnostic
 * @param {(edits: Edit[]) => void} apply
 */
export function problemBody(diagnostic, apply) {
    const { severity, code, message, help, labels = [], fixes = [] } = diagnostic;
    const fix = ({ title, edits }) => button(inline(title), () => apply(edits), { className: "fix" });
    return [
        element(
            "p",
            { className: "message" },
            element("span", { className: `severity ${severity}` }, severity),
            " ",
            inline(message),
        ),
        labels.length > 0 &&
            element(
                "ul",
                { className: "labels" },
                labels.map((label) => element("li", {}, inline(label.text))),
            ),
        element("p", { className: "ways" }, fixes.map(fix), element("code", { className: "code" }, code)),
        help && element("p", { className: "help" }, inline(help)),
    ];
}

/** Applies the first fix of the diagnostic at the cursor, or of the next one. */
function fixAtCursor(view, diagnostics, apply) {
    const head = view.state.selection.main.head;
    const withFix = diagnostics.filter((diagnostic) => diagnostic.fixes?.length > 0);
    const here = withFix.find(({ from, to }) => from <= head && head <= to) ?? withFix[0];
    if (!here) return false;
    apply(here.fixes[0].edits);
    return true;
}

/** Completions of the server. What is illegal is listed last and greyed, with its reason. */
function completionSource(api, failed) {
    return async (context) => {
        const word = context.matchBefore(/\w+/);
        if (!context.explicit && !word && !context.matchBefore(/[.:]\s?$/)) return null;
        const aborter = new AbortController();
        context.addEventListener("abort", () => aborter.abort(), { onDocChange: true });
        try {
            const text = context.state.doc.toString();
            const answer = await api.complete({ text, offset: context.pos }, aborter.signal);
            if (!answer || context.aborted) return null;
            return { from: answer.from, to: answer.to, options: answer.items.map(option), validFor: /^\w*$/ };
        } catch (error) {
            if (error.name !== "AbortError") failed(error);
            return null;
        }
    };
}

function option({ label, kind, detail, documentation, insert, illegal }) {
    const texts = [illegal && element("p", { className: "reason" }, inline(illegal)), ...markdown(documentation ?? "")].filter(
        Boolean,
    );
    return {
        label,
        type: kind,
        detail: illegal ? `not here: ${illegal}` : (detail ?? undefined),
        apply: insert ?? label,
        boost: illegal ? -99 : 0,
        illegal: Boolean(illegal),
        info: texts.length > 0 ? () => element("div", { className: "prose" }, texts) : undefined,
    };
}

function optionClass(completion) {
    return completion.illegal ? "illegal" : "";
}

async function hover(api, view, offset) {
    const text = view.state.doc.toString();
    const answer = await api.hover({ text, offset }).catch(() => null);
    if (!answer || text !== view.state.doc.toString()) return null;
    return tooltip(answer);
}

function tooltip({ from, to, markdown: text }) {
    return {
        pos: from,
        end: to,
        above: true,
        create: () => ({ dom: element("div", { className: "prose hover" }, markdown(text)) }),
    };
}

const setKeyboardHover = StateEffect.define();

/** The explanation that Alt-I shows at the cursor, until the next key or change. */
const keyboardHover = StateField.define({
    create: () => null,
    update(value, transaction) {
        for (const effect of transaction.effects) if (effect.is(setKeyboardHover)) return effect.value;
        return transaction.docChanged || transaction.selection ? null : value;
    },
    provide: (field) => showTooltip.from(field),
});

function closeHover(view) {
    const isOpen = view.state.field(keyboardHover) !== null;
    if (isOpen) view.dispatch({ effects: setKeyboardHover.of(null) });
    return isOpen;
}

/** Selects the next diagnostic and shows its message there, unless it is about an earlier text. */
function goToProblem(view, { diagnostics, about }, apply) {
    if (!nextDiagnostic(view)) return false;
    if (about !== view.state.doc.toString()) return true;
    const { from, to } = view.state.selection.main;
    const here = diagnostics.find((diagnostic) => diagnostic.from <= to && Math.max(diagnostic.to, diagnostic.from) >= from);
    const dom = here && element("div", { className: "problem prose" }, ...problemBody(here, apply));
    if (dom) view.dispatch({ effects: setKeyboardHover.of({ pos: from, end: to, above: true, create: () => ({ dom }) }) });
    return true;
}

function showHover(api, view, failed) {
    const text = view.state.doc.toString();
    const offset = view.state.selection.main.head;
    api.hover({ text, offset }).then((answer) => {
        if (text === view.state.doc.toString()) view.dispatch({ effects: setKeyboardHover.of(answer && tooltip(answer)) });
    }, failed);
    return true;
}

/**
 * A small part of Markdown as elements: what the server sends for hovers and completions.
 *
 * Input: paragraphs, lists, tables, fenced code, `code`, **bold**, *italic*. Output: elements. Everything else stays text, so that no
 * text becomes markup and no link leaves the page.
 */
import { element } from "./dom.mjs";

/** @param {string} text @returns {HTMLElement[]} one element per block */
export function markdown(text) {
    const blocks = [];
    const lines = text.replaceAll("\r", "").split("\n");
    while (lines.length > 0) {
        const line = lines[0];
        if (line.trim() === "") lines.shift();
        else if (line.startsWith("```")) blocks.push(fenced(lines));
        else if (/^\s*[-*] /.test(line)) blocks.push(list(lines));
        else if (line.startsWith("|")) blocks.push(table(lines));
        else if (/^#{1,6} /.test(line))
            blocks.push(element("p", { className: "heading" }, inline(lines.shift().replace(/^#+ /, ""))));
        else if (/^(-{3,}|\*{3,})$/.test(line.trim())) blocks.push(rule(lines));
        else blocks.push(paragraph(lines));
    }
    return blocks;
}

function rule(lines) {
    lines.shift();
    return element("hr");
}

function fenced(lines) {
    lines.shift();
    const code = [];
    while (lines.length > 0 && !lines[0].startsWith("```")) code.push(lines.shift());
    lines.shift();
    return element("pre", {}, element("code", {}, code.join("\n")));
}

function list(lines) {
    const items = [];
    while (lines.length > 0 && /^\s*[-*] /.test(lines[0]))
        items.push(element("li", {}, inline(lines.shift().replace(/^\s*[-*] /, ""))));
    return element("ul", {}, items);
}

function table(lines) {
    const rows = [];
    while (lines.length > 0 && lines[0].startsWith("|")) {
        const cells = lines
            .shift()
            .trim()
            .replace(/^\||\|$/g, "")
            .split("|");
        if (!cells.every((cell) => /^\s*:?-+:?\s*$/.test(cell))) rows.push(cells);
    }
    const row = (cells) =>
        element(
            "tr",
            {},
            cells.map((cell) => element("td", {}, inline(cell.trim()))),
        );
    return element("table", {}, rows.map(row));
}

function paragraph(lines) {
    const parts = [];
    while (lines.length > 0 && lines[0].trim() !== "" && !/^(```|\||\s*[-*] )/.test(lines[0])) parts.push(lines.shift());
    // A line that begins like a list but is none would never be taken.
    if (parts.length === 0) parts.push(lines.shift());
    return element("p", {}, inline(parts.join(" ")));
}

/** Returns the parts of a line: text, code, bold and italic. */
export function inline(text) {
    return text.split(/(`[^`]+`|\*\*[^*]+\*\*|\*[^*\s][^*]*\*)/).map((part) => {
        if (/^`[^`]+`$/.test(part)) return element("code", {}, part.slice(1, -1));
        if (/^\*\*[^*]+\*\*$/.test(part)) return element("strong", {}, inline(part.slice(2, -2)));
        if (/^\*[^*]+\*$/.test(part)) return element("em", {}, inline(part.slice(1, -1)));
        return part;
    });
}

// Tokenises descriptions with the TextMate grammar, as VS Code does.
//
// Input on stdin: a JSON array of texts. Output on stdout: for each text an array of [offset, length, scopes], in UTF-16 code units.
import { readFileSync } from "node:fs";

import oniguruma from "vscode-oniguruma";
import textmate from "vscode-textmate";

const here = (path) => new URL(path, import.meta.url);
await oniguruma.loadWASM(readFileSync(here("node_modules/vscode-oniguruma/release/onig.wasm")));
const grammarPath = here("../../examples/editors/fragbuf.tmLanguage.json");
const registry = new textmate.Registry({
    onigLib: Promise.resolve({
        createOnigScanner: (patterns) => new oniguruma.OnigScanner(patterns),
        createOnigString: (text) => new oniguruma.OnigString(text),
    }),
    loadGrammar: async (scope) =>
        scope === "source.fragbuf" ? textmate.parseRawGrammar(readFileSync(grammarPath, "utf8"), "grammar.json") : null,
});
const grammar = await registry.loadGrammar("source.fragbuf");
const tokenise = (text) => {
    const found = [];
    let [stack, start] = [textmate.INITIAL, 0];
    for (const line of text.split("\n")) {
        const { tokens, ruleStack } = grammar.tokenizeLine(line, stack);
        for (const { startIndex, endIndex, scopes } of tokens) {
            const end = Math.min(endIndex, line.length);
            if (line.slice(startIndex, end).trim() !== "") {
                found.push([start + startIndex, end - startIndex, scopes]);
            }
        }
        [stack, start] = [ruleStack, start + line.length + 1];
    }
    return found;
};
process.stdout.write(JSON.stringify(JSON.parse(readFileSync(0, "utf8")).map(tokenise)));

/**
 * The tokens of descriptions and of generated shaders, for the colours of the editors.
 *
 * Input: names that the server lists. Output: languages for CodeMirror. Colours only: what is right or wrong comes from the server.
 */
import { StreamLanguage } from "./vendor/codemirror.mjs";

/** Items of a description and words of its closures: the grammar has them, and no registry lists them. */
const KEYWORDS = new Set(
    (
        "buffer from fragment uniform keep least all where resolve fn else let mut if for in return break continue as true false " +
        "storage sync cull opaque select peeling objects allocation overflow ties addressing counters samples sort wgsl"
    ).split(" "),
);

const TYPES = new Set(
    "f32 u32 i32 usize bool vec2 vec3 vec4 Vec2 Vec3 Vec4 rgba8 rgba16 octahedral Fragment Uniforms".split(" "),
);

const SHADER_KEYWORDS = new Set(
    (
        "fn let var const struct if else for while loop break continue return switch case default discard true false alias override " +
        "layout in out inout uniform buffer coherent readonly writeonly volatile restrict precision highp void enable requires"
    ).split(" "),
);

const SHADER_TYPES =
    /^(?:f16|f32|u32|i32|bool|float|double|int|uint|atomic|array|ptr|[biu]?vec[234]|vec[234][fiuh]|mat[234](?:x[234])?f?|[ui]?(?:texture|image|sampler)\w*|u?int64_t)$/;

/**
 * Returns the language of descriptions.
 * @param {Iterable<string>} names techniques and values of axes, as far as the server lists them
 */
export function descriptionLanguage(names) {
    const known = new Set(names);
    return StreamLanguage.define({
        name: "fragbuf",
        startState: () => ({ comment: false, after: "" }),
        token: (stream, state) => token(stream, state, (word) => kindOfWord(word, stream, state, known)),
        languageData: {
            commentTokens: { line: "//", block: { open: "/*", close: "*/" } },
            closeBrackets: { brackets: ["(", "[", "{"] },
        },
    });
}

function kindOfWord(word, stream, state, known) {
    const previous = state.after;
    state.after = word;
    if (previous === ".") return stream.match(/^\s*\(/, false) ? "variableName.function" : "propertyName";
    if (previous === "buffer") return "typeName";
    if (previous === "from" || known.has(word)) return "atom";
    if (stream.match(/^\s*:(?!:)/, false)) return KEYWORDS.has(word) ? "keyword" : "propertyName";
    if (KEYWORDS.has(word)) return "keyword";
    if (TYPES.has(word)) return "typeName";
    return stream.match(/^\s*\(/, false) ? "variableName.function" : "variableName";
}

/** The language of the generated text: near enough to WGSL, GLSL, HLSL and MSL for colours. */
export const shaderLanguage = StreamLanguage.define({
    name: "shader",
    startState: () => ({ comment: false, after: "" }),
    token: (stream, state) =>
        token(stream, state, (word) => {
            const previous = state.after;
            state.after = word;
            if (previous === "@" || previous === "#") return "keyword";
            if (SHADER_KEYWORDS.has(word)) return "keyword";
            if (SHADER_TYPES.test(word)) return "typeName";
            if (/^[A-Z][A-Z0-9_]+$/.test(word)) return "atom";
            if (previous === ".") return "propertyName";
            return stream.match(/^\s*\(/, false) ? "variableName.function" : "variableName";
        }),
});

/** Reads one token of a language with the comments of C. */
function token(stream, state, kindOf) {
    if (state.comment) {
        state.comment = !stream.match(/^.*?\*\//);
        if (state.comment) stream.skipToEnd();
        return "comment";
    }
    if (stream.eatSpace()) return null;
    if (stream.match("//")) {
        stream.skipToEnd();
        return "comment";
    }
    if (stream.match("/*")) {
        state.comment = !stream.match(/^.*?\*\//);
        if (state.comment) stream.skipToEnd();
        return "comment";
    }
    if (stream.match(/^(?:0[xX][0-9a-fA-F]+|\d[\d_]*(?:\.\d[\d_]*)?(?:[eE][+-]?\d+)?)(?:[uif](?:32)?|h)?\b/))
        return after(state, "number");
    if (stream.match(/^"[^"]*"?/)) return after(state, "string");
    const word = stream.match(/^[A-Za-z_]\w*/);
    if (word) return kindOf(word[0]);
    const sign = stream.next();
    state.after = sign;
    return /[{}()[\];,]/.test(sign) ? "punctuation" : "operator";
}

function after(state, kind) {
    state.after = "";
    return kind;
}

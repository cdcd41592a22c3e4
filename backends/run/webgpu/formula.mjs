/**
 * Evaluates the formulas of a manifest: whole numbers and symbols with `+ - * /`, parentheses and a few functions.
 * A formula is parsed once, into a tree of closures. Nothing is passed to `eval`.
 * @module
 */

/** The functions, and how many arguments each takes. */
const FUNCTIONS = {
    min: [2, Math.min],
    max: [2, Math.max],
    ceil_div: [2, (a, b) => quotient(a, b) + (a % b > 0 ? 1 : 0)],
    pow2: [1, (a) => 2 ** a],
    log2_ceil: [1, (a) => {
        let power = 0;
        while (2 ** power < a) power++;
        return power;
    }],
};

const OPERATORS = {
    "+": (a, b) => a + b,
    "-": (a, b) => a - b,
    "*": (a, b) => a * b,
    "/": quotient,
};

/** Divides and rounds down. The quotient of numbers up to 2^53 may round up; that of a multiple is exact. */
function quotient(a, b) {
    return (a - (a % b)) / b;
}

/** @type {Map<string, (symbol: (name: string) => number) => number>} */
const parsed = new Map();

/**
 * Returns the value of a formula.
 * @param {string} formula
 * @param {(name: string) => number} symbol Returns the value of a symbol, or throws if it has none.
 * @returns {number} A whole number from 0 to 2^53 - 1.
 */
export function evaluate(formula, symbol) {
    if (!parsed.has(formula)) parsed.set(formula, parse(formula));
    const value = parsed.get(formula)(symbol);
    if (!Number.isSafeInteger(value) || value < 0) {
        throw new Error(`the formula \`${formula}\` has the value ${value}: use a smaller frame, or fewer fragments per pixel`);
    }
    return value;
}

/** Parses a formula by recursive descent. */
function parse(formula) {
    const tokens = String(formula).match(/[A-Za-z_]\w*|\d+|\S/g) ?? [];
    let at = 0;
    const fail = () => {
        const found = at < tokens.length ? `\`${tokens[at]}\`` : "its end";
        throw new Error(`the formula \`${formula}\` is malformed at ${found}: generate the manifest again`);
    };
    const takes = (token) => tokens[at] === token && ++at > 0;
    const expect = (token) => takes(token) || fail();

    /** Parses operands that are joined by operators of one precedence. */
    const joined = (operators, operand) => {
        let left = operand();
        while (operators.includes(tokens[at])) {
            const [operator, first] = [OPERATORS[tokens[at++]], left];
            const second = operand();
            left = (symbol) => operator(first(symbol), second(symbol));
        }
        return left;
    };
    const sum = () => joined(["+", "-"], product);
    const product = () => joined(["*", "/"], factor);
    const factor = () => {
        if (takes("(")) {
            const inner = sum();
            expect(")");
            return inner;
        }
        const word = tokens[at++] ?? fail();
        if (/^\d/.test(word)) return () => Number(word);
        if (takes("(")) return call(word);
        if (!/^\w/.test(word)) at--, fail();
        return (symbol) => symbol(word);
    };
    const call = (name) => {
        const [count, apply] = Object.hasOwn(FUNCTIONS, name) ? FUNCTIONS[name] : fail();
        const operands = [sum()];
        while (takes(",")) operands.push(sum());
        expect(")");
        if (operands.length !== count) fail();
        return (symbol) => apply(...operands.map((operand) => operand(symbol)));
    };

    const value = sum();
    if (at < tokens.length) fail();
    return value;
}

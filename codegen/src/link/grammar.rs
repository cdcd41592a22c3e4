//! Finds operators that need parentheses in WGSL (WGSL §8.18 and §3.9), and expressions and branches too long for naga. naga parses mixtures of operators that browsers reject; it rejects
//! comparisons that are read as a template list, without help.
//!
//! Input: the source of a user file. Output: the operators and branches that are errors. Everything else is left to naga.

use super::token::{Token, TokenKind, tokens};

/// An operator that needs parentheses.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct GrammarError {
    /// The byte offset of the operator.
    pub(crate) at: usize,
    /// The operator.
    pub(crate) operator: &'static str,
    pub(crate) message: String,
    pub(crate) help: &'static str,
    /// Whether the expression or branch is too long.
    pub(crate) is_length: bool,
}

/// The most operators of one expression, and the most branches of one `if`. naga recurses once for each.
const MOST_OPERATORS: usize = 500;
const MOST_BRANCHES: usize = 150;

/// A binary operator in the source.
#[derive(Clone, Copy)]
struct Operator {
    text: &'static str,
    at: usize,
}

/// The classes of operators. Each class has its own rules for its neighbours.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Class {
    Arithmetic,
    Shift,
    Comparison,
    Bitwise,
    Logical,
}

/// The operators and signs, the longest first.
const SIGNS: [(&str, Option<Class>); 36] = [
    ("<<=", None),
    (">>=", None),
    ("->", None),
    ("++", None),
    ("--", None),
    ("+=", None),
    ("-=", None),
    ("*=", None),
    ("/=", None),
    ("%=", None),
    ("&=", None),
    ("|=", None),
    ("^=", None),
    ("&&", Some(Class::Logical)),
    ("||", Some(Class::Logical)),
    ("<<", Some(Class::Shift)),
    (">>", Some(Class::Shift)),
    ("<=", Some(Class::Comparison)),
    (">=", Some(Class::Comparison)),
    ("==", Some(Class::Comparison)),
    ("!=", Some(Class::Comparison)),
    ("<", Some(Class::Comparison)),
    (">", Some(Class::Comparison)),
    ("+", Some(Class::Arithmetic)),
    ("-", Some(Class::Arithmetic)),
    ("*", Some(Class::Arithmetic)),
    ("/", Some(Class::Arithmetic)),
    ("%", Some(Class::Arithmetic)),
    ("&", Some(Class::Bitwise)),
    ("|", Some(Class::Bitwise)),
    ("^", Some(Class::Bitwise)),
    ("=", None),
    (",", None),
    (";", None),
    (":", None),
    ("@", None),
];

/// Keywords after which an operator is unary.
const KEYWORDS: [&str; 6] = ["return", "if", "while", "switch", "case", "const_assert"];

/// The names that template lists follow, apart from those of matrices and textures.
const TEMPLATES: [&str; 9] = ["array", "atomic", "bitcast", "ptr", "var", "vec2", "vec3", "vec4", "binding_array"];

/// The shapes in names of textures that template lists follow.
const TEXTURES: [&str; 11] = [
    "1d",
    "2d",
    "2d_array",
    "3d",
    "cube",
    "cube_array",
    "multisampled_2d",
    "storage_1d",
    "storage_2d",
    "storage_2d_array",
    "storage_3d",
];

/// Returns the errors in the order of the source.
pub(crate) fn grammar_errors(source: &str) -> Vec<GrammarError> {
    let (code, _) = tokens(source);
    let templates = template_signs(&code);
    let mut errors = Vec::new();
    for (open, _) in &templates {
        let name = code[open - 1].text;
        if !takes_template_list(name) {
            errors.push(GrammarError {
                at: code[*open].at,
                operator: "<",
                message: format!("`{name} <` starts a template list, which a later `>` ends"),
                help: "put the right operand of `<` in parentheses: `a < (b >> c)`",
                is_length: false,
            });
        }
    }
    mixed_operators(&code, &templates, &mut errors);
    errors.extend(long_branch(&code));
    errors.sort_by_key(|error| error.at);
    errors
}

/// Reports an `if` of too many branches.
fn long_branch(code: &[Token<'_>]) -> Option<GrammarError> {
    let is = |index: usize, text: &str| code.get(index).is_some_and(|token| token.text == text);
    // Per open brace, the branches of the `if` that is being read there.
    let mut branches = vec![0usize];
    for (index, token) in code.iter().enumerate() {
        match token.text {
            "{" => branches.push(0),
            "}" => {
                if branches.len() > 1 {
                    branches.pop();
                }
                if let Some(count) = branches.last_mut() {
                    *count = if is(index + 1, "else") { *count + 1 } else { 0 };
                    if *count > MOST_BRANCHES {
                        return Some(GrammarError {
                            at: code.get(index + 1).map_or(token.at, |next| next.at),
                            operator: "else",
                            message: format!("an `if` of more than {MOST_BRANCHES} branches"),
                            help: "use a `switch`, or a loop over an array",
                            is_length: true,
                        });
                    }
                }
            }
            _ => {}
        }
    }
    None
}

/// Tests whether WGSL has a template list after this name.
fn takes_template_list(name: &str) -> bool {
    let is_matrix = |size: &str| matches!(size.as_bytes(), [b'2'..=b'4', b'x', b'2'..=b'4']);
    TEMPLATES.contains(&name)
        || name.strip_prefix("mat").is_some_and(is_matrix)
        || name.strip_prefix("texture_").is_some_and(|shape| TEXTURES.contains(&shape))
}

/// Returns the indices of `<` and `>` of template lists, as WGSL finds them before it parses expressions.
fn template_signs(code: &[Token<'_>]) -> Vec<(usize, usize)> {
    let (mut found, mut pending, mut depth) = (Vec::new(), Vec::<(usize, usize)>::new(), 0usize);
    let is = |index: usize, text: &str| code.get(index).is_some_and(|token: &Token<'_>| token.text == text);
    let touches = |index: usize| index > 0 && code[index - 1].at + code[index - 1].text.len() == code[index].at;
    let mut index = 0;
    while index < code.len() {
        let next_is = |text: &str| is(index + 1, text) && touches(index + 1);
        match code[index].text {
            "<" if index > 0 && code[index - 1].kind == TokenKind::Name => match next_is("<") || next_is("=") {
                true => index += 1,
                false => pending.push((index, depth)),
            },
            ">" => match pending.last() {
                Some((open, level)) if *level == depth => {
                    found.push((*open, index));
                    pending.pop();
                }
                _ if next_is("=") => index += 1,
                _ => {}
            },
            "(" | "[" => depth += 1,
            ")" | "]" => {
                pending.retain(|(_, level)| *level < depth);
                depth = depth.saturating_sub(1);
            }
            "!" | "=" if next_is("=") => index += 1,
            "=" | ";" | "{" | ":" => {
                pending.clear();
                depth = 0;
            }
            "&" | "|" if is(index + 1, code[index].text) && touches(index + 1) => {
                pending.retain(|(_, level)| *level < depth);
                index += 1;
            }
            _ => {}
        }
        index += 1;
    }
    found
}

/// Reports operators of different classes in one expression.
fn mixed_operators(code: &[Token<'_>], templates: &[(usize, usize)], errors: &mut Vec<GrammarError>) {
    let mut levels: Vec<Vec<Operator>> = vec![Vec::new()];
    let (mut index, mut after_operand) = (0, false);
    let is_template = |index: usize| templates.iter().any(|(open, close)| *open == index || *close == index);
    while index < code.len() {
        let token = &code[index];
        let (mut taken, mut is_operand) = (1, false);
        match token.text {
            "(" | "[" | "{" => levels.push(Vec::new()),
            "<" if is_template(index) => levels.push(Vec::new()),
            ")" | "]" | "}" => {
                errors.extend(mixture(&levels.pop().unwrap_or_default()));
                is_operand = token.text != "}";
            }
            ">" if is_template(index) => {
                errors.extend(mixture(&levels.pop().unwrap_or_default()));
                is_operand = true;
            }
            text if token.kind == TokenKind::Sign => match sign(code, index) {
                Some((text, Some(_))) if after_operand => {
                    taken = text.len();
                    if let Some(level) = levels.last_mut() {
                        level.push(Operator { text, at: token.at });
                    }
                }
                Some((text, None)) => {
                    taken = text.len();
                    errors.extend(mixture(&levels.last_mut().map(std::mem::take).unwrap_or_default()));
                }
                // A unary operator, or a member.
                _ => is_operand = text == ".",
            },
            text => {
                is_operand = !KEYWORDS.contains(&text);
                // The sign of an exponent is a token of its own.
                let is_exponent =
                    token.kind == TokenKind::Number && text.ends_with(['e', 'E']) && !text.starts_with("0x");
                taken += usize::from(
                    is_exponent && matches!(code.get(index + 1), Some(next) if matches!(next.text, "+" | "-")),
                );
            }
        }
        // The body of a branch or loop ends its header's expression.
        if token.text == "{" && levels.len() > 1 {
            let outer = levels.len() - 2;
            errors.extend(mixture(&std::mem::take(&mut levels[outer])));
        }
        after_operand = is_operand;
        index += taken;
        if levels.is_empty() {
            levels.push(Vec::new());
        }
    }
}

/// Returns the longest sign at a token.
fn sign(code: &[Token<'_>], index: usize) -> Option<(&'static str, Option<Class>)> {
    SIGNS.into_iter().find(|(text, _)| {
        text.bytes().enumerate().all(|(offset, byte)| {
            let at = code[index].at + offset;
            code.get(index + offset).is_some_and(|token| token.at == at && token.text.as_bytes() == [byte])
        })
    })
}

fn class(operator: Operator) -> Option<Class> {
    SIGNS.into_iter().find(|(text, _)| *text == operator.text).and_then(|(_, class)| class)
}

/// Returns the first operator of an expression that cannot follow the ones before it.
fn mixture(operators: &[Operator]) -> Option<GrammarError> {
    if let Some(operator) = operators.get(MOST_OPERATORS) {
        return Some(GrammarError {
            at: operator.at,
            operator: operator.text,
            message: format!("an expression of more than {MOST_OPERATORS} operators"),
            help: "divide the expression: `let part = …;`",
            is_length: true,
        });
    }
    let is = |operator: &Operator, wanted: Class| class(*operator) == Some(wanted);
    // `&`, `|`, `^`, `&&` and `||` stand alone or repeat, except that `&&` and `||` join comparisons.
    for (index, operator) in operators.iter().enumerate() {
        let others = &operators[..index];
        let conflict = others.iter().find(|other| {
            let is_either = |wanted: Class| is(operator, wanted) || is(other, wanted);
            let logical = is(operator, Class::Logical) && is(other, Class::Logical);
            (is_either(Class::Bitwise) || logical) && operator.text != other.text
        });
        // Within one operand of `&&` or `||`, there is one comparison, and one shift on each side of it.
        let part = others.iter().rposition(|other| is(other, Class::Logical)).map_or(0, |at| at + 1);
        let part = &others[part..];
        let side = part.iter().rposition(|other| is(other, Class::Comparison)).map_or(0, |at| at + 1);
        let conflict = conflict.or_else(|| match class(*operator)? {
            Class::Comparison => part.iter().find(|other| is(other, Class::Comparison)),
            Class::Shift => part[side..].first(),
            Class::Arithmetic => part[side..].iter().find(|other| is(other, Class::Shift)),
            Class::Bitwise | Class::Logical => None,
        });
        if let Some(other) = conflict {
            return Some(GrammarError {
                at: operator.at,
                operator: operator.text,
                message: format!("WGSL does not combine `{}` and `{}` without parentheses", other.text, operator.text),
                help: "put one of the two operations in parentheses: Rust's precedence does not apply",
                is_length: false,
            });
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use fragbuf_templates::Registry;

    use super::grammar_errors;

    fn operators(expression: &str) -> Vec<&'static str> {
        let source = format!("fn f(a: u32, b: u32, c: u32) -> bool {{\n    return {expression};\n}}\n");
        grammar_errors(&source).into_iter().map(|error| error.operator).collect()
    }

    #[test]
    fn operators_that_need_parentheses_are_found() {
        for (expression, expected) in [
            ("a * b ^ c", &["^"][..]),
            ("a ^ b * c", &["*"]),
            ("a + b & c", &["&"]),
            ("a & b | c", &["|"]),
            ("a << b + c", &["+"]),
            ("a + b << c", &["<<"]),
            ("a << b << c", &["<<"]),
            ("a < b && b < c || c < a", &["||"]),
            ("a & b == c", &["=="]),
            ("a == b == c", &["=="]),
            ("a < b >> c", &["<"]),
            ("f(a < b, c > (a))", &["<"]),
            ("material < b >> c", &["<"]),
            ("f(texture_of < b, c > (a))", &["<"]),
            ("mat2x3<f32>() == mat4x2<f32>() && array<u32, a << 1>()[0] < c", &[]),
            ("vec2<u32>(a * b ^ c, a)[a & b | c]", &["^", "|"]),
            ("a << b == c && -a >> b < c", &[]),
            ("(a * b) ^ c ^ (a & b & c)", &[]),
            ("a < (b >> c) && f(a, -b) == 1.5e-3 * c", &[]),
            ("array<vec2<u32>, 4u>()[a + b * c - a % b].x > c >> 2u", &[]),
            ("a <= b || b >= c || !(a != b)", &[]),
        ] {
            assert_eq!(operators(expression), expected, "{expression}");
        }
    }

    #[test]
    fn statements_end_expressions() {
        let source = "fn f(p: ptr<function, u32>) {\n    let a = *p & 1u;\n    var b = a << 2u;\n    b |= a * 2u;\n    \
                      for (var i = 0u; i < 4u; i++) { b ^= i | a; }\n    if a + b > 3u { return; } else if b < a { *p = a * b; }\n    \
                      switch a & 3u { case 1u: { b = a % 2u; } default: { b >>= 1u; } }\n    \
                      switch i32(a) { case -1i << 2u, 8i >> 1u: { b = 1u; } default: {} }\n    const_assert -1i << 2u < 0i;\n}\n";
        assert_eq!(grammar_errors(source), []);
    }

    /// The rules reject nothing that Tint accepts: all templates pass it in generated sources.
    #[test]
    fn templates_have_no_errors() {
        let registry = Registry::builtin();
        let templates: Vec<_> = registry.rows().iter().filter_map(|row| row.template.as_ref()).collect();
        assert!(templates.len() > 40);
        for template in templates.into_iter().chain(registry.shared()) {
            assert_eq!(grammar_errors(&template.source), [], "{}", template.path);
        }
    }
}

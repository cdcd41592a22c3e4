//! Names and formulas as Rust spells them.

use fragbuf_codegen::Bound;
use fragbuf_templates::vocabulary::{Expression, Formula};

/// Words that Rust keeps for itself.
const KEYWORDS: &str = "abstract as async await become box break const continue crate do dyn else enum extern false final \
    fn for gen if impl in let loop macro match mod move mut override priv pub ref return self Self static struct super \
    trait true try type typeof union unsafe unsized use virtual where while yield";

/// A name in lower case whose other signs are underscores, and that is no keyword.
pub(super) fn snake_case(name: &str) -> String {
    let plain = |letter: char| if letter.is_ascii_alphanumeric() { letter.to_ascii_lowercase() } else { '_' };
    let mut word: String = name.chars().map(plain).collect();
    if word.is_empty() || word.starts_with(|first: char| first.is_ascii_digit()) {
        word.insert(0, '_');
    }
    if KEYWORDS.split_whitespace().any(|keyword| keyword == word) || word == "_" {
        word.push('_');
    }
    word
}

/// The symbols of a formula that are bound after generation, as parameters.
const SYMBOLS: [&str; 5] = ["width", "height", "k", "fragments", "kept"];

/// A constant function: the parameters that the formula needs, and its value. A formula that cannot be read has been
/// refused when the plan was made.
pub(super) fn formula(formula: &Formula, bound: &Bound, pixels: &Formula) -> (Vec<&'static str>, String) {
    let (Ok(expression), Ok(pixels)) = (formula.read(), pixels.read()) else { return (Vec::new(), "0".to_owned()) };
    let mut used = Vec::new();
    let text = written(&expression, bound, &pixels, &mut used);
    (SYMBOLS.into_iter().filter(|symbol| used.iter().any(|used| used == symbol)).collect(), text)
}

fn written(expression: &Expression, bound: &Bound, pixels: &Expression, used: &mut Vec<String>) -> String {
    match expression {
        Expression::Number(number) => number.to_string(),
        Expression::Symbol(symbol) => match bound.value(symbol) {
            Some(value) => value.to_string(),
            // Its definition is over the frame's width and height.
            None if symbol == "pixels" && expression != pixels => written(pixels, bound, pixels, used),
            None => {
                used.push(symbol.clone());
                symbol.clone()
            }
        },
        Expression::Apply(operator, arguments) => {
            let parts: Vec<String> = arguments.iter().map(|argument| written(argument, bound, pixels, used)).collect();
            match (*operator, parts.as_slice()) {
                ("ceil_div", [a, b]) => format!("u64::div_ceil({a}, {b})"),
                ("pow2", [a]) => format!("(1u64 << {a})"),
                // Functions of traits are not for constants.
                ("min", [a, b]) => format!("(if {a} < {b} {{ {a} }} else {{ {b} }})"),
                ("max", [a, b]) => format!("(if {a} > {b} {{ {a} }} else {{ {b} }})"),
                (operator, [a, b]) => format!("({a} {operator} {b})"),
                (operator, parts) => format!("{operator}({})", parts.join(", ")),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn modules_have_names_that_rust_takes() {
        let names = ["Glass", "my-glass.v2", "2d", "type", "", "_"].map(snake_case);
        assert_eq!(names, ["glass", "my_glass_v2", "_2d", "type_", "__", "__"]);
    }

    #[test]
    fn formulas_keep_their_meaning() {
        let bound = Bound(vec![("entry_words".to_owned(), 3)]);
        let of = |text: &'static str| formula(&Formula::from(text), &bound, &"width * height".into());
        let (parameters, text) = of("pixels * k * entry_words");
        assert_eq!((parameters, text.as_str()), (vec!["width", "height", "k"], "(((width * height) * k) * 3)"));
        assert_eq!(of("ceil_div(pixels, 1024)").1, "u64::div_ceil((width * height), 1024)");
        assert_eq!(of("fragments / (k * 2)"), (vec!["k", "fragments"], "(fragments / (k * 2))".to_owned()));
        assert_eq!(of("max(k, 2) - min(k, 1)").1, "((if k > 2 { k } else { 2 }) - (if k < 1 { k } else { 1 }))");
    }
}

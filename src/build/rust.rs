//! Writes names and formulas in Rust.

use std::collections::BTreeSet;

use fragbuf_codegen::{PlanValue, Quantity, SymbolId, SymbolTable, Term, is_boolean};

/// The keywords of Rust.
const KEYWORDS: &str = "abstract as async await become box break const continue crate do dyn else enum extern false final \
    fn for gen if impl in let loop macro match mod move mut override priv pub ref return self Self static struct super \
    trait true try type typeof union unsafe unsized use virtual where while yield";

/// Returns a name in lower case. Underscores replace other characters; a keyword gets one more underscore.
pub(super) fn snake_case(name: &str) -> String {
    let plain = |letter: char| if letter.is_ascii_alphanumeric() { letter.to_ascii_lowercase() } else { '_' };
    let mut identifier: String = name.chars().map(plain).collect();
    if identifier.is_empty() || identifier.starts_with(|first: char| first.is_ascii_digit()) {
        identifier.insert(0, '_');
    }
    if identifier == "_" {
        identifier.push('_');
    }
    self::identifier(&identifier)
}

/// Returns a name of WGSL; a keyword of Rust gets one more underscore.
pub(super) fn identifier(name: &str) -> String {
    let is_keyword = KEYWORDS.split_whitespace().any(|keyword| keyword == name);
    if is_keyword { format!("{name}_") } else { name.to_owned() }
}

/// A formula in Rust.
pub(super) struct RustFormula {
    /// The symbols that it names, in the order of the table.
    pub parameters: Vec<SymbolId>,
    /// The expression.
    pub value: String,
}

/// Returns a formula as an expression of its parameters. Symbols of generation time are numbers, the addressing row
/// defines the pixels of a frame, and all other symbols are parameters.
pub(super) fn formula(of: &Quantity, symbols: &SymbolTable) -> RustFormula {
    let mut used = BTreeSet::new();
    let value = expression(of.term(), symbols, &mut used);
    RustFormula { parameters: used.into_iter().collect(), value }
}

fn expression(term: &Term, symbols: &SymbolTable, used: &mut BTreeSet<SymbolId>) -> String {
    match term {
        Term::Number(number) => number.to_string(),
        Term::Symbol(id) => match &symbols.get(*id).value {
            PlanValue::Number(number) => number.to_string(),
            PlanValue::Default(quantity) if *id == SymbolId::PIXELS => expression(quantity.term(), symbols, used),
            _ => {
                used.insert(*id);
                symbols.get(*id).name.to_string()
            }
        },
        Term::Apply(operator, _) if is_boolean(operator) => format!("({} as u64)", condition(term, symbols, used)),
        Term::Apply(operator, arguments) => {
            let parts: Vec<String> = arguments.iter().map(|argument| expression(argument, symbols, used)).collect();
            match (*operator, parts.as_slice()) {
                ("ceil_div", [a, b]) => format!("u64::div_ceil({a}, {b})"),
                ("pow2", [a]) => format!("(1u64 << {a})"),
                ("log2_ceil", [a]) => format!("(u64::next_power_of_two({a}).trailing_zeros() as u64)"),
                // Trait methods such as `Ord::min` cannot be called in a `const fn`.
                ("min", [a, b]) => format!("({{ let (a, b) = ({a}, {b}); if a < b {{ a }} else {{ b }} }})"),
                ("max", [a, b]) => format!("({{ let (a, b) = ({a}, {b}); if a > b {{ a }} else {{ b }} }})"),
                (operator, parts) => format!("({})", parts.join(&format!(" {operator} "))),
            }
        }
    }
}

/// Returns a formula as a condition, in parentheses.
fn condition(term: &Term, symbols: &SymbolTable, used: &mut BTreeSet<SymbolId>) -> String {
    let (operator, parts): (&str, Vec<String>) = match term {
        Term::Apply(operator @ ("&&" | "||"), arguments) => {
            (operator, arguments.iter().map(|argument| condition(argument, symbols, used)).collect())
        }
        Term::Apply(operator, arguments) if is_boolean(operator) => {
            (operator, arguments.iter().map(|argument| expression(argument, symbols, used)).collect())
        }
        _ => ("!=", vec![expression(term, symbols, used), "0".to_owned()]),
    };
    format!("({})", parts.join(&format!(" {operator} ")))
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    #[test]
    fn module_names_are_valid_in_rust() {
        let names = ["Glass", "my-glass.v2", "2d", "type", "", "_"].map(snake_case);
        assert_eq!(names, ["glass", "my_glass_v2", "_2d", "type_", "__", "__"]);
    }

    #[test]
    fn formulas_keep_their_meaning() {
        use fragbuf_codegen::plan;
        use fragbuf_model::{Draft, Selection, SourceSpan, check};
        use fragbuf_templates::Registry;
        let registry = Registry::builtin();
        let draft = Draft::from_technique("kplus_array", &SourceSpan::new("test", 1, 1));
        let variant = check(&draft, &registry).unwrap();
        let plan = plan(&variant, &Selection::first(&variant), &registry).unwrap();
        let of = |text: &'static str| {
            let formula = formula(&plan.symbols.compile(&text.into()).unwrap(), &plan.symbols);
            let names = formula.parameters.into_iter().map(|id| plan.symbols.get(id).name.to_string());
            (names.collect::<Vec<_>>(), formula.value)
        };
        let (parameters, text) = of("pixels * k * entry_words");
        assert_eq!(parameters, ["width", "height", "k"]);
        assert_eq!(text, "(((width * height) * k) * 2)");
        assert_eq!(of("ceil_div(pixels, 1024)").1, "u64::div_ceil((width * height), 1024)");
        assert_eq!(
            of("fragments / (k * 2)"),
            (vec!["k".to_owned(), "fragments".to_owned()], "(fragments / (k * 2))".to_owned())
        );
        assert_eq!(of("n * pixels").0, ["width", "height", "n"]);
        assert_eq!(
            of("max(k, 2) - min(k, 1)").1,
            "(({ let (a, b) = (k, 2); if a > b { a } else { b } }) - ({ let (a, b) = (k, 1); if a < b { a } else { b } }))"
        );
        assert_eq!(
            of("k * (n == 3 && fragments || k < 2)").1,
            "(k * ((((n == 3) && (fragments != 0)) || (k < 2)) as u64))"
        );
        assert_eq!(of("log2_ceil(n) + 7 / capacity").1, "((u64::next_power_of_two(n).trailing_zeros() as u64) + 0)");
    }
}

//! Writes formulas as C expressions over `const struct fragbuf_symbols *symbols`.

use fragbuf_codegen::{PlanValue, Quantity, SymbolTable, Term};
use fragbuf_templates::vocabulary::{BindingTime, SYMBOLS, Symbol};

/// Returns the symbols that are fields of `struct fragbuf_symbols`: those that have no number in every generated file.
pub(super) fn fields() -> impl Iterator<Item = &'static Symbol> {
    SYMBOLS.iter().filter(|symbol| !matches!(symbol.when, BindingTime::Description | BindingTime::Generation))
}

/// Returns the body of a function that computes `factor` times a formula.
pub(super) fn body(factor: u32, of: &Quantity, symbols: &SymbolTable) -> String {
    let value = expression(of.term(), symbols);
    let value = if factor == 1 { value } else { format!("fragbuf_multiply({factor}, {value})") };
    let unused = if value.contains("symbols->") { "" } else { "    (void)symbols;\n" };
    format!("{unused}    return {value};\n")
}

/// Returns the value of a formula.
pub(super) fn expression(term: &Term, symbols: &SymbolTable) -> String {
    match term {
        Term::Number(number) => format!("UINT64_C({number})"),
        Term::Symbol(id) => {
            let symbol = symbols.get(*id);
            match &symbol.value {
                PlanValue::Number(number) => format!("UINT64_C({number})"),
                PlanValue::Default(quantity) if !fields().any(|field| symbol.name == field.name) => {
                    expression(quantity.term(), symbols)
                }
                _ => format!("symbols->{}", symbol.name),
            }
        }
        Term::Apply(operator, arguments) => {
            let parts: Vec<String> = arguments.iter().map(|argument| expression(argument, symbols)).collect();
            let (a, b) = (parts.first().map_or("", String::as_str), parts.get(1).map_or("", String::as_str));
            match *operator {
                "+" => format!("fragbuf_add({a}, {b})"),
                "-" => format!("fragbuf_subtract({a}, {b})"),
                "*" => format!("fragbuf_multiply({a}, {b})"),
                "/" => format!("fragbuf_divide({a}, {b})"),
                "==" => format!("fragbuf_equal({a}, {b})"),
                "!=" => format!("fragbuf_not(fragbuf_equal({a}, {b}))"),
                "<" => format!("fragbuf_less({a}, {b})"),
                ">" => format!("fragbuf_less({b}, {a})"),
                "<=" => format!("fragbuf_not(fragbuf_less({b}, {a}))"),
                ">=" => format!("fragbuf_not(fragbuf_less({a}, {b}))"),
                "&&" => format!("fragbuf_and({a}, {b})"),
                "||" => format!("fragbuf_or({a}, {b})"),
                function => format!("fragbuf_{function}({})", parts.join(", ")),
            }
        }
    }
}

//! Formulas of a plan in the notation of the papers.

use fragbuf_templates::vocabulary::{Formula, FormulaError, Pass, Polynomial};

use super::resource::PlannedResource;
use crate::{Action, LoweredFrame, PlannedPass, Quantity, SymbolTable};

/// Returns the memory that grows with the pixels, in words per pixel. Pools grow with the fragments of all pixels, so they count f
/// words per word of a node, and f/4 per word of a page of four. The sum omits sizes that grow with neither or with a fraction of
/// the pixels, and external textures.
pub(super) fn words_per_pixel(resources: &[PlannedResource], symbols: &SymbolTable) -> Polynomial {
    let internal = resources.iter().filter(|planned| !planned.is_external());
    let total =
        internal.fold(Polynomial::default(), |total, planned| total.plus(&size_by_k(&planned.words, symbols), 1));
    total
        .coefficient("pixels")
        .plus(&total.coefficient("fragments").times(&Polynomial::symbol("f")), 1)
        .plus(&total.coefficient("kept").times(&Polynomial::symbol("f_k")), 1)
        .plus(&total.fractions("fragments", "f"), 1)
}

/// Returns a size with the capacity as k: in the papers, memory is that of the greatest k.
fn size_by_k(words: &Quantity, symbols: &SymbolTable) -> Polynomial {
    let number = |name: &str| symbols.number_of(name).filter(|_| name != CAPACITY);
    let size = words.formula().read().and_then(|size| size.polynomial(&number)).unwrap_or_default();
    let factor = size.coefficient(CAPACITY);
    let by = |name: &str| factor.times(&Polynomial::symbol(name));
    size.plus(&by(CAPACITY), -1).plus(&by("k"), 1)
}

/// The symbol of the greatest k that generated code supports.
const CAPACITY: &str = "capacity";

/// Returns how often the passes that meet `is_counted` run, as a formula over the limits of loops.
pub(super) fn runs(
    frame: &LoweredFrame,
    passes: &[PlannedPass],
    symbols: &SymbolTable,
    is_counted: &dyn Fn(&Pass) -> bool,
) -> Polynomial {
    let mut sum = Polynomial::default();
    // The products of the limits of the loops around a command.
    let mut products = vec![Polynomial::number(1)];
    for command in &frame.commands {
        let product = products.last().cloned().unwrap_or_default();
        match command.action {
            Action::Pass(id) if is_counted(&passes[id.0]) => sum = sum.plus(&product, 1),
            Action::Loop(id) => products.push(product.times(&polynomial(&frame.loops[id.0].max_iterations, symbols))),
            Action::LoopEnd(_) => drop(products.pop()),
            _ => {}
        }
    }
    sum
}

/// Returns a formula in normal form. Formulas without one are rejected when the plan is created.
fn polynomial(quantity: &Quantity, symbols: &SymbolTable) -> Polynomial {
    normal_form(quantity.formula(), symbols).unwrap_or_default()
}

/// Returns a formula as a sum of products of symbols.
pub(super) fn normal_form(formula: &Formula, symbols: &SymbolTable) -> Result<Polynomial, FormulaError> {
    formula.read()?.polynomial(&|name| symbols.number_of(name))
}

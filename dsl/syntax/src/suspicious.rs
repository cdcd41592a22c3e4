//! Calls and ranges whose bounds are literals in the wrong order: they are valid, and their result is always the same.
//!
//! Input: a checked function, and the helpers that it calls. Output: a warning per call or range. `clamp` with such bounds is an error
//! already, as it panics in Rust.

use fragbuf_model::{Spanned, Suspicious};

use crate::fold::{self, Value};
use crate::methods::Spelling;
use crate::tree::{Block, Expr, Function, Kind, Sequence, Statement};

/// Names of two parameters of a helper that are a lower and an upper bound.
const BOUNDS: [(&str, &str); 9] = [
    ("lo", "hi"),
    ("low", "high"),
    ("lower", "upper"),
    ("least", "most"),
    ("least", "greatest"),
    ("min", "max"),
    ("edge0", "edge1"),
    ("e0", "e1"),
    ("begin", "end"),
];

/// Functions of shading languages that users write as helpers, and the places of their bounds.
const WITH_BOUNDS: [(&str, usize, usize); 4] =
    [("smoothstep", 0, 1), ("smooth_step", 0, 1), ("linear_step", 0, 1), ("clamp", 1, 2)];

/// Returns the suspicious calls and ranges of a function.
pub(crate) fn of(function: &Function, helpers: &[Option<&Function>]) -> Vec<Spanned<Suspicious>> {
    let mut search = Search { function, helpers, found: Vec::new() };
    search.block(&function.body);
    search.found
}

struct Search<'a> {
    function: &'a Function,
    helpers: &'a [Option<&'a Function>],
    found: Vec<Spanned<Suspicious>>,
}

impl Search<'_> {
    fn block(&mut self, block: &Block) {
        for statement in &block.statements {
            match statement {
                Statement::Let { value, .. } | Statement::Expr(value) => self.expr(value),
            }
        }
        block.value.iter().for_each(|value| self.expr(value));
    }

    fn expr(&mut self, expr: &Expr) {
        match &expr.kind {
            Kind::Method(Spelling::Call(outer @ ("min" | "max")), arguments) => self.nested(outer, arguments, expr),
            Kind::Helper(index, arguments) => self.helper(*index, arguments, expr),
            Kind::For(each) => {
                if let Sequence::Range { from, to, .. } = &each.sequence {
                    self.range(from, to);
                }
            }
            _ => {}
        }
        expr.kind.operands().into_iter().for_each(|operand| self.expr(operand));
        if let Some(block) = expr.kind.block() {
            self.block(block);
        }
    }

    fn constant(&self, expr: &Expr) -> Option<Value> {
        fold::constant(expr, self.function)
    }

    /// Warns of `x.max(1.0).min(0.0)`.
    fn nested(&mut self, outer: &str, arguments: &[Expr], expr: &Expr) {
        let [receiver, bound] = arguments else { return };
        let Kind::Method(Spelling::Call(inner @ ("min" | "max")), inside) = &receiver.kind else { return };
        let (Some(inner_bound), true) = (inside.get(1), *inner != outer) else { return };
        let (low, high) = if outer == "max" { (bound, inner_bound) } else { (inner_bound, bound) };
        let (Some(low), Some(high)) = (self.constant(low), self.constant(high)) else { return };
        if !fold::is_above(&low, &high) {
            return;
        }
        let (message, help) = match (fold::shown(&low), fold::shown(&high)) {
            (Some(low), Some(high)) => {
                let always = if outer == "max" { &low } else { &high };
                let message = format!("this is always {always}: the lower bound {low} is above the upper bound {high}");
                (message, format!("swap them: `.max({high}).min({low})`, or `.clamp({high}, {low})`"))
            }
            _ => ("a lower bound is above its upper bound".to_owned(), "swap the bounds of `max` and `min`".to_owned()),
        };
        self.add(expr, message, help);
    }

    /// Warns of `smoothstep(0.9, 0.1, x)` if `smoothstep` is a helper.
    fn helper(&mut self, index: usize, arguments: &[Expr], expr: &Expr) {
        let Some(Some(helper)) = self.helpers.get(index) else { return };
        let names: Vec<&str> = helper
            .parameters
            .iter()
            .filter_map(|id| helper.variables.get(*id))
            .map(|variable| variable.name.as_str())
            .collect();
        let place = |name: &str| names.iter().position(|other| *other == name);
        let of_names = BOUNDS.iter().find_map(|(low, high)| Some((place(low)?, place(high)?)));
        let rust_name = helper.name.strip_prefix("user_").unwrap_or(&helper.name);
        let of_function = WITH_BOUNDS.iter().find(|(name, ..)| *name == rust_name);
        let of_function = of_function.map(|(_, low, high)| (*low, *high)).filter(|_| names.len() == 3);
        let Some((low_at, high_at)) = of_names.or(of_function) else { return };
        // Uniforms are no arguments of the tree: the places may differ.
        let (Some(low), Some(high), true) =
            (arguments.get(low_at), arguments.get(high_at), arguments.len() == names.len())
        else {
            return;
        };
        let (Some(low), Some(high)) = (self.constant(low), self.constant(high)) else { return };
        if let (true, Some(low), Some(high)) = (fold::is_above(&low, &high), fold::shown(&low), fold::shown(&high)) {
            let name = |at: usize| names.get(at).copied().unwrap_or_default();
            let message = format!(
                "the lower bound `{}` is {low}, and the upper bound `{}` is {high}",
                name(low_at),
                name(high_at)
            );
            self.add(expr, message, format!("swap them: {high} first, then {low}"));
        }
    }

    /// Warns of `for i in 8..0`.
    fn range(&mut self, from: &Expr, to: &Expr) {
        let (Some(low), Some(high)) = (self.constant(from), self.constant(to)) else { return };
        if let (true, Some(low), Some(high)) = (fold::is_above(&low, &high), fold::shown(&low), fold::shown(&high)) {
            let message = format!("this loop never runs: its range begins at {low}, above its end {high}");
            self.add(from, message, format!("swap them; to count down, write `({high}..{low}).rev()`"));
        }
    }

    fn add(&mut self, expr: &Expr, message: String, help: String) {
        self.found.push(Spanned::new(Suspicious { message, help }, expr.span.clone()));
    }
}

//! `for` over a range.
//!
//! Input: a typed range and the body of the loop. Output: WGSL's `for`, whose bounds are evaluated once before the first iteration,
//! as in Rust. A counter cannot pass the greatest or the least value of its type, so a comparison of the counter with such a bound
//! never ends the loop. If a bound may be such a value, a variable contains whether another iteration follows.

use fragbuf_model::SourceSpan;

use super::lowering::Lowering;
use super::needs::{assigns, is_plain};
use super::numbers;
use super::source::ExprSource;
use crate::fold::{self, Value};
use crate::tree::{Block, Expr, Kind, Operator, Sequence, VariableId};
use crate::types::Type;

/// The parts of a loop over a range.
struct Range<'a> {
    variable: Option<VariableId>,
    ty: Type,
    body: &'a Block,
    span: &'a SourceSpan,
}

impl Lowering<'_> {
    /// Writes a loop over a range.
    pub(super) fn range_loop(&mut self, sequence: &Sequence, body: &Block, span: &SourceSpan) {
        let Sequence::Range { variable, ty, from, to, inclusive, reversed } = sequence else { return };
        let range = Range { variable: *variable, ty: self.function.inference.resolve_or_default(*ty), body, span };
        let after = if *inclusive { self.after(to) } else { None };
        let is_open = *inclusive && after.is_none() && (*reversed || !is_count(to));
        // These loops compare with the start in every iteration, or read it twice.
        let from = if *reversed || is_open { self.bound(*variable, "start", from) } else { self.start(from, to) };
        let to = self.bound(*variable, "end", to);
        if self.dead {
            return;
        }
        match (is_open, *reversed) {
            (true, false) => self.through_last(&range, [&from, &to, &to], Operator::Less),
            (true, true) => self.through_last(&range, [&from, &to, &from], Operator::Greater),
            (false, true) => self.backward(&range, &from, &after.unwrap_or(to)),
            (false, false) => {
                let operator = if *inclusive { Operator::LessEqual } else { Operator::Less };
                self.forward(&range, &from, &to, operator);
            }
        }
        self.names.close();
        self.dead = false;
    }

    fn forward(&mut self, range: &Range<'_>, from: &ExprSource, to: &ExprSource, operator: Operator) {
        self.names.open();
        let name = self.declare(range.variable, "index");
        let condition = ExprSource::binary(operator, &ExprSource::primary(name.clone()), to);
        self.emit(format!("for (var {name} = {}; {}; {name}++) {{", from.source, condition.source), range.span);
        self.body(range.body, |_| {});
    }

    /// Writes a reverse loop from below `after`. Its counter is one above the index, so that the condition also holds for unsigned
    /// integers.
    fn backward(&mut self, range: &Range<'_>, from: &ExprSource, after: &ExprSource) {
        self.names.open();
        let name = self.user_name(range.variable, "index");
        let next = self.names.fresh(&format!("{name}_next"));
        let condition = ExprSource::binary(Operator::Greater, &ExprSource::primary(next.clone()), from);
        self.emit(format!("for (var {next} = {}; {}; {next}--) {{", after.source, condition.source), range.span);
        let one = numbers::integer(1, range.ty).source;
        self.body(range.body, |lowering| {
            if range.variable.is_some() {
                let name = lowering.declare(range.variable, "index");
                lowering.emit(format!("let {name} = {next} - {one};"), range.span);
            }
        });
    }

    /// Writes a loop whose last index may be the greatest or least value of its type: a variable contains whether another
    /// iteration follows. The step after the last iteration may wrap; nothing reads its result.
    fn through_last(&mut self, range: &Range<'_>, [from, to, last]: [&ExprSource; 3], operator: Operator) {
        let more = self.names.fresh(&format!("{}_more", self.user_name(range.variable, "index")));
        // The first comparison would hold for every end.
        let any = match from.source == least(range.ty).source {
            true => "true".to_owned(),
            false => ExprSource::binary(Operator::LessEqual, from, to).source,
        };
        self.emit(format!("var {more} = {any};"), range.span);
        self.names.open();
        let name = self.declare(range.variable, "index");
        let (first, step) = if operator == Operator::Less { (from, "++") } else { (to, "--") };
        self.emit(format!("for (var {name} = {}; {more}; {name}{step}) {{", first.source), range.span);
        let follows = ExprSource::binary(operator, &ExprSource::primary(name), last).source;
        self.body(range.body, |lowering| lowering.emit(format!("{more} = {follows};"), range.span));
    }

    /// Returns the start of the range, which is evaluated before the end.
    fn start(&mut self, from: &Expr, to: &Expr) -> ExprSource {
        let source = self.value(from);
        if assigns(to) && !self.is_stable(from) { self.bind("value", &source, &from.span) } else { source }
    }

    /// Returns a bound that every iteration compares with. Its value does not change during the loop.
    fn bound(&mut self, variable: Option<VariableId>, which: &str, expr: &Expr) -> ExprSource {
        let source = self.value(expr);
        let simple = is_plain(expr) || is_count(expr) || self.is_constant(expr);
        if simple && self.is_stable(expr) {
            return source;
        }
        let name = self.user_name(variable, "index");
        self.bind(&format!("{name}_{which}"), &source, &expr.span)
    }

    /// Returns the value after a constant, if its type has one.
    fn after(&self, expr: &Expr) -> Option<ExprSource> {
        match fold::constant(expr, self.function)? {
            Value::U32(value) => Some(numbers::integer(value.checked_add(1)?.into(), Type::U32)),
            Value::I32(value) => {
                let after = value.checked_add(1)?;
                let magnitude = u64::from(after.unsigned_abs());
                Some(if after < 0 { numbers::negative(magnitude) } else { numbers::integer(magnitude, Type::I32) })
            }
            _ => None,
        }
    }
}

/// Returns the least value of an integer type.
fn least(ty: Type) -> ExprSource {
    match ty {
        Type::I32 => numbers::negative(u64::from(i32::MIN.unsigned_abs())),
        _ => numbers::integer(0, ty),
    }
}

/// Returns whether this is the number of fragments, which is far below the greatest integer, or a cast of it.
fn is_count(expr: &Expr) -> bool {
    match &expr.kind {
        Kind::LayerCount => true,
        Kind::Cast(inner) => matches!(inner.kind, Kind::LayerCount),
        _ => false,
    }
}

//! Compiles value conversions and bit casts.

use naga::{Expression, Handle, ScalarKind};

use super::compiler::{Compiler, Result};
use crate::operation::{Op, Word};
use crate::scalar::Unary;
use crate::wide::Wide;

impl Compiler<'_> {
    /// Compiles `kind(expression)`; if `bytes` is `None`, a bit cast.
    pub(super) fn convert(
        &mut self,
        expression: Handle<Expression>,
        kind: ScalarKind,
        bytes: Option<u8>,
    ) -> Result<Word> {
        use ScalarKind::{Bool, Float, Sint, Uint};
        let inner = self.type_of(expression);
        let (from, width) = self.kind_of(inner)?;
        let count = self.layouts.dense(inner)? / width;
        let a = self.words(expression)?;
        let wide = match bytes {
            None => return Ok(a),
            Some(8) if kind != Float => true,
            Some(1 | 4) => false,
            Some(bytes) => return Err(format!("{}-bit numbers", 8 * bytes)),
        };
        Ok(match (width, wide) {
            (1, false) => {
                let op = match (from, kind) {
                    (Float, Sint) => Unary::FToS,
                    (Float, Uint) => Unary::FToU,
                    (Float, Bool) => Unary::FToBool,
                    (Sint, Float) => Unary::SToF,
                    (Uint | Bool, Float) => Unary::UToF,
                    (Sint | Uint, Bool) => Unary::ToBool,
                    _ => return Ok(a),
                };
                self.each(op, a, count)
            }
            (1, true) => {
                let op = match (from, kind) {
                    (Float, Sint) => Wide::FromFToS,
                    (Float, _) => Wide::FromFToU,
                    (Sint, _) => Wide::FromS,
                    _ => Wide::FromU,
                };
                self.each_wide(op, a, a, count, 1)
            }
            (_, true) => a,
            (_, false) => match (from, kind) {
                (Sint, Float) => self.each_wide(Wide::SToF, a, a, count, 2),
                (_, Float) => self.each_wide(Wide::UToF, a, a, count, 2),
                (_, Bool) => self.each_wide(Wide::ToBool, a, a, count, 2),
                _ => {
                    let to = self.take(count);
                    for number in 0..count {
                        self.push(Op::Copy { to: to + number, from: a + 2 * number, count: 1 });
                    }
                    to
                }
            },
        })
    }
}

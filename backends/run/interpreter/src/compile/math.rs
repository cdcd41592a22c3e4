//! Compiles WGSL's built-in functions. Vector functions become operations on single words.

use naga::{Expression, Handle, MathFunction, ScalarKind};

use super::compiler::{Compiler, Result};
use crate::operation::{Op, Word};
use crate::packing::{Pack, Unpack};
use crate::scalar::{Binary, Ternary, Unary};
use crate::wide::Wide;

impl Compiler<'_> {
    pub(super) fn math(&mut self, function: MathFunction, arguments: &[Handle<Expression>]) -> Result<Word> {
        let inner = self.type_of(arguments[0]);
        let (kind, width) = self.kind_of(inner)?;
        let total = self.layouts.dense(inner)?;
        let mut words = Vec::with_capacity(arguments.len());
        for argument in arguments {
            let count = self.layouts.dense(self.type_of(*argument))?;
            words.push((self.words(*argument)?, count));
        }
        let a = words[0].0;
        let b = words.get(1).map_or(a, |(word, _)| *word);
        if width == 2 {
            return self.wide_math(function, kind, a, &words, total / 2);
        }
        if let Some(op) = pack_op(function) {
            let from = if op == Pack::InsertBits { return self.insert_bits(&words, total) } else { a };
            let to = self.take(1);
            self.push(Op::Pack { op, to, a: from });
            return Ok(to);
        }
        if let Some(op) = unpack_op(function) {
            let to = self.take(op.components());
            self.push(Op::Unpack { op, to, a });
            return Ok(to);
        }
        if let Some(op) = unary_op(function, kind) {
            return Ok(self.each(op, a, total));
        }
        if let Some(op) = binary_op(function, kind) {
            return Ok(self.pairs(op, a, b, total));
        }
        if let Some(op) = ternary_op(function, kind) {
            return Ok(self.triples(op, &words, total));
        }
        match function {
            MathFunction::Clamp => {
                let (least, most) = match kind {
                    ScalarKind::Sint => (Binary::MinS, Binary::MaxS),
                    ScalarKind::Uint => (Binary::MinU, Binary::MaxU),
                    _ => (Binary::MinF, Binary::MaxF),
                };
                let raised = self.pairs(most, a, b, total);
                Ok(self.pairs(least, raised, words[2].0, total))
            }
            // Unsigned.
            MathFunction::Abs => Ok(a),
            MathFunction::Modf => {
                let whole = self.each(Unary::Trunc, a, total);
                let rest = self.pairs(Binary::SubtractF, a, whole, total);
                Ok(self.concatenated(&[(rest, total), (whole, total)]))
            }
            MathFunction::Frexp => {
                let fraction = self.each(Unary::FrexpFraction, a, total);
                let exponent = self.each(Unary::FrexpExponent, a, total);
                Ok(self.concatenated(&[(fraction, total), (exponent, total)]))
            }
            MathFunction::Dot if kind == ScalarKind::Float => Ok(self.dot_of(a, b, total)),
            MathFunction::Dot => {
                let products = self.pairs(Binary::Multiply, a, b, total);
                Ok(self.fold(Binary::Add, products, total))
            }
            MathFunction::Cross => self.cross(a, b),
            MathFunction::Length => Ok(self.length(a, total)),
            MathFunction::Distance => {
                let difference = self.pairs(Binary::SubtractF, a, b, total);
                Ok(self.length(difference, total))
            }
            MathFunction::Normalize => {
                let length = self.length(a, total);
                let lengths = self.repeated(length, total);
                Ok(self.pairs(Binary::DivideF, a, lengths, total))
            }
            MathFunction::FaceForward => {
                let side = self.dot_of(b, words[2].0, total);
                let zero = self.constant(0);
                let front = self.take(1);
                self.push(Op::Binary { op: Binary::LessF, to: front, a: side, b: zero });
                let back = self.each(Unary::NegateF, a, total);
                let to = self.take(total);
                for word in 0..total {
                    self.push(Op::Ternary {
                        op: Ternary::Select,
                        to: to + word,
                        a: front,
                        b: a + word,
                        c: back + word,
                    });
                }
                Ok(to)
            }
            MathFunction::Reflect => {
                // e1 - 2 * dot(e2, e1) * e2
                let side = self.dot_of(b, a, total);
                let doubled = self.pairs(Binary::AddF, side, side, 1);
                let doubled = self.repeated(doubled, total);
                let along = self.pairs(Binary::MultiplyF, doubled, b, total);
                Ok(self.pairs(Binary::SubtractF, a, along, total))
            }
            MathFunction::Refract => Ok(self.refract(a, b, words[2].0, total)),
            MathFunction::Transpose => self.transpose(inner, a),
            MathFunction::Determinant => self.determinant(inner, a),
            other => Err(format!("the built-in function {other:?}")),
        }
    }

    fn wide_math(
        &mut self,
        function: MathFunction,
        kind: ScalarKind,
        a: Word,
        words: &[(Word, u32)],
        count: u32,
    ) -> Result<Word> {
        let is_signed = kind == ScalarKind::Sint;
        let (least, most) = if is_signed { (Wide::MinS, Wide::MaxS) } else { (Wide::MinU, Wide::MaxU) };
        let b = words.get(1).map_or(a, |(word, _)| *word);
        match function {
            MathFunction::Min => Ok(self.each_wide(least, a, b, count, 2)),
            MathFunction::Max => Ok(self.each_wide(most, a, b, count, 2)),
            MathFunction::Clamp => {
                let raised = self.each_wide(most, a, b, count, 2);
                Ok(self.each_wide(least, raised, words[2].0, count, 2))
            }
            MathFunction::Abs if is_signed => Ok(self.each_wide(Wide::AbsS, a, a, count, 2)),
            MathFunction::Abs => Ok(a),
            other => Err(format!("the built-in function {other:?} on 64 bits")),
        }
    }

    /// Applies an operation to each component; a scalar operand is used for all.
    fn triples(&mut self, op: Ternary, words: &[(Word, u32)], total: u32) -> Word {
        let at = |operand: usize, word: u32| {
            let (first, count) = words[operand];
            first + if count == 1 { 0 } else { word }
        };
        let to = self.take(total);
        for word in 0..total {
            self.push(Op::Ternary { op, to: to + word, a: at(0, word), b: at(1, word), c: at(2, word) });
        }
        to
    }

    fn insert_bits(&mut self, words: &[(Word, u32)], total: u32) -> Result<Word> {
        let [(word, _), (new, _), (offset, _), (count, _)] = *words else {
            return Err("`insertBits` with other arguments".to_owned());
        };
        let to = self.take(total);
        for number in 0..total {
            let row = self.concatenated(&[(word + number, 1), (new + number, 1), (offset, 1), (count, 1)]);
            self.push(Op::Pack { op: Pack::InsertBits, to: to + number, a: row });
        }
        Ok(to)
    }

    /// Copies ranges of words into consecutive words.
    fn concatenated(&mut self, parts: &[(Word, u32)]) -> Word {
        let to = self.take(parts.iter().map(|(_, count)| count).sum());
        let mut at = to;
        for (from, count) in parts {
            self.push(Op::Copy { to: at, from: *from, count: *count });
            at += count;
        }
        to
    }

    fn repeated(&mut self, word: Word, count: u32) -> Word {
        let parts: Vec<(Word, u32)> = (0..count).map(|_| (word, 1)).collect();
        self.concatenated(&parts)
    }

    fn dot_of(&mut self, a: Word, b: Word, total: u32) -> Word {
        let products = self.pairs(Binary::MultiplyF, a, b, total);
        self.fold(Binary::AddF, products, total)
    }

    fn length(&mut self, a: Word, total: u32) -> Word {
        if total == 1 {
            return self.each(Unary::AbsF, a, 1);
        }
        let squares = self.dot_of(a, a, total);
        self.each(Unary::Sqrt, squares, 1)
    }

    fn cross(&mut self, a: Word, b: Word) -> Result<Word> {
        let rotated = |compiler: &mut Self, v: Word, by: u32| {
            let parts = [(v + by % 3, 1), (v + (by + 1) % 3, 1), (v + (by + 2) % 3, 1)];
            compiler.concatenated(&parts)
        };
        let (a1, b2) = (rotated(self, a, 1), rotated(self, b, 2));
        let (a2, b1) = (rotated(self, a, 2), rotated(self, b, 1));
        let (left, right) = (self.pairs(Binary::MultiplyF, a1, b2, 3), self.pairs(Binary::MultiplyF, a2, b1, 3));
        Ok(self.pairs(Binary::SubtractF, left, right, 3))
    }

    /// Computes `refract`: k = 1 - e3² (1 - dot(e2, e1)²); 0 if k < 0, else e3 e1 - (e3 dot(e2, e1) + √k) e2.
    fn refract(&mut self, a: Word, b: Word, ratio: Word, total: u32) -> Word {
        let one = self.constant(1f32.to_bits());
        let zero = self.constant(0);
        let side = self.dot_of(b, a, total);
        let square = self.pairs(Binary::MultiplyF, side, side, 1);
        let rest = self.pairs(Binary::SubtractF, one, square, 1);
        let ratios = self.pairs(Binary::MultiplyF, ratio, ratio, 1);
        let bent = self.pairs(Binary::MultiplyF, ratios, rest, 1);
        let k = self.pairs(Binary::SubtractF, one, bent, 1);
        let is_none = self.pairs(Binary::LessF, k, zero, 1);
        let root = self.each(Unary::Sqrt, k, 1);
        let scaled = self.pairs(Binary::MultiplyF, ratio, side, 1);
        let along = self.pairs(Binary::AddF, scaled, root, 1);
        let (alongs, ratios) = (self.repeated(along, total), self.repeated(ratio, total));
        let inward = self.pairs(Binary::MultiplyF, ratios, a, total);
        let normal = self.pairs(Binary::MultiplyF, alongs, b, total);
        let through = self.pairs(Binary::SubtractF, inward, normal, total);
        let to = self.take(total);
        for word in 0..total {
            self.push(Op::Ternary { op: Ternary::Select, to: to + word, a: is_none, b: zero, c: through + word });
        }
        to
    }
}

fn pack_op(function: MathFunction) -> Option<Pack> {
    Some(match function {
        MathFunction::Pack4x8snorm => Pack::Snorm8,
        MathFunction::Pack4x8unorm => Pack::Unorm8,
        MathFunction::Pack2x16snorm => Pack::Snorm16,
        MathFunction::Pack2x16unorm => Pack::Unorm16,
        MathFunction::Pack2x16float => Pack::Half,
        MathFunction::Pack4xI8 => Pack::Signed8,
        MathFunction::Pack4xU8 => Pack::Unsigned8,
        MathFunction::Pack4xI8Clamp => Pack::SignedClamped8,
        MathFunction::Pack4xU8Clamp => Pack::UnsignedClamped8,
        MathFunction::InsertBits => Pack::InsertBits,
        _ => return None,
    })
}

fn unpack_op(function: MathFunction) -> Option<Unpack> {
    Some(match function {
        MathFunction::Unpack4x8snorm => Unpack::Snorm8,
        MathFunction::Unpack4x8unorm => Unpack::Unorm8,
        MathFunction::Unpack2x16snorm => Unpack::Snorm16,
        MathFunction::Unpack2x16unorm => Unpack::Unorm16,
        MathFunction::Unpack2x16float => Unpack::Half,
        MathFunction::Unpack4xI8 => Unpack::Signed8,
        MathFunction::Unpack4xU8 => Unpack::Unsigned8,
        _ => return None,
    })
}

fn unary_op(function: MathFunction, kind: ScalarKind) -> Option<Unary> {
    let is_float = kind == ScalarKind::Float;
    let is_signed = kind == ScalarKind::Sint;
    Some(match function {
        MathFunction::Abs if is_float => Unary::AbsF,
        MathFunction::Abs if is_signed => Unary::AbsS,
        MathFunction::Sign if is_signed => Unary::SignS,
        MathFunction::Sign => Unary::SignF,
        MathFunction::Saturate => Unary::Saturate,
        MathFunction::Cos => Unary::Cos,
        MathFunction::Cosh => Unary::Cosh,
        MathFunction::Sin => Unary::Sin,
        MathFunction::Sinh => Unary::Sinh,
        MathFunction::Tan => Unary::Tan,
        MathFunction::Tanh => Unary::Tanh,
        MathFunction::Acos => Unary::Acos,
        MathFunction::Asin => Unary::Asin,
        MathFunction::Atan => Unary::Atan,
        MathFunction::Asinh => Unary::Asinh,
        MathFunction::Acosh => Unary::Acosh,
        MathFunction::Atanh => Unary::Atanh,
        MathFunction::Radians => Unary::Radians,
        MathFunction::Degrees => Unary::Degrees,
        MathFunction::Ceil => Unary::Ceil,
        MathFunction::Floor => Unary::Floor,
        MathFunction::Round => Unary::Round,
        MathFunction::Fract => Unary::Fract,
        MathFunction::Trunc => Unary::Trunc,
        MathFunction::Exp => Unary::Exp,
        MathFunction::Exp2 => Unary::Exp2,
        MathFunction::Log => Unary::Log,
        MathFunction::Log2 => Unary::Log2,
        MathFunction::Sqrt => Unary::Sqrt,
        MathFunction::InverseSqrt => Unary::InverseSqrt,
        MathFunction::QuantizeToF16 => Unary::QuantizeToF16,
        MathFunction::CountTrailingZeros => Unary::TrailingZeros,
        MathFunction::CountLeadingZeros => Unary::LeadingZeros,
        MathFunction::CountOneBits => Unary::CountOnes,
        MathFunction::ReverseBits => Unary::ReverseBits,
        MathFunction::FirstTrailingBit => Unary::FirstTrailingBit,
        MathFunction::FirstLeadingBit if is_signed => Unary::FirstLeadingBitS,
        MathFunction::FirstLeadingBit => Unary::FirstLeadingBitU,
        _ => return None,
    })
}

fn binary_op(function: MathFunction, kind: ScalarKind) -> Option<Binary> {
    Some(match (function, kind) {
        (MathFunction::Min, ScalarKind::Sint) => Binary::MinS,
        (MathFunction::Min, ScalarKind::Uint) => Binary::MinU,
        (MathFunction::Min, _) => Binary::MinF,
        (MathFunction::Max, ScalarKind::Sint) => Binary::MaxS,
        (MathFunction::Max, ScalarKind::Uint) => Binary::MaxU,
        (MathFunction::Max, _) => Binary::MaxF,
        (MathFunction::Pow, _) => Binary::Power,
        (MathFunction::Atan2, _) => Binary::Atan2,
        (MathFunction::Step, _) => Binary::Step,
        (MathFunction::Ldexp, _) => Binary::Ldexp,
        (MathFunction::Dot4I8Packed, _) => Binary::Dot4S,
        (MathFunction::Dot4U8Packed, _) => Binary::Dot4U,
        _ => return None,
    })
}

fn ternary_op(function: MathFunction, kind: ScalarKind) -> Option<Ternary> {
    Some(match function {
        MathFunction::Fma => Ternary::FusedMultiplyAdd,
        MathFunction::Mix => Ternary::Mix,
        MathFunction::SmoothStep => Ternary::SmoothStep,
        MathFunction::ExtractBits if kind == ScalarKind::Sint => Ternary::ExtractBitsS,
        MathFunction::ExtractBits => Ternary::ExtractBitsU,
        _ => return None,
    })
}

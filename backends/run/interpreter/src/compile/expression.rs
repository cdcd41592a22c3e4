//! Compiles expressions to words, pointers or textures.

use naga::{Expression, Handle, RelationalFunction, TypeInner, VectorSize};

use super::compiler::{Compiler, Result, Value};
use super::constant::literal_words;
use super::pointer::Pointer;
use crate::layout::{count, is_pointer};
use crate::operation::{Op, Word};
use crate::scalar::{Binary, Ternary, Unary};

impl Compiler<'_> {
    /// Returns the value of an expression. An expression that needs no `Emit` statement is compiled at its first use.
    pub(super) fn value(&mut self, expression: Handle<Expression>) -> Result<Value> {
        match self.callee.values[expression.index()] {
            Some(value) => Ok(value),
            None => {
                self.emit(expression)?;
                self.callee.values[expression.index()].ok_or_else(|| "a result that precedes its statement".to_owned())
            }
        }
    }

    /// Compiles an expression at the current instruction.
    pub(super) fn emit(&mut self, expression: Handle<Expression>) -> Result<()> {
        let value = self.evaluate(expression)?;
        self.callee.values[expression.index()] = Some(value);
        Ok(())
    }

    fn evaluate(&mut self, expression: Handle<Expression>) -> Result<Value> {
        let function = self.callee.function;
        let words = match &function.expressions[expression] {
            Expression::Literal(literal) => self.constants(&literal_words(literal)?),
            Expression::Constant(constant) => {
                let words = self.constant_value(self.module.constants[*constant].init)?;
                self.constants(&words)
            }
            Expression::Override(handle) => {
                let init = self.module.overrides[*handle].init.ok_or("an override without a value")?;
                let words = self.constant_value(init)?;
                self.constants(&words)
            }
            Expression::ZeroValue(kind) => self.zero_value(self.layouts.inner(*kind))?,
            Expression::Compose { components, .. } => self.compose(components)?,
            Expression::Access { base, index } => return self.access(*base, *index),
            Expression::AccessIndex { base, index } => return self.access_at(*base, *index),
            Expression::Splat { size, value } => self.splat(*size, *value)?,
            Expression::Swizzle { size, vector, pattern } => {
                let from = self.words(*vector)?;
                let (_, width) = self.kind_of(self.type_of(*vector))?;
                let to = self.take(count(*size) * width);
                for (number, component) in (0..count(*size)).zip(pattern) {
                    let from = from + *component as u32 * width;
                    self.push(Op::Copy { to: to + number * width, from, count: width });
                }
                to
            }
            Expression::FunctionArgument(number) => {
                return self
                    .callee
                    .arguments
                    .get(*number as usize)
                    .copied()
                    .ok_or_else(|| "a missing argument".to_owned());
            }
            Expression::GlobalVariable(handle) => {
                return self.globals.get(handle).copied().ok_or_else(|| "an unsupported variable".to_owned());
            }
            Expression::LocalVariable(handle) => {
                let (first, length) = self.callee.locals[handle.index()].ok_or("an unsupported variable")?;
                return Ok(Value::Pointer(Pointer::to_variable(first, length)));
            }
            Expression::Load { pointer } => {
                let target = self.pointer(*pointer)?;
                let inner = self.layouts.pointee(self.type_of(*pointer))?;
                self.load(target, &inner)?
            }
            Expression::Unary { op, expr } => self.unary(*op, *expr)?,
            Expression::Binary { op, left, right } => self.binary(*op, *left, *right)?,
            Expression::Select { condition, accept, reject } => self.select(*condition, *accept, *reject)?,
            Expression::Relational { fun, argument } => self.relational(*fun, *argument)?,
            Expression::Math { fun, arg, arg1, arg2, arg3 } => {
                let arguments = [Some(*arg), *arg1, *arg2, *arg3];
                self.math(*fun, &arguments.into_iter().flatten().collect::<Vec<_>>())?
            }
            Expression::As { expr, kind, convert } => self.convert(*expr, *kind, *convert)?,
            Expression::ArrayLength(array) => self.array_length(*array)?,
            Expression::CallResult(_)
            | Expression::AtomicResult { .. }
            | Expression::WorkGroupUniformLoadResult { .. } => {
                return Err("a result that precedes its statement".to_owned());
            }
            Expression::ImageLoad { image, coordinate, array_index: None, sample, level } => {
                self.texel(*image, *coordinate, sample.or(*level))?
            }
            Expression::ImageLoad { .. } => return Err("layers of textures".to_owned()),
            Expression::ImageQuery { image, query } => self.extent(*image, query)?,
            Expression::ImageSample { .. } => return Err("samplers".to_owned()),
            Expression::Derivative { .. } => return Err("derivatives".to_owned()),
            Expression::SubgroupBallotResult | Expression::SubgroupOperationResult { .. } => {
                return Err("subgroup operations".to_owned());
            }
            Expression::RayQueryVertexPositions { .. }
            | Expression::RayQueryProceedResult
            | Expression::RayQueryGetIntersection { .. } => return Err("rays".to_owned()),
            Expression::CooperativeLoad { .. } | Expression::CooperativeMultiplyAdd { .. } => {
                return Err("cooperative matrices".to_owned());
            }
        };
        Ok(Value::Words(words))
    }

    fn constants(&mut self, words: &[u32]) -> Word {
        if let [one] = words { self.constant(*one) } else { self.consecutive_constants(words) }
    }

    fn compose(&mut self, components: &[Handle<Expression>]) -> Result<Word> {
        let mut parts = Vec::with_capacity(components.len());
        for component in components {
            let width = self.layouts.dense(self.type_of(*component))?;
            parts.push((self.words(*component)?, width));
        }
        let to = self.take(parts.iter().map(|(_, width)| width).sum());
        let mut at = to;
        for (from, count) in parts {
            self.push(Op::Copy { to: at, from, count });
            at += count;
        }
        Ok(to)
    }

    fn splat(&mut self, size: VectorSize, value: Handle<Expression>) -> Result<Word> {
        let from = self.words(value)?;
        let (_, width) = self.kind_of(self.type_of(value))?;
        let to = self.take(count(size) * width);
        for number in 0..count(size) {
            self.push(Op::Copy { to: to + number * width, from, count: width });
        }
        Ok(to)
    }

    fn select(
        &mut self,
        condition: Handle<Expression>,
        accept: Handle<Expression>,
        reject: Handle<Expression>,
    ) -> Result<Word> {
        let inner = self.type_of(accept);
        let total = self.layouts.dense(inner)?;
        let conditions = self.layouts.dense(self.type_of(condition))?;
        // A vector of conditions selects component by component, a scalar selects all.
        let each = if conditions == 1 { total } else { total / conditions };
        let (a, b, c) = (self.words(condition)?, self.words(accept)?, self.words(reject)?);
        let to = self.take(total);
        for word in 0..total {
            let a = a + word / each.max(1);
            self.push(Op::Ternary { op: Ternary::Select, to: to + word, a, b: b + word, c: c + word });
        }
        Ok(to)
    }

    fn relational(&mut self, function: RelationalFunction, argument: Handle<Expression>) -> Result<Word> {
        let words = self.layouts.dense(self.type_of(argument))?;
        let a = self.words(argument)?;
        let op = match function {
            RelationalFunction::All => Err(Binary::And),
            RelationalFunction::Any => Err(Binary::Or),
            RelationalFunction::IsNan => Ok(Unary::IsNan),
            RelationalFunction::IsInf => Ok(Unary::IsInf),
        };
        match op {
            Ok(op) => {
                let to = self.take(words);
                for word in 0..words {
                    self.push(Op::Unary { op, to: to + word, a: a + word });
                }
                Ok(to)
            }
            Err(op) => Ok(self.fold(op, a, words)),
        }
    }

    /// Computes `a[0] op a[1] op …`.
    pub(super) fn fold(&mut self, op: Binary, a: Word, words: u32) -> Word {
        let mut sum = a;
        for word in 1..words {
            let to = self.take(1);
            self.push(Op::Binary { op, to, a: sum, b: a + word });
            sum = to;
        }
        sum
    }

    pub(super) fn is_pointer(&self, expression: Handle<Expression>) -> bool {
        is_pointer(self.type_of(expression))
    }

    /// Returns the type that an expression points to, or its own type.
    pub(super) fn pointee_or_type(&self, expression: Handle<Expression>) -> Result<TypeInner> {
        let inner = self.type_of(expression);
        if is_pointer(inner) { self.layouts.pointee(inner) } else { Ok(inner.clone()) }
    }
}

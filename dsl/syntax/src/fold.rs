//! Constant expressions: what is known before any shader runs.
//!
//! In: a checked function. Out: the values of expressions made of literals, and a mistake wherever WGSL would refuse such
//! a value: overflow, a division by zero, a result that is not finite. WGSL refuses these when a shader is created, so
//! they must not get that far. Calls of methods are never constant here: the printer makes sure of it in WGSL too.

use fragbuf_model::{Origin, codes};

use crate::methods::Spelling;
use crate::report::Report;
use crate::tree::{Block, Expr, Function, Kind, Operator, Over, Statement};
use crate::types::Type;

/// A known value.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    /// A number, or the components of a vector.
    Float(Vec<f32>),
    U32(u32),
    I32(i32),
    Bool(bool),
}

/// Reports every constant that WGSL would refuse.
pub(crate) fn refuse_overflow(function: &Function, report: &mut Report) {
    let mut wrong = |origin: &Origin, message: &str, hint: &str| {
        report.error(codes::OUT_OF_RANGE, origin, message, hint);
    };
    Folding { function, wrong: &mut wrong }.block(&function.body);
}

/// The value of a constant expression.
pub(crate) fn constant(expr: &Expr, function: &Function) -> Option<Value> {
    let has_statements = matches!(expr.kind, Kind::If(_) | Kind::For(_) | Kind::Block(_));
    if has_statements { None } else { Folding { function, wrong: &mut |_, _, _| {} }.expr(expr) }
}

struct Folding<'a> {
    function: &'a Function,
    wrong: &'a mut dyn FnMut(&Origin, &str, &str),
}

impl Folding<'_> {
    fn block(&mut self, block: &Block) -> Option<Value> {
        for statement in &block.statements {
            let (Statement::Let { value, .. } | Statement::Expr(value)) = statement;
            self.expr(value);
        }
        let value = block.value.as_deref().and_then(|value| self.expr(value));
        value.filter(|_| block.statements.is_empty())
    }

    fn expr(&mut self, expr: &Expr) -> Option<Value> {
        let ty = self.function.type_of(expr);
        match &expr.kind {
            Kind::Float(value) => Some(Value::Float(vec![*value])),
            Kind::Whole(value) => whole(*value, ty),
            Kind::Bool(value) => Some(Value::Bool(*value)),
            Kind::Negate(inner) => self.negate(inner, expr, ty),
            Kind::Not(inner) => not(self.expr(inner)?),
            Kind::Binary(operator, left, right) => self.binary(*operator, left, right, expr),
            Kind::Cast(inner) => {
                let value = self.expr(inner)?;
                cast(&value, ty)
            }
            Kind::Vector(components) => self.vector(components, ty),
            Kind::Components(inner, names) => components(&self.expr(inner)?, names),
            Kind::Assign { operator, value, place } => {
                self.expr(place);
                let value = self.expr(value);
                if let (Some(operator), Some(value)) = (operator, &value) {
                    self.divisor(*operator, value, expr);
                }
                None
            }
            Kind::Method(spelling, arguments) => {
                let values: Vec<Option<Value>> = arguments.iter().map(|argument| self.expr(argument)).collect();
                self.clamp(*spelling, &values, expr);
                None
            }
            Kind::Block(block) => self.block(block),
            other => {
                let values: Vec<Option<Value>> =
                    other.operands().into_iter().map(|operand| self.expr(operand)).collect();
                self.endless(other, &values, expr);
                other.block().map(|block| self.block(block));
                None
            }
        }
    }

    /// A loop up to and with the greatest number would count past it.
    fn endless(&mut self, kind: &Kind, bounds: &[Option<Value>], expr: &Expr) {
        let Kind::For(each) = kind else { return };
        let (Over::Range { inclusive: true, .. }, [_, Some(end)]) = (&each.over, bounds) else { return };
        if matches!(end, Value::U32(u32::MAX) | Value::I32(i32::MAX)) {
            self.refuse(expr, "this loop would count past the greatest number", "write `a..b`, or a smaller end");
        }
    }

    fn refuse(&mut self, expr: &Expr, message: &str, hint: &str) -> Option<Value> {
        (self.wrong)(&expr.origin, message, hint);
        None
    }

    fn negate(&mut self, inner: &Expr, expr: &Expr, ty: Type) -> Option<Value> {
        if let (Kind::Whole(value), Type::I32) = (&inner.kind, ty) {
            let negative = i64::try_from(*value).ok().and_then(|value| i32::try_from(-value).ok());
            return negative.map(Value::I32);
        }
        match self.expr(inner)? {
            Value::Float(parts) => Some(Value::Float(parts.into_iter().map(|part| -part).collect())),
            Value::I32(value) => match value.checked_neg() {
                Some(value) => Some(Value::I32(value)),
                None => {
                    self.refuse(expr, "this constant overflows an `i32`", "the least `i32` has no positive counterpart")
                }
            },
            _ => None,
        }
    }

    fn vector(&mut self, components: &[Expr], ty: Type) -> Option<Value> {
        let values: Vec<Option<Value>> = components.iter().map(|component| self.expr(component)).collect();
        let mut parts = Vec::new();
        for value in values {
            match value? {
                Value::Float(part) => parts.extend(part),
                _ => return None,
            }
        }
        match (ty, parts.as_slice()) {
            (Type::Vector(size), [all]) => Some(Value::Float(vec![*all; usize::from(size)])),
            _ => Some(Value::Float(parts)),
        }
    }

    fn binary(&mut self, operator: Operator, left: &Expr, right: &Expr, expr: &Expr) -> Option<Value> {
        let (left, right) = (self.expr(left), self.expr(right));
        let right = right?;
        if !self.divisor(operator, &right, expr) {
            return None;
        }
        match (left?, right) {
            (Value::Float(a), Value::Float(b)) => self.floats(operator, &a, &b, expr),
            (Value::U32(a), b) => self.unsigned(operator, a, &b, expr),
            (Value::I32(a), b) => self.signed(operator, a, &b, expr),
            (Value::Bool(a), Value::Bool(b)) => truth(operator, a, b),
            _ => None,
        }
    }

    /// Whether a known right side is allowed, whatever the left one is.
    fn divisor(&mut self, operator: Operator, right: &Value, expr: &Expr) -> bool {
        let zero = matches!(right, Value::U32(0) | Value::I32(0));
        if zero && matches!(operator, Operator::Divide | Operator::Remainder) {
            self.refuse(expr, "this divides by zero", "divide by something else");
            return false;
        }
        let bits = match right {
            Value::U32(bits) => Some(i64::from(*bits)),
            Value::I32(bits) => Some(i64::from(*bits)),
            _ => None,
        };
        if operator.is_shift() && bits.is_some_and(|bits| !(0..32).contains(&bits)) {
            self.refuse(expr, "this shifts by more bits than there are", "shift by 0 to 31");
            return false;
        }
        true
    }

    fn floats(&mut self, operator: Operator, a: &[f32], b: &[f32], expr: &Expr) -> Option<Value> {
        if let Some(result) = compared(operator, a.first(), b.first()) {
            return Some(Value::Bool(result));
        }
        let apply = |a: f32, b: f32| match operator {
            Operator::Add => a + b,
            Operator::Subtract => a - b,
            Operator::Multiply => a * b,
            Operator::Divide => a / b,
            _ => a % b,
        };
        let pick = |parts: &[f32], index: usize| parts.get(index).or(parts.first()).copied().unwrap_or(0.0);
        let size = a.len().max(b.len());
        let parts: Vec<f32> = (0..size).map(|index| apply(pick(a, index), pick(b, index))).collect();
        if parts.iter().all(|part| part.is_finite()) {
            return Some(Value::Float(parts));
        }
        self.refuse(expr, "this constant is not a finite number", "shaders have no infinity: use `f32::MAX`")
    }

    fn unsigned(&mut self, operator: Operator, a: u32, right: &Value, expr: &Expr) -> Option<Value> {
        if operator.is_shift() {
            let bits = bits(right)?;
            let shifted = if operator == Operator::ShiftLeft { a << bits } else { a >> bits };
            return Some(Value::U32(shifted));
        }
        let Value::U32(b) = *right else { return None };
        if let Some(result) = compared(operator, Some(&a), Some(&b)) {
            return Some(Value::Bool(result));
        }
        let result = match operator {
            Operator::Add => a.checked_add(b),
            Operator::Subtract => a.checked_sub(b),
            Operator::Multiply => a.checked_mul(b),
            Operator::Divide => a.checked_div(b),
            Operator::Remainder => a.checked_rem(b),
            Operator::BitAnd => Some(a & b),
            Operator::BitOr => Some(a | b),
            _ => Some(a ^ b),
        };
        match result {
            Some(value) => Some(Value::U32(value)),
            None => self.refuse(expr, "this constant overflows a `u32`", "it goes from 0 to 4294967295"),
        }
    }

    fn signed(&mut self, operator: Operator, a: i32, right: &Value, expr: &Expr) -> Option<Value> {
        if operator.is_shift() {
            let bits = bits(right)?;
            let shifted = if operator == Operator::ShiftLeft { a << bits } else { a >> bits };
            return Some(Value::I32(shifted));
        }
        let Value::I32(b) = *right else { return None };
        if let Some(result) = compared(operator, Some(&a), Some(&b)) {
            return Some(Value::Bool(result));
        }
        let result = match operator {
            Operator::Add => a.checked_add(b),
            Operator::Subtract => a.checked_sub(b),
            Operator::Multiply => a.checked_mul(b),
            Operator::Divide => a.checked_div(b),
            Operator::Remainder => a.checked_rem(b),
            Operator::BitAnd => Some(a & b),
            Operator::BitOr => Some(a | b),
            _ => Some(a ^ b),
        };
        match result {
            Some(value) => Some(Value::I32(value)),
            None => self.refuse(expr, "this constant overflows an `i32`", "it goes from -2147483648 to 2147483647"),
        }
    }

    fn clamp(&mut self, spelling: Spelling, values: &[Option<Value>], expr: &Expr) {
        let [_, Some(low), Some(high)] = values else { return };
        let crossed = match (low, high) {
            (Value::Float(low), Value::Float(high)) => low.iter().zip(high).any(|(low, high)| low > high),
            (Value::U32(low), Value::U32(high)) => low > high,
            (Value::I32(low), Value::I32(high)) => low > high,
            _ => false,
        };
        if spelling == Spelling::Call("clamp") && crossed {
            self.refuse(expr, "the lower bound is above the upper one", "write `clamp(lower, upper)`");
        }
    }
}

fn whole(value: u64, ty: Type) -> Option<Value> {
    match ty {
        Type::I32 => i32::try_from(value).ok().map(Value::I32),
        _ => u32::try_from(value).ok().map(Value::U32),
    }
}

fn not(value: Value) -> Option<Value> {
    match value {
        Value::Bool(value) => Some(Value::Bool(!value)),
        Value::U32(value) => Some(Value::U32(!value)),
        Value::I32(value) => Some(Value::I32(!value)),
        Value::Float(_) => None,
    }
}

fn truth(operator: Operator, a: bool, b: bool) -> Option<Value> {
    Some(Value::Bool(match operator {
        Operator::And | Operator::BitAnd => a && b,
        Operator::Or | Operator::BitOr => a || b,
        Operator::Equal => a == b,
        Operator::NotEqual | Operator::BitXor => a != b,
        _ => return None,
    }))
}

fn compared<T: PartialOrd>(operator: Operator, a: Option<&T>, b: Option<&T>) -> Option<bool> {
    let (a, b) = (a?, b?);
    Some(match operator {
        Operator::Equal => a == b,
        Operator::NotEqual => a != b,
        Operator::Less => a < b,
        Operator::LessEqual => a <= b,
        Operator::Greater => a > b,
        Operator::GreaterEqual => a >= b,
        _ => return None,
    })
}

fn bits(value: &Value) -> Option<u32> {
    match value {
        Value::U32(bits) => Some(*bits),
        Value::I32(bits) => u32::try_from(*bits).ok(),
        _ => None,
    }
}

/// Conversions as Rust makes them. From a fraction to a whole number the printer writes calls, so that is not constant.
fn cast(value: &Value, ty: Type) -> Option<Value> {
    match (value, ty) {
        (Value::Float(parts), Type::F32) => Some(Value::Float(parts.clone())),
        (Value::U32(value), Type::F32) => Some(Value::Float(vec![*value as f32])),
        (Value::I32(value), Type::F32) => Some(Value::Float(vec![*value as f32])),
        (Value::U32(value), Type::I32) => Some(Value::I32(value.cast_signed())),
        (Value::I32(value), Type::U32 | Type::Usize) => Some(Value::U32(value.cast_unsigned())),
        (Value::U32(_), Type::U32 | Type::Usize) | (Value::I32(_), Type::I32) => Some(value.clone()),
        (Value::Bool(value), Type::I32) => Some(Value::I32(i32::from(*value))),
        (Value::Bool(value), Type::U32 | Type::Usize) => Some(Value::U32(u32::from(*value))),
        _ => None,
    }
}

fn components(value: &Value, names: &str) -> Option<Value> {
    let Value::Float(parts) = value else { return None };
    let pick = |letter: char| "xyzw".find(letter).and_then(|index| parts.get(index)).copied();
    names.chars().map(pick).collect::<Option<Vec<f32>>>().map(Value::Float)
}

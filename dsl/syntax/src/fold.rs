//! Constant folding.
//!
//! Input: a checked function. Output: the values of expressions of literals, and an error for every value that WGSL rejects
//! when a shader is created: overflow, a division by zero, a result that is not finite. Method calls are never constant
//! here; the printer ensures the same in WGSL.

use fragbuf_model::{SourceSpan, codes};

use crate::methods::Spelling;
use crate::report::Report;
use crate::tree::{Block, Expr, Function, Kind, Operator, Statement, VariableId};
use crate::types::Type;

/// The value of a constant expression.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    /// A float, or the components of a vector.
    Float(Vec<f32>),
    U32(u32),
    I32(i32),
    Bool(bool),
}

/// Reports every constant that WGSL rejects.
pub(crate) fn reject_overflow(function: &Function, report: &mut Report) {
    let mut error = |span: &SourceSpan, message: &str, help: &str| {
        report.error(codes::OUT_OF_RANGE, span, message, help);
    };
    Folding::new(function, &mut error).block(&function.body);
}

/// Returns the value of an expression whose last part is constant in WGSL. Blocks in it may have statements with effects.
pub(crate) fn constant(expr: &Expr, function: &Function) -> Option<Value> {
    Folding::new(function, &mut |_, _, _| {}).expr(expr)
}

struct Folding<'a> {
    function: &'a Function,
    error: &'a mut dyn FnMut(&SourceSpan, &str, &str),
    /// The values of variables that are not mutable, so far. Validators use them for right operands and indices only.
    variables: Vec<Option<Value>>,
}

impl<'a> Folding<'a> {
    fn new(function: &'a Function, error: &'a mut dyn FnMut(&SourceSpan, &str, &str)) -> Self {
        Folding { function, error, variables: vec![None; function.variables.len()] }
    }

    fn block(&mut self, block: &Block) -> Option<Value> {
        for statement in &block.statements {
            match statement {
                Statement::Let { variable, value, .. } => self.variable(*variable, value),
                Statement::Expr(value) => drop(self.expr(value)),
            }
        }
        let value = block.value.as_deref()?;
        self.expr(value).or_else(|| self.variable_value(value))
    }

    fn variable(&mut self, variable: Option<VariableId>, value: &Expr) {
        let found = self.expr(value);
        let found = found.or_else(|| self.variable_value(value));
        let Some(id) = variable.filter(|id| !self.function.is_mutable(*id)) else { return };
        if let Some(slot) = self.variables.get_mut(id) {
            *slot = found;
        }
    }

    /// Returns the value of a name that was declared with a constant. A cast that WGSL does not have is still that name.
    fn variable_value(&self, expr: &Expr) -> Option<Value> {
        let wgsl = |expr: &Expr| self.function.type_of(expr).wgsl();
        match &expr.kind {
            Kind::Variable(id) => self.variables.get(*id)?.clone(),
            Kind::Cast(inner) if wgsl(inner) == wgsl(expr) => self.variable_value(inner),
            _ => None,
        }
    }

    fn expr(&mut self, expr: &Expr) -> Option<Value> {
        let ty = self.function.type_of(expr);
        match &expr.kind {
            Kind::Float(value) => Some(Value::Float(vec![*value])),
            Kind::Integer(value) => literal(*value, ty),
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
            Kind::Element(inner, index) => self.element(inner, index, expr),
            Kind::Assign { operator, value, place } => {
                self.expr(place);
                let constant = self.expr(value);
                if let (Some(operator), Some(value)) = (operator, constant.or_else(|| self.variable_value(value))) {
                    self.check_right_operand(*operator, &value, expr);
                }
                None
            }
            Kind::Method(spelling, arguments) => {
                let values: Vec<Option<Value>> = arguments.iter().map(|argument| self.expr(argument)).collect();
                self.clamp(*spelling, &values, expr);
                self.divisor(*spelling, &values, arguments, expr);
                None
            }
            Kind::Block(block) => self.block(block),
            other => {
                for operand in other.operands() {
                    self.expr(operand);
                }
                other.block().map(|block| self.block(block));
                None
            }
        }
    }

    fn element(&mut self, inner: &Expr, index: &Expr, expr: &Expr) -> Option<Value> {
        let (vector, constant) = (self.expr(inner), self.expr(index));
        let known = constant.clone().or_else(|| self.variable_value(index))?;
        let (Type::Vector(size), Some(at)) = (self.function.type_of(inner), integer(&known)) else { return None };
        if !(0..i64::from(size)).contains(&at) {
            return self.reject(expr, "this index is out of bounds", "components are numbered from 0");
        }
        match (vector?, constant?) {
            (Value::Float(parts), _) => Some(Value::Float(vec![*parts.get(usize::try_from(at).ok()?)?])),
            _ => None,
        }
    }

    fn reject(&mut self, expr: &Expr, message: &str, help: &str) -> Option<Value> {
        (self.error)(&expr.span, message, help);
        None
    }

    fn negate(&mut self, inner: &Expr, expr: &Expr, ty: Type) -> Option<Value> {
        if let (Kind::Integer(value), Type::I32) = (&inner.kind, ty) {
            let negative = i64::try_from(*value).ok().and_then(|value| i32::try_from(-value).ok());
            return negative.map(Value::I32);
        }
        match self.expr(inner)? {
            Value::Float(parts) => Some(Value::Float(parts.into_iter().map(|part| -part).collect())),
            Value::I32(value) => match value.checked_neg() {
                Some(value) => Some(Value::I32(value)),
                None => {
                    self.reject(expr, "this constant overflows an `i32`", "the least `i32` has no positive counterpart")
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
        let (left, constant) = (self.expr(left), self.expr(right));
        let known = constant.clone().or_else(|| self.variable_value(right))?;
        if !self.check_right_operand(operator, &known, expr) {
            return None;
        }
        match (left?, constant?) {
            (Value::Float(a), Value::Float(b)) => self.floats(operator, &a, &b, expr),
            (Value::Bool(a), Value::Bool(b)) => logical(operator, a, b),
            (left, right) => self.integers(operator, &left, &right, expr),
        }
    }

    /// Rejects a right operand that is invalid for every left operand: a zero divisor, or a shift count out of range.
    fn check_right_operand(&mut self, operator: Operator, right: &Value, expr: &Expr) -> bool {
        let zero = matches!(right, Value::U32(0) | Value::I32(0));
        if zero && matches!(operator, Operator::Divide | Operator::Remainder) {
            self.reject(expr, "this divides by zero", "divide by something else");
            return false;
        }
        if operator.is_shift() && integer(right).is_some_and(|count| !(0..32).contains(&count)) {
            self.reject(expr, "this shifts by more bits than there are", "shift by 0 to 31");
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
        self.reject(expr, "this constant is not a finite number", "shaders have no infinity: use `f32::MAX`")
    }

    /// Folds an operation on integers in 64 bits, and rejects a result outside the type of the left operand.
    fn integers(&mut self, operator: Operator, left: &Value, right: &Value, expr: &Expr) -> Option<Value> {
        let (a, b) = (integer(left)?, integer(right)?);
        let is_signed = matches!(left, Value::I32(_));
        if operator.is_shift() {
            let shifted = if operator == Operator::ShiftLeft { a << b } else { a >> b };
            let low = u32::try_from(shifted & i64::from(u32::MAX)).ok()?;
            return Some(if is_signed { Value::I32(low.cast_signed()) } else { Value::U32(low) });
        }
        if is_signed != matches!(right, Value::I32(_)) {
            return None;
        }
        if let Some(result) = compared(operator, Some(&a), Some(&b)) {
            return Some(Value::Bool(result));
        }
        let in_range = |value: i64| match is_signed {
            true => i32::try_from(value).ok().map(Value::I32),
            false => u32::try_from(value).ok().map(Value::U32),
        };
        let result = match operator {
            Operator::Add => a.checked_add(b),
            Operator::Subtract => a.checked_sub(b),
            Operator::Multiply => a.checked_mul(b),
            Operator::Divide => a.checked_div(b),
            // In Rust a remainder overflows if the quotient does.
            Operator::Remainder => a.checked_div(b).and_then(in_range).and_then(|_| a.checked_rem(b)),
            Operator::BitAnd => Some(a & b),
            Operator::BitOr => Some(a | b),
            _ => Some(a ^ b),
        };
        match (result.and_then(in_range), is_signed) {
            (Some(value), _) => Some(value),
            (None, false) => self.reject(expr, "this constant overflows a `u32`", "it goes from 0 to 4294967295"),
            (None, true) => {
                self.reject(expr, "this constant overflows an `i32`", "it goes from -2147483648 to 2147483647")
            }
        }
    }

    /// Rejects a zero divisor of a method whose expression divides by its argument.
    fn divisor(&mut self, spelling: Spelling, values: &[Option<Value>], arguments: &[Expr], expr: &Expr) {
        let (Spelling::Template(template), [_, value, ..], [_, argument, ..]) = (spelling, values, arguments) else {
            return;
        };
        let value = value.clone().or_else(|| self.variable_value(argument));
        if let (true, Some(value)) = (template.contains("% $1"), value) {
            self.check_right_operand(Operator::Remainder, &value, expr);
        }
    }

    fn clamp(&mut self, spelling: Spelling, values: &[Option<Value>], expr: &Expr) {
        let [_, Some(low), Some(high)] = values else { return };
        if spelling == Spelling::Call("clamp") && is_above(low, high) {
            let help = match (shown(low), shown(high)) {
                (Some(low), Some(high)) => format!("swap them: `clamp({high}, {low})`"),
                _ => "write `clamp(lower, upper)`".to_owned(),
            };
            self.reject(expr, "the lower bound is above the upper one", &help);
        }
    }
}

/// Returns a number as a literal; `None`: it is a vector or a `bool`.
pub(crate) fn shown(value: &Value) -> Option<String> {
    match value {
        Value::Float(parts) => match parts.as_slice() {
            [number] => Some(format!("{number:?}")),
            _ => None,
        },
        Value::U32(number) => Some(number.to_string()),
        Value::I32(number) => Some(number.to_string()),
        Value::Bool(_) => None,
    }
}

/// Tests whether a number, or a component of a vector, is above that of another.
pub(crate) fn is_above(low: &Value, high: &Value) -> bool {
    match (low, high) {
        (Value::Float(low), Value::Float(high)) => low.iter().zip(high).any(|(low, high)| low > high),
        (Value::U32(low), Value::U32(high)) => low > high,
        (Value::I32(low), Value::I32(high)) => low > high,
        _ => false,
    }
}

fn literal(value: u64, ty: Type) -> Option<Value> {
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

fn logical(operator: Operator, a: bool, b: bool) -> Option<Value> {
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

/// Returns the value of an integer.
fn integer(value: &Value) -> Option<i64> {
    match value {
        Value::U32(value) => Some(i64::from(*value)),
        Value::I32(value) => Some(i64::from(*value)),
        _ => None,
    }
}

/// Returns the value of `value as ty`. A cast from float to integer is not constant: the printer writes calls for it.
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

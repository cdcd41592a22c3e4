//! Evaluates closures by the meaning that Rust and `fragbuf language` give them, on syn's syntax trees. It shares no code with
//! fragbuf. Floats are ranges: see [`super::range`].
//!
//! Integers wrap, `x / 0` is `x`, `x % 0` is 0 and shift counts are modulo 32. Where Rust panics instead, the evaluator records it,
//! so that rustc can judge that, too.

use std::collections::HashMap;

use super::methods;
use super::operators::{self, Panics};
use super::range::{Range, Undefined};
use super::types::{ATTRIBUTES, Type, UNIFORMS};
use super::value::{Input, Value};

/// The reasons to leave an expression early.
pub enum Stop {
    Undefined(Undefined),
    Return(Value),
    Break,
    Continue,
}

impl From<Undefined> for Stop {
    fn from(reason: Undefined) -> Stop {
        Stop::Undefined(reason)
    }
}

/// A function of a program.
pub struct Function {
    pub parameters: Vec<(String, Option<Type>)>,
    pub result: Option<Type>,
    pub body: syn::Block,
}

/// The result of a closure.
pub struct Outcome {
    pub value: Result<Value, Undefined>,
    /// Where Rust panics instead.
    pub panics: Panics,
}

/// Evaluates a function with these arguments.
pub fn evaluate(functions: &HashMap<String, Function>, name: &str, arguments: Vec<Value>, input: &Input) -> Outcome {
    let mut evaluator = Evaluator { functions, input, names: Vec::new(), panics: Panics::default(), steps: 0 };
    let value = match evaluator.call(name, arguments) {
        Ok(value) => Ok(value),
        Err(Stop::Undefined(reason)) => Err(reason),
        Err(_) => Err(Undefined::Gap("a jump out of a function")),
    };
    Outcome { value, panics: evaluator.panics }
}

struct Evaluator<'a> {
    functions: &'a HashMap<String, Function>,
    input: &'a Input,
    names: Vec<(String, Value)>,
    panics: Panics,
    steps: u32,
}

/// The evaluated steps of one closure: far above what generated closures need.
const STEPS: u32 = 100_000;

/// The reason for no result after so many steps.
pub const TOO_LONG: Undefined = Undefined::Gap("too many steps");

impl Evaluator<'_> {
    fn call(&mut self, name: &str, arguments: Vec<Value>) -> Result<Value, Stop> {
        let functions = self.functions;
        let function = functions.get(name).ok_or(Undefined::Gap("an unknown function"))?;
        let caller = std::mem::take(&mut self.names);
        for ((name, ty), value) in function.parameters.iter().zip(arguments) {
            self.names.push((name.clone(), ty.map_or(value.clone(), |ty| value.typed(ty))));
        }
        let result = match self.block(&function.body) {
            Ok(value) | Err(Stop::Return(value)) => Ok(function.result.map_or(value.clone(), |ty| value.typed(ty))),
            Err(stop) => Err(stop),
        };
        self.names = caller;
        result
    }

    fn block(&mut self, block: &syn::Block) -> Result<Value, Stop> {
        let visible = self.names.len();
        let result = self.statements(block);
        self.names.truncate(visible);
        result
    }

    fn statements(&mut self, block: &syn::Block) -> Result<Value, Stop> {
        let mut value = Value::Unit;
        for statement in &block.stmts {
            match statement {
                syn::Stmt::Local(local) => self.local(local)?,
                syn::Stmt::Expr(expr, semicolon) => {
                    value = self.expr(expr)?;
                    if semicolon.is_some() {
                        value = Value::Unit;
                    }
                }
                _ => return Err(Undefined::Gap("an unknown statement").into()),
            }
        }
        Ok(value)
    }

    fn local(&mut self, local: &syn::Local) -> Result<(), Stop> {
        let init = local.init.as_ref().ok_or(Undefined::Gap("a variable without a value"))?;
        let mut value = self.expr(&init.expr)?;
        let pattern = match &local.pat {
            syn::Pat::Type(typed) => {
                if let Some(ty) = named(&typed.ty) {
                    value = value.typed(ty);
                }
                &*typed.pat
            }
            other => other,
        };
        if let syn::Pat::Ident(name) = pattern {
            self.names.push((name.ident.to_string(), value));
        }
        Ok(())
    }

    fn expr(&mut self, expr: &syn::Expr) -> Result<Value, Stop> {
        self.steps += 1;
        if self.steps > STEPS {
            return Err(TOO_LONG.into());
        }
        match expr {
            syn::Expr::Paren(inner) => self.expr(&inner.expr),
            syn::Expr::Lit(literal) => Ok(operators::literal(&literal.lit)?),
            syn::Expr::Path(path) => self.path(&path.path),
            syn::Expr::Field(field) => self.field(field),
            syn::Expr::Index(index) => self.index(index),
            syn::Expr::Unary(unary) => {
                if let Some(value) = operators::negative_literal(unary) {
                    return Ok(value);
                }
                let value = self.expr(&unary.expr)?;
                Ok(operators::unary(&unary.op, value, &mut self.panics)?)
            }
            syn::Expr::Binary(binary) => self.binary(binary),
            syn::Expr::Cast(cast) => {
                let value = self.expr(&cast.expr)?;
                Ok(operators::cast(value, named(&cast.ty).ok_or(Undefined::Gap("a cast to an unknown type"))?)?)
            }
            syn::Expr::Call(call) => self.function(call),
            syn::Expr::MethodCall(call) => self.method(call),
            syn::Expr::If(branch) => self.branch(branch),
            syn::Expr::Block(block) => self.block(&block.block),
            syn::Expr::ForLoop(each) => self.for_loop(each),
            syn::Expr::Assign(assign) => {
                let value = self.expr(&assign.right)?;
                self.update(&assign.left, |old, _| Ok(value.like(&old)))
            }
            syn::Expr::Return(leave) => {
                let value = self.expr(leave.expr.as_ref().ok_or(Undefined::Gap("a return without a value"))?)?;
                Err(Stop::Return(value))
            }
            syn::Expr::Break(_) => Err(Stop::Break),
            syn::Expr::Continue(_) => Err(Stop::Continue),
            _ => Err(Undefined::Gap("an unknown expression").into()),
        }
    }

    fn path(&self, path: &syn::Path) -> Result<Value, Stop> {
        let Some(name) = path.get_ident() else { return Ok(operators::constant(path)?) };
        let found = self.names.iter().rev().find(|(other, _)| name == other);
        Ok(found.ok_or(Undefined::Gap("an unknown name"))?.1.clone())
    }

    fn field(&mut self, field: &syn::ExprField) -> Result<Value, Stop> {
        let base = self.expr(&field.base)?;
        let syn::Member::Named(name) = &field.member else { return Err(Undefined::Gap("a tuple").into()) };
        let name = name.to_string();
        let at = |fields: &[(&str, Type)]| {
            fields.iter().position(|(other, _)| *other == name).ok_or(Undefined::Gap("an unknown field"))
        };
        match base {
            Value::Uniforms => Ok(self.input.uniforms[at(&UNIFORMS)?].clone()),
            Value::Fragment(attributes) => Ok(attributes[at(&ATTRIBUTES)?].clone()),
            Value::Vector(parts) => Ok(Value::Float(parts[component(&name)?])),
            _ => Err(Undefined::Gap("a field of a number").into()),
        }
    }

    fn index(&mut self, index: &syn::ExprIndex) -> Result<Value, Stop> {
        let base = self.expr(&index.expr)?;
        let at = self.expr(&index.index)?.integer()? as usize;
        let input = self.input;
        match base {
            Value::Vector(parts) => Ok(Value::Float(*parts.get(at).ok_or(Undefined::Open("an index out of bounds"))?)),
            Value::Fragments => Ok(input.fragments.get(at).ok_or(Undefined::Open("an index out of bounds"))?.clone()),
            _ => Err(Undefined::Gap("an index into a number").into()),
        }
    }

    fn binary(&mut self, binary: &syn::ExprBinary) -> Result<Value, Stop> {
        if let Some(operator) = operators::compound(&binary.op) {
            // The operands of generated assignments are primitive numbers, or vectors whose right side assigns nothing: Rust
            // evaluates the right side first.
            let right = self.expr(&binary.right)?;
            return self.update(&binary.left, |old, panics| operators::binary(operator, old, right, panics));
        }
        let left = self.expr(&binary.left)?;
        match (&binary.op, &left) {
            (syn::BinOp::And(_), Value::Bool(false)) | (syn::BinOp::Or(_), Value::Bool(true)) => Ok(left),
            (syn::BinOp::And(_) | syn::BinOp::Or(_), _) => self.expr(&binary.right),
            _ => {
                let right = self.expr(&binary.right)?;
                let operator = operators::simple(&binary.op).ok_or(Undefined::Gap("an unknown operator"))?;
                Ok(operators::binary(operator, left, right, &mut self.panics)?)
            }
        }
    }

    /// Evaluates a place and replaces its value.
    fn update(
        &mut self,
        place: &syn::Expr,
        new: impl FnOnce(Value, &mut Panics) -> Result<Value, Undefined>,
    ) -> Result<Value, Stop> {
        let mut steps = Vec::new();
        let name = self.steps_of(place, &mut steps)?;
        let variable = self
            .names
            .iter_mut()
            .rev()
            .find(|(other, _)| *other == name)
            .ok_or(Undefined::Gap("an unknown variable"))?;
        let panics = &mut self.panics;
        replace(&mut variable.1, &steps, |old| new(old, panics))?;
        Ok(Value::Unit)
    }

    /// Returns the variable of a place, and adds the index of each field or element.
    fn steps_of(&mut self, place: &syn::Expr, steps: &mut Vec<usize>) -> Result<String, Stop> {
        match place {
            syn::Expr::Paren(inner) => self.steps_of(&inner.expr, steps),
            syn::Expr::Path(path) => Ok(path.path.get_ident().ok_or(Undefined::Gap("a path as a place"))?.to_string()),
            syn::Expr::Field(field) => {
                let name = self.steps_of(&field.base, steps)?;
                let syn::Member::Named(member) = &field.member else { return Err(Undefined::Gap("a tuple").into()) };
                let member = member.to_string();
                let attribute = ATTRIBUTES.iter().position(|(other, _)| *other == member);
                steps.push(attribute.map_or_else(|| component(&member), Ok)?);
                Ok(name)
            }
            syn::Expr::Index(index) => {
                let name = self.steps_of(&index.expr, steps)?;
                steps.push(self.expr(&index.index)?.integer()? as usize);
                Ok(name)
            }
            _ => Err(Undefined::Gap("an unknown place").into()),
        }
    }

    fn function(&mut self, call: &syn::ExprCall) -> Result<Value, Stop> {
        let syn::Expr::Path(path) = &*call.func else { return Err(Undefined::Gap("a call of a value").into()) };
        let path: Vec<String> = path.path.segments.iter().map(|segment| segment.ident.to_string()).collect();
        let path: Vec<&str> = path.iter().map(String::as_str).collect();
        let mut arguments = call.args.iter().map(|argument| self.expr(argument)).collect::<Result<Vec<_>, _>>()?;
        let floats = |values: &[Value]| values.iter().map(Value::float).collect::<Result<Vec<Range>, _>>();
        match path.as_slice() {
            ["vec2" | "vec3" | "vec4"] | ["Vec2" | "Vec3" | "Vec4", "new"] => Ok(Value::Vector(floats(&arguments)?)),
            ["Vec2", "splat"] => Ok(Value::Vector(vec![arguments[0].float()?; 2])),
            ["Vec3", "splat"] => Ok(Value::Vector(vec![arguments[0].float()?; 3])),
            ["Vec4", "splat"] => Ok(Value::Vector(vec![arguments[0].float()?; 4])),
            ["f32", "from_bits"] => Ok(methods::from_bits(&arguments[0])?),
            [name] => self.call(name, arguments),
            [_, name] => {
                let receiver = arguments.remove(0);
                Ok(methods::call(name, receiver, arguments, &mut self.panics)?)
            }
            _ => Err(Undefined::Gap("an unknown function").into()),
        }
    }

    fn method(&mut self, call: &syn::ExprMethodCall) -> Result<Value, Stop> {
        let receiver = self.expr(&call.receiver)?;
        let arguments = call.args.iter().map(|argument| self.expr(argument)).collect::<Result<Vec<_>, _>>()?;
        let name = call.method.to_string();
        if receiver == Value::Fragments {
            let count = self.input.fragments.len();
            return match name.as_str() {
                "len" => Ok(Value::Usize(count as u64)),
                "is_empty" => Ok(Value::Bool(count == 0)),
                _ => Err(Undefined::Gap("an unknown method of a list").into()),
            };
        }
        Ok(methods::call(&name, receiver, arguments, &mut self.panics)?)
    }

    fn branch(&mut self, branch: &syn::ExprIf) -> Result<Value, Stop> {
        match (self.expr(&branch.cond)?.bool()?, &branch.else_branch) {
            (true, _) => self.block(&branch.then_branch),
            (false, Some((_, other))) => self.expr(other),
            (false, None) => Ok(Value::Unit),
        }
    }

    fn for_loop(&mut self, each: &syn::ExprForLoop) -> Result<Value, Stop> {
        let items = self.items(&each.expr)?;
        let pattern: Vec<&syn::Pat> = match &*each.pat {
            syn::Pat::Tuple(parts) => parts.elems.iter().collect(),
            other => vec![other],
        };
        for item in items {
            let visible = self.names.len();
            for (part, value) in pattern.iter().zip(item) {
                if let syn::Pat::Ident(name) = part {
                    self.names.push((name.ident.to_string(), value));
                }
            }
            let result = self.block(&each.body);
            self.names.truncate(visible);
            match result {
                Ok(_) | Err(Stop::Continue) => {}
                Err(Stop::Break) => break,
                Err(other) => return Err(other),
            }
        }
        Ok(Value::Unit)
    }

    /// Returns the values of a loop's variables in each iteration.
    fn items(&mut self, sequence: &syn::Expr) -> Result<Box<dyn Iterator<Item = Vec<Value>>>, Stop> {
        match sequence {
            syn::Expr::Paren(inner) => self.items(&inner.expr),
            syn::Expr::Range(range) => self.range(range, false),
            syn::Expr::MethodCall(call) => match call.method.to_string().as_str() {
                "iter" => self.items(&call.receiver),
                "enumerate" => {
                    let inner = self.items(&call.receiver)?;
                    let numbered = |(at, item): (usize, Vec<Value>)| {
                        std::iter::once(Value::Usize(at as u64)).chain(item).collect()
                    };
                    Ok(Box::new(inner.enumerate().map(numbered)))
                }
                "rev" => {
                    let receiver = operators::without_parens(&call.receiver);
                    if let syn::Expr::Range(range) = receiver {
                        return self.range(range, true);
                    }
                    let mut all: Vec<Vec<Value>> = self.items(receiver)?.collect();
                    all.reverse();
                    Ok(Box::new(all.into_iter()))
                }
                _ => Err(Undefined::Gap("an unknown iterator").into()),
            },
            _ => {
                let fragments = self.input.fragments.clone();
                Ok(Box::new(fragments.into_iter().map(|fragment| vec![fragment])))
            }
        }
    }

    fn range(&mut self, range: &syn::ExprRange, reversed: bool) -> Result<Box<dyn Iterator<Item = Vec<Value>>>, Stop> {
        let (from, to) = (
            range.start.as_ref().ok_or(Undefined::Gap("no start"))?,
            range.end.as_ref().ok_or(Undefined::Gap("no end"))?,
        );
        let (from, to) = (self.expr(from)?, self.expr(to)?);
        let (from, to) = (from.clone().like(&to), to.like(&from));
        let last = to.integer()? - i128::from(matches!(range.limits, syn::RangeLimits::HalfOpen(_)));
        let first = from.integer()?;
        let value = move |index: i128| vec![Value::Literal(index).like(&from)];
        Ok(match reversed {
            true => Box::new((first..=last).rev().map(value)),
            false => Box::new((first..=last).map(value)),
        })
    }
}

/// Replaces a value inside of another.
fn replace(
    value: &mut Value,
    steps: &[usize],
    new: impl FnOnce(Value) -> Result<Value, Undefined>,
) -> Result<(), Undefined> {
    let Some((step, rest)) = steps.split_first() else {
        *value = new(value.clone())?;
        return Ok(());
    };
    match value {
        Value::Fragment(attributes) => replace(&mut attributes[*step], rest, new),
        Value::Vector(parts) => {
            let part = parts.get_mut(*step).ok_or(Undefined::Open("an index out of bounds"))?;
            *part = new(Value::Float(*part))?.float()?;
            Ok(())
        }
        _ => Err(Undefined::Gap("a part of a number")),
    }
}

/// Returns the index of a vector's component.
pub fn component(name: &str) -> Result<usize, Undefined> {
    ["x", "y", "z", "w"].iter().position(|other| *other == name).ok_or(Undefined::Gap("an unknown component"))
}

fn named(ty: &syn::Type) -> Option<Type> {
    let syn::Type::Path(path) = ty else { return None };
    Type::named(&path.path.get_ident()?.to_string())
}

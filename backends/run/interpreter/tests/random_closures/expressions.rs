//! Random expressions.

use super::random::Random;
use super::source::{Level, Source};
use super::table::{Argument, Method, NUMBERS, VECTORS};
use super::types::{ATTRIBUTES, Type, UNIFORMS};

/// A variable in scope.
#[derive(Clone, Debug)]
pub struct Variable {
    pub name: String,
    pub ty: Type,
    pub mutable: bool,
}

/// What the generator has declared so far.
pub struct Scope<'r> {
    pub random: &'r mut Random,
    /// The result of the function, for `return`.
    pub result: Type,
    pub variables: Vec<Variable>,
    /// Names of fragments and of lists of fragments.
    pub fragments: Vec<String>,
    pub lists: Vec<&'static str>,
    pub uniforms: bool,
    /// A function that may be called: name, parameters, result.
    pub helper: Option<(String, Vec<Type>, Type)>,
    pub loops: usize,
    /// Whether expressions may contain assignments.
    pub effects: bool,
    /// Whether float literals have a suffix: Rust must know the type of a method's receiver.
    pub suffixed: bool,
    /// The number of declared names, of which some repeat.
    pub names: usize,
    /// The statements that may still be written.
    pub budget: usize,
    pub indent: usize,
}

const COMPARISONS: [&str; 6] = ["<", "<=", ">", ">=", "==", "!="];
const NUMERIC: [Type; 3] = [Type::U32, Type::I32, Type::F32];

impl<'r> Scope<'r> {
    pub fn new(random: &'r mut Random, result: Type) -> Self {
        let budget = 2 + random.below(9);
        Scope {
            random,
            result,
            variables: Vec::new(),
            fragments: Vec::new(),
            lists: Vec::new(),
            uniforms: false,
            helper: None,
            loops: 0,
            effects: true,
            suffixed: false,
            names: 0,
            budget,
            indent: 0,
        }
    }

    /// Returns an expression.
    pub fn expr(&mut self, ty: Type, depth: usize) -> Source {
        if depth == 0 || self.random.once_in(6) {
            return self.leaf(ty);
        }
        match self.random.below(12) {
            0 => self.branch(ty, depth - 1),
            1 if self.effects && self.budget > 0 => self.block_value(ty, depth - 1),
            2 => self.call(ty, depth - 1),
            3 | 4 => self.method(ty, depth - 1),
            _ => self.operation(ty, depth - 1),
        }
    }

    /// Returns a variable, a literal, a uniform or an attribute.
    pub fn leaf(&mut self, ty: Type) -> Source {
        let visible = self.visible(ty);
        match self.random.below(12) {
            0..=6 if !visible.is_empty() => {
                let at = self.random.below(visible.len());
                Source::primary(visible[at].clone())
            }
            3..=8 if self.uniforms => match fields(&UNIFORMS, ty) {
                names if names.is_empty() => self.literal(ty),
                names => Source::primary(format!("u.{}", self.random.pick(&names))),
            },
            9 | 10 => self.attribute(ty),
            // Comparisons of literals would remove most branches.
            _ if ty == Type::Bool && !self.random.once_in(8) => self.comparison(),
            _ => self.literal(ty),
        }
    }

    fn comparison(&mut self) -> Source {
        let ty = self.random.pick(&NUMERIC);
        let operator = self.random.pick(&COMPARISONS);
        let left = self.leaf(ty);
        left.binary(operator, &self.leaf(ty))
    }

    /// Returns the variables of this type that no other hides.
    fn visible(&self, ty: Type) -> Vec<String> {
        let is_hidden = |at: usize, name: &str| self.variables[at + 1..].iter().any(|other| other.name == name);
        let fits = |(at, variable): (usize, &Variable)| {
            (variable.ty == ty && !is_hidden(at, &variable.name)).then(|| variable.name.clone())
        };
        self.variables.iter().enumerate().filter_map(fits).collect()
    }

    /// Returns a mutable variable of this type.
    pub fn mutable(&mut self, ty: Type) -> Option<String> {
        let visible = self.visible(ty);
        let is_mutable = |name: &String| {
            self.variables.iter().rev().find(|other| other.name == **name).is_some_and(|other| other.mutable)
        };
        let mutable: Vec<String> = visible.into_iter().filter(is_mutable).collect();
        (!mutable.is_empty()).then(|| mutable[self.random.below(mutable.len())].clone())
    }

    fn attribute(&mut self, ty: Type) -> Source {
        let names = fields(&ATTRIBUTES, ty);
        if names.is_empty() {
            return self.literal(ty);
        }
        let name = self.random.pick(&names);
        match (self.fragments.is_empty(), self.lists.is_empty()) {
            (false, _) => {
                let at = self.random.below(self.fragments.len());
                Source::primary(format!("{}.{name}", self.fragments[at]))
            }
            (true, false) => Source::primary(format!("fragments[fragments.len() - 1].{name}")),
            _ => self.literal(ty),
        }
    }

    pub fn literal(&mut self, ty: Type) -> Source {
        let text = match ty {
            Type::U32 => self.random.pick(&[
                "0u32",
                "1u32",
                "2u32",
                "3_u32",
                "7u32",
                "31u32",
                "32u32",
                "0xffu32",
                "0x8000_0000u32",
                "4294967295u32",
                "u32::MAX",
                "1000u32",
            ]),
            Type::I32 => self.random.pick(&[
                "0i32",
                "1i32",
                "-1i32",
                "2i32",
                "-3i32",
                "7i32",
                "31i32",
                "i32::MIN",
                "i32::MAX",
                "-2147483648i32",
                "-100i32",
                "65537i32",
            ]),
            Type::Usize => self.random.pick(&["0usize", "1usize", "2usize", "3usize", "5usize"]),
            Type::Bool => self.random.pick(&["true", "false"]),
            Type::F32 => self.random.pick(&[
                "0.0",
                "1.0",
                "-1.0",
                "0.5",
                "2.0",
                "0.1",
                "-0.3",
                "3.75",
                "1e3",
                "1.5e-3",
                "-7.25f32",
                "100.0_f32",
                "16777216.0",
                "std::f32::consts::PI",
                "f32::EPSILON",
                "4294967296.0",
            ]),
            Type::Vector(size) => {
                if self.random.once_in(2) {
                    let name = self.random.pick(&["ZERO", "ONE", "NEG_ONE"]);
                    return Source::primary(format!("Vec{size}::{name}"));
                }
                let parts: Vec<String> = (0..size).map(|_| self.leaf(Type::F32).text).collect();
                return Source::primary(format!("vec{size}({})", parts.join(", ")));
            }
        };
        let level = if text.starts_with('-') { Level::Unary } else { Level::Primary };
        let suffix = if self.suffixed && ty == Type::F32 && !text.contains(['f', ':']) { "_f32" } else { "" };
        Source { text: format!("{text}{suffix}"), level, constant: true }
    }

    /// Returns an operand that may be an integer literal without suffix, because the other operand has a type.
    fn operand_of_typed(&mut self, ty: Type, depth: usize) -> Source {
        match ty.is_integer() && self.random.once_in(3) {
            true => {
                let literal = Source::primary(self.random.pick(&["1", "2", "3", "5", "16", "100"]));
                Source { constant: true, ..literal }
            }
            false => self.expr(ty, depth),
        }
    }

    /// Returns a left operand. It seldom consists of literals: fragbuf rejects most operations on literals that overflow.
    fn left(&mut self, ty: Type, depth: usize) -> Source {
        let left = self.expr(ty, depth);
        let visible = self.visible(ty);
        match left.constant && !visible.is_empty() && !self.random.once_in(10) {
            true => Source::primary(visible[self.random.below(visible.len())].clone()),
            false => left,
        }
    }

    fn operation(&mut self, ty: Type, depth: usize) -> Source {
        match ty {
            Type::Bool => self.bool_operation(depth),
            Type::U32 | Type::I32 => self.integer_operation(ty, depth),
            Type::Usize => self.index_operation(depth),
            Type::F32 => self.float_operation(depth),
            Type::Vector(size) => self.vector_operation(size, depth),
        }
    }

    fn bool_operation(&mut self, depth: usize) -> Source {
        match self.random.below(8) {
            0 => self.expr(Type::Bool, depth).unary('!'),
            1 | 2 => {
                let operator = self.random.pick(&["&&", "||", "&", "|", "^", "==", "!="]);
                let left = self.expr(Type::Bool, depth);
                left.binary(operator, &self.expr(Type::Bool, depth))
            }
            _ => {
                let ty = self.random.pick(&NUMERIC);
                let operator = self.random.pick(&COMPARISONS);
                let left = self.left(ty, depth);
                left.binary(operator, &self.operand_of_typed(ty, depth))
            }
        }
    }

    fn integer_operation(&mut self, ty: Type, depth: usize) -> Source {
        match self.random.below(10) {
            0 if ty == Type::I32 => self.expr(ty, depth).unary('-'),
            0 | 1 => self.expr(ty, depth).unary('!'),
            2 | 3 => {
                let other = if ty == Type::U32 { Type::I32 } else { Type::U32 };
                let from = self.random.pick(&[other, Type::Bool, Type::F32, Type::Usize, ty]);
                self.expr(from, depth).cast(ty.rust())
            }
            4 => {
                let left = self.left(ty, depth);
                let count = self.random.pick(&[Type::U32, Type::I32]);
                let count = self.operand_of_typed(count, depth);
                left.binary(self.random.pick(&["<<", ">>"]), &count)
            }
            _ => {
                let operator = self.random.pick(&["+", "-", "*", "/", "%", "&", "|", "^", "+", "*"]);
                let left = self.left(ty, depth);
                left.binary(operator, &self.operand_of_typed(ty, depth))
            }
        }
    }

    fn index_operation(&mut self, depth: usize) -> Source {
        let left = self.left(Type::Usize, depth);
        match self.random.below(4) {
            0 => left.binary("%", &Source::primary(self.random.pick(&["1", "2", "3"]))),
            1 => left.binary("+", &self.leaf(Type::Usize)),
            _ => {
                let small = self.expr(Type::U32, depth).binary("&", &Source::primary("3"));
                small.cast("usize")
            }
        }
    }

    fn float_operation(&mut self, depth: usize) -> Source {
        match self.random.below(12) {
            0 => self.expr(Type::F32, depth).unary('-'),
            1 => {
                let from = self.random.pick(&[Type::U32, Type::I32, Type::F32]);
                self.expr(from, depth).cast("f32")
            }
            2 => {
                let bits = self.expr(Type::U32, depth).binary("&", &Source::primary("0x3fff_ffff"));
                Source::primary(format!("f32::from_bits({})", bits.text))
            }
            3 | 4 => self.component(depth),
            _ => {
                let operator = self.random.pick(&["+", "-", "*", "/", "%", "+", "-", "*"]);
                let left = self.left(Type::F32, depth);
                left.binary(operator, &self.expr(Type::F32, depth))
            }
        }
    }

    fn component(&mut self, depth: usize) -> Source {
        let size = 2 + self.random.below(3);
        let vector = self.expr(Type::Vector(size), depth);
        match self.random.below(3) {
            0 => {
                let index = self.expr(Type::Usize, depth.min(1)).binary("%", &Source::primary(size.to_string()));
                vector.element(&index)
            }
            1 => vector.element(&Source::primary(self.random.below(size).to_string())),
            _ => vector.field(["x", "y", "z", "w"][self.random.below(size)]),
        }
    }

    fn vector_operation(&mut self, size: usize, depth: usize) -> Source {
        let ty = Type::Vector(size);
        match self.random.below(8) {
            0 => self.expr(ty, depth).unary('-'),
            1 => {
                let parts: Vec<String> = (0..size).map(|_| self.expr(Type::F32, depth).text).collect();
                let function = self.random.pick(&["vec", "Vec"]);
                let path = if function == "vec" { format!("vec{size}") } else { format!("Vec{size}::new") };
                Source::primary(format!("{path}({})", parts.join(", ")))
            }
            2 => Source::primary(format!("Vec{size}::splat({})", self.expr(Type::F32, depth).text)),
            3 => {
                let from = 2 + self.random.below(3);
                let letters = ["x", "y", "z", "w"];
                let swizzle: String = (0..size).map(|_| letters[self.random.below(from)]).collect();
                self.expr(Type::Vector(from), depth).method(&swizzle, &[])
            }
            4 => {
                let operator = self.random.pick(&["+", "-", "*", "/"]);
                let left = self.expr(ty, depth);
                left.binary(operator, &self.expr(Type::F32, depth))
            }
            5 => {
                let operator = self.random.pick(&["+", "-", "*", "/"]);
                let left = self.expr(Type::F32, depth);
                left.binary(operator, &self.expr(ty, depth))
            }
            _ => {
                let operator = self.random.pick(&["+", "-", "*", "/", "%", "+", "-", "*"]);
                let left = self.expr(ty, depth);
                left.binary(operator, &self.expr(ty, depth))
            }
        }
    }

    /// Returns a method call whose result has this type.
    fn method(&mut self, ty: Type, depth: usize) -> Source {
        let fits: Vec<&Method> = NUMBERS.iter().chain(VECTORS).filter(|method| method.result == ty).collect();
        if fits.is_empty() {
            return match self.lists.is_empty() {
                true => self.operation(ty, depth),
                false if ty == Type::Bool => Source::primary("fragments.is_empty()"),
                false => Source::primary("fragments.len()"),
            };
        }
        let method = fits[self.random.below(fits.len())];
        let receiver = self.receiver(method.on, depth);
        let receiver = limited(&receiver, method.limits);
        let mut arguments = Vec::new();
        for argument in method.arguments {
            arguments.push(match argument {
                Argument::Any(ty) => self.operand_of_typed(*ty, depth),
                Argument::Limited(ty, limits) => limited(&self.receiver(*ty, depth), limits),
            });
        }
        if self.random.once_in(8) && method.on != Type::Usize {
            let all: Vec<String> = std::iter::once(&receiver).chain(&arguments).map(|part| part.text.clone()).collect();
            return Source::primary(format!("{}::{}({})", method.on.rust(), method.name, all.join(", ")));
        }
        receiver.method(method.name, &arguments)
    }

    /// Returns an expression whose type Rust knows before it reads the method.
    pub fn receiver(&mut self, ty: Type, depth: usize) -> Source {
        let outer = std::mem::replace(&mut self.suffixed, true);
        let receiver = self.expr(ty, depth);
        self.suffixed = outer;
        receiver
    }

    fn call(&mut self, ty: Type, depth: usize) -> Source {
        let Some((name, parameters, result)) = self.helper.clone() else { return self.operation(ty, depth) };
        if result != ty {
            return self.operation(ty, depth);
        }
        let arguments: Vec<String> = parameters.iter().map(|ty| self.expr(*ty, depth).text).collect();
        Source::primary(format!("{name}({})", arguments.join(", ")))
    }
}

/// Returns the fields of this type.
fn fields(all: &[(&'static str, Type)], ty: Type) -> Vec<&'static str> {
    all.iter().filter(|field| field.1 == ty).map(|field| field.0).collect()
}

fn limited(source: &Source, limits: &str) -> Source {
    match limits.strip_prefix('.').and_then(|limits| limits.split_once('(')) {
        Some((name, rest)) => source.method(name, &[Source::primary(rest.strip_suffix(')').unwrap_or(rest))]),
        None => source.clone(),
    }
}

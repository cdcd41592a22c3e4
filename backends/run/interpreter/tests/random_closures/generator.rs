//! Generates closures: random functions over the whole grammar of the language, and the texts of their descriptions.
//!
//! Input: a seed. Output: Rust source that rustc accepts. Loops end after a few iterations, and indices are in bounds.

use super::expressions::Scope;
use super::random::Random;
use super::types::{ATTRIBUTES, Type, UNIFORMS};

/// A generated closure with the function that it calls.
#[derive(Clone, Debug)]
pub struct Program {
    /// The number of the program, which its functions have in their names.
    pub index: usize,
    /// The declaration of the helper, `fn h0(…) -> … { … }`.
    pub helper: String,
    /// The body of the closure, with braces.
    pub body: String,
    /// The result of the closure.
    pub result: Type,
    /// Whether this is an effect over the list of fragments, or a function of one fragment.
    pub is_resolve: bool,
}

impl Program {
    /// Generates the program of this number.
    pub fn random(index: usize) -> Program {
        let mut random = Random::new(index as u64 + 1);
        let is_resolve = random.once_in(4);
        let result = if is_resolve { Type::Vector(4) } else { random.pick(&RESULTS) };
        let helper = helper(&mut random, index);
        let mut scope = Scope::new(&mut random, result);
        if is_resolve {
            scope.lists.push("fragments");
        } else {
            scope.fragments.push("f".to_owned());
        }
        scope.uniforms = true;
        scope.helper = Some((format!("h{index}"), helper.1, helper.2));
        let body = scope.body(result);
        Program { index, helper: helper.0, body, result, is_resolve }
    }

    /// Returns the name of the closure.
    pub fn name(&self) -> String {
        format!("c{}", self.index)
    }

    /// Returns the functions as parts of a description.
    pub fn parts(&self) -> String {
        let Program { index, helper, body, result, is_resolve } = self;
        match is_resolve {
            true => format!("{helper}\nresolve |fragments, u| {body}\n"),
            false => format!("{helper}\nfn c{index}(f: Fragment, u: Uniforms) -> {} {body}\n", result.rust()),
        }
    }

    /// Returns the functions as Rust.
    pub fn rust(&self) -> String {
        let Program { index, helper, body, result, is_resolve } = self;
        let parameters = if *is_resolve { "fragments: Fragments<'_>" } else { "f: Fragment" };
        format!("{helper}\nfn c{index}({parameters}, u: Uniforms) -> {} {body}\n", result.rust())
    }

    /// Returns a description that contains the program.
    pub fn description(&self) -> String {
        let list = |fields: &[(&str, Type)]| {
            fields.iter().map(|(name, ty)| format!("{name}: {}", ty.keyword())).collect::<Vec<_>>().join(", ")
        };
        format!(
            "buffer Compared {{\nfragment {{ {} }}\nuniform {{ {} }}\n{}}}\n",
            list(&ATTRIBUTES),
            list(&UNIFORMS),
            self.parts()
        )
    }
}

/// The results of functions. Integers and `bool` are compared exactly, so they are the most frequent.
const RESULTS: [Type; 9] = [
    Type::U32,
    Type::U32,
    Type::I32,
    Type::I32,
    Type::Bool,
    Type::F32,
    Type::Vector(2),
    Type::Vector(3),
    Type::Vector(4),
];

/// Returns a function with parameters, their types, and its result.
fn helper(random: &mut Random, index: usize) -> (String, Vec<Type>, Type) {
    let count = 1 + random.below(3);
    let types: Vec<Type> = (0..count).map(|_| random.pick(&RESULTS)).collect();
    let result = random.pick(&RESULTS);
    let mut scope = Scope::new(random, result);
    let mut parameters = Vec::new();
    for ty in &types {
        let mutable = scope.random.once_in(3);
        let name = scope.declare_parameter(*ty, mutable);
        parameters.push(format!("{}{name}: {}", if mutable { "mut " } else { "" }, ty.rust()));
    }
    let body = scope.body(result);
    (format!("fn h{index}({}) -> {} {body}", parameters.join(", "), result.rust()), types, result)
}

//! Values of the evaluator.

use super::range::{Range, Undefined};
use super::types::{ATTRIBUTES, FRAGMENTS, Type, UNIFORMS, words_of};

/// A value of a closure.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// An integer literal without suffix: the other operand has its type.
    Literal(i128),
    U32(u32),
    I32(i32),
    Usize(u64),
    Bool(bool),
    Float(Range),
    Vector(Vec<Range>),
    /// The attributes of a fragment, in the order of [`ATTRIBUTES`].
    Fragment(Vec<Value>),
    Fragments,
    Uniforms,
    Unit,
}

/// What a closure reads: uniforms and the fragments of a pixel.
#[derive(Clone, Debug)]
pub struct Input {
    pub words: Vec<u32>,
    pub uniforms: Vec<Value>,
    /// The fragments of the pixel.
    pub fragments: Vec<Value>,
    /// The words of all fragments, used or not.
    pub layers: Vec<Value>,
}

impl Input {
    /// The number of words of an input.
    pub fn size() -> usize {
        words_of(&UNIFORMS) + FRAGMENTS * words_of(&ATTRIBUTES) + 1
    }

    /// Reads an input from its words: uniforms, fragments, and the number of fragments.
    pub fn from_words(words: Vec<u32>) -> Input {
        let mut at = words.iter().copied();
        let uniforms = read(&UNIFORMS, &mut at);
        let layers: Vec<Value> = (0..FRAGMENTS).map(|_| Value::Fragment(read(&ATTRIBUTES, &mut at))).collect();
        let count = at.next().unwrap_or(0) as usize;
        drop(at);
        Input { words, uniforms, fragments: layers[..count].to_vec(), layers }
    }
}

fn read(fields: &[(&str, Type)], words: &mut impl Iterator<Item = u32>) -> Vec<Value> {
    let mut next = || words.next().unwrap_or(0);
    fields.iter().map(|(_, ty)| from_words(*ty, &mut next)).collect()
}

fn from_words(ty: Type, next: &mut impl FnMut() -> u32) -> Value {
    match ty {
        Type::U32 => Value::U32(next()),
        Type::I32 => Value::I32(next().cast_signed()),
        Type::Usize => Value::Usize(next().into()),
        Type::Bool => Value::Bool(next() != 0),
        Type::F32 => Value::Float(Range::of(f32::from_bits(next()))),
        Type::Vector(size) => Value::Vector((0..size).map(|_| Range::of(f32::from_bits(next()))).collect()),
    }
}

impl Value {
    /// Gives a literal the type of another value.
    pub fn like(self, other: &Value) -> Value {
        let Value::Literal(literal) = self else { return self };
        match other {
            Value::U32(_) => Value::U32(literal as u32),
            Value::Usize(_) => Value::Usize(literal as u64),
            Value::Literal(_) => Value::Literal(literal),
            _ => Value::I32(literal as i32),
        }
    }

    /// Gives a literal this type.
    pub fn typed(self, ty: Type) -> Value {
        match ty {
            Type::U32 => self.like(&Value::U32(0)),
            Type::Usize => self.like(&Value::Usize(0)),
            _ => self.like(&Value::I32(0)),
        }
    }

    pub fn float(&self) -> Result<Range, Undefined> {
        if let Value::Float(range) = self { Ok(*range) } else { Err(Undefined::Gap("not a float")) }
    }

    /// Returns the components of a float or vector.
    pub fn parts(&self) -> Result<Vec<Range>, Undefined> {
        match self {
            Value::Float(range) => Ok(vec![*range]),
            Value::Vector(parts) => Ok(parts.clone()),
            _ => Err(Undefined::Gap("not a vector")),
        }
    }

    /// Returns an integer of any type.
    pub fn integer(&self) -> Result<i128, Undefined> {
        match self {
            Value::Literal(value) => Ok(*value),
            Value::U32(value) => Ok(i128::from(*value)),
            Value::I32(value) => Ok(i128::from(*value)),
            Value::Usize(value) => Ok(i128::from(*value)),
            _ => Err(Undefined::Gap("not an integer")),
        }
    }

    pub fn bool(&self) -> Result<bool, Undefined> {
        if let Value::Bool(value) = self { Ok(*value) } else { Err(Undefined::Gap("not a bool")) }
    }

    /// Returns whether a device's words are this value.
    pub fn is(&self, words: &[u32]) -> bool {
        let all = |parts: &[Range]| parts.iter().zip(words).all(|(part, word)| part.contains(f32::from_bits(*word)));
        match self {
            Value::Float(range) => all(&[*range]),
            Value::Vector(parts) => all(parts),
            Value::Bool(value) => words.first() == Some(&u32::from(*value)),
            other => other.integer().is_ok_and(|value| words.first().is_some_and(|word| *word == value as u32)),
        }
    }
}

//! Numbers whose type is decided later: `1` is an `i32` unless something it meets says otherwise, as in Rust.
//!
//! In: types that must agree, one pair at a time. Out: for each number without a suffix, its type. An unsuffixed whole
//! number never becomes an `f32`: Rust would refuse it.

use crate::types::Type;

/// What is known of the undecided numbers of one function.
#[derive(Debug, Default)]
pub(crate) struct Inference {
    slots: Vec<Slot>,
}

#[derive(Debug)]
struct Slot {
    whole: bool,
    decided: Option<Type>,
}

impl Inference {
    /// The type of an unsuffixed `1`.
    pub(crate) fn whole(&mut self) -> Type {
        self.slot(true)
    }

    /// The type of an unsuffixed `1.0`.
    pub(crate) fn fractional(&mut self) -> Type {
        self.slot(false)
    }

    fn slot(&mut self, whole: bool) -> Type {
        self.slots.push(Slot { whole, decided: None });
        Type::Unknown(self.slots.len() - 1)
    }

    /// The type as far as it is known now.
    pub(crate) fn resolve(&self, mut kind: Type) -> Type {
        // Slots only ever point at slots that were undecided, so this ends.
        while let Type::Unknown(index) = kind {
            match self.slots.get(index).and_then(|slot| slot.decided) {
                Some(next) => kind = next,
                None => return kind,
            }
        }
        kind
    }

    /// The type once the whole function is known: what is still open is an `i32` or an `f32`.
    pub(crate) fn settle(&self, kind: Type) -> Type {
        match self.resolve(kind) {
            open @ Type::Unknown(_) => {
                if self.is_whole(open) {
                    Type::I32
                } else {
                    Type::F32
                }
            }
            known => known,
        }
    }

    /// Whether it is a whole number, decided or not.
    pub(crate) fn is_whole(&self, kind: Type) -> bool {
        match self.resolve(kind) {
            Type::Unknown(index) => self.slots.get(index).is_some_and(|slot| slot.whole),
            known => known.is_integer(),
        }
    }

    /// Whether it is an `f32`, or will be.
    pub(crate) fn is_fractional(&self, kind: Type) -> bool {
        match self.resolve(kind) {
            open @ Type::Unknown(_) => !self.is_whole(open),
            known => known == Type::F32,
        }
    }

    /// Makes the two agree, and says what they agree on; nothing where they cannot.
    pub(crate) fn unify(&mut self, a: Type, b: Type) -> Option<Type> {
        let (a, b) = (self.resolve(a), self.resolve(b));
        match (a, b) {
            (Type::Error, other) | (other, Type::Error) | (Type::Never, other) | (other, Type::Never) => Some(other),
            _ if a == b => Some(a),
            (Type::Unknown(index), other) | (other, Type::Unknown(index)) => {
                let agrees =
                    if self.is_whole(Type::Unknown(index)) { self.is_whole(other) } else { self.is_fractional(other) };
                if !agrees {
                    return None;
                }
                if let Some(slot) = self.slots.get_mut(index) {
                    slot.decided = Some(other);
                }
                Some(other)
            }
            _ => None,
        }
    }

    /// The type in a message.
    pub(crate) fn name(&self, kind: Type) -> &'static str {
        match self.resolve(kind) {
            open @ Type::Unknown(_) if self.is_whole(open) => "a whole number",
            Type::Unknown(_) => "f32",
            known => known.rust(),
        }
    }
}

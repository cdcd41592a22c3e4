//! Constants of the number types and of glam's vectors.
//!
//! Input: the segments of a path. Output: the value of a number, or the components of a vector. Functions such as
//! `Vec3::new` are in `check/calls.rs`.

use std::f32::consts;

use crate::types::Type;

/// The value of a constant.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Constant {
    Float(f32),
    U32(u32),
    I32(i32),
    /// A vector with equal components: size and value.
    Splat(u8, f32),
    /// A unit vector: size, index of the component, and its value.
    Axis(u8, u8, f32),
}

impl Constant {
    /// Returns the type in Rust.
    pub(crate) fn rust(&self) -> &'static str {
        match self {
            Constant::Float(_) => Type::F32,
            Constant::U32(_) => Type::U32,
            Constant::I32(_) => Type::I32,
            Constant::Splat(size, _) | Constant::Axis(size, ..) => Type::Vector(*size),
        }
        .rust()
    }
}

/// Returns the constant of a path without `std` or `core`.
pub(crate) fn find(path: &[String]) -> Option<Constant> {
    let path: Vec<&str> = path.iter().map(String::as_str).collect();
    match path.as_slice() {
        ["f32", "consts", name] => FLOAT_CONSTS.iter().find(|row| row.0 == *name).map(|row| Constant::Float(row.1)),
        ["f32", name] => FLOATS.iter().find(|row| row.0 == *name).map(|row| Constant::Float(row.1)),
        ["u32", "MIN"] => Some(Constant::U32(u32::MIN)),
        ["u32", "MAX"] => Some(Constant::U32(u32::MAX)),
        ["u32" | "i32", "BITS"] => Some(Constant::U32(u32::BITS)),
        ["i32", "MIN"] => Some(Constant::I32(i32::MIN)),
        ["i32", "MAX"] => Some(Constant::I32(i32::MAX)),
        ["Vec2", name] => vector(2, name),
        ["Vec3", name] => vector(3, name),
        ["Vec4", name] => vector(4, name),
        _ => None,
    }
}

fn vector(size: u8, name: &str) -> Option<Constant> {
    let splats = [("ZERO", 0.0), ("ONE", 1.0), ("NEG_ONE", -1.0), ("MAX", f32::MAX), ("MIN", f32::MIN)];
    if let Some((_, value)) = splats.iter().find(|row| row.0 == name) {
        return Some(Constant::Splat(size, *value));
    }
    let (axis, value) = match name.strip_prefix("NEG_") {
        Some(axis) => (axis, -1.0),
        None => (name, 1.0),
    };
    let index = ["X", "Y", "Z", "W"].iter().take(usize::from(size)).position(|name| *name == axis)?;
    Some(Constant::Axis(size, u8::try_from(index).ok()?, value))
}

/// Returns the path of every constant, for suggestions.
pub(crate) fn names() -> Vec<String> {
    let mut all: Vec<String> = FLOATS.iter().map(|row| format!("f32::{}", row.0)).collect();
    all.extend(FLOAT_CONSTS.iter().map(|row| format!("f32::consts::{}", row.0)));
    all.extend(["u32::MIN", "u32::MAX", "i32::MIN", "i32::MAX"].map(String::from));
    for (size, axes) in [(2, "X Y"), (3, "X Y Z"), (4, "X Y Z W")] {
        let names = axes.split(' ').chain(["ZERO", "ONE", "NEG_ONE"]);
        all.extend(names.map(|name| format!("Vec{size}::{name}")));
    }
    all
}

const FLOATS: &[(&str, f32)] =
    &[("MAX", f32::MAX), ("MIN", f32::MIN), ("MIN_POSITIVE", f32::MIN_POSITIVE), ("EPSILON", f32::EPSILON)];

const FLOAT_CONSTS: &[(&str, f32)] = &[
    ("PI", consts::PI),
    ("TAU", consts::TAU),
    ("E", consts::E),
    ("FRAC_PI_2", consts::FRAC_PI_2),
    ("FRAC_PI_3", consts::FRAC_PI_3),
    ("FRAC_PI_4", consts::FRAC_PI_4),
    ("FRAC_PI_6", consts::FRAC_PI_6),
    ("FRAC_PI_8", consts::FRAC_PI_8),
    ("FRAC_1_PI", consts::FRAC_1_PI),
    ("FRAC_2_PI", consts::FRAC_2_PI),
    ("FRAC_2_SQRT_PI", consts::FRAC_2_SQRT_PI),
    ("FRAC_1_SQRT_2", consts::FRAC_1_SQRT_2),
    ("SQRT_2", consts::SQRT_2),
    ("LN_2", consts::LN_2),
    ("LN_10", consts::LN_10),
    ("LOG2_E", consts::LOG2_E),
    ("LOG2_10", consts::LOG2_10),
    ("LOG10_E", consts::LOG10_E),
    ("LOG10_2", consts::LOG10_2),
];

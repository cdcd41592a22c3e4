//! Calls of functions of GLSL, HLSL and WGSL, and the equivalent Rust expressions.
//!
//! Input: the name of an unknown function, and the sources and types of its arguments. Output: an expression that replaces the whole call.
//! It is in parentheses unless it is a call itself, so it is right inside of any other expression.

use fragbuf_model::nearest_name;

use crate::methods::{self, MethodType};
use crate::types::Type;

/// An argument of a call. `ty` is `F32` or `I32` for a literal whose type is not known yet.
#[derive(Clone, Debug)]
pub(crate) struct Given {
    /// Its source, in parentheses unless it is a name, a literal or a call.
    pub source: String,
    pub ty: Type,
    /// Whether it is a literal without a suffix.
    pub is_literal: bool,
}

impl Given {
    /// Returns its source as an operand of floats.
    fn float(&self) -> String {
        match (self.is_literal, self.ty) {
            (true, ty) if ty.is_integer() => format!("{}.0", self.source),
            _ => self.source.clone(),
        }
    }

    /// Returns its source as a receiver of methods of a number of this type, which the source alone does not have.
    pub(crate) fn typed(&self, ty: Type) -> String {
        let is_plain = self.source.starts_with(|letter: char| letter.is_ascii_digit());
        match ty {
            _ if !is_plain => format!("({} as {})", self.source, ty.rust()),
            Type::F32 => format!("{}_f32", self.float()),
            _ => format!("{}_{}", self.source, ty.rust()),
        }
    }

    /// Returns its source as an argument of a number of this type.
    pub(crate) fn of_type(&self, ty: Type) -> String {
        match ty {
            Type::F32 => self.as_float().source,
            ty if self.is_literal || self.ty == ty || !self.ty.is_integer() => self.source.clone(),
            ty => format!("({} as {})", self.source, ty.rust()),
        }
    }

    /// Returns it as a float: an integer is converted.
    fn as_float(&self) -> Given {
        match self.ty {
            ty if ty.is_integer() && self.is_literal => Given { source: self.float(), ty: Type::F32, is_literal: true },
            ty if ty.is_integer() => {
                Given { source: format!("({} as f32)", self.source), ty: Type::F32, is_literal: false }
            }
            _ => self.clone(),
        }
    }

    /// Returns its type as an operand of floats.
    fn ty_as_float(&self) -> Type {
        if self.is_literal { Type::F32 } else { self.ty }
    }

    /// Returns whether it is a vector.
    pub(crate) fn ty_is_vector(&self) -> bool {
        self.size().is_some()
    }

    fn size(&self) -> Option<u8> {
        match self.ty {
            Type::Vector(size) => Some(size),
            _ => None,
        }
    }
}

/// An equivalent expression. `$0`, `$1` … are the arguments, and `$V` is the type of the greatest of them that is a vector.
struct Row {
    names: &'static [&'static str],
    /// The names of the arguments in messages, if their number is another.
    arguments: &'static [&'static str],
    /// For numbers.
    number: &'static str,
    /// For vectors; `None`: it is applied to each component.
    vector: Option<&'static str>,
    /// Whether the other arguments of `vector` must be numbers.
    is_tail_scalar: bool,
}

const fn row(
    names: &'static [&'static str],
    arguments: &'static [&'static str],
    number: &'static str,
    vector: Option<&'static str>,
) -> Row {
    Row { names, arguments, number, vector, is_tail_scalar: false }
}

const SMOOTHSTEP: &str = "({ let t = (($2 - $0) / ($1 - $0)).clamp(0.0, 1.0); t * t * (3.0 - 2.0 * t) })";
const SMOOTHSTEP_OF_VECTORS: &str =
    "({ let t = (($2 - $0) / ($1 - $0)).clamp($V::ZERO, $V::ONE); t * t * (3.0 - 2.0 * t) })";

#[rustfmt::skip]
const ROWS: &[Row] = &[
    row(&["mix", "lerp"], &["a", "b", "t"], "($0 + ($1 - $0) * $2)", Some("($0 + ($1 - $0) * $2)")),
    row(&["select"], &["a", "b", "condition"], "(if $2 { $1 } else { $0 })", Some("(if $2 { $1 } else { $0 })")),
    row(&["saturate"], &["x"], "$0.clamp(0.0, 1.0)", Some("$0.clamp($V::ZERO, $V::ONE)")),
    row(&["smoothstep"], &["a", "b", "x"], SMOOTHSTEP, Some(SMOOTHSTEP_OF_VECTORS)),
    row(&["step"], &["edge", "x"], "(if $1 < $0 { 0.0 } else { 1.0 })", None),
    row(&["frac", "fract"], &["x"], "($0 - $0.floor())", Some("($0 - $0.floor())")),
    row(&["sign"], &["x"], "(if $0 == 0.0 { 0.0 } else { $0.signum() })", None),
    row(&["inversesqrt", "inverseSqrt", "rsqrt"], &["x"], "$0.sqrt().recip()", None),
    row(&["rcp"], &["x"], "$0.recip()", Some("$0.recip()")),
    Row { is_tail_scalar: true, ..row(&["pow"], &["x", "y"], "$0.powf($1)", Some("$0.powf($1)")) },
    row(&["log"], &["x"], "$0.ln()", None),
    row(&["fma", "mad"], &["a", "b", "c"], "$0.mul_add($1, $2)", Some("($0 * $1 + $2)")),
    row(&["radians"], &["x"], "$0.to_radians()", Some("($0 * (std::f32::consts::PI / 180.0))")),
    row(&["degrees"], &["x"], "$0.to_degrees()", Some("($0 * (180.0 / std::f32::consts::PI))")),
    row(&["mod"], &["x", "y"], "($0 - $1 * ($0 / $1).floor())", Some("($0 - $1 * ($0 / $1).floor())")),
    row(&["fmod"], &["x", "y"], "($0 % $1)", Some("($0 % $1)")),
    row(&["round", "roundEven"], &["x"], "$0.round_ties_even()", None),
    row(&["atan"], &["y", "x"], "$0.atan2($1)", None),
    row(&["bitCount", "countbits", "countOneBits"], &["x"], "$0.count_ones()", None),
    row(&["reversebits", "bitfieldReverse", "reverseBits"], &["x"], "$0.reverse_bits()", None),
    row(&["firstbitlow", "findLSB", "firstTrailingBit", "countTrailingZeros"], &["x"], "$0.trailing_zeros()", None),
    row(&["firstbithigh", "findMSB", "firstLeadingBit"], &["x"], "(31 - $0.leading_zeros())", None),
    row(&["countLeadingZeros"], &["x"], "$0.leading_zeros()", None),
    row(&["floatBitsToUint", "asuint"], &["x"], "$0.to_bits()", None),
    row(&["uintBitsToFloat", "asfloat"], &["x"], "f32::from_bits($0)", None),
    row(&["floatBitsToInt", "asint"], &["x"], "($0.to_bits() as i32)", None),
];

/// Returns the help for a call of a function of another language that is not a type; `None`: no language has it.
pub(crate) fn help(name: &str, given: &[Given]) -> Option<String> {
    match (name, given) {
        ("range" | "xrange", given) => return Some(range(given)),
        ("not", [operand]) => return Some(format!("write `!{}`", operand.source)),
        ("log", [x, base]) if base.source.parse() == Ok(2.0_f32) => {
            return Some(format!("write `{}.log2()`", receiver_source(x)));
        }
        ("log", [x, base]) => return Some(format!("write `({}.ln() / {}.ln())`", receiver_source(x), floating(base))),
        // `lerp` of vectors takes a number.
        ("mix" | "lerp", [a, b, t]) if a.size().is_some() && a.size() == b.size() && t.size().is_none() => {
            return Some(method("lerp", given));
        }
        ("extend", [first, second]) if first.size().is_none() && second.size().is_none() => {
            return Some(format!("write `vec2({}, {})`", first.as_float().source, second.as_float().source));
        }
        ("max" | "min", [only]) if only.size().is_some() => {
            return Some(format!("it is a method: write `{}.{name}_element()`", only.source));
        }
        ("max" | "min", [first, second, rest @ ..]) if !rest.is_empty() => return several(name, (first, second), rest),
        _ => {}
    }
    let is_method = methods::is_method(name);
    // A method of this name has another number of arguments: `atan(y, x)`.
    let is_row = |row: &&Row| row.names.contains(&name) && (!is_method || given.len() == row.arguments.len());
    let Some(row) = ROWS.iter().find(is_row) else {
        return is_method.then(|| method(name, given));
    };
    let named: Vec<Given> = row.arguments.iter().map(|name| named(name, Type::F32)).collect();
    let given = if given.len() == row.arguments.len() { given } else { &named };
    let size = given.iter().filter_map(Given::size).max();
    let Some(size) = size else { return Some(format!("write `{}`", filled(row.number, given))) };
    let is_tail_vector = row.is_tail_scalar && given.iter().skip(1).any(|argument| argument.size().is_some());
    match row.vector.filter(|_| !is_tail_vector) {
        Some(template) => {
            let expression = filled(template, given).replace("$V", &format!("Vec{size}"));
            Some(format!("write `{expression}`"))
        }
        None => Some(each_component(&filled(row.number, &components(given)))),
    }
}

/// Returns the help for a function with a path, `std::cmp::min(a, b)` or `f32::from(x)`.
pub(crate) fn associated(path: &str, given: &[Given]) -> Option<String> {
    let (owner, name) = path.rsplit_once("::")?;
    let owner = Type::from_rust(owner.rsplit("::").next().unwrap_or(owner));
    match (owner, name, given) {
        (Some(Type::Vector(size)), "from" | "from_array" | "from_slice" | "new", given) => {
            vector(size, given).or_else(|| Some(format!("write `{}`", constructor(size))))
        }
        (Some(ty), "from" | "try_from" | "new", [only]) if ty == Type::F32 || ty.is_integer() => {
            Some(format!("convert: `({} as {})`", only.source, ty.rust()))
        }
        _ => help(name, given),
    }
}

/// Returns the constructor of a vector with names for its components.
fn constructor(size: u8) -> String {
    let components: Vec<String> =
        "xyzw".chars().take(usize::from(size)).map(|component| component.to_string()).collect();
    format!("vec{size}({})", components.join(", "))
}

/// Returns the help for the method or the function of another language whose name is nearest to an unknown one.
pub(crate) fn nearest(name: &str, given: &[Given]) -> Option<String> {
    let foreign = ROWS.iter().flat_map(|row| row.names.iter().copied());
    let known: Vec<&str> = methods::METHODS.iter().map(|method| method.name).chain(foreign).collect();
    // Many names of three letters are near to one of a method.
    let nearest = nearest_name(name, &known).filter(|_| name.len() > 3)?;
    Some(format!("did you mean `{nearest}`? {}", help(nearest, given)?))
}

/// Returns the declaration of a function with these arguments.
pub(crate) fn declaration(name: &str, given: &[Given]) -> String {
    let mut parameters: Vec<String> = Vec::new();
    for argument in given {
        let begins = |parameter: &String, name: &str| parameter.split(':').next() == Some(name);
        // `f.depth` is the parameter `depth`.
        let last = argument.source.rsplit('.').next().unwrap_or_default();
        let is_name = |name: &&str| syn::parse_str::<syn::Ident>(name).is_ok() && *name != "_";
        let is_new = |name: &&str| !parameters.iter().any(|parameter| begins(parameter, name));
        let letters = ["x", "y", "z", "w", "a", "b", "c", "d"];
        let name = std::iter::once(last).filter(is_name).chain(letters).find(is_new).unwrap_or("e");
        let ty = match argument.ty {
            ty if ty.is_value() && ty != Type::Error => ty.rust(),
            Type::Uniforms => Type::Uniforms.rust(),
            _ => Type::F32.rust(),
        };
        parameters.push(format!("{name}: {ty}"));
    }
    format!("fn {name}({}) -> f32 {{ … }}", parameters.join(", "))
}

/// Returns the help for `max(a, b, c)` and the like: a chain of calls of a method of two operands.
fn several(name: &str, (first, second): (&Given, &Given), rest: &[Given]) -> Option<String> {
    let of_two = method(name, &[first.clone(), second.clone()]);
    let chain = of_two.strip_suffix('`')?;
    let is_vector = first.size().or(second.size());
    let operand = |given: &Given| match (is_vector, given.size()) {
        (Some(size), None) => format!("Vec{size}::splat({})", given.float()),
        _ if first.ty == Type::F32 || second.ty == Type::F32 => given.float(),
        _ => given.source.clone(),
    };
    let more: String = rest.iter().map(|given| format!(".{name}({})", operand(given))).collect();
    Some(format!("{chain}{more}`"))
}

/// Returns the source of a receiver of a method of floats.
fn floating(given: &Given) -> String {
    receiver_source(&Given { source: given.float(), ty: given.ty_as_float(), is_literal: given.is_literal })
}

/// Returns the help for a range of another language.
fn range(given: &[Given]) -> String {
    match given {
        [to] => format!("write `0..{}`", to.source),
        [from, to] => format!("write `{}..{}`", from.source, to.source),
        _ => "write `a..b`: the step of a range is 1, and `(a..b).rev()` counts down".to_owned(),
    }
}

/// Returns the help for a function that is a method.
fn method(name: &str, given: &[Given]) -> String {
    let floats: Vec<Given> = match given.first() {
        Some(first) if methods::find(first.ty, name).is_none() && methods::find(Type::F32, name).is_some() => {
            given.iter().map(Given::as_float).collect()
        }
        _ => given.to_vec(),
    };
    let Some((receiver, rest)) = floats.split_first() else { return format!("it is a method: write `a.{name}()`") };
    let size = given.iter().filter_map(Given::size).max();
    let receiver = match (size, receiver.size()) {
        // `max(0.0, v)`
        (Some(size), None) => &Given {
            source: format!("Vec{size}::splat({})", receiver.float()),
            ty: Type::Vector(size),
            is_literal: false,
        },
        _ => receiver,
    };
    let Some(found) = methods::find(receiver.ty, name) else {
        return of_components(name, &floats).unwrap_or_else(|| {
            let receivers: Vec<&str> = methods::receivers(name).map(Type::rust).collect();
            format!("it is a method of {}", receivers.join(", "))
        });
    };
    let arguments = rest.iter().zip(found.parameters.iter().chain(std::iter::repeat(&MethodType::Receiver)));
    let arguments = arguments.map(|(argument, parameter)| match (parameter.on(receiver.ty), argument.size()) {
        (Type::Vector(size), None) => format!("Vec{size}::splat({})", argument.float()),
        (Type::F32, None) => argument.float(),
        _ => argument.source.clone(),
    });
    let arguments: Vec<String> = arguments.collect();
    format!("it is a method: write `{}.{name}({})`", receiver_source(receiver), arguments.join(", "))
}

/// Returns the help for a method of numbers that is called on a vector. `None`: numbers have no such method, or it is no vector.
pub(crate) fn of_components(name: &str, given: &[Given]) -> Option<String> {
    given.first()?.size()?;
    methods::find(Type::F32, name)?;
    let components = components(given);
    let rest: Vec<String> = components.iter().skip(1).map(Given::float).collect();
    Some(each_component(&format!("{}.{name}({})", components.first().map(receiver_source)?, rest.join(", "))))
}

/// Returns the source of a receiver: a literal needs a type.
fn receiver_source(receiver: &Given) -> String {
    let suffix = match receiver.ty {
        Type::F32 => "_f32",
        _ => "_u32",
    };
    if receiver.is_literal { format!("{}{suffix}", receiver.source) } else { receiver.source.clone() }
}

/// Returns the help for a constructor of a vector of `size` components; `None`: the arguments have another number of components.
pub(crate) fn vector(size: u8, given: &[Given]) -> Option<String> {
    match given {
        [] => None,
        [only] if only.size().is_none() => Some(format!("write `Vec{size}::splat({})`", only.float())),
        [only] if only.size() == Some(size) => Some(format!("write `{}`", only.source)),
        [only] => {
            let letters = "xyzw".get(..usize::from(size)).filter(|_| only.size() > Some(size))?;
            Some(format!("write `{}.{letters}()`", only.source))
        }
        [first, rest @ ..] if first.size().is_some() && rest.iter().all(|argument| argument.size().is_none()) => {
            let is_whole = usize::from(first.size()?) + rest.len() == usize::from(size);
            let rest: String = rest.iter().map(|argument| format!(".extend({})", argument.float())).collect();
            is_whole.then(|| format!("write `{}{rest}`", first.source))
        }
        all => {
            let components: Vec<String> = all.iter().flat_map(component_sources).collect();
            let is_whole = components.len() == usize::from(size);
            is_whole.then(|| format!("write `vec{size}({})`", components.join(", ")))
        }
    }
}

/// Returns the sources of the components of an argument.
fn component_sources(argument: &Given) -> Vec<String> {
    match argument.size() {
        Some(size) => {
            "xyzw".chars().take(usize::from(size)).map(|letter| format!("{}.{letter}", argument.source)).collect()
        }
        None => vec![argument.float()],
    }
}

/// Returns the first component of each vector.
fn components(given: &[Given]) -> Vec<Given> {
    let first = |argument: &Given| match argument.size() {
        Some(_) => Given { source: format!("{}.x", argument.source), ty: Type::F32, is_literal: false },
        None => argument.clone(),
    };
    given.iter().map(first).collect()
}

fn each_component(expression: &str) -> String {
    format!("compute each component, as `{expression}` for the first")
}

fn named(name: &str, ty: Type) -> Given {
    Given { source: name.to_owned(), ty, is_literal: false }
}

/// Returns an expression with its arguments. If the type of none is known, literals have suffixes, as receivers of methods need.
fn filled(template: &str, given: &[Given]) -> String {
    let are_literals = given.iter().all(|argument| argument.is_literal);
    let has_floats = given.iter().any(|argument| argument.ty == Type::F32 || argument.size().is_some());
    let mut expression = template.to_owned();
    for (index, argument) in given.iter().enumerate() {
        let argument = &match has_floats {
            true => Given { source: argument.float(), ty: argument.ty_as_float(), is_literal: argument.is_literal },
            false => argument.clone(),
        };
        let receiver = receiver_source(argument);
        let operand = if are_literals { receiver.clone() } else { argument.source.clone() };
        expression =
            expression.replace(&format!("${index}."), &format!("{receiver}.")).replace(&format!("${index}"), &operand);
    }
    expression
}

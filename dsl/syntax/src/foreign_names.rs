//! Names of GLSL, HLSL and WGSL, and what the closure language has instead.
//!
//! Input: an unknown name, and where it is written. Output: the help of the error, if another language has the name. Names that the
//! language has with other letters, such as `vec3` for `Vec3`, are left to the nearest name.

/// Returns what a closure writes instead of a type.
pub(crate) fn rust_type(name: &str) -> Option<String> {
    if let Some(size) = vector_size(name) {
        return Some(format!("write `Vec{size}`"));
    }
    match number(name)? {
        Number::Float => Some("write `f32`".to_owned()),
        Number::Signed => Some("write `i32`".to_owned()),
        Number::Unsigned => Some("write `u32`".to_owned()),
        Number::Bool => Some("write `bool`".to_owned()),
        Number::Vector => Some("components of vectors are `f32`: use one variable per component".to_owned()),
        Number::Matrix => Some("matrices are not supported: use one vector per column".to_owned()),
        Number::Texture => Some(TEXTURES.to_owned()),
    }
}

/// Returns what a `fragment` block writes instead of a type.
pub(crate) fn attribute_format(name: &str) -> Option<String> {
    if let Some(size) = vector_size(name) {
        return Some(format!("write `vec{size}`, or a smaller format: `rgba8`, `rgba16` or `octahedral`"));
    }
    match name {
        "rgb8" | "rgba" | "rgb" | "color" | "colour" | "unorm4x8" | "rgba8unorm" | "r8g8b8a8_unorm" => {
            return Some("write `rgba8`".to_owned());
        }
        "rgba16f" | "rgba16unorm" | "half4" | "unorm4x16" => return Some("write `rgba16`".to_owned()),
        "normal" | "oct" | "octahedron" | "snorm2x16" => return Some("write `octahedral`".to_owned()),
        _ => {}
    }
    match number(name)? {
        Number::Float => Some("write `f32`".to_owned()),
        Number::Signed => Some("write `u32`, and convert in closures: `f.name as i32`".to_owned()),
        Number::Unsigned => Some("write `u32`".to_owned()),
        Number::Bool => Some("write `u32`, and compare in closures: `f.name != 0`".to_owned()),
        Number::Vector => Some("components of vectors are `f32`: use one `u32` per component".to_owned()),
        Number::Matrix => Some("matrices are not supported: use one attribute per column".to_owned()),
        Number::Texture => Some(TEXTURES.to_owned()),
    }
}

/// Returns what a `uniform` block writes instead of a type.
pub(crate) fn uniform_type(name: &str) -> Option<String> {
    if let Some(size) = vector_size(name) {
        return Some(format!("write `vec{size}`"));
    }
    match number(name)? {
        Number::Float => Some("write `f32`".to_owned()),
        Number::Signed => Some("write `i32`".to_owned()),
        Number::Unsigned => Some("write `u32`".to_owned()),
        Number::Bool => Some("write `u32`, and compare in closures: `u.name != 0`".to_owned()),
        Number::Vector => Some("components of vectors are `f32`: use one uniform per component".to_owned()),
        Number::Matrix => Some("matrices are not supported: use one `vec4` per column".to_owned()),
        Number::Texture => Some(TEXTURES.to_owned()),
    }
}

/// Returns what a closure writes instead of a function.
pub(crate) fn function(name: &str) -> Option<String> {
    if let Some(size) = vector_size(name) {
        return Some(format!("write `vec{size}(…)`"));
    }
    let cast = match number(name) {
        Some(Number::Float) => Some("f32"),
        Some(Number::Signed) => Some("i32"),
        Some(Number::Unsigned) => Some("u32"),
        Some(Number::Bool) => return Some("compare: `x != 0`".to_owned()),
        Some(Number::Vector) => {
            return Some("components of vectors are `f32`: use one variable per component".to_owned());
        }
        Some(Number::Matrix) => return Some("matrices are not supported: use one vector per column".to_owned()),
        Some(Number::Texture) | None => None,
    };
    if let Some(ty) = cast {
        return Some(format!("convert with `x as {ty}`"));
    }
    if name.starts_with("texture") || name.starts_with("tex2D") || name.starts_with("image") {
        return Some(TEXTURES.to_owned());
    }
    let expression = EXPRESSIONS.iter().find(|(names, _)| names.contains(&name)).map(|(_, expression)| *expression)?;
    Some(format!("write `{expression}`"))
}

/// Returns what a closure writes instead of a value.
pub(crate) fn value(name: &str) -> Option<String> {
    let found = VALUES.iter().find(|(names, _)| names.contains(&name)).map(|(_, help)| *help)?;
    Some(found.to_owned())
}

/// Returns the swizzle of the components `xyzw` for one of `rgba` or `stpq`.
pub(crate) fn swizzle(name: &str) -> Option<String> {
    ["rgba", "stpq"].iter().find_map(|letters| {
        let component = |letter| letters.find(letter).and_then(|at| "xyzw".chars().nth(at));
        name.chars().map(component).collect()
    })
}

const TEXTURES: &str = "closures do not read textures: store the value in an attribute";

/// The kinds of types of shading languages that are not vectors of `f32`.
enum Number {
    Float,
    Signed,
    Unsigned,
    Bool,
    Vector,
    Matrix,
    Texture,
}

fn number(name: &str) -> Option<Number> {
    Some(match name {
        "float" | "half" | "double" | "float1" | "half1" | "min16float" | "f32" | "f16" | "f64" => Number::Float,
        "int" | "int1" | "i32" | "i16" | "i8" | "short" | "long" => Number::Signed,
        "uint" | "uint1" | "dword" | "u32" | "u16" | "u8" | "unsigned" | "byte" => Number::Unsigned,
        "bool" | "boolean" => Number::Bool,
        _ if is_numbered(name, &["uvec", "ivec", "bvec", "dvec", "uint", "int", "bool", "double"]) => Number::Vector,
        _ if ["mat2", "mat3", "mat4", "float2x", "float3x", "float4x"]
            .iter()
            .any(|matrix| name.starts_with(matrix)) =>
        {
            Number::Matrix
        }
        _ if ["texture", "Texture", "sampler", "Sampler"].iter().any(|texture| name.starts_with(texture)) => {
            Number::Texture
        }
        _ => return None,
    })
}

/// Tests whether a name is one of these with 2, 3 or 4 after it.
fn is_numbered(name: &str, before: &[&str]) -> bool {
    before.iter().any(|before| matches!(name.strip_prefix(before), Some("2" | "3" | "4")))
}

/// Returns the size of a vector of `f32`.
fn vector_size(name: &str) -> Option<char> {
    let name = name.strip_suffix('f').unwrap_or(name);
    let is_vector = is_numbered(name, &["float", "half", "vec", "Vec", "f32x", "min16float"]);
    name.chars().next_back().filter(|_| is_vector)
}

/// Functions of shading languages, and the equivalent Rust expressions.
const EXPRESSIONS: &[(&[&str], &str)] = &[
    (&["mix", "lerp"], "a + (b - a) * t` for numbers, or `a.lerp(b, t)` for vectors: `t: f32"),
    (&["select"], "if condition { b } else { a }` for WGSL's `select(a, b, condition)"),
    (&["saturate"], "x.clamp(0.0, 1.0)"),
    (&["smoothstep"], "{ let t = ((x - a) / (b - a)).clamp(0.0, 1.0); t * t * (3.0 - 2.0 * t) }"),
    (&["step"], "if x < edge { 0.0 } else { 1.0 }"),
    (&["frac", "fract"], "x - x.floor()"),
    (&["sign"], "x.signum()`, which is never 0 for an `f32`; or `if x == 0.0 { 0.0 } else { x.signum() }"),
    (&["inversesqrt", "inverseSqrt", "rsqrt"], "x.sqrt().recip()"),
    (&["rcp"], "x.recip()"),
    (&["pow"], "x.powf(y)"),
    (&["log"], "x.ln()"),
    (&["fma", "mad"], "a.mul_add(b, c)"),
    (&["radians"], "x.to_radians()"),
    (&["degrees"], "x.to_degrees()"),
    (&["mod"], "x - y * (x / y).floor()"),
    (&["fmod"], "x % y"),
    (&["round", "roundEven"], "x.round_ties_even()"),
    (&["bitCount", "countbits", "countOneBits"], "x.count_ones()"),
    (&["reversebits", "bitfieldReverse", "reverseBits"], "x.reverse_bits()"),
    (&["firstbitlow", "findLSB", "firstTrailingBit", "countTrailingZeros"], "x.trailing_zeros()"),
    (&["firstbithigh", "findMSB", "firstLeadingBit"], "31 - x.leading_zeros()"),
    (&["countLeadingZeros"], "x.leading_zeros()"),
    (&["floatBitsToUint", "asuint"], "x.to_bits()"),
    (&["uintBitsToFloat", "asfloat"], "f32::from_bits(x)"),
    (&["floatBitsToInt", "asint"], "x.to_bits() as i32"),
];

/// Values of shading languages, and how a description has them.
const VALUES: &[(&[&str], &str)] = &[
    (&["discard"], "`return` a value; a `where |f| …` closure rejects fragments"),
    (
        &["gl_FragCoord", "SV_Position"],
        "closures do not have the position of the pixel: store it in an attribute; depth is `f.depth`",
    ),
    (&["gl_FragDepth", "gl_FragColor", "SV_Target"], "the value of the closure is its result; depth is `f.depth`"),
    (&["PI", "M_PI"], "write `std::f32::consts::PI`"),
    (&["FLT_MAX"], "write `f32::MAX`"),
    (&["FLT_EPSILON"], "write `f32::EPSILON`"),
    (&["UINT_MAX"], "write `u32::MAX`"),
    (&["INT_MAX"], "write `i32::MAX`"),
];

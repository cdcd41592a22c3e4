//! Names of GLSL, HLSL and WGSL, and what the closure language has instead.
//!
//! Input: an unknown name, and where it is written. Output: the help of the error, if another language has the name. Names that the
//! language has with other letters, such as `vec3` for `Vec3`, are left to the nearest name.

use crate::foreign_functions::{self, Given};
use crate::types::Type;

/// What a description writes in place of a type of another language.
pub(crate) struct Replacement {
    /// The type; `None`: no type has the same meaning.
    pub(crate) own: Option<String>,
    /// The help of the error.
    pub(crate) help: String,
}

impl Replacement {
    /// Returns a type, and what the help says after it.
    fn by(own: impl Into<String>, more: &str) -> Option<Self> {
        let own = own.into();
        Some(Replacement { help: format!("write `{own}`{more}"), own: Some(own) })
    }

    /// Returns the help where no type has the same meaning.
    fn none(help: &str) -> Option<Self> {
        Some(Replacement { own: None, help: help.to_owned() })
    }
}

/// Returns what a closure writes instead of a type.
pub(crate) fn rust_type(name: &str) -> Option<Replacement> {
    if let Some(size) = vector_size(name) {
        return Replacement::by(format!("Vec{size}"), "");
    }
    match number(name)? {
        Number::Float => Replacement::by("f32", ""),
        Number::Signed => Replacement::by("i32", ""),
        Number::Unsigned => Replacement::by("u32", ""),
        Number::Bool => Replacement::by("bool", ""),
        Number::Vector => Replacement::none("components of vectors are `f32`: use one variable per component"),
        Number::Matrix => Replacement::none("matrices are not supported: use one vector per column"),
        Number::Texture => Replacement::none(TEXTURES),
    }
}

/// Returns what a `fragment` block writes instead of a type.
pub(crate) fn attribute_format(name: &str) -> Option<Replacement> {
    if let Some(size) = vector_size(name) {
        return Replacement::by(format!("vec{size}"), ", or a smaller format: `rgba8`, `rgba16` or `octahedral`");
    }
    match name {
        "rgb8" | "rgba" | "rgb" | "color" | "colour" | "unorm4x8" | "rgba8unorm" | "r8g8b8a8_unorm" => {
            return Replacement::by("rgba8", "");
        }
        "rgba16f" | "rgba16unorm" | "half4" | "unorm4x16" => return Replacement::by("rgba16", ""),
        "normal" | "oct" | "octahedron" | "snorm2x16" => return Replacement::by("octahedral", ""),
        _ => {}
    }
    match number(name)? {
        Number::Float => Replacement::by("f32", ""),
        Number::Signed => {
            Replacement::by("u32", " if no value is negative, else `f32`, which is exact for whole numbers up to 2^24")
        }
        Number::Unsigned => Replacement::by("u32", ""),
        Number::Bool => Replacement::by("u32", ", and compare in closures: `f.name != 0`"),
        Number::Vector => Replacement::none("components of vectors are `f32`: use one `u32` per component"),
        Number::Matrix => Replacement::none("matrices are not supported: use one attribute per column"),
        Number::Texture => Replacement::none(TEXTURES),
    }
}

/// Returns what a `uniform` block writes instead of a type.
pub(crate) fn uniform_type(name: &str) -> Option<Replacement> {
    if let Some(size) = vector_size(name) {
        return Replacement::by(format!("vec{size}"), "");
    }
    match number(name)? {
        Number::Float => Replacement::by("f32", ""),
        Number::Signed => Replacement::by("i32", ""),
        Number::Unsigned => Replacement::by("u32", ""),
        Number::Bool => Replacement::by("u32", ", and compare in closures: `u.name != 0`"),
        Number::Vector => Replacement::none("components of vectors are `f32`: use one uniform per component"),
        Number::Matrix => Replacement::none("matrices are not supported: use one `vec4` per column"),
        Number::Texture => Replacement::none(TEXTURES),
    }
}

/// Returns what a `texture` block writes instead of a dimension.
pub(crate) fn texture_dimension(name: &str) -> Option<Replacement> {
    let lower = name.to_ascii_lowercase();
    match lower.trim_end_matches("<f32>") {
        "d2" | "sampler2d" | "texture2d" | "texture_2d" | "image2d" | "2" => Replacement::by("2d", ""),
        "d3" | "sampler3d" | "texture3d" | "texture_3d" | "image3d" | "3" => Replacement::by("3d", ""),
        "1d" | "d1" | "sampler1d" | "texture1d" | "texture_1d" => {
            Replacement::by("2d", " with a texture of one row, and sample it at `vec2(x, 0.5)`")
        }
        "cube" | "samplercube" | "texturecube" | "texture_cube" => {
            Replacement::none("cube textures are not supported: use a `2d` texture with an octahedral map")
        }
        _ => None,
    }
}

/// Returns what a closure writes instead of a call of a function.
pub(crate) fn function(name: &str, given: &[Given]) -> Option<String> {
    if let Some(size) = vector_size(name) {
        let size = size.to_digit(10).and_then(|size| u8::try_from(size).ok()).unwrap_or(4);
        return Some(foreign_functions::vector(size, given).unwrap_or_else(|| format!("write `vec{size}(…)`")));
    }
    let operand = match given {
        [only] => only.source.as_str(),
        _ => "x",
    };
    let cast = match number(name) {
        Some(Number::Float) => "f32",
        Some(Number::Signed) => "i32",
        Some(Number::Unsigned) => "u32",
        Some(Number::Bool) => {
            let zero = if matches!(given, [Given { ty: Type::F32, .. }]) { "0.0" } else { "0" };
            return Some(format!("compare: `({operand} != {zero})`"));
        }
        Some(Number::Vector) => {
            return Some("components of vectors are `f32`: use one variable per component".to_owned());
        }
        Some(Number::Matrix) => return Some("matrices are not supported: use one vector per column".to_owned()),
        Some(Number::Texture) => return Some(TEXTURES.to_owned()),
        None if DERIVATIVES.contains(&name) => {
            return Some("closures have no derivatives: store what the derivative is for in an attribute".to_owned());
        }
        None if matches!(name, "any" | "all") => {
            let operator = if name == "any" { "||" } else { "&&" };
            return Some(format!("combine comparisons of components: `v.x > 0.5 {operator} v.y > 0.5`"));
        }
        None if name.starts_with("tex2D") || name.starts_with("image") => return Some(TEXTURES.to_owned()),
        None => return foreign_functions::help(name, given),
    };
    Some(format!("convert: `({operand} as {cast})`"))
}

/// Returns what a closure writes instead of a constructor with the type of its components, `vec3<f32>(…)`.
pub(crate) fn generic_constructor(name: &str) -> Option<&'static str> {
    match vector_size(name)? {
        '2' => Some("write `vec2(…)` without the type in `<…>`, or `Vec2::splat(…)` for equal components"),
        '3' => Some("write `vec3(…)` without the type in `<…>`, or `Vec3::splat(…)` for equal components"),
        _ => Some("write `vec4(…)` without the type in `<…>`, or `Vec4::splat(…)` for equal components"),
    }
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

const DERIVATIVES: [&str; 8] = ["dFdx", "dFdy", "fwidth", "ddx", "ddy", "dpdx", "dpdy", "ddx_fine"];

const TEXTURES: &str = "declare `texture { lut: 2d }` in the buffer, and write `u.lut.sample(vec2(x, y))`";

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

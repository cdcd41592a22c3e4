//! Helper functions with the meaning of a WGSL operator, where GLSL's operator is undefined or differs.
//!
//! Input: a helper. Output: its definition, with the reason in a comment. Names begin with `wgsl_`, a prefix that printed
//! names never have.

use naga::VectorSize;

/// A helper function; the overloads for different types share a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Helper {
    DivideUint(u8),
    DivideInt(u8),
    RemainderUint(u8),
    RemainderInt(u8),
    RemainderFloat(u8),
    ExtractBits { signed: bool, size: u8 },
    InsertBits { signed: bool, size: u8 },
    PackBytes { signed: bool, clamp: bool },
    UnpackBytes { signed: bool },
    FloatToUint(u8),
    FloatToInt(u8),
    Modf(u8),
    Frexp(u8),
    DotBytes { signed: bool },
    QuantizeToHalf(u8),
}

/// Returns the number of lanes; 1 for a scalar.
pub fn lanes(size: Option<VectorSize>) -> u8 {
    size.map_or(1, |size| size as u8)
}

/// Returns the name of a type with the given lanes.
fn typed(stem: &str, scalar: &str, lanes: u8) -> String {
    if lanes == 1 { scalar.to_owned() } else { format!("{stem}{lanes}") }
}

impl Helper {
    /// Returns the name of the function.
    pub fn name(self) -> &'static str {
        match self {
            Self::DivideUint(_) | Self::DivideInt(_) => "wgsl_divide",
            Self::RemainderUint(_) | Self::RemainderInt(_) | Self::RemainderFloat(_) => "wgsl_remainder",
            Self::ExtractBits { .. } => "wgsl_extract_bits",
            Self::InsertBits { .. } => "wgsl_insert_bits",
            Self::PackBytes { clamp: false, .. } => "wgsl_pack_bytes",
            Self::PackBytes { clamp: true, .. } => "wgsl_pack_bytes_clamped",
            Self::UnpackBytes { signed: false } => "wgsl_unpack_bytes_unsigned",
            Self::UnpackBytes { signed: true } => "wgsl_unpack_bytes_signed",
            Self::FloatToUint(_) => "wgsl_uint",
            Self::FloatToInt(_) => "wgsl_int",
            Self::QuantizeToHalf(_) => "wgsl_quantize_to_half",
            Self::Modf(_) => "wgsl_modf",
            Self::Frexp(_) => "wgsl_frexp",
            Self::DotBytes { signed: false } => "wgsl_dot_bytes_unsigned",
            Self::DotBytes { signed: true } => "wgsl_dot_bytes_signed",
        }
    }

    /// Returns the name of the type of the result, if the helper defines it.
    pub fn result(self) -> Option<String> {
        match self {
            Self::Modf(lanes) => Some(modf_result(lanes)),
            Self::Frexp(lanes) => Some(frexp_result(lanes)),
            _ => None,
        }
    }

    /// Returns the definition with an include guard, because two libraries in one shader may use the same function.
    pub fn guarded(self) -> String {
        let words: String = format!("{self:?}")
            .chars()
            .map(|letter| if letter.is_ascii_alphanumeric() { letter } else { ' ' })
            .collect();
        let guard = format!("WGSL_{}", words.split_whitespace().collect::<Vec<_>>().join("_").to_ascii_uppercase());
        format!("#ifndef {guard}\n#define {guard}\n{}#endif\n", self.text())
    }

    /// Returns the definition.
    pub fn text(self) -> String {
        match self {
            Self::Modf(lanes) => modf(lanes),
            Self::Frexp(lanes) => frexp(lanes),
            Self::QuantizeToHalf(lanes) => quantize_to_half(lanes),
            Self::DotBytes { signed } => dot_bytes(signed),
            Self::DivideUint(lanes) => divide("uvec", "uint", lanes, false),
            Self::DivideInt(lanes) => divide("ivec", "int", lanes, true),
            Self::RemainderUint(lanes) => remainder_uint(lanes),
            Self::RemainderInt(lanes) => remainder_int(lanes),
            Self::RemainderFloat(lanes) => {
                let ty = typed("vec", "float", lanes);
                format!(
                    "// The result has the sign of a; mod() would give it that of b.\n{ty} wgsl_remainder({ty} a, {ty} b) {{\n    return a - b * trunc(a / b);\n}}\n"
                )
            }
            Self::ExtractBits { signed, size } => {
                let ty = if signed { typed("ivec", "int", size) } else { typed("uvec", "uint", size) };
                format!(
                    "// bitfieldExtract() is undefined for a range beyond bit 31.\n{ty} wgsl_extract_bits({ty} value, uint offset, uint count) {{\n    uint start = min(offset, 32u);\n    return bitfieldExtract(value, int(start), int(min(count, 32u - start)));\n}}\n"
                )
            }
            Self::InsertBits { signed, size } => {
                let ty = if signed { typed("ivec", "int", size) } else { typed("uvec", "uint", size) };
                format!(
                    "// bitfieldInsert() is undefined for a range beyond bit 31.\n{ty} wgsl_insert_bits({ty} value, {ty} bits, uint offset, uint count) {{\n    uint start = min(offset, 32u);\n    return bitfieldInsert(value, bits, int(start), int(min(count, 32u - start)));\n}}\n"
                )
            }
            Self::PackBytes { signed, clamp } => pack_bytes(signed, clamp),
            Self::UnpackBytes { signed: false } => {
                "uvec4 wgsl_unpack_bytes_unsigned(uint word) {\n    return (uvec4(word) >> uvec4(0u, 8u, 16u, 24u)) & uvec4(255u);\n}\n".to_owned()
            }
            Self::UnpackBytes { signed: true } => {
                "ivec4 wgsl_unpack_bytes_signed(uint word) {\n    return (ivec4(word) << ivec4(24, 16, 8, 0)) >> ivec4(24);\n}\n".to_owned()
            }
            Self::FloatToUint(lanes) => {
                let (from, to) = (typed("vec", "float", lanes), typed("uvec", "uint", lanes));
                format!(
                    "// WGSL saturates where uint() is undefined; 4294967040 is the greatest float below 2^32. NaN is undefined in both.\n{to} wgsl_uint({from} value) {{\n    return {to}(clamp(value, 0.0, 4294967040.0));\n}}\n"
                )
            }
            Self::FloatToInt(lanes) => {
                let (from, to) = (typed("vec", "float", lanes), typed("ivec", "int", lanes));
                format!(
                    "// WGSL saturates where int() is undefined; 2147483520 is the greatest float below 2^31. NaN is undefined in both.\n{to} wgsl_int({from} value) {{\n    return {to}(clamp(value, -2147483648.0, 2147483520.0));\n}}\n"
                )
            }
        }
    }
}

fn divide(stem: &str, scalar: &str, lanes: u8, signed: bool) -> String {
    let ty = typed(stem, scalar, lanes);
    let divisor = divisor(&ty, lanes, signed);
    let reason = if signed {
        "// In WGSL, dividing by zero, or the least integer by -1, gives a."
    } else {
        "// In WGSL, dividing by zero gives a."
    };
    format!("{reason}\n{ty} wgsl_divide({ty} a, {ty} b) {{\n    return a / {divisor};\n}}\n")
}

/// Prints the divisor: b, or 1 where the quotient is a in WGSL.
fn divisor(ty: &str, lanes: u8, signed: bool) -> String {
    match (lanes, signed) {
        (1, false) => "(b == 0u ? 1u : b)".to_owned(),
        (1, true) => "(b == 0 || (b == -1 && a == (-2147483647 - 1)) ? 1 : b)".to_owned(),
        (_, false) => format!("mix(b, {ty}(1u), equal(b, {ty}(0u)))"),
        (_, true) => {
            let bools = ty.replace("ivec", "bvec");
            let words = ty.replace("ivec", "uvec");
            let least = format!("{words}(equal(b, {ty}(-1))) & {words}(equal(a, {ty}(-2147483647 - 1)))");
            format!("mix(b, {ty}(1), {bools}({words}(equal(b, {ty}(0))) | ({least})))")
        }
    }
}

fn remainder_uint(lanes: u8) -> String {
    let ty = typed("uvec", "uint", lanes);
    let divisor = divisor(&ty, lanes, false);
    format!(
        "// In WGSL, the remainder of a division by zero is 0.\n{ty} wgsl_remainder({ty} a, {ty} b) {{\n    return a % {divisor};\n}}\n"
    )
}

fn remainder_int(lanes: u8) -> String {
    let ty = typed("ivec", "int", lanes);
    let divisor = divisor(&ty, lanes, true);
    format!(
        "// GLSL's % is undefined for negative operands; in WGSL the remainder of a division by zero is 0.\n{ty} wgsl_remainder({ty} a, {ty} b) {{\n    {ty} divisor = {divisor};\n    return a - divisor * (a / divisor);\n}}\n"
    )
}

fn pack_bytes(signed: bool, clamp: bool) -> String {
    let ty = if signed { "ivec4" } else { "uvec4" };
    let name = Helper::PackBytes { signed, clamp }.name();
    let bytes = match (signed, clamp) {
        (_, false) => "uvec4(value) & uvec4(255u)",
        (true, true) => "uvec4(clamp(value, ivec4(-128), ivec4(127))) & uvec4(255u)",
        (false, true) => "min(value, uvec4(255u))",
    };
    format!(
        "uint {name}({ty} value) {{\n    uvec4 bytes = {bytes};\n    return bytes.x | (bytes.y << 8u) | (bytes.z << 16u) | (bytes.w << 24u);\n}}\n"
    )
}

fn modf_result(lanes: u8) -> String {
    typed("wgsl_modf_result_vec", "wgsl_modf_result", lanes)
}

/// Defines modf() with the type of its result.
fn modf(lanes: u8) -> String {
    let (ty, result) = (typed("vec", "float", lanes), modf_result(lanes));
    format!(
        "struct {result} {{\n    {ty} fract;\n    {ty} whole;\n}};\n\n{result} wgsl_modf({ty} value) {{\n    {ty} whole = trunc(value);\n    return {result}(value - whole, whole);\n}}\n"
    )
}

fn frexp_result(lanes: u8) -> String {
    typed("wgsl_frexp_result_vec", "wgsl_frexp_result", lanes)
}

/// Defines frexp() with the type of its result.
fn frexp(lanes: u8) -> String {
    let (ty, integer, result) = (typed("vec", "float", lanes), typed("ivec", "int", lanes), frexp_result(lanes));
    format!(
        "struct {result} {{\n    {ty} fract;\n    {integer} exp;\n}};\n\n{result} wgsl_frexp({ty} value) {{\n    {integer} exponent;\n    {ty} fraction = frexp(value, exponent);\n    return {result}(fraction, exponent);\n}}\n"
    )
}

fn quantize_to_half(lanes: u8) -> String {
    let ty = typed("vec", "float", lanes);
    let value = match lanes {
        1 => "unpackHalf2x16(packHalf2x16(vec2(value, 0.0))).x",
        2 => "unpackHalf2x16(packHalf2x16(value))",
        3 => "vec3(unpackHalf2x16(packHalf2x16(value.xy)), unpackHalf2x16(packHalf2x16(vec2(value.z, 0.0))).x)",
        _ => "vec4(unpackHalf2x16(packHalf2x16(value.xy)), unpackHalf2x16(packHalf2x16(value.zw)))",
    };
    format!("{ty} wgsl_quantize_to_half({ty} value) {{\n    return {value};\n}}\n")
}

/// Defines the dot product of four packed bytes.
fn dot_bytes(signed: bool) -> String {
    let (ty, vector) = if signed { ("int", "ivec4") } else { ("uint", "uvec4") };
    let (name, unpack) = (Helper::DotBytes { signed }.name(), |word: &str| match signed {
        true => format!("(ivec4({word}) << ivec4(24, 16, 8, 0)) >> ivec4(24)"),
        false => format!("(uvec4({word}) >> uvec4(0u, 8u, 16u, 24u)) & uvec4(255u)"),
    });
    let (a, b) = (unpack("a"), unpack("b"));
    format!(
        "{ty} {name}(uint a, uint b) {{\n    {vector} products = ({a}) * ({b});\n    return products.x + products.y + products.z + products.w;\n}}\n"
    )
}

//! The names that GLSL reserves.
//!
//! Tests whether a name is reserved for fields, or for functions, variables and types. `names` chooses replacements.

use std::collections::HashMap;
use std::sync::LazyLock;

/// Keywords, keywords reserved for future use, and types: reserved for variables, functions, types and fields.
const KEYWORDS: &str = "\
    active asm atomic_uint attribute bool break buffer bvec2 bvec3 bvec4 case cast centroid class coherent common \
    const continue default discard do double else enum extern external false filter fixed flat float for fvec2 \
    fvec3 fvec4 goto half highp hvec2 hvec3 hvec4 if in inline inout input int interface invariant ivec2 ivec3 \
    ivec4 layout long lowp mediump namespace noinline noperspective out output packed partition patch precise \
    precision public readonly resource restrict return row_major sample sampler samplerShadow shared short sizeof \
    smooth static struct subroutine superp switch template this true typedef uint uniform union unsigned using \
    uvec2 uvec3 uvec4 varying vec2 vec3 vec4 void volatile while writeonly int8_t int16_t int32_t int64_t uint8_t \
    uint16_t uint32_t uint64_t float16_t float32_t float64_t subpassInput isubpassInput usubpassInput \
    subpassInputMS isubpassInputMS usubpassInputMS nonuniformEXT demote accelerationStructureEXT rayQueryEXT \
    defined std140 std430";

/// Built-in functions: a function or variable of the same name would hide them.
const FUNCTIONS: &str = "\
    EmitStreamVertex EmitVertex EndPrimitive EndStreamPrimitive abs acos acosh all allInvocations \
    allInvocationsEqual any anyInvocation asin asinh atan atanh atomicAdd atomicAnd atomicCompSwap atomicCounter \
    atomicExchange atomicLoad atomicMax atomicMin atomicOr atomicStore atomicXor barrier \
    beginInvocationInterlockARB bitCount bitfieldExtract bitfieldInsert bitfieldReverse ceil clamp controlBarrier \
    cos cosh cross degrees determinant distance dot endInvocationInterlockARB equal exp exp2 faceforward findLSB \
    findMSB floatBitsToInt floatBitsToUint floor fma fract frexp ftransform fwidth fwidthCoarse fwidthFine \
    greaterThan greaterThanEqual groupMemoryBarrier imulExtended intBitsToFloat interpolateAtCentroid \
    interpolateAtOffset interpolateAtSample inverse inversesqrt isinf isnan ldexp length lessThan lessThanEqual \
    log log2 main matrixCompMult max min mix mod modf normalize not notEqual outerProduct packDouble2x32 \
    packHalf2x16 packSnorm2x16 packSnorm4x8 packUnorm2x16 packUnorm4x8 pow radians reflect refract round roundEven \
    sign sin sinh smoothstep sqrt step subpassLoad tan tanh transpose trunc uaddCarry uintBitsToFloat umulExtended \
    dFdx dFdxCoarse dFdxFine dFdy dFdyCoarse dFdyFine unpackDouble2x32 unpackHalf2x16 unpackSnorm2x16 \
    unpackSnorm4x8 unpackUnorm2x16 unpackUnorm4x8 usubBorrow";

/// Prefixes of families of names: built-in functions (`textureLod`), built-in variables and generated names.
const FAMILIES: &[&str] = &[
    "gl_",
    "wgsl_",
    "texture",
    "texelFetch",
    "image",
    "atomicCounter",
    "memoryBarrier",
    "noise",
    "shadow1D",
    "shadow2D",
    "subgroup",
];

/// The parts of opaque type names: prefix, stem and shape.
const TYPE_PREFIXES: &[&str] = &["", "i", "u"];
const TYPE_STEMS: &[&str] = &["sampler", "texture", "image"];
const SHAPES: &[&str] = &["1D", "2D", "3D", "Cube", "Buffer"];

/// The two lists above.
#[derive(Clone, Copy, PartialEq, Eq)]
enum List {
    Keywords,
    Functions,
}

static RESERVED: LazyLock<HashMap<&'static str, List>> = LazyLock::new(|| {
    let functions = FUNCTIONS.split(' ').map(|name| (name, List::Functions));
    functions.chain(KEYWORDS.split(' ').map(|name| (name, List::Keywords))).collect()
});

/// Tests whether a name is reserved even for fields.
pub fn is_keyword(name: &str) -> bool {
    RESERVED.get(name) == Some(&List::Keywords) || has_reserved_form(name)
}

/// Tests whether a name is reserved for functions, variables and types.
pub fn is_reserved(name: &str) -> bool {
    RESERVED.contains_key(name) || has_reserved_form(name) || FAMILIES.iter().any(|family| is_of_family(name, family))
}

/// Tests for the forms of names that are reserved even for fields.
fn has_reserved_form(name: &str) -> bool {
    let has_two_underscores = || name.as_bytes().windows(2).any(|pair| pair == b"__");
    name.starts_with("gl_") || has_two_underscores() || is_matrix(name) || is_opaque(name)
}

/// Tests whether a name is of a family: `texture` and `textureLod` are of `texture`; `textured` and `texture_size` are not.
fn is_of_family(name: &str, family: &str) -> bool {
    let Some(rest) = name.strip_prefix(family) else { return false };
    family.ends_with('_') || !rest.starts_with(|c: char| c == '_' || c.is_lowercase())
}

/// Tests for matrix and vector types: `mat4`, `mat3x2`, `dmat4`, `dvec3`.
fn is_matrix(name: &str) -> bool {
    let shape = ["mat", "dmat", "dvec", "f16mat", "f16vec", "u64vec", "i64vec", "u16vec", "i16vec", "u8vec", "i8vec"]
        .iter()
        .find_map(|stem| name.strip_prefix(stem));
    shape.is_some_and(|shape| shape.len() <= 3 && shape.starts_with(['2', '3', '4']))
}

/// Tests for opaque types, such as `sampler2DMSArray` and `uimageBuffer`.
fn is_opaque(name: &str) -> bool {
    TYPE_PREFIXES.iter().any(|prefix| {
        let Some(rest) = name.strip_prefix(prefix) else { return false };
        TYPE_STEMS.iter().any(|stem| {
            rest.strip_prefix(stem).is_some_and(|shape| SHAPES.iter().any(|known| shape.starts_with(known)))
        })
    })
}

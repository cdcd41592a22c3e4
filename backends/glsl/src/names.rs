//! Names: WGSL names in, legal and collision-free GLSL names out.
//!
//! A name stays as it is unless GLSL reserves it; then it gets a `_` at the end. Nothing here depends on the order of
//! anything but the module's own arenas, so the same module has the same names on every run.

use std::collections::{BTreeMap, BTreeSet};

use naga::{Constant, Function, GlobalVariable, Handle, Module, Type, TypeInner};

/// Words that no variable, function, type or field may be called: keywords, those reserved for the future, and types.
const KEYWORDS: &[&str] = &[
    "active", "asm", "atomic_uint", "attribute", "bool", "break", "buffer", "bvec2", "bvec3", "bvec4", "case", "cast", "centroid",
    "class", "coherent", "common", "const", "continue", "default", "discard", "do", "double", "else", "enum", "extern", "external",
    "false", "filter", "fixed", "flat", "float", "for", "fvec2", "fvec3", "fvec4", "goto", "half", "highp", "hvec2", "hvec3",
    "hvec4", "if", "in", "inline", "inout", "input", "int", "interface", "invariant", "ivec2", "ivec3", "ivec4", "layout", "long",
    "lowp", "mediump", "namespace", "noinline", "noperspective", "out", "output", "packed", "partition", "patch", "precise",
    "precision", "public", "readonly", "resource", "restrict", "return", "row_major", "sample", "sampler", "samplerShadow", "shared",
    "short", "sizeof", "smooth", "static", "struct", "subroutine", "superp", "switch", "template", "this", "true", "typedef", "uint",
    "uniform", "union", "unsigned", "using", "uvec2", "uvec3", "uvec4", "varying", "vec2", "vec3", "vec4", "void", "volatile",
    "while", "writeonly", "int8_t", "int16_t", "int32_t", "int64_t", "uint8_t", "uint16_t", "uint32_t", "uint64_t", "float16_t",
    "float32_t", "float64_t", "subpassInput", "isubpassInput", "usubpassInput", "subpassInputMS", "isubpassInputMS",
    "usubpassInputMS", "nonuniformEXT", "demote", "accelerationStructureEXT", "rayQueryEXT", "defined", "std140", "std430",
];

/// Functions of the language: a function or variable of the same name would hide them.
const FUNCTIONS: &[&str] = &[
    "EmitStreamVertex", "EmitVertex", "EndPrimitive", "EndStreamPrimitive", "abs", "acos", "acosh", "all", "allInvocations",
    "allInvocationsEqual", "any", "anyInvocation", "asin", "asinh", "atan", "atanh", "atomicAdd", "atomicAnd", "atomicCompSwap",
    "atomicCounter", "atomicExchange", "atomicLoad", "atomicMax", "atomicMin", "atomicOr", "atomicStore", "atomicXor", "barrier",
    "beginInvocationInterlockARB", "bitCount", "bitfieldExtract", "bitfieldInsert", "bitfieldReverse", "ceil", "clamp",
    "controlBarrier", "cos", "cosh", "cross", "degrees", "determinant", "distance", "dot", "endInvocationInterlockARB", "equal",
    "exp", "exp2", "faceforward", "findLSB", "findMSB", "floatBitsToInt", "floatBitsToUint", "floor", "fma", "fract", "frexp",
    "ftransform", "fwidth", "fwidthCoarse", "fwidthFine", "greaterThan", "greaterThanEqual", "groupMemoryBarrier", "imulExtended",
    "intBitsToFloat", "interpolateAtCentroid", "interpolateAtOffset", "interpolateAtSample", "inverse", "inversesqrt", "isinf",
    "isnan", "ldexp", "length", "lessThan", "lessThanEqual", "log", "log2", "main", "matrixCompMult", "max", "min", "mix", "mod",
    "modf", "normalize", "not", "notEqual", "outerProduct", "packDouble2x32", "packHalf2x16", "packSnorm2x16", "packSnorm4x8",
    "packUnorm2x16", "packUnorm4x8", "pow", "radians", "reflect", "refract", "round", "roundEven", "sign", "sin", "sinh",
    "smoothstep", "sqrt", "step", "subpassLoad", "tan", "tanh", "transpose", "trunc", "uaddCarry", "uintBitsToFloat",
    "umulExtended", "dFdx", "dFdxCoarse", "dFdxFine", "dFdy", "dFdyCoarse", "dFdyFine", "unpackDouble2x32", "unpackHalf2x16", "unpackSnorm2x16", "unpackSnorm4x8", "unpackUnorm2x16",
    "unpackUnorm4x8", "usubBorrow",
];

/// Whole families, by how their names begin: functions (`textureLod`), types (`sampler2D`, `mat4x3`) and what is generated.
const FAMILIES: &[&str] =
    &["gl_", "wgsl_", "texture", "texelFetch", "image", "atomicCounter", "memoryBarrier", "noise", "shadow1D", "shadow2D", "subgroup"];

/// Prefixes of type names; what follows them in a type name is a digit or a shape.
const TYPE_PREFIXES: &[&str] = &["", "i", "u"];
const TYPE_STEMS: &[&str] = &["sampler", "texture", "image"];
const SHAPES: &[&str] = &["1D", "2D", "3D", "Cube", "Buffer"];

/// May not be used as any name at all, not even of a field.
pub fn is_keyword(name: &str) -> bool {
    KEYWORDS.contains(&name) || name.starts_with("gl_") || name.contains("__") || is_matrix(name) || is_opaque(name)
}

/// May not be used as the name of a function, variable or type.
pub fn is_reserved(name: &str) -> bool {
    is_keyword(name) || FUNCTIONS.contains(&name) || FAMILIES.iter().any(|family| is_of_family(name, family))
}

/// `texture` and `textureLod` are of the family `texture`; `textured` and `texture_size` are not.
fn is_of_family(name: &str, family: &str) -> bool {
    let Some(rest) = name.strip_prefix(family) else { return false };
    family.ends_with('_') || !rest.starts_with(|c: char| c == '_' || c.is_lowercase())
}

/// `mat4`, `mat3x2`, `dmat4`, `dvec3`.
fn is_matrix(name: &str) -> bool {
    let shape = ["mat", "dmat", "dvec", "f16mat", "f16vec", "u64vec", "i64vec", "u16vec", "i16vec", "u8vec", "i8vec"].iter().find_map(|stem| name.strip_prefix(stem));
    shape.is_some_and(|shape| shape.len() <= 3 && shape.starts_with(['2', '3', '4']))
}

/// `sampler2DMSArray`, `uimageBuffer` and their kin.
fn is_opaque(name: &str) -> bool {
    TYPE_PREFIXES.iter().any(|prefix| {
        let Some(rest) = name.strip_prefix(prefix) else { return false };
        TYPE_STEMS.iter().any(|stem| rest.strip_prefix(stem).is_some_and(|shape| SHAPES.iter().any(|known| shape.starts_with(known))))
    })
}

/// A name that may be written, before asking whether it is taken.
pub fn legal(name: &str, reserved: impl Fn(&str) -> bool) -> String {
    let mut text = String::with_capacity(name.len());
    for c in name.chars() {
        match c {
            // GLSL has only ASCII names.
            c if !c.is_ascii_alphanumeric() && c != '_' => text.push_str(&format!("u{:x}_", u32::from(c))),
            // GLSL reserves every name with two underscores in a row.
            '_' if text.ends_with('_') => text.push_str("u_"),
            c => text.push(c),
        }
    }
    if text.is_empty() || text.starts_with(|c: char| c.is_ascii_digit()) {
        text.insert_str(0, "value");
    }
    if text.starts_with("gl_") || text.starts_with("wgsl_") {
        text.insert_str(0, "user_");
    }
    if reserved(&text) {
        text.push(if text.ends_with('_') { 'x' } else { '_' });
    }
    text
}

/// The first of `name`, `name_2`, `name_3`, … that is not taken.
pub fn free(name: &str, taken: impl Fn(&str) -> bool) -> String {
    if !taken(name) {
        return name.to_owned();
    }
    let stem = name.trim_end_matches('_');
    (2u32..).map(|n| format!("{stem}_{n}")).find(|candidate| !taken(candidate)).unwrap_or_default()
}

/// `pixel_heads` as `PixelHeads`.
pub fn upper_camel(name: &str) -> String {
    let capital = |word: &str| {
        let mut letters = word.chars();
        letters.next().map(|first| first.to_ascii_uppercase().to_string() + letters.as_str()).unwrap_or_default()
    };
    name.split('_').map(capital).collect()
}

/// Names of everything at module scope, and of what is generated there.
#[derive(Default)]
pub struct GlobalNames {
    pub functions: BTreeMap<Handle<Function>, String>,
    pub globals: BTreeMap<Handle<GlobalVariable>, String>,
    pub constants: BTreeMap<Handle<Constant>, String>,
    pub types: BTreeMap<Handle<Type>, String>,
    taken: BTreeSet<String>,
}

impl GlobalNames {
    /// Takes a new name at module scope.
    pub fn declare(&mut self, name: &str) -> String {
        let name = free(&legal(name, is_reserved), |candidate| self.taken.contains(candidate));
        self.taken.insert(name.clone());
        name
    }

    pub fn is_taken(&self, name: &str) -> bool {
        self.taken.contains(name)
    }
}

/// A field's name: fields live in their structure, so only keywords are in the way.
pub fn field(members: &[naga::StructMember], index: usize) -> String {
    let own = |index: usize| {
        let name = members.get(index).and_then(|member| member.name.as_deref()).unwrap_or("member");
        // `.length` would be taken for the beginning of the method of arrays.
        legal(name, |name| is_keyword(name) || name == "length")
    };
    let name = own(index);
    let before: Vec<String> = (0..index).map(own).collect();
    free(&name, |candidate| before.iter().any(|earlier| earlier == candidate))
}

/// Names all module-scope items; those that may keep their names go first, so that a mangled name never displaces one.
pub fn global_names(module: &Module) -> GlobalNames {
    let mut names = GlobalNames::default();
    for keep in [true, false] {
        let wanted = |name: &Option<String>| name.clone().filter(|name| (legal(name, is_reserved) == *name) == keep);
        for (handle, ty) in module.types.iter() {
            if let (Some(name), TypeInner::Struct { .. }) = (wanted(&ty.name), &ty.inner) {
                let name = names.declare(&name);
                names.types.insert(handle, name);
            }
        }
        for (handle, constant) in module.constants.iter() {
            if let Some(name) = wanted(&constant.name) {
                let name = names.declare(&name);
                names.constants.insert(handle, name);
            }
        }
        for (handle, global) in module.global_variables.iter() {
            if let Some(name) = wanted(&global.name) {
                let name = names.declare(&name);
                names.globals.insert(handle, name);
            }
        }
        for (handle, function) in module.functions.iter() {
            if let Some(name) = wanted(&function.name) {
                let name = names.declare(&name);
                names.functions.insert(handle, name);
            }
        }
    }
    for (handle, _) in module.global_variables.iter().filter(|(_, global)| global.name.is_none()) {
        let name = names.declare("global");
        names.globals.insert(handle, name);
    }
    for (handle, _) in module.functions.iter().filter(|(_, function)| function.name.is_none()) {
        let name = names.declare("function");
        names.functions.insert(handle, name);
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reserved_names_are_mangled() {
        for name in ["mix", "sample", "input", "texture", "textureLod", "sampler2DMS", "mat4x3", "dvec2", "image2D", "imageStore", "main"] {
            assert!(is_reserved(name), "{name}");
            assert_eq!(legal(name, is_reserved), format!("{name}_"));
        }
        for name in ["heads", "textures", "texture_size", "matter", "image_width", "color", "fragment", "count", "u"] {
            assert!(!is_reserved(name), "{name}");
        }
    }

    /// The words of the GLSL 4.60 specification (keywords, reserved words, built-in functions), as naga lists them too.
    #[test]
    fn all_words_of_the_language_are_reserved() {
        let words = include_str!("../tests/glsl_reserved.txt").split_whitespace();
        let missing: Vec<&str> = words.filter(|word| !is_reserved(word)).collect();
        assert!(missing.is_empty(), "{missing:?}");
    }

    #[test]
    fn names_are_legal() {
        assert_eq!(legal("a__b", is_reserved), "a_u_b");
        assert_eq!(legal("gl_x", is_reserved), "user_gl_x");
        assert_eq!(legal("größe", is_reserved), "gruf6_udf_e");
        assert_eq!(free("x", |name| name == "x" || name == "x_2"), "x_3");
        assert_eq!(upper_camel("pixel_heads"), "PixelHeads");
    }
}

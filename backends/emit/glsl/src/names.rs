//! Maps WGSL names to legal and collision-free GLSL names.
//!
//! A name that GLSL reserves gets a `_` at the end; others are unchanged. The result depends only on the order of the
//! module's arenas, so the same module has the same names on every run.

use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};

use crate::reserved::{is_keyword, is_reserved};
use naga::{Constant, Function, GlobalVariable, Handle, Module, Type, TypeInner};

/// Returns a legal name; it may be taken.
pub fn legal_name(name: &str, reserved: impl Fn(&str) -> bool) -> String {
    let mut text = String::with_capacity(name.len());
    for c in name.chars() {
        match c {
            // GLSL names are ASCII.
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

/// Returns a legal name for a function, variable or type; it may be taken.
pub fn legal_unreserved(name: &str) -> Cow<'_, str> {
    if is_legal(name) { Cow::Borrowed(name) } else { Cow::Owned(legal_name(name, is_reserved)) }
}

/// Tests whether a name is legal unchanged.
fn is_legal(name: &str) -> bool {
    let plain = name.bytes().all(|byte| byte.is_ascii_alphanumeric() || byte == b'_')
        && !name.starts_with(|c: char| c.is_ascii_digit());
    plain && !name.is_empty() && !name.contains("__") && !name.starts_with("wgsl_") && !is_reserved(name)
}

/// Returns the first of `name`, `name_2`, `name_3`, … that is not taken.
pub fn unique_name(name: &str, taken: impl Fn(&str) -> bool) -> String {
    if !taken(name) {
        return name.to_owned();
    }
    let stem = name.trim_end_matches('_');
    (2u32..).map(|n| format!("{stem}_{n}")).find(|candidate| !taken(candidate)).unwrap_or_default()
}

/// Converts snake case to camel case: `pixel_heads` to `PixelHeads`.
pub fn upper_camel(name: &str) -> String {
    let capital = |word: &str| {
        let mut letters = word.chars();
        letters.next().map(|first| first.to_ascii_uppercase().to_string() + letters.as_str()).unwrap_or_default()
    };
    name.split('_').map(capital).collect()
}

/// The names at module scope, generated ones included.
#[derive(Default)]
pub struct GlobalNames {
    pub functions: BTreeMap<Handle<Function>, String>,
    pub globals: BTreeMap<Handle<GlobalVariable>, String>,
    pub constants: BTreeMap<Handle<Constant>, String>,
    pub types: BTreeMap<Handle<Type>, String>,
    taken: BTreeSet<String>,
}

impl GlobalNames {
    /// Reserves a new name at module scope.
    pub fn declare(&mut self, name: &str) -> String {
        self.declare_legal(&legal_unreserved(name))
    }

    /// As [`Self::declare`], for a legal name.
    fn declare_legal(&mut self, name: &str) -> String {
        let name = unique_name(name, |candidate| self.taken.contains(candidate));
        self.taken.insert(name.clone());
        name
    }

    /// Tests whether a name is taken at module scope.
    pub fn is_taken(&self, name: &str) -> bool {
        self.taken.contains(name)
    }
}

/// Returns a field's name. Fields are scoped to their structure, so only keywords are reserved.
pub fn field_name(members: &[naga::StructMember], index: usize) -> String {
    let legal = |index: usize| {
        let name = members.get(index).and_then(|member| member.name.as_deref()).unwrap_or("member");
        // GLSL parses `.length` as the method of arrays.
        legal_name(name, |name| is_keyword(name) || name == "length")
    };
    let name = legal(index);
    let before: Vec<String> = (0..index).map(legal).collect();
    unique_name(&name, |candidate| before.iter().any(|earlier| earlier == candidate))
}

/// An item at module scope.
enum Item {
    Type(Handle<Type>),
    Constant(Handle<Constant>),
    Global(Handle<GlobalVariable>),
    Function(Handle<Function>),
}

/// Returns the items that have a name.
fn named_items(module: &Module) -> impl Iterator<Item = (Item, &str)> {
    let types = module.types.iter().filter(|(_, ty)| matches!(ty.inner, TypeInner::Struct { .. }));
    let types = types.filter_map(|(handle, ty)| Some((Item::Type(handle), ty.name.as_deref()?)));
    let constants = module.constants.iter();
    let constants = constants.filter_map(|(handle, item)| Some((Item::Constant(handle), item.name.as_deref()?)));
    let globals = module.global_variables.iter();
    let globals = globals.filter_map(|(handle, item)| Some((Item::Global(handle), item.name.as_deref()?)));
    let functions = module.functions.iter();
    let functions = functions.filter_map(|(handle, item)| Some((Item::Function(handle), item.name.as_deref()?)));
    types.chain(constants).chain(globals).chain(functions)
}

/// Names all module-scope items. Legal names come first, so that a mangled name never takes one of them.
pub fn global_names(module: &Module) -> GlobalNames {
    let mut names = GlobalNames::default();
    let (legal, others): (Vec<_>, Vec<_>) = named_items(module).partition(|(_, name)| is_legal(name));
    let count = legal.len();
    for (index, (item, name)) in legal.into_iter().chain(others).enumerate() {
        let name = if index < count { names.declare_legal(name) } else { names.declare(name) };
        match item {
            Item::Type(handle) => drop(names.types.insert(handle, name)),
            Item::Constant(handle) => drop(names.constants.insert(handle, name)),
            Item::Global(handle) => drop(names.globals.insert(handle, name)),
            Item::Function(handle) => drop(names.functions.insert(handle, name)),
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
        for name in [
            "mix",
            "sample",
            "input",
            "texture",
            "textureLod",
            "sampler2DMS",
            "mat4x3",
            "dvec2",
            "image2D",
            "imageStore",
            "main",
        ] {
            assert!(is_reserved(name), "{name}");
            assert_eq!(legal_name(name, is_reserved), format!("{name}_"));
        }
        for name in ["heads", "textures", "texture_size", "matter", "image_width", "color", "fragment", "count", "u"] {
            assert!(!is_reserved(name), "{name}");
        }
    }

    /// The keywords, reserved keywords and built-in functions of the GLSL 4.60 specification, as naga lists them.
    #[test]
    fn all_keywords_and_functions_are_reserved() {
        let names = include_str!("../tests/glsl_reserved.txt").split_whitespace();
        let missing: Vec<&str> = names.filter(|name| !is_reserved(name)).collect();
        assert!(missing.is_empty(), "{missing:?}");
    }

    #[test]
    fn names_are_legal() {
        assert_eq!(legal_name("a__b", is_reserved), "a_u_b");
        assert_eq!(legal_name("gl_x", is_reserved), "user_gl_x");
        assert_eq!(legal_name("größe", is_reserved), "gruf6_udf_e");
        assert_eq!(unique_name("x", |name| name == "x" || name == "x_2"), "x_3");
        assert_eq!(upper_camel("pixel_heads"), "PixelHeads");
    }
}

//! The reference of the closure language, computed from the tables that the type checker reads.
//!
//! Out: Markdown. What stands here is what is accepted; nothing is described twice.

use std::fmt::Write;

use fragbuf_model::{Format, UniformType};

use crate::constants;
use crate::methods::{METHODS, Method, REFUSED, Slot, Spelling};
use crate::types::Type;

/// Types, methods, constants, and what Rust has and shaders have not: as Markdown.
pub fn reference() -> String {
    let mut text = String::from(
        "Closures and `fn` helpers are Rust, with the vectors of glam. Every value has one type, found as Rust finds it: literals \
         take the type that they are used as, nothing is converted without `as`.\n",
    );
    payload(&mut text);
    statements(&mut text);
    methods(&mut text);
    values(&mut text);
    refused(&mut text);
    text
}

fn payload(text: &mut String) {
    text.push_str("\n# Types\n\n| attribute | words | a closure sees |\n|---|---|---|\n");
    for format in Format::ALL {
        let seen = Type::of_attribute(format).rust();
        let _ = writeln!(text, "| `{}` | {} | `{seen}` |", format.keyword(), format.words());
    }
    let uniforms: Vec<String> = UniformType::ALL.iter().map(|kind| format!("`{}`", kind.keyword())).collect();
    let _ = writeln!(text, "\nUniforms are {}.", uniforms.join(", "));
    let named: Vec<String> = Type::NAMED.iter().map(|(name, _)| format!("`{name}`")).collect();
    let _ = writeln!(text, "Helpers take and give {}.", named.join(", "));
}

fn statements(text: &mut String) {
    text.push_str(
        "\n# Statements\n\n\
         * `let`, `let mut`, assignment to variables and components, `=` and all of `+= -= *= /= %= &= |= ^= <<= >>=`;\n\
         * `if … { … } else { … }` as a statement or a value, `return`, blocks as values;\n\
         * `for i in a..b`, `for i in a..=b`, `for f in fragments`, `for (i, f) in fragments.iter().enumerate()`, each also with \
         `.rev()`; `break`, `continue`. How often a loop goes round is known when it begins: there is no `while`;\n\
         * `fragments.len()`, `fragments[i]`: nearest first in `resolve`;\n\
         * `vec2(x, y)`, `Vec3::new(x, y, z)`, `Vec4::splat(x)`; components `v.x` and `v[0]`, several as `v.xy()`, `v.zyx()` …; `as` between numbers;\n\
         * helpers: `fn name(parameter: type, …) -> type { … }`, without recursion.\n",
    );
}

fn methods(text: &mut String) {
    text.push_str("\n# Methods\n\n| on | method | in WGSL | |\n|---|---|---|---|\n");
    for method in METHODS {
        let _ = writeln!(
            text,
            "| {} | `{}` | `{}` | {} |",
            receivers(method.on),
            signature(method),
            spelling(method.wgsl),
            method.note
        );
    }
}

fn receivers(on: &[Type]) -> String {
    on.iter().map(|kind| kind.rust()).collect::<Vec<_>>().join(" ")
}

fn signature(method: &Method) -> String {
    let named = |slot: &Slot| match slot {
        Slot::Own => "Self",
        Slot::Is(kind) => kind.rust(),
    };
    let takes: Vec<&str> = method.takes.iter().map(named).collect();
    format!("{}({}) -> {}", method.name, takes.join(", "), named(&method.gives))
}

/// With the receiver as `x`; a bar would end the cell of the table.
fn spelling(wgsl: Spelling) -> String {
    let text = match wgsl {
        Spelling::Call(function) => format!("{function}(x, …)"),
        Spelling::Text(text) => ["x", "a", "b"]
            .iter()
            .enumerate()
            .fold(text.to_owned(), |text, (i, name)| text.replace(&format!("${i}"), name)),
    };
    text.replace('|', "\\|")
}

fn values(text: &mut String) {
    let names: Vec<String> = constants::names().iter().map(|name| format!("`{name}`")).collect();
    let _ = writeln!(text, "\n# Constants\n\n{}.", names.join(", "));
}

fn refused(text: &mut String) {
    text.push_str("\n# What Rust has and shaders have not\n\n| on | method | why | instead |\n|---|---|---|---|\n");
    for (on, name, why, way) in REFUSED {
        let _ = writeln!(text, "| {} | `{name}` | {why} | {way} |", receivers(on));
    }
    text.push_str(
        "\nReferences, tuples, arrays, `match`, `if let`, macros, closures in closures and struct literals are refused with \
         what to write instead.\n",
    );
}

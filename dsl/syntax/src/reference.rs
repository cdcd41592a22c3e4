//! The reference of the closure language.
//!
//! Input: the tables that the type checker uses. Output: Markdown that lists what the checker accepts.

use std::fmt::Write;

use fragbuf_model::{Format, UniformType};

use crate::check::TEXTURE_METHODS;
use crate::methods::{METHODS, Method, MethodType, Spelling, UNSUPPORTED};
use crate::types::Type;

/// Returns the types, methods, constants and unsupported constructs as Markdown.
pub fn reference() -> String {
    let mut markdown = String::from(
        "Closures and `fn` helpers are Rust, with the vectors of glam. Types are inferred as in Rust: a literal \
         has the type that its use needs, and only `as` converts.\n",
    );
    types(&mut markdown);
    statements(&mut markdown);
    arithmetic(&mut markdown);
    methods(&mut markdown);
    textures(&mut markdown);
    constants(&mut markdown);
    unsupported(&mut markdown);
    markdown
}

/// Returns the Rust type of an attribute in closures.
pub fn type_of_attribute(format: Format) -> &'static str {
    Type::of_attribute(format).rust()
}

fn types(markdown: &mut String) {
    markdown.push_str("\n# Types\n\n| attribute | words | type in a closure |\n|---|---|---|\n");
    for format in Format::ALL {
        let ty = type_of_attribute(format);
        let _ = writeln!(markdown, "| `{}` | {} | `{ty}` |", format.keyword(), format.words());
    }
    let uniforms: Vec<String> = UniformType::ALL.iter().map(|ty| format!("`{}`", ty.keyword())).collect();
    let _ = writeln!(markdown, "\nTypes of uniforms: {}.", uniforms.join(", "));
    let named: Vec<String> = Type::NAMED.iter().map(|(name, _)| format!("`{name}`")).collect();
    let _ = writeln!(markdown, "Types of helper parameters and results: {}.", named.join(", "));
}

fn statements(markdown: &mut String) {
    markdown.push_str(
        "\n# Statements\n\n\
         * `let`, `let mut`, assignment to variables and components, `=` and all of `+= -= *= /= %= &= |= ^= <<= >>=`;\n\
         * `if … { … } else { … }` as a statement or a value, `return`, blocks as values;\n\
         * `for i in a..b`, `for i in a..=b`, `for f in fragments`, `for (i, f) in fragments.iter().enumerate()`, each also with \
         `.rev()`; `break`, `continue`. The number of iterations is known when a loop starts: there is no `while`;\n\
         * `fragments.len()`, `fragments[i]`: sorted from near to far in `resolve`;\n\
         * `vec2(x, y)`, `Vec3::new(x, y, z)`, `Vec4::splat(x)`; components `v.x` and `v[0]`, swizzles `v.xy()`, `v.zyx()` …; `as` between numbers;\n\
         * helpers: `fn name(parameter: type, …) -> type { … }`, without recursion.\n",
    );
}

fn arithmetic(markdown: &mut String) {
    markdown.push_str(
        "\n# Arithmetic\n\n\
         * Operands are evaluated from left to right, as in Rust; `&&` and `||` may omit the right one.\n\
         * Integers wrap, and shift counts are taken modulo 32, as in Rust without overflow checks. Where Rust always panics, devices \
         have these results: `x / 0` is `x`, `x % 0` is 0, the least `i32` divided by -1 is itself, with the remainder 0.\n\
         * Constants that overflow, divide by zero or shift by more than 31 are errors, as are constants that are not finite.\n\
         * `usize` has 32 bits. An index past the end of a vector has an undefined result; past the end of `fragments` it is the last \
         fragment.\n\
         * Results of floats are equal to Rust's within the accuracy of WGSL. Devices may replace numbers nearer to 0 than 1.2e-38 by 0, \
         ignore the sign of 0, fuse a product and a sum, and regroup sums and products: intermediate results must be far from the limits \
         of `f32`, and a sum has an error relative to its greatest term. Infinities and NaN are not supported.\n\
         * `%` of floats rounds the quotient before it is truncated: near a multiple of the divisor, the result is near 0 or near the \
         divisor. The quotient is truncated towards 0. glam rounds that of `Vec4` down on processors with SIMD instructions.\n",
    );
}

fn methods(markdown: &mut String) {
    markdown.push_str(
        "\n# Methods\n\nResults are equal to Rust's, as stated for arithmetic; remarks state what differs.\n",
    );
    markdown.push_str("\n| receiver | method | in WGSL | |\n|---|---|---|---|\n");
    for method in METHODS {
        let _ = writeln!(
            markdown,
            "| {} | `{}` | `{}` | {} |",
            receivers(method.on),
            signature(method),
            spelling(method.wgsl),
            method.note
        );
    }
}

fn textures(markdown: &mut String) {
    markdown.push_str(
        "\n# Textures and images\n\n\
         `texture { lut: 2d, volume: 3d }` declares textures, which the caller supplies; `image near |fragments, u| …` computes a value \
         per pixel before the effect. Closures read both through the uniforms: `u.lut.sample(vec2(0.5, 0.5))`, `u.near.at(1, 0)`. A texel \
         has four floats. Filters are computed in the shader, in 32 bits, so that all devices give the same result; places \
         beyond the border are those of the nearest texel.\n\n\
         | of | method | |\n|---|---|---|\n",
    );
    for method in TEXTURE_METHODS {
        let on: Vec<&str> = method.on.iter().map(|shape| Type::Texture(*shape).rust()).collect();
        let _ = writeln!(markdown, "| {} | `{}` | {} |", on.join(" "), method.signature(), method.about);
    }
}

fn receivers(on: &[Type]) -> String {
    on.iter().map(|ty| ty.rust()).collect::<Vec<_>>().join(" ")
}

fn signature(method: &Method) -> String {
    let name = |ty: &MethodType| match ty {
        MethodType::Receiver => "Self",
        MethodType::Fixed(ty) => ty.rust(),
    };
    let parameters: Vec<&str> = method.parameters.iter().map(name).collect();
    format!("{}({}) -> {}", method.name, parameters.join(", "), name(&method.result))
}

/// Returns the WGSL expression with `x` as the receiver. A bar is escaped: it would end the cell of the table.
fn spelling(wgsl: Spelling) -> String {
    let expression = match wgsl {
        Spelling::Call(function) => format!("{function}(x, …)"),
        Spelling::Template(template) | Spelling::ByZero { other: template, .. } => ["x", "a", "b"]
            .iter()
            .enumerate()
            .fold(template.to_owned(), |template, (i, name)| template.replace(&format!("${i}"), name))
            .replace("$T", "Self"),
    };
    expression.replace('|', "\\|")
}

fn constants(markdown: &mut String) {
    let names: Vec<String> = crate::constants::names().iter().map(|name| format!("`{name}`")).collect();
    let _ = writeln!(markdown, "\n# Constants\n\n{}.", names.join(", "));
}

fn unsupported(markdown: &mut String) {
    markdown.push_str("\n# Unsupported\n\n| receiver | method | why | instead |\n|---|---|---|---|\n");
    for (on, name, why, instead) in UNSUPPORTED {
        let _ = writeln!(markdown, "| {} | `{name}` | {why} | {instead} |", receivers(on));
    }
    markdown.push_str(
        "\nReferences, tuples, arrays, `match`, `if let`, macros, closures in closures and struct literals are errors; the \
         message says what to write instead.\n",
    );
}

//! Paths and types as written.
//!
//! Input: a path or a type of syn. Output: the segments of the path, or a [`Type`].

use fragbuf_model::{SourceSpan, codes};
use syn::spanned::Spanned;

use super::noted::candidates_for_type;
use crate::report::Report;
use crate::types::Type;
use crate::{foreign_names, unknown_name};

/// Returns the segments of a path without a leading `std` or `core`, or `None` if it has generics.
pub(super) fn segments(path: &syn::Path) -> Option<Vec<String>> {
    let plain = path.segments.iter().all(|segment| segment.arguments.is_empty());
    let mut names: Vec<String> = path.segments.iter().map(|segment| segment.ident.to_string()).collect();
    if names.len() > 1 && names.first().is_some_and(|first| first == "std" || first == "core") {
        names.remove(0);
    }
    (plain && path.leading_colon.is_none()).then_some(names)
}

/// Returns the type that a user wrote.
pub(crate) fn written_type(written: &syn::Type, report: &mut Report) -> Type {
    let span = report.at(written.span());
    match written {
        syn::Type::Paren(inner) => written_type(&inner.elem, report),
        syn::Type::Group(inner) => written_type(&inner.elem, report),
        syn::Type::Tuple(tuple) if tuple.elems.is_empty() => Type::Unit,
        syn::Type::Path(path) if path.qself.is_none() => match segments(&path.path).as_deref() {
            Some([name]) => named_type(name, &span, report),
            _ => unsupported_type(&span, report),
        },
        syn::Type::Reference(_) => {
            let help = "pass the value itself: all values are copied";
            report.error(codes::UNSUPPORTED, &span, "references are not supported", help);
            Type::Error
        }
        _ => unsupported_type(&span, report),
    }
}

fn unsupported_type(span: &SourceSpan, report: &mut Report) -> Type {
    report.error(codes::UNSUPPORTED, span, "this type is not supported", format!("types are {}", list()));
    Type::Error
}

fn named_type(name: &str, span: &SourceSpan, report: &mut Report) -> Type {
    if report.is_placeholder(name) {
        candidates_for_type(report);
        return Type::Error;
    }
    if let Some(found) = Type::from_rust(name) {
        return found;
    }
    let instead = match name {
        "f64" | "f16" => Some("`f32`"),
        "u8" | "u16" | "u64" | "u128" => Some("`u32`"),
        "i8" | "i16" | "i64" | "i128" | "isize" => Some("`i32`"),
        _ => None,
    };
    match instead {
        Some(instead) => {
            let message = format!("the type `{name}` is not supported");
            report.error(codes::UNSUPPORTED, span, message, format!("use {instead}"));
        }
        None => {
            let names = Type::NAMED.map(|(name, _)| name);
            let help = foreign_names::rust_type(name)
                .map(|foreign| foreign.help)
                .unwrap_or_else(|| unknown_name::help(name, &names));
            report.error(codes::UNKNOWN_NAME, span, format!("cannot find type `{name}`"), help);
        }
    }
    Type::Error
}

fn list() -> String {
    Type::NAMED.map(|(name, _)| format!("`{name}`")).join(", ")
}

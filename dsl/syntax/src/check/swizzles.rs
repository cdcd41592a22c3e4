//! Swizzles that are written as fields, `v.xyz` or `v.rgb`, as in shading languages.
//!
//! Input: an expression of syn. Output: the same with the methods that the closure language has: `v.xyz()`.

use crate::environment::Environment;
use crate::foreign_names;
use crate::types::Type;

/// Replaces the swizzles of an expression that are fields by methods. Attributes and uniforms of such a name stay.
pub(super) fn correct(expr: &mut syn::Expr, environment: &Environment) {
    use syn::Expr::{Binary, Call, Cast, Field, Group, MethodCall, Paren, Unary};
    match expr {
        Paren(inner) => correct(&mut inner.expr, environment),
        Group(inner) => correct(&mut inner.expr, environment),
        Unary(inner) => correct(&mut inner.expr, environment),
        Cast(inner) => correct(&mut inner.expr, environment),
        Binary(binary) => {
            correct(&mut binary.left, environment);
            correct(&mut binary.right, environment);
        }
        Call(call) => call.args.iter_mut().for_each(|argument| correct(argument, environment)),
        MethodCall(call) => {
            correct(&mut call.receiver, environment);
            call.args.iter_mut().for_each(|argument| correct(argument, environment));
        }
        Field(field) => {
            correct(&mut field.base, environment);
            if let Some(corrected) = corrected(field, environment) {
                *expr = corrected;
            }
        }
        _ => {}
    }
}

/// Whether a name is a swizzle of several components `xyzw`.
pub(super) fn is_swizzle(name: &str) -> bool {
    (2..=4).contains(&name.len()) && name.chars().all(|letter| "xyzw".contains(letter))
}

/// Returns the help for a method that is a swizzle of other letters, `v.rgb()`, or one component, `v.x()`. `None`: it is neither.
pub(super) fn instead(ty: Type, name: &str, receiver: &str) -> Option<String> {
    let Type::Vector(size) = ty else { return None };
    let xyzw = match name {
        _ if !name.is_empty() && name.len() <= 4 && name.chars().all(|letter| "xyzw".contains(letter)) => {
            name.to_owned()
        }
        _ => foreign_names::swizzle(name).filter(|_| (1..=4).contains(&name.len()))?,
    };
    let is_inside = xyzw.chars().all(|letter| "xyzw".find(letter).is_some_and(|at| at < usize::from(size)));
    let letters = "x, y, z, w".get(..usize::from(size) * 3 - 2)?;
    Some(match (is_inside, xyzw.len()) {
        (false, _) => format!("the components of `Vec{size}` are {letters}"),
        (true, 1) => format!("a component is a field: write `{receiver}.{xyzw}`"),
        (true, _) => format!("components are named x, y, z, w: write `{receiver}.{xyzw}()`"),
    })
}

/// Returns the method of a field that is a swizzle, or a field with the name of the component.
fn corrected(field: &syn::ExprField, environment: &Environment) -> Option<syn::Expr> {
    let syn::Member::Named(name) = &field.member else { return None };
    let written = name.to_string();
    let declared = environment.attributes.iter().chain(&environment.uniforms);
    if declared.into_iter().any(|(declared, _)| *declared == written) {
        return None;
    }
    if written.is_empty() || !written.is_ascii() {
        return None;
    }
    let xyzw = foreign_names::swizzle(&written).unwrap_or(written);
    let name = syn::Ident::new(&xyzw, name.span());
    if xyzw.len() == 1 && "xyzw".contains(&xyzw) {
        return Some(syn::Expr::Field(syn::ExprField { member: syn::Member::Named(name), ..field.clone() }));
    }
    if !is_swizzle(&xyzw) {
        return None;
    }
    Some(syn::Expr::MethodCall(syn::ExprMethodCall {
        attrs: Vec::new(),
        receiver: field.base.clone(),
        dot_token: field.dot_token,
        paren_token: syn::token::Paren(name.span()),
        method: name,
        turbofish: None,
        args: syn::punctuated::Punctuated::new(),
    }))
}

//! Assignments: `x = …`, `x += …`, and to a component, an element or an attribute of a `let mut`.
//!
//! Input: a place expression and a value. Output: a typed assignment, if Rust accepts it.

use fragbuf_model::{Diagnostic, SourceSpan, codes};
use syn::spanned::Spanned;

use super::checker::Checker;
use super::given::{source, source_of_operand};
use super::mismatch::quoted;
use super::swizzles;
use crate::foreign_names;
use crate::tree::{Expr, Kind, Operator};
use crate::types::Type;

impl Checker<'_, '_, '_> {
    pub(super) fn assign(&mut self, assign: &syn::ExprAssign) -> Expr {
        let span = self.at(assign.span());
        if let Some(error) = self.swizzled_place(&assign.left, "=", &assign.right) {
            return error;
        }
        let place = self.place(&assign.left);
        let value = self.expr(&assign.right, Some(place.ty));
        if self.is_ignored(&place) {
            return Expr::error(span);
        }
        if self.inference.unify(value.ty, place.ty).is_none() && self.redeclare_place(&place, &value, "assign") {
            return Expr::error(span);
        }
        let value = self.require(value, place.ty, &assign.right);
        let kind = Kind::Assign { place: Box::new(place), operator: None, value: Box::new(value) };
        Expr::new(kind, Type::Unit, span)
    }

    /// Reports a place whose declaration with a literal does not fit a value that is assigned: `let mut s = 0; s += f.depth;`. Returns
    /// whether it is one.
    fn redeclare_place(&mut self, place: &Expr, value: &Expr, verb: &str) -> bool {
        let fits = self.inference.is_float(value.ty)
            || matches!(self.inference.resolve(value.ty), Type::Vector(_))
            || self.inference.is_integer(value.ty) && verb == "assign";
        let Some(fix) = self.redeclared(place, value.ty).filter(|_| fits) else { return false };
        let (a, b) = (quoted(self.inference.name(value.ty)), quoted(self.inference.name(place.ty)));
        let message = match verb {
            "assign" => format!("mismatched types: expected {b}, found {a}"),
            operator => format!("cannot apply `{operator}` to {b} and {a}"),
        };
        self.report_declaration(codes::TYPE_MISMATCH, place, message, fix);
        true
    }

    /// Reports an assignment in place of a comparison: `a = b` where a `bool` is expected.
    pub(super) fn assignment_for_comparison(&mut self, assign: &syn::ExprAssign) -> Expr {
        // `a && b = c` is an assignment to `a && b`; `a && b == c` compares `b` and `c`.
        let comparison = format!("{} == {}", source(&assign.left), source(&assign.right));
        let span = self.at(assign.eq_token.span());
        let message = "mismatched types: expected `bool`, found an assignment";
        self.report.error(
            codes::TYPE_MISMATCH,
            &span,
            message,
            format!("`=` assigns: write `==` to compare, `{comparison}`"),
        );
        // Both sides are checked for other errors, unless operators around the comparison are part of them.
        if !matches!(*assign.left, syn::Expr::Binary(_)) {
            self.expr(&assign.left, None);
            self.expr(&assign.right, None);
        }
        Expr::error(span)
    }

    pub(super) fn compound(
        &mut self,
        left: &syn::Expr,
        operator: Operator,
        right: &syn::Expr,
        span: SourceSpan,
    ) -> Expr {
        if let Some(error) = self.swizzled_place(left, &format!("{}=", operator.symbol()), right) {
            return error;
        }
        let place = self.place(left);
        let value = self.expr(right, None);
        if self.is_ignored(&place) {
            return Expr::error(span);
        }
        let ty = self.operation(operator, &place, &value);
        // `x += v` with a scalar `x` and a vector `v` is invalid: it would change the type of `x`.
        if ty.is_none_or(|ty| self.inference.unify(ty, place.ty).is_none()) {
            self.no_assignment(operator, (&place, left), (&value, right), &span);
            return Expr::error(span);
        }
        self.record_integer_operand(&place, right);
        let kind = Kind::Assign { place: Box::new(place), operator: Some(operator), value: Box::new(value) };
        Expr::new(kind, Type::Unit, span)
    }

    /// Reports a compound assignment that Rust does not have. Only the value can be converted, or the variable declared differently.
    fn no_assignment(
        &mut self,
        operator: Operator,
        (place, left): (&Expr, &syn::Expr),
        (value, right): (&Expr, &syn::Expr),
        span: &SourceSpan,
    ) {
        let symbol = format!("{}=", operator.symbol());
        if operator.is_arithmetic() && self.redeclare_place(place, value, &symbol) {
            return;
        }
        let (a, b) = (self.inference.resolve(place.ty), self.inference.resolve(value.ty));
        let are_numbers = self.is_number(a) && self.is_number(b);
        let is_vector = matches!(b, Type::Vector(_)) && self.is_number(a);
        if !operator.is_arithmetic() || !are_numbers && !is_vector {
            self.no_operation(operator, (place, left), (value, right), span);
            return;
        }
        let (a, b) = (quoted(self.inference.name(place.ty)), quoted(self.inference.name(value.ty)));
        let message = format!("cannot apply `{symbol}` to {a} and {b}");
        let help = self.fix(value, place.ty, right);
        self.report.error(codes::TYPE_MISMATCH, &value.span, message, help);
    }

    /// Reports an assignment to several components, `v.xyz = …` or `v.xyz() += …`; `None`: it is another place.
    fn swizzled_place(&mut self, left: &syn::Expr, operator: &str, right: &syn::Expr) -> Option<Expr> {
        let (base, letters) = match left {
            syn::Expr::Paren(inner) => return self.swizzled_place(&inner.expr, operator, right),
            syn::Expr::Field(field) => match &field.member {
                syn::Member::Named(name) => (&*field.base, name.to_string()),
                syn::Member::Unnamed(_) => return None,
            },
            syn::Expr::MethodCall(call) if call.args.is_empty() => (&*call.receiver, call.method.to_string()),
            _ => return None,
        };
        let xyzw = foreign_names::swizzle(&letters).unwrap_or(letters);
        if !(2..=4).contains(&xyzw.len()) || !xyzw.chars().all(|letter| "xyzw".contains(letter)) {
            return None;
        }
        let errors = self.report.count();
        let vector = self.expr(base, None);
        let Type::Vector(size) = self.inference.resolve(vector.ty) else {
            return (self.report.count() > errors).then(|| Expr::error(vector.span));
        };
        let span = self.at(left.span());
        // The fix repeats the value, so that its swizzles are methods.
        let mut right = right.clone();
        swizzles::correct(&mut right, self.environment);
        let value = self.expr(&right, None);
        let is_inside = xyzw.chars().all(|letter| "xyzw".find(letter).is_some_and(|at| at < usize::from(size)));
        let help = match is_inside {
            true => format!("assign each component: `{}`", self.components(base, &xyzw, operator, (&value, &right))),
            false => {
                let components = "x, y, z, w".get(..usize::from(size) * 3 - 2).unwrap_or_default();
                format!("the components of `Vec{size}` are {components}")
            }
        };
        self.report.error(codes::NOT_MUTABLE, &span, "cannot assign to several components at once", help);
        self.require_mutable(&vector, &vector.span);
        Some(Expr::error(span))
    }

    /// Returns the statements that assign the components `xyzw` of `base`. A value that is no name is computed once, before the first
    /// assignment may change what it reads.
    fn components(&self, base: &syn::Expr, xyzw: &str, operator: &str, (value, right): (&Expr, &syn::Expr)) -> String {
        let is_vector = matches!(self.inference.resolve(value.ty), Type::Vector(_) | Type::Error);
        let base_source = source(base);
        // The swizzle of a name is a choice of its components: `c.xy = v.yx()`.
        let (from, letters) = match right {
            syn::Expr::MethodCall(call) if call.args.is_empty() && swizzles::is_swizzle(&call.method.to_string()) => {
                (&*call.receiver, call.method.to_string())
            }
            other => (other, "xyzw".to_owned()),
        };
        let is_simple = |expr: &syn::Expr| matches!(expr, syn::Expr::Path(_) | syn::Expr::Lit(_));
        let is_place = |expr: &syn::Expr| match expr {
            syn::Expr::Field(field) => is_simple(&field.base),
            other => is_simple(other),
        };
        let value = match self.literal_as_float(right) {
            Some(literal) => literal,
            None => source_of_operand(from),
        };
        let is_once = !is_place(from) || source(from) == base_source;
        let name = ["v", "value", "components"].into_iter().find(|name| self.lookup(name).is_none()).unwrap_or("v_");
        let (before, operand, letters) = match is_once {
            true => (format!("let {name} = {}; ", source(right)), name.to_owned(), "xyzw".to_owned()),
            false => (String::new(), value, letters),
        };
        let parts = xyzw.chars().zip(letters.chars()).map(|(to, from)| match is_vector {
            true => format!("{base_source}.{to} {operator} {operand}.{from};"),
            false => format!("{base_source}.{to} {operator} {operand};"),
        });
        before + &parts.collect::<Vec<_>>().join(" ")
    }

    /// Returns an integer literal as a float.
    fn literal_as_float(&self, expr: &syn::Expr) -> Option<String> {
        match expr {
            syn::Expr::Lit(syn::ExprLit { lit: syn::Lit::Int(number), .. }) if number.suffix().is_empty() => {
                Some(format!("{}.0", number.base10_digits()))
            }
            _ => None,
        }
    }

    /// Checks the left side of an assignment.
    fn place(&mut self, expr: &syn::Expr) -> Expr {
        if matches!(expr, syn::Expr::Infer(_)) {
            let span = self.at(expr.span());
            return self.unsupported(span, "`_ = …` is not supported", "remove the statement");
        }
        let place = self.expr(expr, None);
        self.require_mutable(&place, &place.span);
        self.uncount_read(&place);
        place
    }

    fn require_mutable(&mut self, part: &Expr, whole: &SourceSpan) {
        match &part.kind {
            Kind::Error => {}
            Kind::Attribute(base, _) | Kind::Element(base, _) => self.require_mutable(base, whole),
            Kind::Components(base, names) if names.len() == 1 => self.require_mutable(base, whole),
            Kind::Variable(id) => self.require_mutable_variable(*id, whole),
            Kind::Uniform(name) if matches!(part.ty, Type::Texture(_)) => {
                let message = format!("cannot assign to `{name}`: textures and images are read-only");
                self.report.error(
                    codes::NOT_MUTABLE,
                    whole,
                    message,
                    "compute an image with `image name |fragments| …`",
                );
            }
            Kind::Uniform(name) => {
                let message = format!("cannot assign to the uniform `{name}`");
                let help = format!("copy it: `let mut {name} = …;`");
                self.report.error(codes::NOT_MUTABLE, whole, message, help);
            }
            Kind::Layer(_) => {
                let message = "cannot assign to a fragment of the list";
                self.report.error(codes::NOT_MUTABLE, whole, message, "copy one: `let mut f = fragments[i];`");
            }
            _ => {
                let message = "invalid left-hand side of assignment";
                self.report.error(codes::NOT_MUTABLE, whole, message, "assign to a variable: `let mut x = …;`");
            }
        }
    }

    fn require_mutable_variable(&mut self, id: usize, whole: &SourceSpan) {
        let Some(variable) = self.variables.get(id) else { return };
        if variable.mutable {
            return;
        }
        let name = variable.name.clone();
        let declared = variable.span.clone();
        let message = format!("cannot assign to `{name}`: it is not declared with `mut`");
        let help = match variable.ty {
            Type::Fragments | Type::Uniforms => {
                format!("`{name}` is read-only: copy the value into a `let mut`")
            }
            _ => format!("declare it with `let mut {name} = …;`, or copy it into a `let mut`"),
        };
        let diagnostic = Diagnostic::new(codes::NOT_MUTABLE, whole, message, help);
        self.report.push(diagnostic.label(&declared, "declared here"));
    }
}

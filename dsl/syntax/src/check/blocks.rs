//! Blocks and `let`: scopes, final values, and statements that diverge.
//!
//! Input: a block, and the type that is expected of it. Output: a typed block. By Rust's rules the last expression without
//! `;` is the value, and a block with a diverging statement needs no value.

use fragbuf_model::{SourceSpan, codes};
use proc_macro2::TokenStream;
use quote::ToTokens;
use syn::spanned::Spanned;

use super::checker::Checker;
use super::given::source;
use super::mismatch::quoted;
use super::noted::Noted;
use super::written_types::written_type;
use crate::tree::{Block, Expr, Kind, Statement, VariableId};
use crate::types::Type;
use crate::{names, token_limits};

impl Checker<'_, '_, '_> {
    /// Checks a block in a new scope. If a type is expected, the value must have it.
    pub(super) fn block(&mut self, block: &syn::Block, expected: Option<Type>) -> Block {
        self.scopes.push(Vec::new());
        let mut checked = Block { statements: Vec::new(), value: None, end: self.at(block.brace_token.span.close()) };
        let count = block.stmts.len();
        for (index, statement) in block.stmts.iter().enumerate() {
            match statement {
                syn::Stmt::Expr(expr, None) if index + 1 == count => {
                    let value = match expected {
                        Some(expected) => self.value(expr, expected),
                        None => self.expr(expr, None),
                    };
                    checked.value = Some(Box::new(value));
                }
                statement => checked.statements.extend(self.statement(statement)),
            }
        }
        if let Some(expected) = expected {
            self.require_block_value(&checked, block, expected);
        }
        self.scopes.pop();
        checked
    }

    /// Returns the type of a checked block.
    pub(super) fn type_of_block(&self, block: &Block, expected: Option<Type>) -> Type {
        match &block.value {
            _ if diverges(block) => Type::Never,
            Some(value) if value.ty != Type::Error => value.ty,
            Some(_) => Type::Error,
            // `block` reported a missing value.
            None => expected.map_or(Type::Unit, |expected| if expected == Type::Unit { expected } else { Type::Error }),
        }
    }

    fn require_block_value(&mut self, checked: &Block, block: &syn::Block, expected: Type) {
        let expected = self.inference.resolve(expected);
        let needless = matches!(expected, Type::Unit | Type::Error | Type::Never);
        if needless || checked.value.is_some() || diverges(checked) {
            return;
        }
        let (span, help) = match (block.stmts.last(), checked.statements.last()) {
            (Some(syn::Stmt::Expr(_, Some(semi))), Some(Statement::Expr(last)))
                if self.inference.unify(last.ty, expected).is_some() =>
            {
                (self.at(semi.span()), "remove this `;`: the last expression without one is the value".to_string())
            }
            _ => (checked.end.clone(), "end the block with the value, without `;`".to_string()),
        };
        let message = format!("expected a value of type `{}`", self.inference.name(expected));
        self.report.error(codes::MISSING_VALUE, &span, message, help);
    }

    fn statement(&mut self, statement: &syn::Stmt) -> Option<Statement> {
        match statement {
            syn::Stmt::Local(local) => self.local(local),
            syn::Stmt::Expr(expr, Some(_)) if decremented(expr).is_some() => {
                let place = decremented(expr).map_or_else(String::new, source);
                let message = "invalid Rust syntax: Rust has no operator `--`";
                let help = format!("write `{place} -= {}`", if place.contains(['.', '[']) { "1.0" } else { "1" });
                self.report.error(codes::UNEXPECTED_TOKEN, &self.at(expr.span()), message, help);
                None
            }
            syn::Stmt::Expr(expr, semi) => {
                // Rust parses an inner block without `;` as a statement, which must not have a value.
                let expected = if semi.is_none() { Some(Type::Unit) } else { None };
                let checked = match expected {
                    Some(expected) => self.value(expr, expected),
                    None => self.expr(expr, None),
                };
                Some(Statement::Expr(checked))
            }
            syn::Stmt::Item(syn::Item::Const(constant)) => {
                let source = |tokens: TokenStream| token_limits::compact(&token_limits::spaced(&tokens));
                let (ty, value) = (source(constant.ty.to_token_stream()), source(constant.expr.to_token_stream()));
                let help = format!("write `let {}: {ty} = {value};`", constant.ident);
                self.unsupported(
                    self.at(constant.const_token.span),
                    "constants inside functions are not supported",
                    help,
                );
                self.declare(&constant.ident, false, true, Type::Error);
                None
            }
            syn::Stmt::Item(item) => {
                let help = "declare it next to the closure: `fn name(x: f32) -> f32 { … }`";
                self.unsupported(self.at(item.span()), "items inside functions are not supported", help);
                None
            }
            syn::Stmt::Macro(invocation) => {
                let help = "write the expanded code";
                self.unsupported(self.at(invocation.span()), "macros are not supported", help);
                None
            }
        }
    }

    fn local(&mut self, local: &syn::Local) -> Option<Statement> {
        let span = self.at(local.let_token.span);
        let (pattern, written) = match &local.pat {
            syn::Pat::Type(typed) => (&*typed.pat, Some(written_type(&typed.ty, self.report))),
            other => (other, None),
        };
        let Some(init) = &local.init else {
            let help = "initialise it: `let x = if … { … } else { … };`, or `let mut x = 0.0;`";
            self.unsupported(span, "variables without an initial value are not supported", help);
            self.local_name(pattern, written.is_some(), written.unwrap_or(Type::Error));
            return None;
        };
        if let Some((token, _)) = &init.diverge {
            let help = "test before it with `if … { return … }`";
            self.unsupported(self.at(token.span), "`let … else` is not supported", help);
        }
        let value = match written {
            Some(written) => self.value(&init.expr, written),
            None => self.expr(&init.expr, None),
        };
        let ty = written.unwrap_or(value.ty);
        self.require_storable(&value, ty);
        let variable = self.local_name(pattern, written.is_some(), ty)?.id();
        if let (Some(id), None) = (variable, written) {
            self.record_literal(id, &init.expr);
        }
        Some(Statement::Let { variable, value, span })
    }

    /// Rejects a `let` of a value that WGSL cannot store in a variable.
    fn require_storable(&mut self, value: &Expr, ty: Type) {
        match self.inference.resolve(ty) {
            Type::Uniforms | Type::Fragments | Type::Texture(_) => {
                let message = format!("{} cannot be stored in a variable", quoted(self.inference.name(ty)));
                let help = match value.kind {
                    Kind::Uniform(_) => "call its methods directly: `u.name.sample(…)`",
                    _ => "use the closure's parameter directly",
                };
                self.unsupported(value.span.clone(), message, help);
            }
            Type::Unit => {
                let message = "this expression has no value";
                self.report.error(codes::MISSING_VALUE, &value.span, message, "remove `let`");
            }
            _ => {}
        }
    }

    /// Declares the name of a `let`; rejects destructuring patterns.
    fn local_name(&mut self, pattern: &syn::Pat, annotated: bool, ty: Type) -> Option<Declaration> {
        let span = self.at(pattern.span());
        match pattern {
            syn::Pat::Wild(_) => Some(Declaration::Wildcard),
            syn::Pat::Ident(name) if name.by_ref.is_none() && name.subpat.is_none() => {
                let mutable = name.mutability.is_some();
                let id = self.declare(&name.ident, mutable, annotated, ty);
                self.lets.push(id);
                Some(Declaration::Name(id))
            }
            _ => {
                let help = "write one `let` for each value";
                self.unsupported(span, "destructuring patterns are not supported", help);
                None
            }
        }
    }

    /// Declares a local name and adds it to the scope.
    pub(super) fn declare(&mut self, name: &syn::Ident, mutable: bool, annotated: bool, ty: Type) -> VariableId {
        let span: SourceSpan = self.at(name.span());
        let name = syn::ext::IdentExt::unraw(name).to_string();
        if !name.is_ascii() {
            let message = format!("the name `{name}` contains non-ASCII characters");
            self.report.error(codes::NAME_RESERVED, &span, message, names::ASCII_ONLY);
        }
        let id = self.new_variable(&name, mutable, annotated, ty, &span);
        self.bind(id);
        self.note(&span, || Noted::Variable(id));
        id
    }
}

/// Returns the operand of `--n`, which Rust parses as a double negation.
fn decremented(expr: &syn::Expr) -> Option<&syn::Expr> {
    let negated = |expr| match expr {
        &syn::Expr::Unary(syn::ExprUnary { op: syn::UnOp::Neg(_), ref expr, .. }) => Some(&**expr),
        _ => None,
    };
    let operand = negated(negated(expr)?)?;
    matches!(operand, syn::Expr::Path(_) | syn::Expr::Field(_) | syn::Expr::Index(_)).then_some(operand)
}

/// The variable of a pattern.
enum Declaration {
    /// `_`
    Wildcard,
    Name(VariableId),
}

impl Declaration {
    fn id(self) -> Option<VariableId> {
        match self {
            Declaration::Wildcard => None,
            Declaration::Name(id) => Some(id),
        }
    }
}

/// Returns whether a statement or the value of the block diverges.
pub(super) fn diverges(block: &Block) -> bool {
    let statement = |statement: &Statement| match statement {
        Statement::Let { value, .. } | Statement::Expr(value) => expr_diverges(value),
    };
    block.statements.iter().any(statement) || block.value.as_deref().is_some_and(expr_diverges)
}

fn expr_diverges(expr: &Expr) -> bool {
    expr.ty == Type::Never || matches!(&expr.kind, Kind::Block(block) if diverges(block))
}

//! Blocks and `let`: scopes, values at the end, and paths that never reach it.
//!
//! In: a block, and the type that its place needs. Out: a typed block. Rust's rules: the last expression without `;` is
//! the value; a block in which a statement never ends needs none.

use fragbuf_model::{Origin, codes};
use syn::spanned::Spanned;

use super::mismatch::quoted;
use super::{Checker, written_type};
use crate::tree::{Block, Expr, Kind, Statement, VariableId};
use crate::types::Type;

impl Checker<'_, '_, '_> {
    /// A block in a scope of its own; where a type is expected, its value is required to have it.
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

    /// The type of a checked block.
    pub(super) fn type_of_block(&self, block: &Block, expected: Option<Type>) -> Type {
        match &block.value {
            _ if ends_early(block) => Type::Never,
            Some(value) if value.ty != Type::Error => value.ty,
            Some(_) => Type::Error,
            // A missing value was reported where the block was checked.
            None => expected.map_or(Type::Unit, |expected| if expected == Type::Unit { expected } else { Type::Error }),
        }
    }

    fn require_block_value(&mut self, checked: &Block, block: &syn::Block, expected: Type) {
        let expected = self.inference.resolve(expected);
        let needless = matches!(expected, Type::Unit | Type::Error | Type::Never);
        if needless || checked.value.is_some() || ends_early(checked) {
            return;
        }
        let (origin, hint) = match (block.stmts.last(), checked.statements.last()) {
            (Some(syn::Stmt::Expr(_, Some(semi))), Some(Statement::Expr(last)))
                if self.inference.unify(last.ty, expected).is_some() =>
            {
                (self.at(semi.span()), "leave out this `;`: the last expression without one is the value".to_string())
            }
            _ => (checked.end.clone(), "end the block with the value, without `;`".to_string()),
        };
        let message = format!("a value of type `{}` is missing here", self.inference.name(expected));
        self.report.error(codes::MISSING_VALUE, &origin, message, hint);
    }

    fn statement(&mut self, statement: &syn::Stmt) -> Option<Statement> {
        match statement {
            syn::Stmt::Local(local) => self.local(local),
            syn::Stmt::Expr(expr, semi) => {
                // Rust takes a block in the middle for a statement of its own, which must not have a value.
                let expected = if semi.is_none() { Some(Type::Unit) } else { None };
                let checked = match expected {
                    Some(expected) => self.value(expr, expected),
                    None => self.expr(expr, None),
                };
                Some(Statement::Expr(checked))
            }
            syn::Stmt::Item(item) => {
                let hint = "write it beside the closure: `fn name(x: f32) -> f32 { … }`";
                self.refuse(self.at(item.span()), "items inside functions are not part of the language", hint);
                None
            }
            syn::Stmt::Macro(invocation) => {
                let hint = "write what the macro stands for";
                self.refuse(self.at(invocation.span()), "macros are not part of the language", hint);
                None
            }
        }
    }

    fn local(&mut self, local: &syn::Local) -> Option<Statement> {
        let origin = self.at(local.let_token.span);
        let (pattern, written) = match &local.pat {
            syn::Pat::Type(typed) => (&*typed.pat, Some(written_type(&typed.ty, self.report))),
            other => (other, None),
        };
        let Some(init) = &local.init else {
            let hint = "give it its value at once: `let x = if … { … } else { … };`, or `let mut x = 0.0;`";
            self.refuse(origin, "a variable without a value is not part of the language", hint);
            self.local_name(pattern, written.is_some(), written.unwrap_or(Type::Error));
            return None;
        };
        if let Some((token, _)) = &init.diverge {
            let hint = "test with `if … { return … }` before";
            self.refuse(self.at(token.span), "`let … else` is not part of the language", hint);
        }
        let value = match written {
            Some(written) => self.value(&init.expr, written),
            None => self.expr(&init.expr, None),
        };
        let kind = written.unwrap_or(value.ty);
        self.refuse_no_value(&value, kind);
        let variable = self.local_name(pattern, written.is_some(), kind)?;
        Some(Statement::Let { variable: variable.id(), value, origin })
    }

    fn refuse_no_value(&mut self, value: &Expr, kind: Type) {
        match self.inference.resolve(kind) {
            Type::Uniforms | Type::Fragments => {
                let message = format!("{} cannot get a second name", quoted(self.inference.name(kind)));
                self.refuse(value.origin.clone(), message, "use the closure's parameter itself");
            }
            Type::Unit => {
                let message = "this gives no value";
                self.report.error(codes::MISSING_VALUE, &value.origin, message, "write it without `let`");
            }
            _ => {}
        }
    }

    /// Declares the name of a `let`; nothing where the pattern is more than a name.
    fn local_name(&mut self, pattern: &syn::Pat, annotated: bool, kind: Type) -> Option<Declared> {
        let origin = self.at(pattern.span());
        match pattern {
            syn::Pat::Wild(_) => Some(Declared::Nothing),
            syn::Pat::Ident(name) if name.by_ref.is_none() && name.subpat.is_none() => {
                let mutable = name.mutability.is_some();
                Some(Declared::Name(self.declare(&name.ident, mutable, annotated, kind)))
            }
            _ => {
                let hint = "write one `let` for each value";
                self.refuse(origin, "a pattern that takes values apart is not part of the language", hint);
                None
            }
        }
    }

    /// Declares a local name and brings it into scope.
    pub(super) fn declare(&mut self, name: &syn::Ident, mutable: bool, annotated: bool, kind: Type) -> VariableId {
        let origin: Origin = self.at(name.span());
        let name = syn::ext::IdentExt::unraw(name).to_string();
        if !name.is_ascii() {
            let message = format!("the name `{name}` has letters beyond ASCII");
            let hint = "shader languages have only a-z, A-Z, 0-9 and _";
            self.report.error(codes::NAME_RESERVED, &origin, message, hint);
        }
        let id = self.new_variable(&name, mutable, annotated, kind, &origin);
        self.bind(id);
        id
    }
}

/// What a pattern declares.
enum Declared {
    /// `_`
    Nothing,
    Name(VariableId),
}

impl Declared {
    fn id(self) -> Option<VariableId> {
        match self {
            Declared::Nothing => None,
            Declared::Name(id) => Some(id),
        }
    }
}

/// Whether some statement of the block never ends normally, or its value does not.
pub(super) fn ends_early(block: &Block) -> bool {
    let statement = |statement: &Statement| match statement {
        Statement::Let { value, .. } | Statement::Expr(value) => never_ends(value),
    };
    block.statements.iter().any(statement) || block.value.as_deref().is_some_and(never_ends)
}

fn never_ends(expr: &Expr) -> bool {
    expr.ty == Type::Never || matches!(&expr.kind, Kind::Block(block) if ends_early(block))
}

//! Makes a program smaller that has a different result on a device: the report of a failure is a few lines.

use quote::ToTokens;
use syn::visit_mut::{self, VisitMut};

use super::generator::Program;

/// The programs that are tried for one report.
const TRIES: usize = 400;

/// Removes statements and operands while the program still fails.
pub fn shrink(mut program: Program, fails: impl Fn(&Program) -> bool) -> Program {
    let (mut tries, mut edit) = (0, 0);
    while let Some(smaller) = edited(&program, edit).filter(|_| tries < TRIES) {
        tries += 1;
        match fails(&smaller) {
            true => program = smaller,
            false => edit += 1,
        }
    }
    program
}

/// Returns the program after the edit of this number, or `None` if it has fewer.
fn edited(program: &Program, number: usize) -> Option<Program> {
    let mut file = syn::parse_file(&program.rust()).ok()?;
    let mut edit = Edit { remaining: number, done: false };
    edit.visit_file_mut(&mut file);
    let functions: Vec<&syn::ItemFn> = file
        .items
        .iter()
        .filter_map(|item| if let syn::Item::Fn(function) = item { Some(function) } else { None })
        .collect();
    let [helper, closure] = functions.as_slice() else { return None };
    let (helper, body) = (helper.to_token_stream().to_string(), closure.block.to_token_stream().to_string());
    edit.done.then_some(Program { helper, body, ..program.clone() })
}

/// The edit of a number, counted in the order of the source.
struct Edit {
    remaining: usize,
    done: bool,
}

impl Edit {
    /// Returns whether this is the edit to make.
    fn is_next(&mut self) -> bool {
        let is_next = !self.done && self.remaining == 0;
        self.remaining = self.remaining.wrapping_sub(1);
        self.done |= is_next;
        is_next
    }
}

impl VisitMut for Edit {
    fn visit_block_mut(&mut self, block: &mut syn::Block) {
        for index in 0..block.stmts.len() {
            if self.is_next() {
                block.stmts.remove(index);
                return;
            }
        }
        visit_mut::visit_block_mut(self, block);
    }

    fn visit_expr_mut(&mut self, expr: &mut syn::Expr) {
        for part in parts(expr) {
            if self.is_next() {
                *expr = part;
                return;
            }
        }
        visit_mut::visit_expr_mut(self, expr);
    }
}

/// Returns the expressions that may replace an expression: its operands. Those of another type are invalid and fail to compile.
fn parts(expr: &syn::Expr) -> Vec<syn::Expr> {
    match expr {
        syn::Expr::Paren(inner) => parts(&inner.expr),
        syn::Expr::Binary(binary) => vec![(*binary.left).clone(), (*binary.right).clone()],
        syn::Expr::Unary(unary) => vec![(*unary.expr).clone()],
        syn::Expr::MethodCall(call) => std::iter::once((*call.receiver).clone()).chain(call.args.clone()).collect(),
        syn::Expr::If(branch) => {
            let then =
                syn::Expr::Block(syn::ExprBlock { attrs: Vec::new(), label: None, block: branch.then_branch.clone() });
            std::iter::once(then).chain(branch.else_branch.as_ref().map(|(_, other)| (**other).clone())).collect()
        }
        syn::Expr::Block(block) => match block.block.stmts.as_slice() {
            [syn::Stmt::Expr(value, None)] => vec![value.clone()],
            _ => Vec::new(),
        },
        _ => Vec::new(),
    }
}

//! Statements: blocks, variables, assignments and branches.
//!
//! Input: typed statements, and the destination of the final value. Output: lines. Nothing is written after a diverging
//! line: some validators reject unreachable code.

use fragbuf_model::resumable::Progress;
use fragbuf_model::{SourceSpan, mangled};

use super::lowering::{Destination, Lowering};
use super::needs::only_value;
use super::source::ExprSource;
use crate::tree::{Block, Expr, If, Kind, Operator, Statement, VariableId};
use crate::types::Type;

impl Lowering<'_> {
    /// Opens a block.
    pub(super) fn open(&mut self) {
        self.lines.indent();
        self.names.open();
    }

    /// Closes a block.
    pub(super) fn close(&mut self) {
        self.names.close();
        self.lines.dedent();
    }

    /// Writes the statements and the value of a block without its braces.
    pub(super) fn block_contents(&mut self, block: &Block, destination: &Destination) {
        self.statements(&block.statements);
        if let Some(value) = &block.value {
            self.store(value, destination);
        }
    }

    pub(super) fn statements(&mut self, statements: &[Statement]) {
        statements.iter().for_each(|statement| self.one_statement(statement));
    }

    pub(super) fn one_statement(&mut self, statement: &Statement) {
        match statement {
            Statement::Let { variable, value, span } => self.variable(*variable, value, span),
            Statement::Expr(expr) => self.statement(expr, &Destination::Unused),
        }
    }

    /// Writes the statements of a block inside an expression, and returns the source of its value.
    pub(super) fn flattened(&mut self, block: &Block) -> ExprSource {
        self.statements(&block.statements);
        match &block.value {
            Some(value) => self.value(value),
            None => ExprSource::primary("0u"),
        }
    }

    /// Writes an expression and stores its value in the destination.
    pub(super) fn store(&mut self, expr: &Expr, destination: &Destination) {
        match (&expr.kind, destination) {
            (_, Destination::Unused) => self.statement(expr, destination),
            (Kind::If(branch), _) if !self.is_select(branch, expr) => self.branch(branch, expr, destination),
            (Kind::Block(block), _) => self.block_contents(block, destination),
            (Kind::Return(_) | Kind::Break | Kind::Continue, _) => self.statement(expr, destination),
            (_, Destination::Return) if self.is_in_effect => self.return_in_effect(expr),
            (_, Destination::Return) => {
                let source = self.value(expr);
                self.emit(format!("return {};", source.source), &expr.span);
                self.dead = true;
            }
            (_, Destination::Assign(name)) => {
                let source = self.value(expr);
                self.emit(format!("{name} = {};", source.source), &expr.span);
            }
        }
    }

    /// Writes an expression as a statement.
    pub(super) fn statement(&mut self, expr: &Expr, destination: &Destination) {
        match &expr.kind {
            Kind::If(branch) => self.branch(branch, expr, destination),
            Kind::Block(block) => self.nested(block, &expr.span),
            Kind::For(each) => self.for_loop(each, &expr.span),
            Kind::Assign { place, operator, value } => self.assign(place, *operator, value, &expr.span),
            Kind::Return(value) => {
                self.store(value, &Destination::Return);
                self.dead = true;
            }
            Kind::Break => {
                if self.is_in_each {
                    self.progress(Progress::AfterLoop, &expr.span);
                }
                self.jump("break;", &expr.span);
            }
            Kind::Continue => self.jump("continue;", &expr.span),
            // The value is unused: only the statements that it needs have an effect.
            _ if self.needs_statements(expr) => drop(self.value(expr)),
            _ => {}
        }
    }

    fn jump(&mut self, line: &str, span: &SourceSpan) {
        self.emit(line.to_string(), span);
        self.dead = true;
    }

    fn nested(&mut self, block: &Block, span: &SourceSpan) {
        if self.dead {
            return;
        }
        self.emit("{".to_string(), span);
        self.open();
        self.block_contents(block, &Destination::Unused);
        self.close();
        self.lines.push("}".to_string(), &block.end);
    }

    /// Writes `let`, or `var` for a mutable variable.
    fn variable(&mut self, variable: Option<VariableId>, value: &Expr, span: &SourceSpan) {
        let Some(id) = variable else { return self.statement(value, &Destination::Unused) };
        let Some(declared) = self.function.variables.get(id) else { return };
        let (name, mutable, annotated) = (declared.name.clone(), declared.mutable, declared.annotated);
        let ty = self.function.inference.resolve_or_default(declared.ty);
        if !ty.is_value() {
            return self.statement(value, &Destination::Unused);
        }
        if self.kept.contains(&id) {
            return self.store(value, &Destination::Assign(self.name_of(id)));
        }
        // The statements of a block come first; the variable gets its value.
        let mut value = value;
        while let Kind::Block(block) = &value.kind {
            let Some(last) = &block.value else { return self.block_contents(block, &Destination::Unused) };
            self.statements(&block.statements);
            value = last;
        }
        if let Kind::If(branch) = &value.kind
            && !self.is_select(branch, value)
        {
            let name = self.names.fresh(&name);
            self.emit(format!("var {name}: {};", ty.wgsl()), span);
            self.store(value, &Destination::Assign(name.clone()));
            return self.set_name(id, name);
        }
        let source = self.value(value);
        let name = self.names.fresh(&name);
        let keyword = if mutable { "var" } else { "let" };
        let written = if annotated { format!(": {}", ty.wgsl()) } else { String::new() };
        self.emit(format!("{keyword} {name}{written} = {};", source.source), span);
        self.set_name(id, name);
    }

    fn assign(&mut self, place: &Expr, operator: Option<Operator>, value: &Expr, span: &SourceSpan) {
        if let (None, Kind::Variable(id), true) = (operator, &place.kind, self.is_statement_value(value)) {
            let name = self.name_of(*id);
            return self.store(value, &Destination::Assign(name));
        }
        // Rust evaluates the value before the place expression.
        let shift = operator.is_some_and(Operator::is_shift);
        let source = if shift { self.shift_count(value) } else { self.operand_before(value, &[place]) };
        let target = self.place(place);
        let line = match operator {
            None => format!("{target} = {};", source.source),
            Some(Operator::BitXor) if self.function.type_of(place) == Type::Bool => {
                format!("{target} = {};", ExprSource::binary(Operator::NotEqual, &self.value(place), &source).source)
            }
            Some(operator) => format!("{target} {}= {};", operator.symbol(), source.source),
        };
        self.emit(line, span);
    }

    /// Writes the place of an assignment. The statements of an index run once; the variable is not copied.
    fn place(&mut self, place: &Expr) -> String {
        match &place.kind {
            Kind::Element(base, index) => {
                let index = self.value(index).source;
                format!("{}[{index}]", self.place(base))
            }
            Kind::Components(base, names) => format!("{}.{names}", self.place(base)),
            Kind::Attribute(base, name) => format!("{}.{}", self.place(base), mangled(name)),
            _ => self.value(place).source,
        }
    }

    /// Returns whether a value is a branch or block whose arms can contain the assignment.
    fn is_statement_value(&self, value: &Expr) -> bool {
        match &value.kind {
            Kind::If(branch) => !self.is_select(branch, value),
            Kind::Block(block) => only_value(block).is_none(),
            _ => false,
        }
    }

    fn branch(&mut self, branch: &If, expr: &Expr, destination: &Destination) {
        let condition = self.value(&branch.condition);
        if self.dead {
            return;
        }
        self.emit(format!("if {} {{", condition.source), &expr.span);
        let then_dead = self.arm(&branch.then, destination);
        let else_dead = match &branch.else_branch {
            None => false,
            Some(else_branch) => self.else_branch(else_branch, destination),
        };
        self.lines.push("}".to_string(), self.end_of_branch(branch));
        self.dead = then_dead && else_dead;
    }

    /// Writes the arms after the first, `} else if … {` and `} else {`. Returns whether all of them diverge.
    fn else_branch(&mut self, else_branch: &Expr, destination: &Destination) -> bool {
        match &else_branch.kind {
            Kind::If(branch) if !self.needs_statements(&branch.condition) => {
                let condition = self.value(&branch.condition);
                self.emit(format!("}} else if {} {{", condition.source), &else_branch.span);
                let then_dead = self.arm(&branch.then, destination);
                let rest = branch.else_branch.as_ref();
                let rest_dead = rest.is_some_and(|rest| self.else_branch(rest, destination));
                then_dead && rest_dead
            }
            Kind::Block(block) if block.statements.is_empty() && block.value.is_none() => false,
            Kind::Block(block) => {
                self.emit("} else {".to_string(), &else_branch.span);
                self.arm(block, destination)
            }
            _ => {
                self.emit("} else {".to_string(), &else_branch.span);
                self.open();
                self.store(else_branch, destination);
                self.close();
                std::mem::replace(&mut self.dead, false)
            }
        }
    }

    /// Writes one arm of a branch. Returns whether it diverges.
    fn arm(&mut self, block: &Block, destination: &Destination) -> bool {
        self.open();
        self.block_contents(block, destination);
        self.close();
        std::mem::replace(&mut self.dead, false)
    }

    fn end_of_branch<'b>(&self, branch: &'b If) -> &'b SourceSpan {
        match branch.else_branch.as_ref().map(|else_branch| &else_branch.kind) {
            Some(Kind::Block(block)) => &block.end,
            Some(Kind::If(inner)) => self.end_of_branch(inner),
            _ => &branch.then.end,
        }
    }
}

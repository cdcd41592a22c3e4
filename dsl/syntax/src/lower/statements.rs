//! Statements: blocks, variables, assignments and branches.
//!
//! In: typed statements, and where the value of the last goes. Out: lines. After a line that never ends normally,
//! nothing is written: some validators refuse what cannot be reached.

use fragbuf_model::Origin;

use super::Lowering;
use super::needs::only_value;
use super::text::Text;
use crate::tree::{Block, Expr, If, Kind, Operator, Statement, VariableId};
use crate::types::Type;

/// Where a value goes.
#[derive(Clone, Debug)]
pub(super) enum Destination {
    /// Nowhere: only what evaluating it does is wanted.
    Nothing,
    /// Out of the function.
    Return,
    /// Into this variable.
    Assign(String),
}

impl Lowering<'_> {
    /// Begins a block.
    pub(super) fn open(&mut self) {
        self.lines.indent();
        self.names.open();
    }

    /// Ends a block; what was unreachable inside may be reached behind it.
    pub(super) fn close(&mut self) {
        self.names.close();
        self.lines.dedent();
    }

    /// The statements of a block, without its braces.
    pub(super) fn block_contents(&mut self, block: &Block, destination: &Destination) {
        self.statements(block);
        if let Some(value) = &block.value {
            self.store(value, destination);
        }
    }

    fn statements(&mut self, block: &Block) {
        for statement in &block.statements {
            match statement {
                Statement::Let { variable, value, origin } => self.variable(*variable, value, origin),
                Statement::Expr(expr) => self.statement(expr, &Destination::Nothing),
            }
        }
    }

    /// A block in the middle of an expression: its statements come first, its value is the text.
    pub(super) fn flattened(&mut self, block: &Block) -> Text {
        self.statements(block);
        match &block.value {
            Some(value) => self.value(value),
            None => Text::primary("0u"),
        }
    }

    /// Evaluates an expression and puts its value where it belongs.
    pub(super) fn store(&mut self, expr: &Expr, destination: &Destination) {
        match (&expr.kind, destination) {
            (_, Destination::Nothing) => self.statement(expr, destination),
            (Kind::If(branch), _) if !self.is_select(branch, expr) => self.branch(branch, expr, destination),
            (Kind::Block(block), _) => self.block_contents(block, destination),
            (Kind::Return(_) | Kind::Break | Kind::Continue, _) => self.statement(expr, destination),
            (_, Destination::Return) => {
                let text = self.value(expr);
                self.emit(format!("return {};", text.text), &expr.origin);
                self.dead = true;
            }
            (_, Destination::Assign(name)) => {
                let text = self.value(expr);
                self.emit(format!("{name} = {};", text.text), &expr.origin);
            }
        }
    }

    /// An expression that stands as a statement.
    pub(super) fn statement(&mut self, expr: &Expr, destination: &Destination) {
        match &expr.kind {
            Kind::If(branch) => self.branch(branch, expr, destination),
            Kind::Block(block) => self.nested(block, &expr.origin),
            Kind::For(each) => self.for_loop(each, &expr.origin),
            Kind::Assign { place, operator, value } => self.assign(place, *operator, value, &expr.origin),
            Kind::Return(value) => {
                self.store(value, &Destination::Return);
                self.dead = true;
            }
            Kind::Break => self.jump("break;", &expr.origin),
            Kind::Continue => self.jump("continue;", &expr.origin),
            // A value that nobody wants: only the statements it needs have an effect.
            _ if self.needs_statements(expr) => drop(self.value(expr)),
            _ => {}
        }
    }

    fn jump(&mut self, line: &str, origin: &Origin) {
        self.emit(line.to_string(), origin);
        self.dead = true;
    }

    fn nested(&mut self, block: &Block, origin: &Origin) {
        if self.dead {
            return;
        }
        self.emit("{".to_string(), origin);
        self.open();
        self.block_contents(block, &Destination::Nothing);
        self.close();
        self.lines.push("}".to_string(), &block.end);
    }

    /// `let`: a `var` where it is assigned later.
    fn variable(&mut self, variable: Option<VariableId>, value: &Expr, origin: &Origin) {
        let Some(id) = variable else { return self.statement(value, &Destination::Nothing) };
        let Some(declared) = self.function.variables.get(id) else { return };
        let (name, mutable, annotated) = (declared.name.clone(), declared.mutable, declared.annotated);
        let ty = self.function.inference.settle(declared.kind);
        if !ty.is_value() {
            return self.statement(value, &Destination::Nothing);
        }
        // The statements of a block come first; its value is what the name gets.
        let mut value = value;
        while let Kind::Block(block) = &value.kind {
            let Some(last) = &block.value else { return self.block_contents(block, &Destination::Nothing) };
            self.statements(block);
            value = last;
        }
        if let Kind::If(branch) = &value.kind
            && !self.is_select(branch, value)
        {
            let name = self.names.fresh(&name);
            self.emit(format!("var {name}: {};", ty.wgsl()), origin);
            self.store(value, &Destination::Assign(name.clone()));
            return self.spell(id, name);
        }
        let text = self.value(value);
        let name = self.names.fresh(&name);
        let word = if mutable { "var" } else { "let" };
        let written = if annotated { format!(": {}", ty.wgsl()) } else { String::new() };
        self.emit(format!("{word} {name}{written} = {};", text.text), origin);
        self.spell(id, name);
    }

    fn assign(&mut self, place: &Expr, operator: Option<Operator>, value: &Expr, origin: &Origin) {
        if let (None, Kind::Variable(id), true) = (operator, &place.kind, self.is_statement_value(value)) {
            let name = self.name_of(*id);
            return self.store(value, &Destination::Assign(name));
        }
        // Rust evaluates the value before the place.
        let shift = operator.is_some_and(Operator::is_shift);
        let text = if shift { self.shift_count(value) } else { self.value(value) };
        let place_text = self.value(place).text;
        let line = match operator {
            None => format!("{place_text} = {};", text.text),
            Some(Operator::BitXor) if self.function.type_of(place) == Type::Bool => {
                format!("{place_text} = {};", Text::binary(Operator::NotEqual, &self.value(place), &text).text)
            }
            Some(operator) => format!("{place_text} {}= {};", operator.sign(), text.text),
        };
        self.emit(line, origin);
    }

    /// Whether a value is a branch or block that can assign by itself, in each of its ways.
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
        self.emit(format!("if {} {{", condition.text), &expr.origin);
        let then_dead = self.arm(&branch.then, destination);
        let else_dead = match &branch.otherwise {
            None => false,
            Some(otherwise) => self.otherwise(otherwise, destination),
        };
        self.lines.push("}".to_string(), self.end_of_branch(branch));
        self.dead = then_dead && else_dead;
    }

    /// The arms behind the first: `} else if … {` and `} else {`. Says whether none of them ends normally.
    fn otherwise(&mut self, otherwise: &Expr, destination: &Destination) -> bool {
        match &otherwise.kind {
            Kind::If(branch) if !self.needs_statements(&branch.condition) => {
                let condition = self.value(&branch.condition);
                self.emit(format!("}} else if {} {{", condition.text), &otherwise.origin);
                let then_dead = self.arm(&branch.then, destination);
                let rest = branch.otherwise.as_ref();
                let rest_dead = rest.is_some_and(|rest| self.otherwise(rest, destination));
                then_dead && rest_dead
            }
            Kind::Block(block) if block.statements.is_empty() && block.value.is_none() => false,
            Kind::Block(block) => {
                self.emit("} else {".to_string(), &otherwise.origin);
                self.arm(block, destination)
            }
            _ => {
                self.emit("} else {".to_string(), &otherwise.origin);
                self.open();
                self.store(otherwise, destination);
                self.close();
                std::mem::replace(&mut self.dead, false)
            }
        }
    }

    /// One way of a branch; says whether it never ends normally.
    fn arm(&mut self, block: &Block, destination: &Destination) -> bool {
        self.open();
        self.block_contents(block, destination);
        self.close();
        std::mem::replace(&mut self.dead, false)
    }

    fn end_of_branch<'b>(&self, branch: &'b If) -> &'b Origin {
        match branch.otherwise.as_ref().map(|otherwise| &otherwise.kind) {
            Some(Kind::Block(block)) => &block.end,
            Some(Kind::If(inner)) => self.end_of_branch(inner),
            _ => &branch.then.end,
        }
    }
}

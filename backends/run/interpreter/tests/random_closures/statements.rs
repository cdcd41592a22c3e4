//! Random statements.

use super::expressions::{Scope, Variable};
use super::source::Source;
use super::types::Type;

const TYPES: [Type; 9] = [
    Type::U32,
    Type::I32,
    Type::F32,
    Type::U32,
    Type::Bool,
    Type::Usize,
    Type::Vector(2),
    Type::Vector(3),
    Type::Vector(4),
];

/// Names that a shading language reserves or declares.
const NAMES: [&str; 14] = [
    "v", "texture", "dot", "main", "sample", "out", "buffer", "vec", "t", "select", "min", "layer", "uniforms",
    "precise",
];

impl Scope<'_> {
    /// Returns the body of a function, with braces.
    pub fn body(&mut self, ty: Type) -> String {
        let count = self.random.below(6);
        self.braces(count, Some(ty), 3)
    }

    /// Declares a parameter.
    pub fn declare_parameter(&mut self, ty: Type, mutable: bool) -> String {
        self.names += 1;
        let name = format!("p{}", self.names);
        self.variables.push(Variable { name: name.clone(), ty, mutable });
        name
    }

    /// Returns a block with statements and, perhaps, a value.
    fn braces(&mut self, statements: usize, value: Option<Type>, depth: usize) -> String {
        let (variables, fragments) = (self.variables.len(), self.fragments.len());
        self.indent += 1;
        let mut lines = String::from("{\n");
        for _ in 0..statements {
            if self.budget == 0 {
                break;
            }
            self.budget -= 1;
            let statement = self.statement();
            self.line(&mut lines, &statement);
        }
        if let Some(ty) = value {
            let value = self.expr(ty, depth);
            self.line(&mut lines, &value.text);
        }
        self.indent -= 1;
        self.variables.truncate(variables);
        self.fragments.truncate(fragments);
        lines.push_str(&"    ".repeat(self.indent));
        lines.push('}');
        lines
    }

    fn line(&self, lines: &mut String, text: &str) {
        lines.push_str(&"    ".repeat(self.indent));
        lines.push_str(text);
        lines.push('\n');
    }

    /// Returns `if … { … } else { … }` as a value.
    pub fn branch(&mut self, ty: Type, depth: usize) -> Source {
        let condition = self.expr(Type::Bool, depth.min(2));
        let statements = if self.effects && self.random.once_in(3) { 1 } else { 0 };
        let then = self.value_arm(statements, ty, depth);
        if self.random.once_in(4) {
            let other = self.branch(ty, depth.saturating_sub(1));
            return Source::statement(format!("if {} {then} else {}", condition.text, other.text));
        }
        let other = self.value_arm(statements, ty, depth);
        Source::statement(format!("if {} {then} else {other}", condition.text))
    }

    /// Returns the arm of a branch: short, or with statements.
    fn value_arm(&mut self, statements: usize, ty: Type, depth: usize) -> String {
        match statements {
            0 => format!("{{ {} }}", self.expr(ty, depth).text),
            count => self.braces(count, Some(ty), depth),
        }
    }

    /// Returns a block that changes a variable before it has a value.
    pub fn block_value(&mut self, ty: Type, depth: usize) -> Source {
        let count = 1 + self.random.below(2);
        Source::statement(self.braces(count, Some(ty), depth))
    }

    fn statement(&mut self) -> String {
        match self.random.below(12) {
            0..=2 => self.variable(),
            3..=6 => self.assignment(),
            7 | 8 => self.conditional(),
            9 if self.loops < 2 => self.range_loop(),
            9 | 10 if self.loops < 2 && !self.lists.is_empty() => self.list_loop(),
            10 => self.leave(),
            _ => self.nested(),
        }
    }

    /// Returns a declaration; its name may hide another.
    fn variable(&mut self) -> String {
        if !self.lists.is_empty() && self.random.once_in(4) {
            return self.fragment_variable();
        }
        let ty = self.random.pick(&TYPES);
        let annotated = self.random.once_in(3);
        let value = if annotated { self.expr(ty, 3) } else { self.receiver(ty, 3) };
        let mutable = !self.random.once_in(3);
        let hides = self.variables.len() > 1 && self.random.once_in(3);
        let name = match hides {
            true => self.variables[self.random.below(self.variables.len())].name.clone(),
            false => {
                self.names += 1;
                let name = self.random.pick(&NAMES);
                if self.random.once_in(4) { name.to_owned() } else { format!("v{}", self.names) }
            }
        };
        let keyword = if mutable { "let mut" } else { "let" };
        let written = if annotated { format!(": {}", ty.rust()) } else { String::new() };
        self.variables.push(Variable { name: name.clone(), ty, mutable });
        format!("{keyword} {name}{written} = {};", value.text)
    }

    fn fragment_variable(&mut self) -> String {
        self.names += 1;
        let name = format!("g{}", self.names);
        let index = self.expr(Type::Usize, 1);
        let index = index.binary("%", &Source::primary("fragments.len()"));
        let attribute = self.random.pick(&[("depth", Type::F32), ("id", Type::U32), ("normal", Type::Vector(3))]);
        let value = self.expr(attribute.1, 2);
        self.fragments.push(name.clone());
        match self.random.once_in(2) {
            true => format!("let {name} = fragments[{}];", index.text),
            false => {
                let pad = "    ".repeat(self.indent);
                format!("let mut {name} = fragments[{}];\n{pad}{name}.{} = {};", index.text, attribute.0, value.text)
            }
        }
    }

    /// Returns an assignment to a variable, a component or an element.
    fn assignment(&mut self) -> String {
        let ty = self.random.pick(&TYPES);
        let Some(name) = self.mutable(ty) else { return self.variable() };
        if let Type::Vector(size) = ty
            && self.random.once_in(2)
        {
            let part = match self.random.below(3) {
                0 => format!("{name}[{}]", self.random.below(size)),
                1 => {
                    let index = self.expr(Type::Usize, 1).binary("%", &Source::primary(size.to_string()));
                    format!("{name}[{}]", index.text)
                }
                _ => format!("{name}.{}", ["x", "y", "z", "w"][self.random.below(size)]),
            };
            let operator = self.random.pick(&["=", "+=", "-=", "*=", "/="]);
            return format!("{part} {operator} {};", self.expr(Type::F32, 3).text);
        }
        let operators: &[&str] = match ty {
            Type::U32 | Type::I32 => &["=", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=", "<<=", ">>="],
            Type::Usize => &["=", "%="],
            Type::Bool => &["=", "&=", "|=", "^="],
            _ => &["=", "+=", "-=", "*=", "/=", "%="],
        };
        let operator = self.random.pick(operators);
        if ty == Type::Usize && operator == "%=" {
            return format!("{name} %= {};", self.random.pick(&["1", "2", "3"]));
        }
        // Rust borrows a vector before it evaluates the right side of a compound assignment.
        let outer = self.effects;
        self.effects &= operator == "=" || !matches!(ty, Type::Vector(_));
        let value = match (ty, operator) {
            (Type::Vector(_), "*=" | "/=") if self.random.once_in(2) => self.expr(Type::F32, 3),
            _ => self.expr(ty, 3),
        };
        self.effects = outer;
        format!("{name} {operator} {};", value.text)
    }

    fn conditional(&mut self) -> String {
        let condition = self.expr(Type::Bool, 2);
        let count = 1 + self.random.below(2);
        let then = self.braces(count, None, 0);
        if self.random.once_in(2) {
            return format!("if {} {then}", condition.text);
        }
        let other = self.braces(count, None, 0);
        format!("if {} {then} else {other}", condition.text)
    }

    /// Returns a loop over a range that may be empty or end at the limits of its type. It ends after a few iterations.
    fn range_loop(&mut self) -> String {
        let ty = self.random.pick(&[Type::U32, Type::I32, Type::U32]);
        let dots = self.random.pick(&["..", "..="]);
        let is_short = self.random.once_in(2);
        let (from, to) = match is_short {
            true => {
                let from = self.random.pick(&["0", "1", "2"]);
                (Source::primary(from), Source::primary(format!("{}{}", self.random.below(5), ty.rust())))
            }
            false => (self.expr(ty, 2), self.expr(ty, 2)),
        };
        let range = format!("{}{dots}{}", wrapped(&from), wrapped(&to));
        let range = if self.random.once_in(2) { format!("({range}).rev()") } else { range };
        self.names += 1;
        let (index, steps) = (format!("i{}", self.names), format!("n{}", self.names));
        let visible = self.variables.len();
        self.variables.push(Variable { name: index.clone(), ty, mutable: false });
        let mut body = self.loop_body();
        self.variables.truncate(visible);
        if is_short {
            return format!("for {index} in {range} {body}");
        }
        let pad = "    ".repeat(self.indent);
        body.insert_str(2, &format!("{pad}    if {steps} >= 4u32 {{ break; }}\n{pad}    {steps} += 1;\n"));
        format!("let mut {steps} = 0u32;\n{pad}for {index} in {range} {body}")
    }

    fn list_loop(&mut self) -> String {
        self.names += 1;
        let (index, fragment) = (format!("i{}", self.names), format!("f{}", self.names));
        let (visible, fragments) = (self.variables.len(), self.fragments.len());
        self.fragments.push(fragment.clone());
        let header = match self.random.below(4) {
            0 => format!("{fragment} in fragments"),
            1 => format!("{fragment} in fragments.iter().rev()"),
            form => {
                self.variables.push(Variable { name: index.clone(), ty: Type::Usize, mutable: false });
                format!(
                    "({index}, {fragment}) in fragments.iter().enumerate(){}",
                    if form == 2 { ".rev()" } else { "" }
                )
            }
        };
        let body = self.loop_body();
        self.variables.truncate(visible);
        self.fragments.truncate(fragments);
        format!("for {header} {body}")
    }

    fn loop_body(&mut self) -> String {
        self.loops += 1;
        let count = 1 + self.random.below(3);
        let body = self.braces(count, None, 0);
        self.loops -= 1;
        body
    }

    /// Returns a jump under a condition.
    fn leave(&mut self) -> String {
        let condition = self.expr(Type::Bool, 2);
        let jump = match (self.loops > 0, self.random.below(4)) {
            (true, 0) => "break".to_owned(),
            (true, 1 | 2) => "continue".to_owned(),
            _ => format!("return {}", self.expr(self.result, 2).text),
        };
        format!("if {} {{ {jump}; }}", condition.text)
    }

    fn nested(&mut self) -> String {
        let count = 1 + self.random.below(2);
        self.braces(count, None, 0)
    }
}

/// Returns the bound of a range: its operators bind tighter than the dots, blocks do not.
fn wrapped(source: &Source) -> String {
    if source.level == super::source::Level::Statement { format!("({})", source.text) } else { source.text.clone() }
}

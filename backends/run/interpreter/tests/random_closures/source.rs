//! Rust source with the parentheses that it needs.

/// The precedence of the outermost operator: higher binds tighter.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// `if` and blocks: always in parentheses inside of another expression.
    Statement,
    Or,
    And,
    Comparison,
    BitOr,
    BitXor,
    BitAnd,
    Shift,
    Sum,
    Product,
    Cast,
    Unary,
    Primary,
}

/// An expression.
#[derive(Clone, Debug)]
pub struct Source {
    pub text: String,
    pub level: Level,
    /// Whether it consists of literals.
    pub constant: bool,
}

impl Source {
    pub fn primary(text: impl Into<String>) -> Source {
        Source { text: text.into(), level: Level::Primary, constant: false }
    }

    pub fn statement(text: String) -> Source {
        Source { text, level: Level::Statement, constant: false }
    }

    /// Returns the text inside of an expression that binds at `level`.
    fn at_least(&self, level: Level) -> String {
        if self.level >= level { self.text.clone() } else { format!("({})", self.text) }
    }

    pub fn method(&self, name: &str, arguments: &[Source]) -> Source {
        let arguments: Vec<&str> = arguments.iter().map(|argument| argument.text.as_str()).collect();
        Source::primary(format!("{}.{name}({})", self.at_least(Level::Primary), arguments.join(", ")))
    }

    pub fn field(&self, name: &str) -> Source {
        Source::primary(format!("{}.{name}", self.at_least(Level::Primary)))
    }

    pub fn element(&self, index: &Source) -> Source {
        Source::primary(format!("{}[{}]", self.at_least(Level::Primary), index.text))
    }

    pub fn unary(&self, operator: char) -> Source {
        Source {
            text: format!("{operator}{}", self.at_least(Level::Unary)),
            level: Level::Unary,
            constant: self.constant,
        }
    }

    pub fn cast(&self, ty: &str) -> Source {
        Source { text: format!("{} as {ty}", self.at_least(Level::Cast)), level: Level::Cast, constant: self.constant }
    }

    pub fn binary(&self, operator: &str, right: &Source) -> Source {
        let level = level_of(operator);
        let least = if level == Level::Comparison { Level::BitOr } else { level };
        let mut left = self.at_least(least);
        // Rust reads `x as u32 < y` as the start of generic arguments.
        let ends_in_type = ["u32", "i32", "usize", "f32"].iter().any(|ty| left.ends_with(&format!(" as {ty}")));
        if operator.starts_with('<') && ends_in_type {
            left = format!("({left})");
        }
        let right_text = if right.level > level { right.text.clone() } else { format!("({})", right.text) };
        Source { text: format!("{left} {operator} {right_text}"), level, constant: self.constant && right.constant }
    }
}

fn level_of(operator: &str) -> Level {
    match operator {
        "*" | "/" | "%" => Level::Product,
        "+" | "-" => Level::Sum,
        "<<" | ">>" => Level::Shift,
        "&" => Level::BitAnd,
        "^" => Level::BitXor,
        "|" => Level::BitOr,
        "&&" => Level::And,
        "||" => Level::Or,
        _ => Level::Comparison,
    }
}

//! A user function after checking: a small tree in which every node has a type and a place.
//!
//! In: nothing; these are plain data. The checker builds it, the printer and the constant pass read it.

use fragbuf_model::Origin;

use crate::infer::Inference;
use crate::methods::Spelling;
use crate::types::Type;

/// Index into [`Function::variables`].
pub(crate) type VariableId = usize;

/// One checked function.
#[derive(Debug)]
pub(crate) struct Function {
    /// Its WGSL name.
    pub name: String,
    pub origin: Origin,
    pub rust: String,
    pub parameters: Vec<VariableId>,
    pub variables: Vec<Variable>,
    pub result: Type,
    pub body: Block,
    /// What the body mentions, in order.
    pub uses: Vec<Use>,
    /// What the undecided numbers turned out to be.
    pub inference: Inference,
}

impl Function {
    /// The type of an expression, numbers decided.
    pub(crate) fn type_of(&self, expr: &Expr) -> Type {
        self.inference.settle(expr.ty)
    }

    /// Whether this variable can be assigned.
    pub(crate) fn is_mutable(&self, variable: VariableId) -> bool {
        self.variables.get(variable).is_some_and(|variable| variable.mutable)
    }
}

/// A name that a function gives to a value.
#[derive(Debug)]
pub(crate) struct Variable {
    /// As the user wrote it; `_` where the user gave none.
    pub name: String,
    pub mutable: bool,
    /// Whether the user wrote its type.
    pub annotated: bool,
    pub kind: Type,
    pub origin: Origin,
}

/// Something outside a function that its body mentions.
#[derive(Clone, Debug)]
pub(crate) enum Use {
    Attribute(String),
    Uniform(String),
    /// Index of the helper, and the call's place.
    Helper(usize, Origin),
}

/// Statements, and perhaps a value at the end.
#[derive(Debug)]
pub(crate) struct Block {
    pub statements: Vec<Statement>,
    pub value: Option<Box<Expr>>,
    /// The closing brace.
    pub end: Origin,
}

#[derive(Debug)]
pub(crate) enum Statement {
    Let { variable: Option<VariableId>, value: Expr, origin: Origin },
    Expr(Expr),
}

/// An expression, its type and its place.
#[derive(Debug)]
pub(crate) struct Expr {
    pub kind: Kind,
    pub ty: Type,
    pub origin: Origin,
}

#[derive(Debug)]
pub(crate) enum Kind {
    /// What a mistake left.
    Error,
    Float(f32),
    Whole(u64),
    Bool(bool),
    Variable(VariableId),
    /// `f.depth`
    Attribute(Box<Expr>, String),
    /// `u.cut`
    Uniform(String),
    /// `v.x` and swizzles.
    Components(Box<Expr>, String),
    /// `v[i]`
    Element(Box<Expr>, Box<Expr>),
    /// `fragments[i]`
    Layer(Box<Expr>),
    /// `fragments.len()`
    LayerCount,
    Negate(Box<Expr>),
    Not(Box<Expr>),
    Binary(Operator, Box<Expr>, Box<Expr>),
    /// `… as T`, T being the node's type.
    Cast(Box<Expr>),
    /// A row of the method table; the receiver is the first argument.
    Method(Spelling, Vec<Expr>),
    /// A helper of the user's, uniforms left out.
    Helper(usize, Vec<Expr>),
    /// A vector from its components, or one for all.
    Vector(Vec<Expr>),
    If(Box<If>),
    Block(Block),
    For(Box<For>),
    Assign {
        place: Box<Expr>,
        operator: Option<Operator>,
        value: Box<Expr>,
    },
    Return(Box<Expr>),
    Break,
    Continue,
}

#[derive(Debug)]
pub(crate) struct If {
    pub condition: Expr,
    pub then: Block,
    /// A block or another `if`.
    pub otherwise: Option<Expr>,
}

#[derive(Debug)]
pub(crate) struct For {
    pub over: Over,
    pub body: Block,
}

/// What a loop goes through.
#[derive(Debug)]
pub(crate) enum Over {
    Range { variable: Option<VariableId>, kind: Type, from: Box<Expr>, to: Box<Expr>, inclusive: bool, reversed: bool },
    Fragments { index: Option<VariableId>, fragment: Option<VariableId>, reversed: bool },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Operator {
    Add,
    Subtract,
    Multiply,
    Divide,
    Remainder,
    BitAnd,
    BitOr,
    BitXor,
    ShiftLeft,
    ShiftRight,
    And,
    Or,
    Equal,
    NotEqual,
    Less,
    LessEqual,
    Greater,
    GreaterEqual,
}

impl Operator {
    /// The sign, the same in Rust and WGSL.
    pub(crate) fn sign(self) -> &'static str {
        match self {
            Operator::Add => "+",
            Operator::Subtract => "-",
            Operator::Multiply => "*",
            Operator::Divide => "/",
            Operator::Remainder => "%",
            Operator::BitAnd => "&",
            Operator::BitOr => "|",
            Operator::BitXor => "^",
            Operator::ShiftLeft => "<<",
            Operator::ShiftRight => ">>",
            Operator::And => "&&",
            Operator::Or => "||",
            Operator::Equal => "==",
            Operator::NotEqual => "!=",
            Operator::Less => "<",
            Operator::LessEqual => "<=",
            Operator::Greater => ">",
            Operator::GreaterEqual => ">=",
        }
    }

    /// `+ - * / %`
    pub(crate) fn is_arithmetic(self) -> bool {
        use Operator::*;
        matches!(self, Add | Subtract | Multiply | Divide | Remainder)
    }

    /// `<< >>`
    pub(crate) fn is_shift(self) -> bool {
        matches!(self, Operator::ShiftLeft | Operator::ShiftRight)
    }

    /// `& | ^`
    pub(crate) fn is_bitwise(self) -> bool {
        matches!(self, Operator::BitAnd | Operator::BitOr | Operator::BitXor)
    }

    /// `&& ||`
    pub(crate) fn is_logical(self) -> bool {
        matches!(self, Operator::And | Operator::Or)
    }
}

impl Expr {
    /// An expression at `origin`.
    pub(crate) fn new(kind: Kind, ty: Type, origin: Origin) -> Self {
        Expr { kind, ty, origin }
    }

    /// What a mistake leaves: agrees with everything.
    pub(crate) fn error(origin: Origin) -> Self {
        Expr::new(Kind::Error, Type::Error, origin)
    }
}

impl Kind {
    /// The expressions directly inside, blocks of statements apart.
    pub(crate) fn operands(&self) -> Vec<&Expr> {
        match self {
            Kind::Error | Kind::Float(_) | Kind::Whole(_) | Kind::Bool(_) | Kind::Variable(_) => Vec::new(),
            Kind::Uniform(_) | Kind::LayerCount | Kind::Break | Kind::Continue | Kind::Block(_) => Vec::new(),
            Kind::Attribute(inner, _) | Kind::Components(inner, _) | Kind::Layer(inner) => vec![inner],
            Kind::Negate(inner) | Kind::Not(inner) | Kind::Cast(inner) | Kind::Return(inner) => vec![inner],
            Kind::Element(a, b) | Kind::Binary(_, a, b) => vec![a, b],
            Kind::Method(_, arguments) | Kind::Helper(_, arguments) | Kind::Vector(arguments) => {
                arguments.iter().collect()
            }
            Kind::Assign { place, value, .. } => vec![place, value],
            Kind::If(branch) => std::iter::once(&branch.condition).chain(&branch.otherwise).collect(),
            Kind::For(each) => match &each.over {
                Over::Range { from, to, .. } => vec![from, to],
                Over::Fragments { .. } => Vec::new(),
            },
        }
    }

    /// The block of statements directly inside.
    pub(crate) fn block(&self) -> Option<&Block> {
        match self {
            Kind::Block(block) => Some(block),
            Kind::If(branch) => Some(&branch.then),
            Kind::For(each) => Some(&each.body),
            _ => None,
        }
    }
}

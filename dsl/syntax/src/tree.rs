//! A user function after type checking: a tree in which every node has a type and a span.
//!
//! Input: none; these types are plain data. The type checker creates them; the WGSL printer and constant folding read them.

use fragbuf_model::{SourceSpan, Spanned};

use crate::infer::Inference;
use crate::methods::Spelling;
use crate::types::{Shape, Type};

/// Index into [`Function::variables`].
pub(crate) type VariableId = usize;

/// One checked function.
#[derive(Debug)]
pub(crate) struct Function {
    /// The name in WGSL.
    pub name: String,
    pub span: SourceSpan,
    pub rust: String,
    pub parameters: Vec<VariableId>,
    pub variables: Vec<Variable>,
    pub result: Type,
    pub body: Block,
    /// The names outside the function that the body uses, in order.
    pub uses: Vec<Use>,
    /// The names of `let`s that no expression reads.
    pub unused: Vec<Spanned<String>>,
    /// The inferred types of numbers.
    pub inference: Inference,
}

impl Function {
    /// Returns the type of an expression, with numbers resolved.
    pub(crate) fn type_of(&self, expr: &Expr) -> Type {
        self.inference.resolve_or_default(expr.ty)
    }

    /// Returns whether this variable is mutable.
    pub(crate) fn is_mutable(&self, variable: VariableId) -> bool {
        self.variables.get(variable).is_some_and(|variable| variable.mutable)
    }
}

/// A local variable or parameter.
#[derive(Debug)]
pub(crate) struct Variable {
    /// The name as the user wrote it.
    pub name: String,
    pub mutable: bool,
    /// Whether the user wrote its type.
    pub annotated: bool,
    pub ty: Type,
    pub span: SourceSpan,
    /// The number of expressions that read it.
    pub reads: usize,
}

/// A use of a name outside the function.
#[derive(Clone, Debug)]
pub(crate) enum Use {
    Attribute(String),
    Uniform(String),
    Texture(String),
    Image(String),
    /// The index of the helper, and the span of the call.
    Helper(usize, SourceSpan),
}

/// Statements and an optional final value.
#[derive(Debug)]
pub(crate) struct Block {
    pub statements: Vec<Statement>,
    pub value: Option<Box<Expr>>,
    /// The span of the closing brace.
    pub end: SourceSpan,
}

#[derive(Debug)]
pub(crate) enum Statement {
    Let { variable: Option<VariableId>, value: Expr, span: SourceSpan },
    Expr(Expr),
}

/// An expression, its type and its span.
#[derive(Debug)]
pub(crate) struct Expr {
    pub kind: Kind,
    pub ty: Type,
    pub span: SourceSpan,
}

#[derive(Debug)]
pub(crate) enum Kind {
    /// An invalid expression.
    Error,
    Float(f32),
    Integer(u64),
    Bool(bool),
    Variable(VariableId),
    /// `f.depth`
    Attribute(Box<Expr>, String),
    /// `u.cut`; also `u.lut` as the receiver of a method.
    Uniform(String),
    /// `u.lut.sample(…)`: the name of the texture, the method and its arguments.
    Lookup(Shape, String, &'static str, Vec<Expr>),
    /// `v.x` and swizzles such as `v.xy()`.
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
    /// `… as T`, where T is the node's type.
    Cast(Box<Expr>),
    /// A row of the method table; the receiver is the first argument.
    Method(Spelling, Vec<Expr>),
    /// A call of a helper, without arguments that are uniforms.
    Helper(usize, Vec<Expr>),
    /// A vector from its components, or from one value for all components.
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
    pub else_branch: Option<Expr>,
}

#[derive(Debug)]
pub(crate) struct For {
    pub sequence: Sequence,
    pub body: Block,
}

/// The sequence over which a loop iterates.
#[derive(Debug)]
pub(crate) enum Sequence {
    Range { variable: Option<VariableId>, ty: Type, from: Box<Expr>, to: Box<Expr>, inclusive: bool, reversed: bool },
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
    /// Returns the symbol, which is the same in Rust and WGSL.
    pub(crate) fn symbol(self) -> &'static str {
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

    /// Returns whether this is one of `+ - * / %`.
    pub(crate) fn is_arithmetic(self) -> bool {
        use Operator::*;
        matches!(self, Add | Subtract | Multiply | Divide | Remainder)
    }

    /// Returns whether this is `<<` or `>>`.
    pub(crate) fn is_shift(self) -> bool {
        matches!(self, Operator::ShiftLeft | Operator::ShiftRight)
    }

    /// Returns whether this is one of `& | ^`.
    pub(crate) fn is_bitwise(self) -> bool {
        matches!(self, Operator::BitAnd | Operator::BitOr | Operator::BitXor)
    }

    /// Returns whether this is one of `== != < <= > >=`.
    pub(crate) fn is_comparison(self) -> bool {
        use Operator::*;
        matches!(self, Equal | NotEqual | Less | LessEqual | Greater | GreaterEqual)
    }

    /// Returns whether this is `&&` or `||`.
    pub(crate) fn is_logical(self) -> bool {
        matches!(self, Operator::And | Operator::Or)
    }
}

impl Expr {
    /// Returns an expression at `span`.
    pub(crate) fn new(kind: Kind, ty: Type, span: SourceSpan) -> Self {
        Expr { kind, ty, span }
    }

    /// Returns an invalid expression, whose type unifies with every type.
    pub(crate) fn error(span: SourceSpan) -> Self {
        Expr::new(Kind::Error, Type::Error, span)
    }
}

impl Kind {
    /// Returns the direct operands, without the contents of blocks.
    pub(crate) fn operands(&self) -> Vec<&Expr> {
        match self {
            Kind::Error | Kind::Float(_) | Kind::Integer(_) | Kind::Bool(_) | Kind::Variable(_) => Vec::new(),
            Kind::Uniform(_) | Kind::LayerCount | Kind::Break | Kind::Continue | Kind::Block(_) => Vec::new(),
            Kind::Attribute(inner, _) | Kind::Components(inner, _) | Kind::Layer(inner) => vec![inner],
            Kind::Negate(inner) | Kind::Not(inner) | Kind::Cast(inner) | Kind::Return(inner) => vec![inner],
            Kind::Element(a, b) | Kind::Binary(_, a, b) => vec![a, b],
            Kind::Method(_, arguments)
            | Kind::Helper(_, arguments)
            | Kind::Lookup(_, _, _, arguments)
            | Kind::Vector(arguments) => arguments.iter().collect(),
            Kind::Assign { place, value, .. } => vec![place, value],
            Kind::If(branch) => std::iter::once(&branch.condition).chain(&branch.else_branch).collect(),
            Kind::For(each) => match &each.sequence {
                Sequence::Range { from, to, .. } => vec![from, to],
                Sequence::Fragments { .. } => Vec::new(),
            },
        }
    }

    /// Returns the direct block of statements.
    pub(crate) fn block(&self) -> Option<&Block> {
        match self {
            Kind::Block(block) => Some(block),
            Kind::If(branch) => Some(&branch.then),
            Kind::For(each) => Some(&each.body),
            _ => None,
        }
    }
}

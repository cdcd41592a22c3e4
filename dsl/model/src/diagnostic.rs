//! What is wrong with a description: a code, the user's place, and a way out.
//!
//! Stages collect every error they can find; none stops at the first. Rendering with the source line is the caller's
//! (the command line draws it, the macro turns it into a compiler error); `Display` gives the plain form.

use std::fmt;

use crate::Origin;

/// The name of one kind of mistake, stable between versions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Code {
    /// Lower-case words joined by `-`.
    pub name: &'static str,
    /// One sentence: what is wrong in general.
    pub meaning: &'static str,
}

/// One mistake.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// Which kind.
    pub code: Code,
    /// What is wrong here, in the user's words.
    pub message: String,
    /// Where.
    pub origin: Origin,
    /// Other places that explain it.
    pub labels: Vec<Label>,
    /// The way out, as an instruction.
    pub hint: String,
}

/// Another place, and what it has to do with the mistake.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// Where.
    pub origin: Origin,
    /// Why it matters.
    pub text: String,
}

impl Diagnostic {
    /// A mistake of kind `code` at `origin`; `hint` says the way out.
    pub fn new(code: Code, origin: &Origin, message: impl Into<String>, hint: impl Into<String>) -> Self {
        Diagnostic { code, message: message.into(), origin: origin.clone(), labels: Vec::new(), hint: hint.into() }
    }

    /// Adds another place that explains the mistake.
    pub fn label(mut self, origin: &Origin, text: impl Into<String>) -> Self {
        self.labels.push(Label { origin: origin.clone(), text: text.into() });
        self
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "error[{}]: {}", self.code.name, self.message)?;
        writeln!(f, "  --> {}", self.origin)?;
        for label in &self.labels {
            writeln!(f, "  --> {}: {}", label.origin, label.text)?;
        }
        write!(f, "  = help: {}", self.hint)
    }
}

/// Every mistake that a stage found, in the order of the user's text.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Diagnostics(Vec<Diagnostic>);

impl Diagnostics {
    /// None yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds one, unless it is there already.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        if !self.0.contains(&diagnostic) {
            self.0.push(diagnostic);
        }
    }

    /// Adds all of `other`.
    pub fn extend(&mut self, other: Diagnostics) {
        other.0.into_iter().for_each(|diagnostic| self.push(diagnostic));
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// All of them.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.0.iter()
    }

    /// `value` if nothing is wrong, else the mistakes, sorted by place.
    pub fn gate<T>(mut self, value: T) -> Result<T, Diagnostics> {
        if self.0.is_empty() {
            return Ok(value);
        }
        self.0.sort_by_key(|diagnostic| (diagnostic.origin.line, diagnostic.origin.column));
        Err(self)
    }
}

impl From<Diagnostic> for Diagnostics {
    fn from(diagnostic: Diagnostic) -> Self {
        Diagnostics(vec![diagnostic])
    }
}

impl<'a> IntoIterator for &'a Diagnostics {
    type Item = &'a Diagnostic;
    type IntoIter = std::slice::Iter<'a, Diagnostic>;

    fn into_iter(self) -> Self::IntoIter {
        self.0.iter()
    }
}

impl fmt::Display for Diagnostics {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, diagnostic) in self.0.iter().enumerate() {
            let separator = if index == 0 { "" } else { "\n\n" };
            write!(f, "{separator}{diagnostic}")?;
        }
        Ok(())
    }
}

macro_rules! codes {
    ($($constant:ident $name:literal $meaning:literal;)*) => {
        /// Every kind of mistake, one constant each.
        pub mod codes {
            use super::Code;
            $(#[doc = $meaning] pub const $constant: Code = Code { name: $name, meaning: $meaning };)*
            /// The whole table.
            pub const ALL: &[Code] = &[$($constant),*];
        }
    };
}

codes! {
    // The text: tokens and grammar.
    UNREADABLE "unreadable" "The text has a token that no Rust text can have, or a bracket without its partner.";
    UNEXPECTED "unexpected" "Something else belongs here by the grammar.";
    MISSING_BUFFER "missing-buffer" "A description is one `buffer Name { … }`.";
    DUPLICATE "duplicate" "A name, a block or an axis is given twice.";
    UNKNOWN_FORMAT "unknown-format" "No attribute or uniform has a type of this name.";
    NAME_RESERVED "name-reserved" "The name belongs to the language or to generated code.";
    // The closures: the Rust subset.
    UNSUPPORTED "unsupported" "Rust has this construct, a shader description does not.";
    UNKNOWN_NAME "unknown-name" "Nothing of this name is in scope.";
    UNKNOWN_FIELD "unknown-field" "The value has no field of this name.";
    UNKNOWN_METHOD "unknown-method" "The type has no method of this name here.";
    METHOD_DIFFERS "method-differs" "The method means something else in Rust than in any shader language.";
    WRONG_TYPE "wrong-type" "The value has another type than its place needs.";
    WRONG_ARGUMENTS "wrong-arguments" "The call has too many or too few arguments.";
    NOT_MUTABLE "not-mutable" "Only a variable declared with `let mut` can be assigned.";
    UNBOUNDED_LOOP "unbounded-loop" "A loop needs an end that can be read from its head.";
    RECURSION "recursion" "Shader functions may not call themselves, not even through others.";
    MISSING_VALUE "missing-value" "Not every path gives the value that this place needs.";
    OUT_OF_RANGE "out-of-range" "The number does not fit.";
    // A WGSL file of the user's own, and the row in its head.
    MISSING_FILE "missing-file" "A file that the description names cannot be read.";
    ROW "row" "A line of the row in the file's head cannot be read.";
    UNKNOWN_FACT "unknown-fact" "There is no fact of this name.";
    UNKNOWN_RESOURCE "unknown-resource" "The row declares no buffer of this name.";
    CONTRACT "contract" "The file does not fulfil the contract of its axis.";
    REFUSED "refused" "The file's own text is no program together with the others.";
    // The description as a whole.
    UNKNOWN_TECHNIQUE "unknown-technique" "The registry has no technique of this name.";
    UNKNOWN_AXIS "unknown-axis" "The registry has no axis of this name.";
    UNKNOWN_VALUE "unknown-value" "The axis has no value of this name.";
    UNKNOWN_OPTION "unknown-option" "The value has no option of this name.";
    BAD_OPTION "bad-option" "The option's value is outside its range.";
    CAPACITY "capacity" "The number of kept fragments is outside what can be generated.";
    MISSING_DEPTH "missing-depth" "A fragment needs `depth: f32`: the kept fragments are put in its order.";
    MISSING_STORAGE "missing-storage" "Neither the description nor a preset says where fragments are stored.";
    UNMET "unmet" "A choice requires something that neither the other choices nor the description give.";
    KEEP_MISMATCH "keep-mismatch" "The storage keeps k, the description says all, or the other way round.";
    TARGET "target" "The target cannot express the variant.";
    // Ours.
    INTERNAL "internal" "Generated text was refused; this is a defect of fragbuf, not of the description.";
}

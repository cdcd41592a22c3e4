//! The errors and warnings about a description: each has a code, a span in the user's source, and a help text.
//!
//! Stages collect all errors; none stops at the first. The command line shows diagnostics with source lines, and the macro
//! turns them into compiler errors; `Display` gives the plain form.

use std::fmt;

use crate::SourceSpan;

/// A kind of error or warning. Its name is stable between versions.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Code {
    /// The name, in kebab-case.
    pub name: &'static str,
    /// One sentence that describes the error in general.
    pub meaning: &'static str,
    /// Whether it is an error.
    pub severity: Severity,
}

/// The severity of a diagnostic.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Severity {
    /// The description is invalid.
    Error,
    /// The description is valid, and a part of it has no effect.
    Warning,
}

impl Severity {
    /// Returns the word before a message.
    pub fn name(self) -> &'static str {
        match self {
            Severity::Error => "error",
            Severity::Warning => "warning",
        }
    }
}

/// One error or warning.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// The kind.
    pub code: Code,
    /// The error, with the names that the user wrote.
    pub message: String,
    /// The span of the error.
    pub span: SourceSpan,
    /// Further spans that explain it.
    pub labels: Vec<Label>,
    /// A fix, as an instruction.
    pub help: String,
}

/// A further span, and its relation to the error.
#[derive(Clone, Debug, PartialEq)]
pub struct Label {
    /// The span.
    pub span: SourceSpan,
    /// Its relation to the error.
    pub text: String,
}

impl Diagnostic {
    /// Creates a diagnostic of kind `code` at `span`; `help` is the fix.
    pub fn new(code: Code, span: &SourceSpan, message: impl Into<String>, help: impl Into<String>) -> Self {
        Diagnostic { code, message: message.into(), span: span.clone(), labels: Vec::new(), help: help.into() }
    }

    /// Returns its severity: that of its code.
    pub fn severity(&self) -> Severity {
        self.code.severity
    }

    /// Adds a further span that explains the error.
    pub fn label(mut self, span: &SourceSpan, text: impl Into<String>) -> Self {
        self.labels.push(Label { span: span.clone(), text: text.into() });
        self
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}[{}]: {}", self.severity().name(), self.code.name, self.message)?;
        writeln!(f, "  --> {}", self.span)?;
        for label in &self.labels {
            writeln!(f, "  --> {}: {}", label.span, label.text)?;
        }
        write!(f, "  = help: {}", self.help)
    }
}

/// Returns a number with its noun in the singular or the plural: `1 word`, `2 words`. The plural of `noun` ends in `s`.
pub fn counted(number: impl fmt::Display, noun: &str) -> String {
    let number = number.to_string();
    let ending = if number == "1" { "" } else { "s" };
    format!("{number} {noun}{ending}")
}

/// The errors that a stage found. [`Diagnostics::into_result`] sorts them by their position.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Diagnostics(Vec<Diagnostic>);

impl Diagnostics {
    /// Creates an empty list.
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a diagnostic if the list does not contain it.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        if !self.0.contains(&diagnostic) {
            self.0.push(diagnostic);
        }
    }

    /// Adds the diagnostics of `other`.
    pub fn extend(&mut self, other: Diagnostics) {
        other.0.into_iter().for_each(|diagnostic| self.push(diagnostic));
    }

    /// Whether the list is empty.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Iterates over the diagnostics.
    pub fn iter(&self) -> std::slice::Iter<'_, Diagnostic> {
        self.0.iter()
    }

    /// Returns `value` if there is no diagnostic; otherwise the diagnostics, sorted by span.
    pub fn into_result<T>(mut self, value: T) -> Result<T, Diagnostics> {
        if self.0.is_empty() {
            return Ok(value);
        }
        self.0.sort_by_key(|diagnostic| (diagnostic.span.line, diagnostic.span.column));
        Err(self)
    }
}

impl FromIterator<Diagnostic> for Diagnostics {
    fn from_iter<I: IntoIterator<Item = Diagnostic>>(found: I) -> Self {
        let mut diagnostics = Diagnostics::new();
        found.into_iter().for_each(|diagnostic| diagnostics.push(diagnostic));
        diagnostics
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
    ($($severity:ident { $($constant:ident $name:literal $meaning:literal;)* })*) => {
        /// The kinds of errors and warnings, one constant each.
        pub mod codes {
            use super::{Code, Severity};
            $($(#[doc = $meaning] pub const $constant: Code =
                Code { name: $name, meaning: $meaning, severity: Severity::$severity };)*)*
            /// All codes.
            pub const ALL: &[Code] = &[$($($constant),*),*];
        }
    };
}

codes! {
    Error {
        // Tokens and grammar.
        INVALID_TOKEN "invalid-token" "The source has a token that Rust does not have, or an unmatched bracket.";
        UNEXPECTED_TOKEN "unexpected-token" "The grammar expects another token here.";
        MISSING_BUFFER "missing-buffer" "A description is one `buffer Name { … }`.";
        DUPLICATE "duplicate" "A name, a built-in value, a block or an axis is given twice.";
        UNKNOWN_FORMAT "unknown-format" "There is no format or uniform type of this name.";
        NAME_RESERVED "name-reserved" "The name is reserved for the language or generated code.";
        // Closures: the Rust subset.
        UNSUPPORTED "unsupported" "Rust has this construct, but the language does not.";
        UNKNOWN_NAME "unknown-name" "No variable, function or type of this name is in scope.";
        UNKNOWN_FIELD "unknown-field" "The value has no field of this name.";
        UNKNOWN_METHOD "unknown-method" "The language has no method of this name on this type.";
        METHOD_DIFFERS "method-differs" "The method has another meaning in Rust than in shader languages.";
        TYPE_MISMATCH "type-mismatch" "The value has another type than expected.";
        ARGUMENT_COUNT "argument-count" "The call has too many or too few arguments.";
        NOT_MUTABLE "not-mutable" "Only a variable declared with `let mut` can be assigned.";
        UNBOUNDED_LOOP "unbounded-loop" "The range of a `for` loop must have an upper bound.";
        RECURSION "recursion" "Shader functions must not call themselves, directly or through other functions.";
        MISSING_VALUE "missing-value" "Not every path returns the expected value.";
        OUT_OF_RANGE "out-of-range" "The number is out of the range of its type.";
        // User files, and the row in their header.
        MISSING_FILE "missing-file" "A file that the description names cannot be read.";
        INVALID_ENCODING "invalid-encoding" "The file is not UTF-8.";
        INVALID_ROW "invalid-row" "A line of the row in the file header is invalid.";
        UNKNOWN_CAPABILITY "unknown-capability" "There is no capability of this name.";
        UNKNOWN_RESOURCE "unknown-resource" "The row declares no buffer of this name.";
        CONTRACT_MISMATCH "contract-mismatch" "The file does not implement the contract of its axis.";
        INVALID_WGSL "invalid-wgsl" "The file is not valid WGSL together with the other sources.";
        // The description as a whole.
        UNKNOWN_TECHNIQUE "unknown-technique" "The registry has no technique of this name.";
        UNKNOWN_AXIS "unknown-axis" "The registry has no axis of this name.";
        UNKNOWN_VALUE "unknown-value" "The axis has no value of this name.";
        UNKNOWN_OPTION "unknown-option" "The value has no option of this name.";
        INVALID_OPTION "invalid-option" "The option's value is outside its range.";
        K_OUT_OF_RANGE "k-out-of-range" "The number of kept fragments is out of range.";
        MISSING_DEPTH "missing-depth" "A fragment needs `depth: f32`: the kept fragments are sorted by it.";
        MISSING_STORAGE "missing-storage" "Neither the description nor a technique chooses a storage.";
        MISSING_CAPABILITY "missing-capability" "A choice requires something that neither the other choices nor the description provide.";
        KEEP_MISMATCH "keep-mismatch" "The storage keeps k fragments and the description all, or the reverse.";
        UNSUPPORTED_TARGET "unsupported-target" "The target cannot express the variant.";
        // Defects of fragbuf.
        INTERNAL "internal" "Generated source is invalid; this is a defect of fragbuf, not of the description.";
    }
    Warning {
        UNUSED_ATTRIBUTE "unused-attribute" "Neither a closure nor a choice reads the attribute, but every fragment stores it.";
        UNUSED_UNIFORM "unused-uniform" "No closure reads the uniform.";
        UNUSED_FUNCTION "unused-function" "No closure calls the function.";
        UNUSED_VARIABLE "unused-variable" "No expression reads the variable.";
        SWAPPED_ARGUMENTS "swapped-arguments" "The bounds of a call or of a range are in the wrong order, so its result does not depend on its input.";
        UNUSED_EFFECT "unused-effect" "No pass of the user file computes the effect, so nothing is drawn.";
        MISSING_CLEAR "missing-clear" "A pass reads words of a buffer that no earlier pass writes and no `clear` sets.";
    }
}

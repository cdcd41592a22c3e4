//! What an editor shows about a description while a user types: diagnostics with their fixes as edits, the meaning of a name, what
//! can be written at an offset and why not, declarations, and an outline.
//!
//! Input: the text of a `.fragbuf` file, which may be incomplete, and offsets in bytes. Output: plain data. Messages, spans and fixes are
//! those of the compiler, and descriptions of rows are those of the registry: nothing here repeats them. Every text and every offset
//! has an answer. Nothing is read, unless [`Document::with_files`] asks for the user files that the text names.
//!
//! ```
//! # use fragbuf::{Registry, analysis::Document};
//! let registry = Registry::builtin();
//! let document = Document::new("buffer B from kplus_aray {\n    keep 8;\n}", "b.fragbuf", &registry);
//! let found = document.diagnostics();
//! assert_eq!((found[0].code, &*found[0].help.split('?').next().unwrap()), ("unknown-technique", "did you mean `kplus_array`"));
//! assert_eq!(document.with_edits(&found[0].fixes[0].edits), "buffer B from kplus_array {\n    keep 8;\n}");
//! ```

mod completion;
mod context;
mod definition;
mod diagnostics;
mod fixes;
mod hover;
mod markdown;
mod outline;
mod placeholder;
mod positions;
mod scan;
mod values;

use std::borrow::Cow;
use std::path::Path;

use fragbuf_model::{Diagnostic, Draft, SourceSpan, Variant};
use fragbuf_syntax::{Parsed, parse};
use fragbuf_templates::Registry;

use crate::{load, source_file};
pub use completion::{Completion, CompletionKind};
pub use definition::Definition;
pub use diagnostics::{Edit, Fix, Found, Label};
pub use hover::Hover;
pub use markdown::option;
pub use outline::{Symbol, SymbolKind};
pub use positions::{Lines, Position, TextSpan};
pub use values::{AxisValue, AxisValues};

/// The text of a description, with the surroundings that its meaning depends on.
#[derive(Clone, Copy, Debug)]
pub struct Document<'a> {
    text: &'a str,
    path: &'a str,
    registry: &'a Registry,
    reads_files: bool,
}

/// A compiled text.
pub(crate) struct Compiled<'a> {
    draft: Option<Draft>,
    variant: Option<Variant>,
    /// The errors, or the warnings of a valid description.
    diagnostics: Vec<Diagnostic>,
    /// The registry with the rows of user files.
    registry: Cow<'a, Registry>,
    /// The user files that were read, by their names in messages.
    files: Vec<(String, String)>,
}

impl<'a> Document<'a> {
    /// Makes a document. Messages call it `path`.
    pub fn new(text: &'a str, path: &'a str, registry: &'a Registry) -> Self {
        Document { text, path, registry, reads_files: false }
    }

    /// Makes the analysis read the user files that the text names, relative to the path of the document.
    pub fn with_files(self) -> Self {
        Document { reads_files: true, ..self }
    }

    /// Returns the text.
    pub fn text(&self) -> &'a str {
        self.text
    }

    /// Returns the lines of the text, which convert offsets.
    pub fn lines(&self) -> Lines<'a> {
        Lines::new(self.text)
    }

    /// Whether the text is longer than a source can be. Only [`Document::diagnostics`] then has an answer.
    fn is_too_long(&self) -> bool {
        self.text.len() as u64 > source_file::MAX_BYTES
    }

    /// Returns the checked description; `None`: it has errors.
    pub fn variant(&self) -> Option<Variant> {
        if self.is_too_long() { None } else { self.compile().variant }
    }

    /// Compiles the text as the command line does.
    fn compile(&self) -> Compiled<'a> {
        let parsed = parse(self.text, self.path);
        self.check(parsed)
    }

    fn check(&self, parsed: Parsed) -> Compiled<'a> {
        let Parsed { draft, diagnostics } = parsed;
        let mut compiled = Compiled {
            draft: draft.clone(),
            variant: None,
            diagnostics: Vec::new(),
            registry: Cow::Borrowed(self.registry),
            files: Vec::new(),
        };
        let result = match draft {
            None => Err(diagnostics),
            Some(draft) if self.reads_files && load::names_files(&draft) => {
                let loaded = load::check_with_files(draft, diagnostics, self.path, self.registry);
                compiled.registry = Cow::Owned(loaded.registry);
                compiled.files = loaded.sources;
                loaded.variant
            }
            Some(draft) => {
                let parsed = Parsed { draft: Some(draft), diagnostics };
                let files = self.reads_files;
                load::check_without_files(&parsed, self.path, self.registry, files)
            }
        };
        match result {
            Ok(variant) => {
                compiled.diagnostics = variant.warnings.iter().cloned().collect();
                compiled.variant = Some(variant);
            }
            Err(errors) => compiled.diagnostics = errors.iter().cloned().collect(),
        }
        compiled
    }

    /// Whether a span is in this document.
    fn contains(&self, span: &SourceSpan) -> bool {
        *span.file == *self.path
    }

    /// Returns the path of a user file as messages name it.
    fn file_name(&self, path: &str) -> String {
        Path::new(self.path).parent().unwrap_or(Path::new("")).join(path).display().to_string()
    }
}

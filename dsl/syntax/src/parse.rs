//! Parses the source or the tokens of a description.
//!
//! Input: source or tokens. Output: [`Parsed`]. The steps run one after another: lexer, limits, grammar, then type check
//! and lowering in [`crate::draft`].

use fragbuf_model::{Diagnostics, Draft, SourceSpan, Variant, check};
use fragbuf_templates::Registry;
use proc_macro2::{Span, TokenStream};

use crate::raw_function::FunctionTokens;
use crate::report::Report;
use crate::{draft, grammar, lexer, token_limits};

/// The result of parsing a description.
#[derive(Clone, Debug)]
pub struct Parsed {
    /// The description without the functions that have errors. `None` if the source has no `buffer`.
    pub draft: Option<Draft>,
    /// Every error, in source order. If there are none, the draft is complete.
    pub diagnostics: Diagnostics,
}

impl Parsed {
    /// Returns the variant if the source has no error and the rules accept the draft. The rules also run on a draft with
    /// errors, so that all errors are reported together.
    pub fn check(&self, registry: &Registry) -> Result<Variant, Diagnostics> {
        let mut diagnostics = self.diagnostics.clone();
        let Some(draft) = &self.draft else { return Err(diagnostics) };
        match check(draft, registry) {
            Ok(variant) => diagnostics.into_result(variant),
            Err(more) => {
                diagnostics.extend(more);
                // There is at least one diagnostic, so the second check never runs.
                diagnostics.into_result(()).and_then(|()| check(draft, registry))
            }
        }
    }
}

/// Parses the source of a `.fragbuf` file; messages call the file `file`.
pub fn parse(source: &str, file: &str) -> Parsed {
    let locate = lexer::locator(source, file);
    match lexer::tokens(source, file) {
        Ok(tokens) => parse_tokens(tokens, &locate),
        Err(invalid) => Parsed { draft: None, diagnostics: (*invalid).into() },
    }
}

/// Parses the tokens of a description; `locate` maps each token span to the user's source.
pub fn parse_tokens(tokens: TokenStream, locate: &dyn Fn(Span) -> SourceSpan) -> Parsed {
    read_tokens(tokens, locate).0
}

/// Parses the tokens of a description, and returns the tokens of each function too, including those that the draft omits.
pub fn read_tokens(tokens: TokenStream, locate: &dyn Fn(Span) -> SourceSpan) -> (Parsed, Vec<FunctionTokens>) {
    let mut report = Report::new(locate);
    let (draft, functions) = read(tokens, &mut report);
    (Parsed { draft, diagnostics: report.finish() }, functions)
}

/// Parses the tokens of a description: the draft, and the tokens of each function.
pub(crate) fn read(tokens: TokenStream, report: &mut Report) -> (Option<Draft>, Vec<FunctionTokens>) {
    let description = token_limits::bounded(tokens, report).and_then(|tokens| grammar::description(tokens, report));
    match description {
        Some(mut description) => {
            let functions = std::mem::take(&mut description.items.function_tokens);
            (Some(draft::build(description, report)), functions)
        }
        None => (None, Vec::new()),
    }
}

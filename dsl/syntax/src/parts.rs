//! A description as parts, for the builder.
//!
//! Input: [`Parts`], plain data with a span for each part. Output: the same [`Parsed`] as from the source of the same
//! description: all front ends share the rules, the type checker and the lowering.

use fragbuf_model::{Choice, Format, Incomplete, KeepCount, SourceSpan, Spanned, TextureDimension, UniformType};
use proc_macro2::{Span, TokenStream};

use crate::captured_tokens::CapturedTokens;
use crate::declarations::Declaration;
use crate::items::{Items, RawDescription};
use crate::parse::Parsed;
use crate::raw_function::{RawFunction, Role};
use crate::report::{Report, Stop};
use crate::{draft, grammar, names, token_limits};

/// The parts of a description. Names are as in a file.
#[derive(Clone, Debug)]
pub struct Parts {
    /// The name after `buffer`.
    pub name: Spanned<String>,
    /// The technique after `from`.
    pub preset: Option<Spanned<String>>,
    /// All other parts, in the order in which they were added.
    pub items: Vec<Part>,
}

/// One part of a description, with its span.
#[derive(Clone, Debug)]
pub enum Part {
    /// A line of `fragment { }`.
    Attribute(Spanned<String>, Format),
    /// A line of `uniform { }`.
    Uniform(Spanned<String>, UniformType),
    /// A line of `texture { }`.
    Texture(Spanned<String>, TextureDimension),
    /// `keep`, and the closure after `least`.
    Keep(Spanned<KeepCount>, Option<CapturedTokens>),
    /// The closure after `where`.
    Constraint(CapturedTokens),
    /// `axis: value else value;`
    Choice(Choice),
    /// The closure after `resolve`.
    Resolve(CapturedTokens, SourceSpan),
    /// The closure after `between`.
    Between(CapturedTokens, SourceSpan),
    /// The name and the closure after `image`.
    Image(Spanned<String>, CapturedTokens),
    /// A helper function.
    Helper(CapturedTokens),
}

/// Returns the description that consists of these parts.
pub fn assemble(parts: &Parts) -> Parsed {
    let mut spans = SpanTable { functions: Vec::new(), default: parts.name.span.clone() };
    let mut invalid = Vec::new();
    let tokens: Vec<Option<TokenStream>> = parts
        .items
        .iter()
        .map(|part| match captured(part)?.tokens() {
            Ok(tokens) => Some(spans.add(captured(part)?, tokens)),
            Err(error) => {
                invalid.push(*error);
                None
            }
        })
        .collect();
    let locate = |span: Span| spans.locate(span);
    let mut report = Report::new(&locate);
    invalid.into_iter().for_each(|error| report.push(error));
    let name = names::buffer(&parts.name, &mut report);
    let preset = parts.preset.as_ref().map(|preset| names::identifier(preset, &mut report));
    let mut assembly = Assembly::default();
    for (part, tokens) in parts.items.iter().zip(tokens) {
        // An error is reported already; the other parts are still added.
        if assembly.add(part, tokens, &mut report).is_err() {
            assembly.items.incomplete = assembly.items.incomplete.or(incomplete(part));
        }
    }
    let Assembly { mut items, attributes, uniforms, textures } = assembly;
    items.add_attributes(attributes, &parts.name.span, &mut report);
    items.add_uniforms(uniforms, &parts.name.span, &mut report);
    items.add_textures(textures, &parts.name.span, &mut report);
    let draft = draft::build(RawDescription { name, preset, items }, &mut report);
    Parsed { draft: Some(draft), diagnostics: report.finish() }
}

fn captured(part: &Part) -> Option<&CapturedTokens> {
    match part {
        Part::Constraint(function) | Part::Helper(function) => Some(function),
        Part::Resolve(function, _) | Part::Between(function, _) | Part::Image(_, function) => Some(function),
        Part::Keep(_, criterion) => criterion.as_ref(),
        Part::Attribute(..) | Part::Uniform(..) | Part::Texture(..) | Part::Choice(_) => None,
    }
}

/// Returns the part of a draft that is incomplete without this part.
fn incomplete(part: &Part) -> Incomplete {
    let none = Incomplete::default();
    match part {
        Part::Attribute(..) => Incomplete { attributes: true, ..none },
        Part::Uniform(..) | Part::Texture(..) | Part::Image(..) => Incomplete { uniforms: true, ..none },
        Part::Keep(..) => Incomplete { keep: true, ..none },
        Part::Constraint(_) => none,
        Part::Choice(_) => Incomplete { choices: true, ..none },
        Part::Resolve(..) | Part::Between(..) => Incomplete { resolve: true, ..none },
        Part::Helper(_) => Incomplete { helpers: true, ..none },
    }
}

/// The items so far, and the declarations of the blocks.
#[derive(Default)]
struct Assembly {
    items: Items,
    attributes: Vec<Declaration>,
    uniforms: Vec<Declaration>,
    textures: Vec<Declaration>,
}

impl Assembly {
    fn add(&mut self, part: &Part, tokens: Option<TokenStream>, report: &mut Report) -> Result<(), Stop> {
        match part {
            Part::Attribute(name, format) => self.attributes.push(declaration(name, format.keyword())),
            Part::Uniform(name, kind) => self.uniforms.push(declaration(name, kind.keyword())),
            Part::Texture(name, dimension) => self.textures.push(declaration(name, dimension.keyword())),
            Part::Choice(choice) => {
                let choice = grammar::choice_from_builder(choice, report)?;
                self.items.add_choice(choice, report);
            }
            Part::Keep(count, None) => self.items.add_keep(count.clone(), None, count.span.clone(), report),
            Part::Keep(count, Some(_)) => {
                let function = closure(tokens, Role::Criterion, report)?;
                self.items.add_keep(count.clone(), Some(function), count.span.clone(), report);
            }
            Part::Constraint(_) => {
                let role = self.items.next_constraint();
                self.items.functions.push(closure(tokens, role, report)?);
            }
            Part::Resolve(_, span) => {
                self.items.effect.get_or_insert(span.clone());
                let function = closure(tokens, Role::Resolve, report)?;
                self.items.add_resolve(function, span, report);
            }
            Part::Between(_, span) => {
                self.items.effect.get_or_insert(span.clone());
                let function = closure(tokens, Role::Between, report)?;
                self.items.add_resolve(function, span, report);
            }
            Part::Image(name, _) => {
                let name = names::declared(name, "image", report);
                let function = closure(tokens, Role::Image(name.value.clone()), report)?;
                self.items.add_image(name, function);
            }
            Part::Helper(_) => {
                let tokens = bounded(tokens, report)?;
                let function = grammar::whole_helper(&tokens, report)?;
                self.items.add_helper(function, report);
            }
        }
        Ok(())
    }
}

fn declaration(name: &Spanned<String>, type_name: &str) -> Declaration {
    Declaration { name: name.clone(), type_name: Spanned::new(type_name.to_owned(), name.span.clone()) }
}

fn closure(tokens: Option<TokenStream>, role: Role, report: &mut Report) -> Result<RawFunction, Stop> {
    let tokens = bounded(tokens, report)?;
    grammar::whole_closure(&tokens, role, report)
}

fn bounded(tokens: Option<TokenStream>, report: &mut Report) -> Result<TokenStream, Stop> {
    tokens.and_then(|tokens| token_limits::bounded(tokens, report)).ok_or(Stop)
}

/// A function from token spans to source spans.
type Locator = Box<dyn Fn(Span) -> SourceSpan>;

/// The source spans of all captured functions. `proc_macro2` gives each function's source a distinct file name.
struct SpanTable {
    /// File name and source spans of each function.
    functions: Vec<(String, Locator)>,
    default: SourceSpan,
}

impl SpanTable {
    fn add(&mut self, captured: &CapturedTokens, tokens: TokenStream) -> TokenStream {
        if let Some(first) = tokens.clone().into_iter().next() {
            self.functions.push((first.span().file(), Box::new(captured.locator())));
        }
        tokens
    }

    fn locate(&self, span: Span) -> SourceSpan {
        let name = span.file();
        let found = self.functions.iter().find(|(file, _)| *file == name);
        found.map_or_else(|| self.default.clone(), |(_, locate)| locate(span))
    }
}

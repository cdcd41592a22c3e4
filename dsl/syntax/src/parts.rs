//! A description put together by a program instead of written: what the builder hands over.
//!
//! In: [`Parts`], plain data with a place for each part. Out: the same [`Parsed`] that the text of the same description
//! gives: one set of rules, one type checker, one lowering for all doors. Nothing here is checked twice or otherwise.

use fragbuf_model::{Choice, Format, KeepCount, Origin, Spanned, UniformType};
use proc_macro2::{Span, TokenStream};

use crate::captured::Captured;
use crate::grammar::{self, Role, Row, Stop};
use crate::report::Report;
use crate::{Parsed, functions, nesting};

/// The parts of a description. Words are as a file would have them.
#[derive(Clone, Debug)]
pub struct Parts {
    /// Behind `buffer`.
    pub name: Spanned<String>,
    /// Behind `from`.
    pub preset: Option<Spanned<String>>,
    /// Everything else, in the order in which it was said.
    pub items: Vec<Part>,
}

/// One part of a description, with the place where it was said.
#[derive(Clone, Debug)]
pub enum Part {
    /// A row of `fragment { }`.
    Attribute(Spanned<String>, Format),
    /// A row of `uniform { }`.
    Uniform(Spanned<String>, UniformType),
    /// `keep`, and the closure behind `least`.
    Keep(Spanned<KeepCount>, Option<Captured>),
    /// The closure behind `where`.
    Constraint(Captured),
    /// `axis: value else value;`
    Choice(Choice),
    /// The closure behind `resolve`.
    Resolve(Captured, Origin),
    /// A helper function.
    Helper(Captured),
}

/// The description that these parts make.
pub fn assemble(parts: &Parts) -> Parsed {
    let mut sources = Sources { read: Vec::new(), otherwise: parts.name.origin.clone() };
    let mut unreadable = Vec::new();
    let tokens: Vec<Option<TokenStream>> = parts
        .items
        .iter()
        .map(|part| match captured(part)?.tokens() {
            Ok(tokens) => Some(sources.add(captured(part)?, tokens)),
            Err(mistake) => {
                unreadable.push(*mistake);
                None
            }
        })
        .collect();
    let place = |span: Span| sources.place(span);
    let mut report = Report::new(&place);
    unreadable.into_iter().for_each(|mistake| report.push(mistake));
    let name = grammar::buffer_name(&parts.name, &mut report);
    let preset = parts.preset.as_ref().map(|preset| grammar::word(preset, &mut report));
    let mut assembly = Assembly { items: grammar::Items::default(), attributes: Vec::new(), uniforms: Vec::new() };
    for (part, tokens) in parts.items.iter().zip(tokens) {
        // What went wrong is reported; the other parts are worth reading.
        let _: Result<(), Stop> = assembly.add(part, tokens, &mut report);
    }
    let Assembly { mut items, attributes, uniforms } = assembly;
    items.add_rows(attributes, uniforms, &mut report);
    let draft = functions::finish(name, preset, items, &mut report);
    Parsed { draft: Some(draft), diagnostics: report.finish() }
}

fn captured(part: &Part) -> Option<&Captured> {
    match part {
        Part::Constraint(function) | Part::Resolve(function, _) | Part::Helper(function) => Some(function),
        Part::Keep(_, criterion) => criterion.as_ref(),
        Part::Attribute(..) | Part::Uniform(..) | Part::Choice(_) => None,
    }
}

struct Assembly {
    items: grammar::Items,
    attributes: Vec<Row>,
    uniforms: Vec<Row>,
}

impl Assembly {
    fn add(&mut self, part: &Part, tokens: Option<TokenStream>, report: &mut Report) -> Result<(), Stop> {
        match part {
            Part::Attribute(name, format) => self.attributes.push(row(name, format.keyword())),
            Part::Uniform(name, kind) => self.uniforms.push(row(name, kind.keyword())),
            Part::Choice(choice) => {
                let choice = grammar::given_choice(choice, report)?;
                self.items.add_choice(choice, report);
            }
            Part::Keep(count, None) => self.items.add_keep(count.clone(), None, count.origin.clone(), report),
            Part::Keep(count, Some(_)) => {
                let function = closure(tokens, Role::Criterion, report)?;
                self.items.add_keep(count.clone(), Some(function), count.origin.clone(), report);
            }
            Part::Constraint(_) => {
                let role = self.items.next_constraint();
                self.items.functions.push(closure(tokens, role, report)?);
            }
            Part::Resolve(_, origin) => {
                let function = closure(tokens, Role::Resolve, report)?;
                self.items.add_resolve(function, origin, report);
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

fn row(name: &Spanned<String>, word: &str) -> Row {
    Row { name: name.clone(), word: Spanned::new(word.to_owned(), name.origin.clone()) }
}

fn closure(tokens: Option<TokenStream>, role: Role, report: &mut Report) -> Result<grammar::RawFunction, Stop> {
    let tokens = bounded(tokens, report)?;
    grammar::whole_closure(&tokens, role, report)
}

fn bounded(tokens: Option<TokenStream>, report: &mut Report) -> Result<TokenStream, Stop> {
    tokens.and_then(|tokens| nesting::bounded(tokens, report)).ok_or(Stop)
}

/// From a span to the user's place.
type Placing = Box<dyn Fn(Span) -> Origin>;

/// Which span belongs to which captured function. Each is a text of its own to `proc_macro2`, under a name of its own.
struct Sources {
    read: Vec<(String, Placing)>,
    otherwise: Origin,
}

impl Sources {
    fn add(&mut self, captured: &Captured, tokens: TokenStream) -> TokenStream {
        if let Some(first) = tokens.clone().into_iter().next() {
            self.read.push((first.span().file(), Box::new(captured.place())));
        }
        tokens
    }

    fn place(&self, span: Span) -> Origin {
        let name = span.file();
        let found = self.read.iter().find(|(file, _)| *file == name);
        found.map_or_else(|| self.otherwise.clone(), |(_, place)| place(span))
    }
}

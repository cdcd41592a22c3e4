//! The items of a buffer, and how reading goes on after a broken one.
//!
//! In: the tokens inside the buffer's braces. Out: [`Items`]: everything as written, closures still unchecked.

use fragbuf_model::{Attribute, Choice, Diagnostic, KeepCount, Origin, Spanned, Uniform, codes};
use proc_macro2::{Delimiter, Spacing, TokenTree};

use super::cursor::{Cursor, is_sign};
use super::{RawFunction, Role, Row, Stop, Written, blocks, choices, closures};
use crate::near;
use crate::report::Report;

/// Everything that stands in a buffer's braces.
#[derive(Default)]
pub(crate) struct Items {
    pub attributes: Vec<Attribute>,
    pub uniforms: Vec<Uniform>,
    /// Attributes and uniforms whose type was refused.
    pub broken_attributes: Vec<String>,
    pub broken_uniforms: Vec<String>,
    /// How many are kept, and where the line stands.
    pub keep: Option<(Spanned<KeepCount>, Origin)>,
    pub choices: Vec<Choice>,
    /// Criterion, constraints, resolve and helpers, in the user's order.
    pub functions: Vec<RawFunction>,
    /// The same in the user's own tokens, also those that could not be read.
    pub written: Vec<Written>,
    fragment_block: Option<Origin>,
    uniform_block: Option<Origin>,
    constraints: usize,
}

/// The words that begin an item.
const WORDS: [&str; 6] = ["fragment", "uniform", "keep", "where", "resolve", "fn"];

impl Items {
    /// Reads all items.
    pub(crate) fn read(&mut self, cursor: &mut Cursor, report: &mut Report) {
        while !cursor.is_done() {
            if cursor.sign(';') {
                continue;
            }
            let before = cursor.position();
            if self.item(cursor, report).is_err() {
                recover(cursor, before);
            }
        }
    }

    fn item(&mut self, cursor: &mut Cursor, report: &mut Report) -> Result<(), Stop> {
        let origin = cursor.origin(report);
        let word = match cursor.peek() {
            Some(TokenTree::Ident(word)) => word.to_string(),
            _ => return Err(unknown_item(cursor, None, report)),
        };
        if is_sign(cursor.peek_second(), ':') {
            return self.choice(cursor, report);
        }
        match word.as_str() {
            "fragment" => self.fragment(cursor, origin, report),
            "uniform" => self.uniform(cursor, origin, report),
            "keep" => self.keep(cursor, origin, report),
            "where" => self.constraint(cursor, report),
            "resolve" => self.resolve(cursor, origin, report),
            "fn" => self.helper(cursor, report),
            _ => Err(unknown_item(cursor, Some(&word), report)),
        }
    }

    fn fragment(&mut self, cursor: &mut Cursor, origin: Origin, report: &mut Report) -> Result<(), Stop> {
        cursor.take();
        let rows = blocks::rows(cursor, "fragment { color: rgba8, depth: f32 }", report)?;
        let (read, broken) = blocks::attributes(rows, report);
        if is_first(&mut self.fragment_block, &origin, "fragment", report) {
            (self.attributes, self.broken_attributes) = (read, broken);
        }
        Ok(())
    }

    fn uniform(&mut self, cursor: &mut Cursor, origin: Origin, report: &mut Report) -> Result<(), Stop> {
        cursor.take();
        let rows = blocks::rows(cursor, "uniform { cut: f32 }", report)?;
        let (read, broken) = blocks::uniforms(rows, report);
        if is_first(&mut self.uniform_block, &origin, "uniform", report) {
            (self.uniforms, self.broken_uniforms) = (read, broken);
        }
        Ok(())
    }

    /// The rows of both blocks, for a door that has no blocks.
    pub(crate) fn add_rows(&mut self, attributes: Vec<Row>, uniforms: Vec<Row>, report: &mut Report) {
        (self.attributes, self.broken_attributes) = blocks::attributes(attributes, report);
        (self.uniforms, self.broken_uniforms) = blocks::uniforms(uniforms, report);
    }

    fn keep(&mut self, cursor: &mut Cursor, origin: Origin, report: &mut Report) -> Result<(), Stop> {
        cursor.take();
        let count = choices::count(cursor, report)?;
        let criterion = if cursor.word("least") {
            Some(closures::closure(cursor, Role::Criterion, &mut self.written, report)?)
        } else {
            if cursor.at_word("greatest") || cursor.at_word("most") {
                let message = format!("only `least` chooses, not {}", cursor.describe());
                let hint = "negate what is compared: `keep 8 least |f| -f.depth;`";
                report.error(codes::UNEXPECTED, &cursor.origin(report), message, hint);
                return Err(Stop);
            }
            end_of_item(cursor, "keep 8;` or, to choose by a value, `keep 8 least |f| …;", report)?;
            None
        };
        self.add_keep(count, criterion, origin, report);
        Ok(())
    }

    /// The line `keep`, unless there is one.
    pub(crate) fn add_keep(
        &mut self,
        count: Spanned<KeepCount>,
        criterion: Option<RawFunction>,
        origin: Origin,
        report: &mut Report,
    ) {
        if let Some((_, first)) = &self.keep {
            let diagnostic =
                Diagnostic::new(codes::DUPLICATE, &origin, "`keep` is given twice", "leave one of them out");
            report.push(diagnostic.label(first, "the first is here"));
            return;
        }
        self.keep = Some((count, origin));
        self.functions.extend(criterion);
    }

    fn constraint(&mut self, cursor: &mut Cursor, report: &mut Report) -> Result<(), Stop> {
        cursor.take();
        let role = self.next_constraint();
        self.functions.push(closures::closure(cursor, role, &mut self.written, report)?);
        Ok(())
    }

    /// The role of one constraint more.
    pub(crate) fn next_constraint(&mut self) -> Role {
        self.constraints += 1;
        Role::Admit(self.constraints - 1)
    }

    fn resolve(&mut self, cursor: &mut Cursor, origin: Origin, report: &mut Report) -> Result<(), Stop> {
        cursor.take();
        let function = closures::closure(cursor, Role::Resolve, &mut self.written, report)?;
        self.add_resolve(function, &origin, report);
        Ok(())
    }

    /// The effect, unless there is one.
    pub(crate) fn add_resolve(&mut self, function: RawFunction, origin: &Origin, report: &mut Report) {
        let first = self.functions.iter().find(|other| other.role == Role::Resolve).map(|other| &other.origin);
        let first = first.or_else(|| self.chosen("resolve"));
        if let Some(first) = first {
            report.push(twice("resolve", origin, first));
            return;
        }
        self.functions.push(function);
    }

    fn helper(&mut self, cursor: &mut Cursor, report: &mut Report) -> Result<(), Stop> {
        let function = closures::helper(cursor, &mut self.written, report)?;
        self.add_helper(function, report);
        Ok(())
    }

    /// A helper function, unless there is one of its name.
    pub(crate) fn add_helper(&mut self, function: RawFunction, report: &mut Report) {
        let same = |other: &&RawFunction| other.role == function.role;
        if let Some(first) = self.functions.iter().find(same) {
            let message = format!("the function `{}` is given twice", function.role.rust_name());
            let diagnostic = Diagnostic::new(codes::DUPLICATE, &function.name_origin, message, "rename one of them");
            report.push(diagnostic.label(&first.name_origin, "the first is here"));
            return;
        }
        self.functions.push(function);
    }

    fn choice(&mut self, cursor: &mut Cursor, report: &mut Report) -> Result<(), Stop> {
        let choice = choices::choice(cursor, report)?;
        self.add_choice(choice, report);
        Ok(())
    }

    /// A choice, unless there is one on its axis.
    pub(crate) fn add_choice(&mut self, choice: Choice, report: &mut Report) {
        let axis = choice.axis.value.as_str();
        let function = self.functions.iter().find(|other| axis == "resolve" && other.role == Role::Resolve);
        let first = self.chosen(axis).or(function.map(|other| &other.origin));
        if let Some(first) = first {
            report.push(twice(axis, &choice.axis.origin, first));
            return;
        }
        self.choices.push(choice);
    }

    fn chosen(&self, axis: &str) -> Option<&Origin> {
        self.choices.iter().find(|other| other.axis.value == axis).map(|other| &other.axis.origin)
    }
}

fn twice(axis: &str, origin: &Origin, first: &Origin) -> Diagnostic {
    let message = format!("`{axis}` is given twice");
    let hint = "leave one of them out; alternatives go on one line: `first else second`";
    Diagnostic::new(codes::DUPLICATE, origin, message, hint).label(first, "the first is here")
}

fn is_first(slot: &mut Option<Origin>, origin: &Origin, block: &str, report: &mut Report) -> bool {
    if let Some(first) = slot {
        let message = format!("`{block} {{ }}` is given twice");
        let diagnostic = Diagnostic::new(codes::DUPLICATE, origin, message, "put everything into one block");
        report.push(diagnostic.label(first, "the first is here"));
        return false;
    }
    *slot = Some(origin.clone());
    true
}

fn unknown_item(cursor: &Cursor, word: Option<&str>, report: &mut Report) -> Stop {
    if cursor.at_sign('#') {
        let hint = "leave it out; what it would switch has no counterpart in a shader";
        report.error(codes::UNSUPPORTED, &cursor.origin(report), "attributes are not part of the language", hint);
        return Stop;
    }
    let message = match word {
        Some("buffer") => "a buffer cannot stand inside another".to_string(),
        _ => format!("{} begins no item of a buffer", cursor.describe()),
    };
    let hint = match word.and_then(|word| near::nearest(word, &WORDS)) {
        _ if matches!(word, Some("pub" | "unsafe" | "const" | "async" | "extern")) => {
            "helper functions begin with `fn`: leave this word out".to_string()
        }
        Some(near) => format!("did you mean `{near}`?"),
        None => "items begin with `fragment`, `uniform`, `keep`, `where`, `resolve`, `fn`, or `axis:`".to_string(),
    };
    report.error(codes::UNEXPECTED, &cursor.origin(report), message, hint);
    Stop
}

/// Takes the `;` of an item; where it is missing but the next item begins, reading goes on there.
pub(crate) fn end_of_item(cursor: &mut Cursor, shape: &str, report: &mut Report) -> Result<(), Stop> {
    if cursor.sign(';') {
        return Ok(());
    }
    let message = format!("`;` belongs here, not {}", cursor.describe());
    report.error(codes::UNEXPECTED, &cursor.origin(report), message, format!("end the item with `;`: `{shape}`"));
    if begins_item(cursor) { Ok(()) } else { Err(Stop) }
}

/// Whether the next tokens can only be a new item.
pub(crate) fn begins_item(cursor: &Cursor) -> bool {
    match (cursor.peek(), cursor.peek_second()) {
        (Some(TokenTree::Ident(word)), second) => match word.to_string().as_str() {
            "where" | "fn" => true,
            "keep" => match second {
                Some(TokenTree::Ident(all)) => all == "all",
                other => matches!(other, Some(TokenTree::Literal(_))),
            },
            "fragment" | "uniform" => matches!(second, Some(TokenTree::Group(_))),
            "resolve" => is_sign(second, '|') || is_single_colon(second),
            _ => is_single_colon(second),
        },
        _ => false,
    }
}

fn is_single_colon(token: Option<&TokenTree>) -> bool {
    matches!(token, Some(TokenTree::Punct(punct))
        if punct.as_char() == ':' && punct.spacing() == Spacing::Alone)
}

/// Goes behind the next `;` or `{ … }`, or to the next item; in any case beyond `before`.
fn recover(cursor: &mut Cursor, before: usize) {
    while cursor.position() == before || !begins_item(cursor) {
        let Some(token) = cursor.take() else { return };
        if is_sign(Some(&token), ';') {
            return;
        }
        if matches!(&token, TokenTree::Group(group) if group.delimiter() == Delimiter::Brace) {
            cursor.sign(';');
            return;
        }
    }
}

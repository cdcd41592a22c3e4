//! Fixes as edits: the help of a diagnostic has them as source in backquotes, and this module finds the part of the text that each replaces.
//!
//! Input: a document, and a diagnostic of it. Output: edits after which the diagnostic is gone; errors that it hid may have come.
//! Candidates are tried through the compiler, the smallest change first, so that no fix depends on the wording of a help.

use std::ops::Range;

use fragbuf_model::{Diagnostic, Severity, SourceSpan, codes};
use fragbuf_syntax::ITEMS;

use super::context::items;
use super::scan::{Kind, Token, closing, opening, tokens};
use super::{Compiled, Document, Edit, Fix, Lines};

/// The greatest number of changes that are tried for one part of a help, for a diagnostic, and for a document.
const MAX_CANDIDATES: usize = 14;
const MAX_OF_DIAGNOSTIC: usize = 24;
const MAX_OF_DOCUMENT: usize = 120;

/// The greatest number of bytes that are compiled to find the fixes of a document.
const MAX_BYTES: usize = 2 << 20;

/// A change of the text: each range with the text in its place.
type Change = Vec<(Range<usize>, String)>;

/// The search for the fixes of a document.
pub(super) struct Trials<'d> {
    document: &'d Document<'d>,
    compiled: &'d Compiled<'d>,
    lines: Lines<'d>,
    tokens: Vec<Token>,
    items: Vec<Range<usize>>,
    left: usize,
}

impl<'d> Trials<'d> {
    /// Prepares the search.
    pub(super) fn new(document: &'d Document<'d>, compiled: &'d Compiled<'d>) -> Self {
        let text = document.text;
        let (lines, tokens, items) = (document.lines(), tokens(text), items(text));
        Trials { document, compiled, lines, tokens, items, left: MAX_OF_DOCUMENT.min(MAX_BYTES / text.len().max(1)) }
    }

    /// Returns the fixes of a diagnostic of the document.
    pub(super) fn fixes(&mut self, diagnostic: &Diagnostic) -> Vec<Fix> {
        if !self.document.contains(&diagnostic.span) {
            return Vec::new();
        }
        let mut fixes: Vec<Fix> = Vec::new();
        let after = self.left.saturating_sub(MAX_OF_DIAGNOSTIC);
        for way in ways(&diagnostic.help) {
            let candidates = self.candidates(&way, &diagnostic.span);
            for mut change in candidates.into_iter().take(MAX_CANDIDATES) {
                if self.left <= after {
                    break;
                }
                change.sort_by_key(|(range, _)| range.start);
                if self.is_fix(diagnostic, &change) {
                    fixes.push(self.fix(&way, change));
                    break;
                }
            }
        }
        fixes.dedup_by(|a, b| a.edits == b.edits);
        fixes
    }

    /// Returns the edits that choose a value on an axis.
    pub(super) fn choose(&self, axis: &str, value: &str) -> Vec<Edit> {
        let change = self.items_for(&format!("{axis}: {value};")).into_iter().next().unwrap_or_default();
        change.into_iter().map(|(range, text)| Edit { span: self.lines.span(range), text }).collect()
    }

    fn fix(&self, way: &Way, change: Change) -> Fix {
        let codes: Vec<String> = way.codes.iter().map(|code| format!("`{code}`")).collect();
        let title = match (way.is_removal, codes.is_empty()) {
            (true, true) => "Remove it".to_owned(),
            (true, false) => format!("Remove {}", codes.join(" and ")),
            (false, _) => format!("Write {}", codes.join(" and ")),
        };
        let edits = change.into_iter().map(|(range, text)| Edit { span: self.lines.span(range), text });
        Fix { title, edits: edits.collect() }
    }

    /// Tests whether the diagnostic is gone after a change, and there are fewer errors, none, or in their place only those that it hid.
    fn is_fix(&mut self, diagnostic: &Diagnostic, change: &Change) -> bool {
        let text = self.document.text;
        let same = change.iter().all(|(range, new)| text.get(range.clone()) == Some(new.as_str()));
        if same || self.left == 0 || change.windows(2).any(|pair| pair[0].0.end > pair[1].0.start) {
            return false;
        }
        self.left -= 1;
        let mut changed = text.to_owned();
        for (range, new) in change.iter().rev() {
            changed.replace_range(range.clone(), new);
        }
        // The rows of user files are in the registry already.
        let after = Document::new(&changed, self.document.path, &self.compiled.registry).compile();
        let is_same = |a: &Diagnostic, b: &Diagnostic| a.code == b.code && a.message == b.message;
        let count = |all: &[Diagnostic]| all.iter().filter(|other| is_same(other, diagnostic)).count();
        if count(&after.diagnostics) >= count(&self.compiled.diagnostics) {
            return false;
        }
        let errors = |all: &[Diagnostic]| all.iter().filter(|other| other.severity() == Severity::Error).count();
        let (before, left) = (errors(&self.compiled.diagnostics), errors(&after.diagnostics));
        if left < before || left == 0 {
            return true;
        }
        // An error hides those of later stages. A name that is replaced may be followed by them; another change only elsewhere.
        let lines = Lines::new(&changed);
        let first = change.first().map_or(0, |(range, _)| range.start);
        let last = change.iter().map(|(range, new)| range.start + new.len()).max().unwrap_or(first);
        let touched = lines.position(first).line..=lines.position(last).line;
        let is_new = |error: &&Diagnostic| !self.compiled.diagnostics.iter().any(|old| is_same(old, error));
        let new: Vec<&Diagnostic> = after.diagnostics.iter().filter(is_new).collect();
        let span = self.lines.source_span(&diagnostic.span).bytes;
        let is_replaced = matches!(change.as_slice(), [(range, _)] if *range == span);
        let is_later = |error: &&Diagnostic| stage(error) > stage(diagnostic);
        let is_elsewhere = |error: &&Diagnostic| !touched.contains(&error.span.line.saturating_sub(1));
        is_replaced && new.iter().all(is_later) || is_of_grammar(diagnostic) && new.iter().all(is_elsewhere)
    }

    /// Returns the changes that a part of a help can mean, the most specific first.
    fn candidates(&self, way: &Way, span: &SourceSpan) -> Vec<Change> {
        let at = self.lines.source_span(span).bytes;
        if way.is_removal {
            return self.removals(way, at);
        }
        match way.codes.as_slice() {
            [code] => {
                let mut found = self.items_for(code);
                found.extend(self.near(code, at));
                found
            }
            several => {
                let parts: Option<Vec<Change>> =
                    several.iter().map(|code| self.items_for(code).into_iter().next()).collect();
                parts.map(|parts| parts.concat()).into_iter().collect()
            }
        }
    }

    /// Returns the changes to whole items: a choice, `keep`, or a block.
    fn items_for(&self, code: &str) -> Vec<Change> {
        let head = code.split([' ', ':']).next().unwrap_or_default();
        let is_choice =
            code.starts_with(&format!("{head}: ")) && self.compiled.registry.axis(head).is_some_and(|axis| axis.chosen);
        let is_item = ITEMS.contains(&head) && code.len() > head.len();
        if !is_choice && !is_item {
            return Vec::new();
        }
        let is_block = code.ends_with('}') && !is_choice;
        let item = match code.ends_with(';') || is_block {
            true => code.to_owned(),
            false => format!("{code};"),
        };
        let mut found = Vec::new();
        if let Some(old) = self.items.iter().rev().find(|old| self.is_same_item(old, head, is_choice)) {
            // The count alone, so that a criterion stays.
            let draft = self.compiled.draft.as_ref();
            let count = draft.and_then(|draft| draft.keep.as_ref()).map(|keep| &keep.count.span);
            if let Some((count, new)) = count.filter(|_| !is_choice).zip(code.strip_prefix("keep ")) {
                let range = self.lines.source_span(count).bytes;
                found.push(vec![(range, new.trim_end_matches(';').to_owned())]);
            }
            found.push(vec![(old.clone(), item)]);
        } else if let Some(place) = self.end_of_items() {
            found.push(vec![(place..place, format!("    {item}\n"))]);
        }
        found
    }

    fn is_same_item(&self, item: &Range<usize>, head: &str, is_choice: bool) -> bool {
        let source = self.document.text.get(item.clone()).unwrap_or_default();
        let rest = source.strip_prefix(head).map(str::trim_start);
        rest.is_some_and(|rest| rest.len() < source.len() && rest.starts_with(':') == is_choice)
    }

    /// Returns the start of the line of the buffer's closing brace, or the brace if it is on a line with others.
    fn end_of_items(&self) -> Option<usize> {
        let brace = self.tokens.iter().rev().find(|token| token.kind == Kind::Close)?.start;
        let before = self.document.text.get(..brace)?;
        let line = before.rfind('\n').map_or(0, |at| at + 1);
        Some(if before.get(line..)?.trim().is_empty() { line } else { brace })
    }

    /// Returns the changes near the span of the diagnostic, the smallest first.
    fn near(&self, code: &str, at: Range<usize>) -> Vec<Change> {
        let mut ranges = vec![at.clone()];
        ranges.extend(self.calls(&at));
        ranges.extend(self.statement(&at, code));
        // A mark alone, such as `;`, is inserted and replaces nothing.
        if code.len() > 1 {
            ranges.extend(self.with_neighbours(&at, code));
        }
        let new = |range: Range<usize>| vec![(range, code.to_owned())];
        let mut found: Vec<Change> = ranges.into_iter().map(new).collect();
        let spaced = |place: usize, text: String| vec![(place..place, text)];
        found.push(spaced(at.end, code.to_owned()));
        found.push(spaced(at.start, format!("{code} ")));
        if code.contains(": ") {
            found.push(spaced(at.start, format!("{code}, ")));
        }
        if code.chars().all(|letter| ")]}".contains(letter)) {
            let end = self.document.text.trim_end().len();
            found.push(spaced(end, format!("\n{code}")));
        }
        found
    }

    /// Returns a range with the token before it (`color rgba8` is `color: rgba8`), with the one after it, and its item.
    fn with_neighbours(&self, at: &Range<usize>, code: &str) -> Vec<Range<usize>> {
        let before = self.tokens.iter().rev().find(|token| token.end <= at.start).map(|before| before.start..at.end);
        let after = self.tokens.iter().find(|token| token.start >= at.end).map(|after| at.start..after.end);
        let item = self.items.iter().find(|item| item.start <= at.start && at.start < item.end).cloned();
        let item = item.filter(|_| code.ends_with([';', '}']));
        [before, after, item].into_iter().flatten().collect()
    }

    /// Returns the call of the function or method at a range, with its receiver.
    fn calls(&self, at: &Range<usize>) -> Vec<Range<usize>> {
        let text = self.document.text;
        let Some(first) = self.tokens.iter().position(|token| token.start == at.start) else { return Vec::new() };
        let word = |index: usize| self.tokens.get(index).map_or("", |token| token.of(text));
        let last = self.tokens.iter().rposition(|token| token.end <= at.end).unwrap_or(first).max(first);
        let end = match word(last + 1) {
            "(" => closing(&self.tokens, last + 1).unwrap_or(last),
            _ => last,
        };
        let mut start = first;
        while start >= 2 && word(start - 1) == "." {
            let mut operand = start - 2;
            while matches!(word(operand), ")" | "]") {
                let Some(open) = opening(&self.tokens, operand) else { break };
                let Some(before) = open.checked_sub(1) else { break };
                let is_name = self.tokens.get(before).is_some_and(|token| token.kind == Kind::Word);
                operand = if is_name { before } else { open };
            }
            if operand >= start {
                break;
            }
            start = operand;
        }
        let range = |first: usize, last: usize| {
            let (first, last) = (self.tokens.get(first)?, self.tokens.get(last)?);
            Some(first.start..last.end)
        };
        let mut found: Vec<Range<usize>> = [range(first, end), range(start, end)].into_iter().flatten().collect();
        found.retain(|range| range != at);
        found.dedup();
        found
    }

    /// Returns the statement or the item at a range if the code is one.
    fn statement(&self, at: &Range<usize>, code: &str) -> Vec<Range<usize>> {
        let first = code.split(' ').next().unwrap_or_default();
        let is_statement = ["let", "for", "fn", "buffer", "from"].contains(&first) || code.contains(" = ");
        if !is_statement {
            return Vec::new();
        }
        let text = self.document.text;
        let is_end = |token: &&Token| matches!(token.of(text), ";" | "{" | "}");
        let before = self.tokens.iter().rev().filter(|token| token.end <= at.start).find(is_end);
        let start = self.tokens.iter().find(|token| before.is_none_or(|before| token.start >= before.end));
        let end = self.tokens.iter().filter(|token| token.start >= at.start).find(is_end);
        let Some((start, end)) = start.zip(end).filter(|(start, end)| start.start < end.start) else {
            return Vec::new();
        };
        let trimmed = text.get(start.start..end.start).unwrap_or_default().trim_end().len();
        vec![start.start..start.start + trimmed, start.start..end.end]
    }

    /// Returns the changes that remove what the diagnostic is about.
    fn removals(&self, way: &Way, at: Range<usize>) -> Vec<Change> {
        let text = self.document.text;
        let mut found: Vec<Range<usize>> = Vec::new();
        if let Some(code) = way.codes.first() {
            let near = text.get(at.start..).and_then(|rest| rest.find(code.as_str())).filter(|near| *near < 200);
            found.extend(near.map(|near| at.start + near..at.start + near + code.len()));
        }
        found.push(at.clone());
        // An entry of a block, with its comma.
        let is_border = |token: &&Token| matches!(token.of(text), "," | "{" | "}" | ";");
        let before = self.tokens.iter().rev().filter(|token| token.end <= at.start).find(is_border);
        let after = self.tokens.iter().filter(|token| token.start >= at.end).find(is_border);
        if let Some((before, after)) = before.zip(after) {
            match (before.of(text), after.of(text)) {
                (_, ",") => found.push(before.end..after.end),
                (",", "}") => {
                    let last = self.tokens.iter().rev().find(|token| token.end <= after.start);
                    found.extend(last.map(|last| before.start..last.end));
                }
                _ => {}
            }
        }
        found.extend(self.statement(&at, "let"));
        let item = self.items.iter().find(|item| item.start <= at.start && at.start < item.end);
        found.extend(item.map(|item| {
            let rest = text.get(item.end..).unwrap_or_default();
            let blank = rest.len() - rest.trim_start_matches([' ', '\n']).len();
            item.start..item.end + blank
        }));
        found.dedup();
        found.into_iter().map(|range| vec![(range, String::new())]).collect()
    }
}

/// Returns the place of a code among all codes, which are in the order in which the compiler finds their errors.
fn stage(diagnostic: &Diagnostic) -> Option<usize> {
    codes::ALL.iter().position(|code| *code == diagnostic.code)
}

/// Whether errors of the rules are not reported while there is this one.
fn is_of_grammar(diagnostic: &Diagnostic) -> bool {
    stage(diagnostic) < codes::ALL.iter().position(|code| *code == codes::UNKNOWN_TECHNIQUE)
}

/// One fix in a help.
#[derive(Debug, PartialEq, Eq)]
struct Way {
    /// The sources in backquotes that belong together.
    codes: Vec<String>,
    is_removal: bool,
}

/// Returns the fixes in a help. Sources that have a part left to fill in, and options of the command line, are none.
fn ways(help: &str) -> Vec<Way> {
    let parts: Vec<&str> = help.split('`').collect();
    let mut ways: Vec<Way> = Vec::new();
    for pair in parts.chunks(2) {
        let &[before, code] = pair else { continue };
        let is_removal = before.ends_with("remove ") || before.ends_with("remove this ");
        match ways.last_mut().filter(|_| before == " and ") {
            Some(last) => last.codes.push(code.to_owned()),
            None => ways.push(Way { codes: vec![code.to_owned()], is_removal }),
        }
    }
    ways.retain(|way| way.codes.iter().all(|code| !code.contains('…') && !code.starts_with("--") && !code.is_empty()));
    if help.contains("remove it") || help.contains("remove one") || help.contains("remove the type") {
        ways.push(Way { codes: Vec::new(), is_removal: true });
    }
    ways
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_help_has_one_fix_for_each_alternative() {
        let found = |help| -> Vec<(Vec<String>, bool)> {
            ways(help).into_iter().map(|way| (way.codes, way.is_removal)).collect()
        };
        let way = |codes: &[&str], is_removal| -> (Vec<String>, bool) {
            (codes.iter().map(|code| (*code).to_owned()).collect(), is_removal)
        };
        assert_eq!(
            found("write `keep all;` and `cull: none`, or choose `a: b`"),
            [way(&["keep all;", "cull: none"], false), way(&["a: b"], false)]
        );
        assert_eq!(found("remove `x`, or call it `_x`"), [way(&["x"], true), way(&["_x"], false)]);
        assert_eq!(found("write `keep 8 least |f| …`; remove it"), [way(&[], true)]);
    }
}

//! Statements that do nothing, or that a known condition decides.
//!
//! In: a function's text and what is known of the names in it. Out: edits of one round; what they make possible is left to
//! the next. Comments directly above a statement go with it.

use std::collections::BTreeSet;
use std::ops::Range;

use super::edit::{Edit, removal};
use super::effects::declared;
use super::expression::{self, Expression};
use super::syntax::{self, Block, Branch, Kind, Statement};
use super::values::{Known, Position, Values};
use super::worth::Worth;
use crate::link::token::{Token, TokenKind};

/// The edits of one round; none where the function cannot be read. `is_first`: nothing has changed so far.
pub(super) fn edits(text: &str, tokens: &[Token<'_>], known: &Known<'_>, is_first: bool) -> Vec<Edit> {
    let Some(body) = syntax::body(tokens) else { return Vec::new() };
    let parameters = tokens[..body.open].windows(2).filter(|pair| pair[1].text == ":").map(|pair| pair[0].text);
    let declarations: Vec<&str> = declared(tokens, &KEYWORDS).chain(parameters).collect();
    let locals: BTreeSet<&str> = declarations.iter().copied().collect();
    let values = Values { tokens, known, locals: &locals, tidies: !is_first, edits: Vec::new() };
    let mut rules = Rules { text, tokens, declarations: &declarations, is_first, values };
    rules.block(&body);
    match body.statements.last().map(|last| last.tokens.clone()) {
        Some(last) if !is_first && last.len() == 2 && tokens[last.start].text == "return" => rules.remove(&last),
        _ => {}
    }
    rules.values.edits
}

const KEYWORDS: [&str; 3] = ["let", "var", "const"];

struct Rules<'r> {
    text: &'r str,
    tokens: &'r [Token<'r>],
    /// Names that the function declares, as often as it does.
    declarations: &'r [&'r str],
    is_first: bool,
    values: Values<'r>,
}

impl Rules<'_> {
    fn block(&mut self, block: &Block) {
        for (index, statement) in block.statements.iter().enumerate() {
            let rest = &block.statements[index + 1..];
            if rest.first().is_some_and(|next| self.join_returns(statement, next)) {
                break;
            }
            self.statement(statement, block);
            if let (true, Some(first), Some(last)) = (self.leaves(statement), rest.first(), rest.last()) {
                self.remove(&(first.tokens.start..last.tokens.end));
                break;
            }
        }
    }

    /// `if a { return true; } return false;` becomes `return a;`, and the reverse `return !a;`.
    fn join_returns(&mut self, statement: &Statement, next: &Statement) -> bool {
        let Kind::If(branches) = &statement.kind else { return false };
        let ([branch], false) = (branches.as_slice(), self.is_first) else { return false };
        let [inner] = branch.block.statements.as_slice() else { return false };
        let values = (self.returned(inner), self.returned(next), self.read(branch.condition.clone()));
        let (Some(value), Some(other), Some(condition)) = values else { return false };
        if value == other || self.values.truth(&condition).is_some() {
            return false;
        }
        let is_denial = self.tokens[branch.condition.start].text == "!";
        let is_denied = !value && is_denial && matches!(condition.kind, expression::Kind::Unary(_));
        let start = branch.condition.start + usize::from(is_denied);
        let [before, behind] = match condition.kind {
            _ if value || is_denied => ["return ", ";"],
            expression::Kind::Unary(_) | expression::Kind::Binary(..) => ["return !(", ");"],
            _ => ["return !", ";"],
        };
        let (whole, kept) = (
            self.values.bytes(&(statement.tokens.start..next.tokens.end)),
            self.values.bytes(&(start..branch.condition.end)),
        );
        if self.text[whole.clone()].contains("//") {
            return false;
        }
        self.values.edits.push(Edit { range: whole.start..kept.start, text: before.to_owned() });
        self.values.edits.push(Edit { range: kept.end..whole.end, text: behind.to_owned() });
        true
    }

    /// What a statement returns, if it is `true` or `false`.
    fn returned(&self, statement: &Statement) -> Option<bool> {
        let [word, value, _] = &self.tokens[statement.tokens.clone()] else { return None };
        match value.text {
            "true" | "false" if word.text == "return" => Some(value.text == "true"),
            _ => None,
        }
    }

    /// Whether nothing behind it in its block runs.
    fn leaves(&self, statement: &Statement) -> bool {
        let word = |number: usize| self.tokens.get(statement.tokens.start + number).map_or("", |token| token.text);
        matches!(statement.kind, Kind::Simple)
            && matches!(word(0), "return" | "break" | "continue")
            && (word(0), word(1)) != ("break", "if")
    }

    fn statement(&mut self, statement: &Statement, around: &Block) {
        match &statement.kind {
            Kind::Simple => self.simple(&statement.tokens, around),
            Kind::If(branches) => self.choice(&statement.tokens, branches),
            Kind::Other(heads, blocks) => {
                heads.iter().for_each(|head| self.head(head));
                blocks.iter().for_each(|block| self.block(block));
            }
        }
    }

    /// What stands before a loop's or a switch's brace: one expression, or a `for`'s three parts.
    fn head(&mut self, head: &Range<usize>) {
        let parts: Vec<usize> = head.clone().filter(|&index| self.tokens[index].text == ";").collect();
        match parts[..] {
            [first, second] => {
                if let Some(equals) = (head.start..first).find(|&index| self.tokens[index].text == "=") {
                    self.fold(equals + 1..first);
                }
                self.fold(first + 1..second);
            }
            _ => self.fold(head.clone()),
        }
    }

    fn simple(&mut self, statement: &Range<usize>, around: &Block) {
        let inner = statement.start..statement.end - 1;
        match self.tokens[statement.start].text {
            word if KEYWORDS.contains(&word) => self.declaration(statement, around),
            "return" => self.fold(inner.start + 1..inner.end),
            "break" | "continue" | "discard" => {}
            name if self.tokens[statement.start + 1].text == "(" => {
                let does_nothing = self.values.worth(name) != Worth::Itself;
                match self.read(inner) {
                    Some(call) if does_nothing && self.has_pure_arguments(&call) => self.remove(statement),
                    Some(call) => self.values.fold(&call, Position::Whole),
                    None => {}
                }
            }
            _ => self.assignment(statement),
        }
    }

    fn has_pure_arguments(&self, call: &Expression) -> bool {
        match &call.kind {
            expression::Kind::Call(arguments) => arguments.iter().all(|argument| self.values.is_pure(argument)),
            _ => false,
        }
    }

    fn assignment(&mut self, statement: &Range<usize>) {
        let Some(equals) = statement.clone().find(|&index| self.tokens[index].text == "=") else { return };
        let Some(value) = self.read(equals + 1..statement.end - 1) else { return };
        let scales = self.tokens[equals - 1].text == "*";
        let target = self.read(statement.start..equals - 1).filter(|target| self.values.is_pure(target));
        if scales && target.is_some() && self.values.is_one(&value) {
            self.remove(statement);
        } else {
            self.values.fold(&value, Position::Whole);
        }
    }

    fn declaration(&mut self, statement: &Range<usize>, around: &Block) {
        let name = self.tokens[statement.start + 1];
        let equals = statement.clone().find(|&index| self.tokens[index].text == "=");
        let value = equals.and_then(|equals| self.read(equals + 1..statement.end - 1));
        let Some(value) = value.filter(|_| name.kind == TokenKind::Name) else { return };
        let uses = self.uses(name.text, statement.start + 1);
        if uses.is_empty() && self.values.is_pure(&value) {
            return self.remove(statement);
        }
        let is_once = self.declarations.iter().filter(|other| **other == name.text).count() == 1;
        let stays = uses.iter().all(|&at| (statement.end..around.close).contains(&at) && !self.is_changed(at));
        match self.values.truth(&value) {
            Some(truth) if is_once && stays => {
                for at in uses {
                    let range = self.values.bytes(&(at..at + 1));
                    self.values.edits.push(Edit { range, text: truth.to_string() });
                }
                self.remove(statement);
            }
            _ => self.values.fold(&value, Position::Whole),
        }
    }

    /// Where else a name stands, as no member.
    fn uses(&self, name: &str, declared: usize) -> Vec<usize> {
        let is_use = |index: &usize| {
            *index != declared && self.tokens[*index].text == name && self.tokens[index - 1].text != "."
        };
        (1..self.tokens.len()).filter(is_use).collect()
    }

    /// Whether a name is assigned to here, or a pointer to it taken.
    fn is_changed(&self, at: usize) -> bool {
        let text = |index: usize| self.tokens.get(index).map_or("", |token| token.text);
        let assigned = text(at + 1) == "=" && text(at + 2) != "=";
        let is_pointed_at = text(at - 1) == "&" && text(at.wrapping_sub(2)) != "&";
        let is_combined = matches!(text(at + 1), "&" | "|") && text(at + 2) == "=";
        assigned || is_pointed_at || is_combined
    }

    fn choice(&mut self, statement: &Range<usize>, branches: &[Branch]) {
        let conditions: Vec<Option<Expression>> =
            branches.iter().map(|branch| self.read(branch.condition.clone())).collect();
        let decided = conditions.iter().position(|condition| self.decision(condition).is_some());
        let Some((at, taken)) = decided.and_then(|at| Some((at, self.decision(&conditions[at])?))) else {
            return self.undecided(statement, branches, &conditions);
        };
        let branch = &branches[at];
        let rest = &branches[at + 1..];
        match (at, taken, rest) {
            (0, true, _) => self.unwrap(statement, &branch.block),
            (0, false, []) => self.remove(statement),
            (0, false, [other]) if other.condition.is_empty() => self.unwrap(statement, &other.block),
            // `if false {…} else if` becomes `if`.
            (0, false, [next, ..]) => {
                self.comments_above(statement);
                self.cut(statement.start, next.condition.start - 1);
            }
            // `else if true {…}` becomes `else {…}`, and ends the chain.
            (_, true, _) => {
                self.cut(branch.condition.start - 1, branch.block.open);
                self.cut_behind(branch.block.close, statement.end);
            }
            // `else if false {…}` goes.
            (_, false, _) => self.cut_behind(branches[at - 1].block.close, branch.block.close + 1),
        }
    }

    fn decision(&self, condition: &Option<Expression>) -> Option<bool> {
        self.values.truth(condition.as_ref()?)
    }

    fn undecided(&mut self, statement: &Range<usize>, branches: &[Branch], conditions: &[Option<Expression>]) {
        let is_pure = |condition: &Option<Expression>| match condition {
            Some(condition) => self.values.is_pure(condition),
            None => false,
        };
        match branches {
            [only] if self.is_empty(&only.block) && is_pure(&conditions[0]) => return self.remove(statement),
            [.., before, last] if self.is_empty(&last.block) => {
                if last.condition.is_empty() || conditions.last().is_some_and(is_pure) {
                    return self.cut_behind(before.block.close, statement.end);
                }
            }
            _ => {}
        }
        for (branch, condition) in branches.iter().zip(conditions) {
            condition.iter().for_each(|condition| self.values.fold(condition, Position::Whole));
            self.block(&branch.block);
        }
    }

    fn is_empty(&self, block: &Block) -> bool {
        block.open + 1 == block.close
    }

    fn fold(&mut self, range: Range<usize>) {
        if let Some(expression) = self.read(range) {
            self.values.fold(&expression, Position::Whole);
        }
    }

    fn read(&self, range: Range<usize>) -> Option<Expression> {
        if range.is_empty() { None } else { expression::read(self.tokens, range) }
    }
}

/// Lines and bytes.
impl Rules<'_> {
    /// Puts the statements of `block` in place of the statement that it is a branch of.
    fn unwrap(&mut self, statement: &Range<usize>, block: &Block) {
        let inner = block.statements.iter().map(|inner| &self.tokens[inner.tokens.start..inner.tokens.end]);
        let moved: Vec<&str> =
            inner.filter(|inner| KEYWORDS.contains(&inner[0].text)).map(|inner| inner[1].text).collect();
        let is_single = |name: &&str| self.declarations.iter().filter(|other| *other == name).count() == 1;
        if !moved.iter().all(is_single) {
            return;
        }
        let (outer, open, close) =
            (self.whole_lines(statement), self.tokens[block.open].at, self.tokens[block.close].at);
        let (first, last) = (self.line_end(open), self.line_start(close));
        if first > last {
            return;
        }
        self.values.edits.push(removal(outer.start..first));
        let mut at = first;
        for line in self.text[first..last].split_inclusive('\n') {
            let indent = line.bytes().take(INDENT).take_while(|byte| *byte == b' ').count();
            self.values.edits.push(removal(at..at + indent));
            at += line.len();
        }
        self.values.edits.push(removal(last..outer.end));
    }

    /// Removes statements.
    fn remove(&mut self, statements: &Range<usize>) {
        let mut lines = self.whole_lines(statements);
        let before = self.text[..lines.start].trim_end_matches(' ');
        let after = &self.text[lines.end..];
        // No two blank lines, and none at the end of a block.
        if before.ends_with("\n\n") && (after.starts_with('\n') || after.trim_start().starts_with('}')) {
            lines.start -= 1;
        } else if before.ends_with("{\n") && after.starts_with('\n') {
            lines.end += 1;
        }
        self.values.edits.push(removal(lines));
    }

    fn comments_above(&mut self, statement: &Range<usize>) {
        let start = self.line_start(self.tokens[statement.start].at);
        let above = self.with_comments(start);
        self.values.edits.push(removal(above..start));
    }

    /// Removes from one token up to another.
    fn cut(&mut self, from: usize, to: usize) {
        self.values.edits.push(removal(self.tokens[from].at..self.tokens[to].at));
    }

    /// Removes what stands behind one token, up to the end of the tokens before `end`.
    fn cut_behind(&mut self, token: usize, end: usize) {
        let start = self.tokens[token].at + self.tokens[token].text.len();
        let last = self.tokens[end - 1];
        self.values.edits.push(removal(start..last.at + last.text.len()));
    }

    /// The lines of some tokens with the comments above; the tokens alone where others stand on their lines.
    fn whole_lines(&self, tokens: &Range<usize>) -> Range<usize> {
        let bytes = self.values.bytes(tokens);
        let (start, end) = (self.line_start(bytes.start), self.line_end(bytes.end));
        let (before, behind) = (self.text[start..bytes.start].trim(), self.text[bytes.end..end].trim());
        if before.is_empty() && (behind.is_empty() || behind.starts_with("//")) {
            return self.with_comments(start)..end;
        }
        let space = self.text[bytes.end..end].bytes().take_while(|byte| *byte == b' ').count();
        bytes.start..bytes.end + space
    }

    /// Where the comments begin that stand directly above a line.
    fn with_comments(&self, line: usize) -> usize {
        let mut start = line;
        while start > 0 {
            let above = self.line_start(start - 1);
            if !self.text[above..start].trim_start().starts_with("//") {
                break;
            }
            start = above;
        }
        start
    }

    fn line_start(&self, at: usize) -> usize {
        self.text[..at].rfind('\n').map_or(0, |end| end + 1)
    }

    fn line_end(&self, at: usize) -> usize {
        self.text[at..].find('\n').map_or(self.text.len(), |length| at + length + 1)
    }
}

/// Spaces of one level of blocks.
const INDENT: usize = 4;

//! Lines that declare a step: a pass or a host step.
//!
//! Input: a line after its keyword. Output: a step of the row.

use fragbuf_model::{Diagnostic, Spanned, codes};
use fragbuf_templates::vocabulary::{Access, Host, Loads, Pass, RowItem, SYMBOLS, Setter, Step, Use};

use super::line::Line;
use super::reader::Read;
use super::statements::Statements;
use crate::report::{FIRST, Stop};

/// How a shader accesses a buffer.
const ACCESSES: [(&str, Access); 5] = [
    ("read", Access::Read),
    ("plain", Access::Plain),
    ("atomic", Access::Atomic),
    ("coherent", Access::Coherent),
    ("hinted", Access::Hinted),
];

/// The symbols that a host step may set.
fn host_symbols() -> impl Iterator<Item = &'static str> {
    SYMBOLS.iter().filter(|symbol| symbol.set_by == Setter::Host).map(|symbol| symbol.name)
}

impl Statements {
    /// Parses `pass skeleton as name: buffer access, …`.
    pub(super) fn pass(&mut self, line: &mut Line<'_>) -> Read<()> {
        const SHAPE: &str = "`pass store: entries plain`";
        let skeleton = self.reader.name(line, "the pass", SHAPE)?;
        let name = match line.keyword("as") {
            true => self.reader.wgsl_name(line, "the name of a pass", "`pass store as again: entries plain`")?,
            false => skeleton.clone(),
        };
        self.reader.punct(line, ':', SHAPE)?;
        let uses = self.uses(line)?;
        let has_name = |step: &Step| matches!(step, Step::Pass(pass) if pass.name == name.value);
        if let Some(first) = self.user_row.row.steps.iter().position(has_name) {
            let message = format!("duplicate pass `{}`", name.value);
            let help = format!("name one of them: `pass {} as another: …`", skeleton.value);
            let diagnostic = Diagnostic::new(codes::DUPLICATE, &name.span, message, help);
            self.reader.diagnostics.push(diagnostic.label(&self.user_row.spans.steps[first], FIRST));
            return Err(Stop);
        }
        self.user_row.row.steps.push(Step::Pass(Pass { uses, ..Pass::geometry(&name.value, &skeleton.value) }));
        self.user_row.spans.steps.push(skeleton.span);
        Ok(())
    }

    /// Parses `host function: reads offsets[pixels], histogram, words[4 for 8]; sets fragments`, and `; lags` after it.
    pub(super) fn host(&mut self, line: &mut Line<'_>) -> Read<()> {
        const SHAPE: &str = "`host allocate: reads offsets[pixels]; sets fragments`";
        let function = self.reader.name(line, "the host's function", SHAPE)?;
        self.reader.punct(line, ':', SHAPE)?;
        let mut host = Host::new(&function.value);
        loop {
            let verb = self.reader.name(line, "`reads`, `sets` or `lags`", SHAPE)?;
            loop {
                host = match verb.value.as_str() {
                    "reads" => self.host_read(line, host, SHAPE)?,
                    "sets" => self.host_set(line, host, SHAPE)?,
                    "lags" => {
                        host = host.lags();
                        break;
                    }
                    other => {
                        let message = format!("expected `reads`, `sets` or `lags`, found `{other}`");
                        return self.reader.stop(codes::INVALID_ROW, &verb.span, message, format!("write {SHAPE}"));
                    }
                };
                if !line.punct(',') {
                    break;
                }
            }
            if !line.punct(';') {
                break;
            }
        }
        if host.sets.is_empty() {
            let message = format!("the host function `{}` sets no symbol", function.value);
            return self.reader.stop(codes::INVALID_ROW, &function.span, message, format!("write {SHAPE}"));
        }
        self.user_row.row.steps.push(Step::Host(host));
        self.user_row.spans.steps.push(function.span);
        Ok(())
    }

    /// Parses `name` (all words of a buffer), `name[index]` (one word) or `name[first for count]` (a range).
    fn host_read(&mut self, line: &mut Line<'_>, host: Host, shape: &str) -> Read<Host> {
        let name = self.reader.wgsl_name(line, "a buffer", shape)?;
        self.used.push(name.clone());
        if !line.punct('[') {
            return Ok(host.reads_all(&name.value));
        }
        let words = line.formula(&[']']);
        self.reader.punct(line, ']', shape)?;
        let (first, count) = words.value.split_once(" for ").unwrap_or((&words.value, "1"));
        let symbols = self.symbols();
        for formula in [first, count] {
            let formula = Spanned::new(formula.trim().to_owned(), words.span.clone());
            self.reader.formula(&formula, &symbols)?;
            self.reader.record_span(RowItem::Read, &formula);
        }
        Ok(host.reads_some(&name.value, first.trim().to_owned(), count.trim().to_owned()))
    }

    fn host_set(&mut self, line: &mut Line<'_>, host: Host, shape: &str) -> Read<Host> {
        let symbol = self.reader.name(line, "a symbol", shape)?;
        let known: Vec<(&str, &str)> = host_symbols().map(|name| (name, name)).collect();
        let name = self.reader.one_of(&symbol, &known, "a symbol that a host step can set")?;
        Ok(host.sets(name))
    }

    /// Parses `buffer access, buffer atomic rechecked, …`.
    pub(super) fn uses(&mut self, line: &mut Line<'_>) -> Read<Vec<Use>> {
        let mut uses = Vec::new();
        while !line.is_done() {
            let name = self.reader.name(line, "a buffer", "`entries plain, counts atomic`")?;
            let access = self.reader.name(line, "an access", "`read`, `plain`, `atomic`, `coherent` or `hinted`")?;
            let mut usage = Use::new(&name.value, self.reader.one_of(&access, &ACCESSES, "an access")?);
            if line.keyword("rechecked") {
                usage.loads = Loads::Rechecked;
            }
            uses.push(usage);
            self.used.push(name);
            if !line.punct(',') {
                break;
            }
        }
        Ok(uses)
    }
}

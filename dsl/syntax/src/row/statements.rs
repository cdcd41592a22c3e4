//! What each line of a row says.

use fragbuf_model::{Code, Diagnostic, Diagnostics, Origin, OwnRow, Spanned, codes};
use fragbuf_templates::vocabulary::{
    Access, Element, Fact, Formula, FormulaError, Hazard, Host, Init, Life, Loads, Parameter, Pass, Resource,
    Soundness, Step, Use,
};

use super::line::Line;
use crate::near;

/// The words that begin a line.
const WORDS: [&str; 12] = [
    "paper",
    "buffer",
    "pass",
    "host",
    "uses",
    "offers",
    "requires",
    "implies",
    "suits",
    "parameter",
    "hazard",
    "soundness",
];

/// How a shader touches a buffer.
const ACCESSES: [(&str, Access); 4] =
    [("read", Access::Read), ("plain", Access::Plain), ("atomic", Access::Atomic), ("coherent", Access::Coherent)];

/// What one element is.
const ELEMENTS: [(&str, Element); 3] =
    [("word", Element::Word), ("entry", Element::Entry), ("beside", Element::Beside)];

/// What an extent may depend on.
const SYMBOLS: [&str; 6] = ["width", "height", "pixels", "k", "fragments", "kept"];

/// A mistake was reported; the rest of the line is not worth reading.
struct Stop;

type Read<T> = Result<T, Stop>;

/// The axis that a row begins with.
pub(super) fn axis(line: &mut Line<'_>, faults: &mut Diagnostics) -> Option<String> {
    let origin = line.here();
    let word = line.word().filter(|word| !WORDS.contains(&word.value.as_str()));
    if let (Some(word), true, Some(_)) = (&word, line.is_done(), line.summary) {
        return Some(word.value.clone());
    }
    let message = "a row begins with its axis, and what the file does behind ` -- `";
    let hint = "write a first line such as `//: storage -- the first k fragments, as they come`";
    faults.push(Diagnostic::new(codes::ROW, &origin, message, hint));
    None
}

/// The row so far.
pub(super) struct Statements {
    own: OwnRow,
    /// The buffers that lines declare, those with mistakes in them too.
    declared: Vec<String>,
    /// The buffers that lines refer to.
    used: Vec<Spanned<String>>,
    faults: Diagnostics,
}

impl Statements {
    pub(super) fn new(own: OwnRow, faults: Diagnostics) -> Self {
        Statements { own, declared: Vec::new(), used: Vec::new(), faults }
    }

    /// The whole row, or every mistake.
    pub(super) fn finish(mut self) -> Result<OwnRow, Diagnostics> {
        let names = &self.declared;
        for used in self.used.iter().filter(|used| !names.contains(&used.value)) {
            let message = format!("the row declares no buffer `{}`", used.value);
            let hint = match names.as_slice() {
                [] => format!("declare it: `//: buffer {}[pixel < pixels]: word`", used.value),
                names => near::hint(&used.value, names),
            };
            self.faults.push(Diagnostic::new(codes::UNKNOWN_RESOURCE, &used.origin, message, hint));
        }
        self.faults.gate(self.own)
    }

    /// Reads one line.
    pub(super) fn read(&mut self, mut line: Line<'_>) {
        if self.statement(&mut line).is_ok() && !line.is_done() {
            let (message, origin) =
                (format!("{} stands behind the end of the statement", line.describe()), line.here());
            self.fault(codes::ROW, &origin, message, "leave it out; a new statement begins on a line of its own");
        }
    }

    fn statement(&mut self, line: &mut Line<'_>) -> Read<()> {
        let word = self.word(line, "a statement", "`buffer`, `pass`, `offers`")?;
        match word.value.as_str() {
            "paper" => self.own.row.paper = line.until(&[]).value.into(),
            "buffer" => return self.buffer(line),
            "pass" => return self.pass(line),
            "host" => return self.host(line),
            "uses" => self.own.row.uses = self.uses(line)?,
            "offers" => self.own.row.offers = self.facts(line)?,
            "requires" => self.own.row.requires = self.facts(line)?,
            "implies" => return self.implies(line),
            "suits" => return self.suits(line),
            "parameter" => return self.parameter(line),
            "hazard" => return self.hazard(line),
            "soundness" => return self.soundness(line),
            // The first line, when the row has no axis: that has been said.
            _ if self.own.row.axis.is_empty() && line.origin() == self.own.places.row => return Err(Stop),
            unknown => {
                let message = format!("no line of a row begins with `{unknown}`");
                return self.stop(codes::ROW, &word.origin, message, near::hint(unknown, &WORDS));
            }
        }
        Ok(())
    }

    /// `buffer name[index < length]…: element, clear 0, host, persistent -- summary`
    fn buffer(&mut self, line: &mut Line<'_>) -> Read<()> {
        let name = self.word(line, "the buffer's name", "`buffer heads[pixel < pixels]: word`")?;
        self.declared.push(name.value.clone());
        let summary = line.summary.unwrap_or("of the user's own").to_owned();
        let mut resource = Resource::new(&name.value, Element::Word, summary);
        while line.sign('[') {
            let index = self.word(line, "an index", "`[pixel < pixels]`")?;
            self.sign(line, '<', "`[pixel < pixels]`")?;
            let length = line.until(&[']']);
            self.sign(line, ']', "`[pixel < pixels]`")?;
            self.formula(&length, &SYMBOLS)?;
            resource = resource.by(&index.value, length.value);
        }
        self.sign(line, ':', "`buffer heads[pixel < pixels]: word`")?;
        let element = self.word(line, "an element", "`word`, `entry` or `beside`")?;
        resource.element = self.one_of(&element, &ELEMENTS, "no element")?;
        while line.sign(',') {
            let word = self.word(line, "an attribute", "`clear 0`, `host` or `persistent`")?;
            match word.value.as_str() {
                "clear" => resource.init = Init::Clear(self.number(line)?),
                "host" => resource.init = Init::Host,
                "persistent" => resource.life = Life::Persistent,
                other => {
                    let hint = near::hint(other, &["clear", "host", "persistent"]);
                    return self.stop(codes::ROW, &word.origin, format!("a buffer has no `{other}`"), hint);
                }
            }
        }
        let known = self.own.row.resources.iter().position(|other| other.name == name.value);
        if let Some(first) = known {
            let message = format!("the buffer `{}` is declared twice", name.value);
            let diagnostic = Diagnostic::new(codes::DUPLICATE, &name.origin, message, "leave one of them out");
            self.faults.push(diagnostic.label(&self.own.places.resources[first], "the first is here"));
            return Err(Stop);
        }
        self.own.row.resources.push(resource);
        self.own.places.resources.push(name.origin);
        Ok(())
    }

    /// `pass skeleton as anchor: buffer access, …`
    fn pass(&mut self, line: &mut Line<'_>) -> Read<()> {
        const SHAPE: &str = "`pass store: entries plain`";
        let skeleton = self.word(line, "the pass", SHAPE)?;
        let anchor = if line.exactly("as") { self.word(line, "the pass's own name", SHAPE)? } else { skeleton.clone() };
        self.sign(line, ':', SHAPE)?;
        let uses = self.uses(line)?;
        self.own.row.steps.push(Step::Pass(Pass { uses, ..Pass::geometry(&anchor.value, &skeleton.value) }));
        self.own.places.steps.push(skeleton.origin);
        Ok(())
    }

    /// `host function: reads offsets[pixels]; sets fragments`
    fn host(&mut self, line: &mut Line<'_>) -> Read<()> {
        const SHAPE: &str = "`host allocate: reads offsets[pixels]; sets fragments`";
        let function = self.word(line, "the host's function", SHAPE)?;
        self.sign(line, ':', SHAPE)?;
        let (mut reads, mut sets) = (Vec::new(), Vec::new());
        loop {
            let verb = self.word(line, "`reads` or `sets`", SHAPE)?;
            let list = match verb.value.as_str() {
                "reads" => &mut reads,
                "sets" => &mut sets,
                other => return self.stop(codes::ROW, &verb.origin, format!("the host cannot `{other}`"), SHAPE),
            };
            loop {
                list.push(line.until(&[',', ';']));
                if !line.sign(',') {
                    break;
                }
            }
            if !line.sign(';') {
                break;
            }
        }
        for read in &reads {
            let name = read.value.split('[').next().unwrap_or("").to_owned();
            let length = name.chars().count() as u32;
            self.used.push(Spanned::new(name, read.origin.clone().with_length(length)));
        }
        let values = |list: Vec<Spanned<String>>| list.into_iter().map(|word| word.value).collect();
        let host = Host { function: function.value, reads: values(reads), sets: values(sets) };
        self.own.row.steps.push(Step::Host(host));
        self.own.places.steps.push(function.origin);
        Ok(())
    }

    /// `buffer access, buffer atomic rechecked, …`
    fn uses(&mut self, line: &mut Line<'_>) -> Read<Vec<Use>> {
        let mut uses = Vec::new();
        while !line.is_done() {
            let name = self.word(line, "a buffer", "`entries plain, counts atomic`")?;
            let access = self.word(line, "how it is touched", "`read`, `plain`, `atomic` or `coherent`")?;
            let mut usage = Use::new(&name.value, self.one_of(&access, &ACCESSES, "no way to touch a buffer")?);
            if line.exactly("rechecked") {
                usage.loads = Loads::Rechecked;
            }
            uses.push(usage);
            self.used.push(name);
            if !line.sign(',') {
                break;
            }
        }
        Ok(uses)
    }

    fn facts(&mut self, line: &mut Line<'_>) -> Read<Vec<Fact>> {
        let mut facts = vec![self.fact(line)?];
        while line.sign(',') {
            facts.push(self.fact(line)?);
        }
        Ok(facts)
    }

    fn fact(&mut self, line: &mut Line<'_>) -> Read<Fact> {
        let word = self.word(line, "a fact", "`keeps-best`, `keeps-all`, `critical`")?;
        if let Some(fact) = Fact::ALL.iter().find(|fact| fact.word() == word.value) {
            return Ok(*fact);
        }
        let known: Vec<String> = Fact::ALL.iter().map(|fact| fact.word()).collect();
        let message = format!("there is no fact `{}`", word.value);
        self.stop(codes::UNKNOWN_FACT, &word.origin, message, near::hint(&word.value, &known))
    }

    /// `implies fact when fact`
    fn implies(&mut self, line: &mut Line<'_>) -> Read<()> {
        let then = self.fact(line)?;
        if !line.exactly("when") {
            return self.unexpected(line, "`when`", "`implies sorted when depth-key`");
        }
        let given = self.fact(line)?;
        self.own.row.implies.push((given, then));
        Ok(())
    }

    /// `suits axis value, …`
    fn suits(&mut self, line: &mut Line<'_>) -> Read<()> {
        loop {
            let axis = self.word(line, "an axis", "`suits cull early`")?;
            let value = self.word(line, "a value", "`suits cull early`")?;
            self.own.row.defaults.push((axis.value.into(), value.value.into()));
            self.own.places.defaults.push(value.origin);
            if !line.sign(',') {
                return Ok(());
            }
        }
    }

    /// `parameter name CONSTANT = formula, from least to greatest -- summary`
    fn parameter(&mut self, line: &mut Line<'_>) -> Read<()> {
        const SHAPE: &str = "`parameter limit SPIN_LIMIT = 4096, from 1 to 65536`";
        let name = self.word(line, "the option's name", SHAPE)?;
        let constant = self.word(line, "the generated constant", SHAPE)?;
        self.sign(line, '=', SHAPE)?;
        let default = line.until(&[',']);
        self.formula(&default, &["capacity", "entry_words", "beside_words"])?;
        if !line.sign(',') || !line.exactly("from") {
            return self.unexpected(line, "`, from`", SHAPE);
        }
        let least = self.number(line)?;
        if !line.exactly("to") {
            return self.unexpected(line, "`to`", SHAPE);
        }
        let greatest = self.number(line)?;
        self.own.row.parameters.push(Parameter {
            name: name.value.into(),
            constant: constant.value.into(),
            default: default.value.into(),
            range: (least, greatest),
            summary: line.summary.unwrap_or("of the user's own").to_owned().into(),
        });
        Ok(())
    }

    /// `hazard name unless fact -- what`
    fn hazard(&mut self, line: &mut Line<'_>) -> Read<()> {
        let name = self.word(line, "the hazard's name", "`hazard torn -- what happens`")?;
        let unless = if line.exactly("unless") { Some(self.fact(line)?) } else { None };
        let what = line.summary.unwrap_or("").to_owned().into();
        self.own.row.hazards.push(Hazard { name: name.value.into(), what, unless });
        Ok(())
    }

    fn soundness(&mut self, line: &mut Line<'_>) -> Read<()> {
        let word = self.word(line, "what it rests on", "`soundness atomics`")?;
        let known = Soundness::ALL.map(|soundness| (soundness.word(), soundness));
        let known: Vec<(&str, Soundness)> = known.iter().map(|(word, soundness)| (word.as_str(), *soundness)).collect();
        self.own.row.soundness = self.one_of(&word, &known, "no soundness")?;
        Ok(())
    }

    fn one_of<T: Copy>(&mut self, word: &Spanned<String>, table: &[(&str, T)], what: &str) -> Read<T> {
        if let Some((_, value)) = table.iter().find(|(name, _)| *name == word.value) {
            return Ok(*value);
        }
        let known: Vec<&str> = table.iter().map(|(name, _)| *name).collect();
        self.stop(codes::ROW, &word.origin, format!("`{}` is {what}", word.value), near::hint(&word.value, &known))
    }

    /// Reports a formula that cannot be read, or that depends on what it may not.
    fn formula(&mut self, formula: &Spanned<String>, symbols: &[&str]) -> Read<()> {
        let value = |symbol: &str| symbols.contains(&symbol).then_some(1);
        let problem = match Formula::from(formula.value.clone()).evaluate(&value) {
            // With every symbol at 1 a difference may be below zero: that is no mistake of the text.
            Ok(_) | Err(FormulaError::Overflow(_)) => return Ok(()),
            Err(FormulaError::Unbound(symbol)) => format!("`{symbol}` is no name that a formula may use here"),
            Err(FormulaError::Malformed { text, .. }) => format!("`{text}` is no formula"),
        };
        let hint = format!("the formula may use {}, `+ - * /`, min, max, ceil_div and pow2", symbols.join(", "));
        self.stop(codes::ROW, &formula.origin, problem, hint)
    }

    fn number(&mut self, line: &mut Line<'_>) -> Read<u32> {
        let word = self.word(line, "a number", "digits only, such as `8`")?;
        let Ok(number) = word.value.parse() else {
            let message = format!("`{}` is no whole number of 32 bits", word.value);
            return self.stop(codes::ROW, &word.origin, message, "write digits only, such as `8`");
        };
        Ok(number)
    }

    fn word(&mut self, line: &mut Line<'_>, what: &str, shape: &str) -> Read<Spanned<String>> {
        match line.word() {
            Some(word) => Ok(word),
            None => self.unexpected(line, what, shape),
        }
    }

    fn sign(&mut self, line: &mut Line<'_>, sign: char, shape: &str) -> Read<()> {
        if line.sign(sign) { Ok(()) } else { self.unexpected(line, &format!("`{sign}`"), shape) }
    }

    fn unexpected<T>(&mut self, line: &mut Line<'_>, what: &str, shape: &str) -> Read<T> {
        let message = format!("{what} belongs here, not {}", line.describe());
        let origin = line.here();
        self.stop(codes::ROW, &origin, message, format!("write {shape}"))
    }

    fn stop<T>(&mut self, code: Code, origin: &Origin, message: String, hint: impl Into<String>) -> Read<T> {
        self.fault(code, origin, message, hint);
        Err(Stop)
    }

    fn fault(&mut self, code: Code, origin: &Origin, message: String, hint: impl Into<String>) {
        self.faults.push(Diagnostic::new(code, origin, message, hint));
    }
}

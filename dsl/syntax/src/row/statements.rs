//! What each line of a row says.

use fragbuf_model::{Diagnostic, Diagnostics, Origin, OwnRow, Spanned, codes};
use fragbuf_templates::vocabulary::{
    Access, Definition, Element, Host, Init, Life, Loads, Parameter, Pass, Resource, SYMBOLS, SetBy, Step, Takes, Use,
    When, Written, is_word_of_formulas,
};

use super::line::Line;
use super::reader::{Read, Reader, Stop};
use crate::near;

/// The words that begin a line.
const WORDS: [&str; 15] = [
    "paper",
    "buffer",
    "pass",
    "host",
    "uses",
    "offers",
    "requires",
    "when",
    "implies",
    "suits",
    "parameter",
    "defines",
    "keeps",
    "hazard",
    "soundness",
];

/// How a shader touches a buffer.
const ACCESSES: [(&str, Access); 4] =
    [("read", Access::Read), ("plain", Access::Plain), ("atomic", Access::Atomic), ("coherent", Access::Coherent)];

/// What one element is.
const ELEMENTS: [(&str, Element); 3] =
    [("word", Element::Word), ("entry", Element::Entry), ("beside", Element::Beside)];

/// The symbols that a host step may set.
fn host_symbols() -> impl Iterator<Item = &'static str> {
    SYMBOLS.iter().filter(|symbol| symbol.set_by == SetBy::Host).map(|symbol| symbol.name)
}

/// Names inside generated accessors, beside which an index stands.
const ACCESSOR_NAMES: [&str; 5] = ["at", "key", "value", "entry", "expected"];

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
    pub(super) own: OwnRow,
    /// The buffers that lines declare, those with mistakes in them too.
    declared: Vec<String>,
    /// The buffers that lines refer to.
    used: Vec<Spanned<String>>,
    /// What a row says once, and where it has: a kind of line, or a name.
    said: Vec<(String, Origin)>,
    pub(super) reader: Reader,
}

/// Lines of which a row has one: what a second said would take the place of what the first did.
const SINGLE: [&str; 6] = ["paper", "offers", "requires", "uses", "keeps", "soundness"];

impl Statements {
    pub(super) fn new(own: OwnRow, faults: Diagnostics) -> Self {
        Statements {
            own,
            declared: Vec::new(),
            used: Vec::new(),
            said: Vec::new(),
            reader: Reader { faults, places: Vec::new() },
        }
    }

    /// The whole row, or every mistake.
    pub(super) fn finish(mut self) -> Result<OwnRow, Diagnostics> {
        for used in self.used.iter().filter(|used| !self.declared.contains(&used.value)) {
            let message = format!("the row declares no buffer `{}`", used.value);
            let hint = match self.declared.as_slice() {
                [] => format!("declare it: `//: buffer {}[pixel < pixels]: word`", used.value),
                names => near::hint(&used.value, names),
            };
            self.reader.fault(codes::UNKNOWN_RESOURCE, &used.origin, message, hint);
        }
        self.own.row.places = self.reader.places;
        self.reader.faults.gate(self.own)
    }

    /// Reads one line.
    pub(super) fn read(&mut self, mut line: Line<'_>) {
        if self.statement(&mut line).is_ok() && !line.is_done() {
            let message = format!("{} stands behind the end of the statement", line.describe());
            let hint = "leave it out; a new statement begins on a line of its own";
            self.reader.fault(codes::ROW, &line.here(), message, hint);
        }
    }

    fn statement(&mut self, line: &mut Line<'_>) -> Read<()> {
        let word = self.reader.word(line, "a statement", "`buffer`, `pass`, `offers`")?;
        if SINGLE.contains(&word.value.as_str()) {
            // What else is wrong with the line is said too.
            let _ = self.once(&word.value, &word.origin, "join the two lines, or leave one of them out");
        }
        let row = &mut self.own.row;
        match word.value.as_str() {
            "paper" => row.paper = line.until(&[]).value.into(),
            "offers" => row.offers = self.reader.facts(line)?,
            "requires" => (row.requires, row.needs) = self.reader.requirements(line)?,
            "uses" => self.own.row.uses = self.uses(line)?,
            "buffer" => return self.buffer(line),
            "pass" => return self.pass(line),
            "host" => return self.host(line),
            "when" => return self.when(line),
            "implies" => return self.implies(line),
            "suits" => return self.suits(line),
            "parameter" => return self.parameter(line),
            "defines" => return self.defines(line),
            "keeps" => return self.keeps(line),
            "hazard" => return self.hazard(line),
            "soundness" => return self.soundness(line),
            // The first line, when the row has no axis: that has been said.
            _ if row.axis.is_empty() && line.origin() == self.own.places.row => return Err(Stop),
            unknown => {
                let message = format!("no line of a row begins with `{unknown}`");
                return self.reader.stop(codes::ROW, &word.origin, message, near::hint(unknown, &WORDS));
            }
        }
        Ok(())
    }

    /// Reports what a row has said already.
    pub(super) fn once(&mut self, what: &str, at: &Origin, hint: &str) -> Read<()> {
        let Some((_, first)) = self.said.iter().find(|(said, _)| said == what) else {
            self.said.push((what.to_owned(), at.clone()));
            return Ok(());
        };
        let diagnostic = Diagnostic::new(codes::DUPLICATE, at, format!("the row says `{what}` twice"), hint);
        self.reader.faults.push(diagnostic.label(first, "the first is here"));
        Err(Stop)
    }

    /// `buffer name[index < length]…: element, clear 0, host, persistent -- summary`
    fn buffer(&mut self, line: &mut Line<'_>) -> Read<()> {
        const SHAPE: &str = "`buffer heads[pixel < pixels]: word`";
        let name = self.reader.name(line, "a buffer's name", SHAPE)?;
        self.declared.push(name.value.clone());
        let mut resource = Resource::new(&name.value, Element::Word, summary(line));
        while line.sign('[') {
            resource = self.extent(line, resource)?;
        }
        self.reader.sign(line, ':', SHAPE)?;
        let element = self.reader.word(line, "an element", "`word`, `entry` or `beside`")?;
        resource.element = self.reader.one_of(&element, &ELEMENTS, "no element")?;
        while line.sign(',') {
            let word = self.reader.word(line, "an attribute", "`clear 0`, `host` or `persistent`")?;
            match word.value.as_str() {
                "clear" => resource.init = Init::Clear(self.reader.number(line)?.value),
                "host" => resource.init = Init::Host,
                "persistent" => resource.life = Life::Persistent,
                other => {
                    let hint = near::hint(other, &["clear", "host", "persistent"]);
                    return self.reader.stop(codes::ROW, &word.origin, format!("a buffer has no `{other}`"), hint);
                }
            }
        }
        let known = self.own.row.resources.iter().position(|other| other.name == name.value);
        if let Some(first) = known {
            let message = format!("the buffer `{}` is declared twice", name.value);
            let diagnostic = Diagnostic::new(codes::DUPLICATE, &name.origin, message, "leave one of them out");
            self.reader.faults.push(diagnostic.label(&self.own.places.resources[first], "the first is here"));
            return Err(Stop);
        }
        self.reader.stands(Written::Resource, &name);
        self.own.row.resources.push(resource);
        self.own.places.resources.push(name.origin);
        Ok(())
    }

    /// `index < length]`
    fn extent(&mut self, line: &mut Line<'_>, resource: Resource) -> Read<Resource> {
        const SHAPE: &str = "`[pixel < pixels]`";
        let index = self.reader.name(line, "an index", SHAPE)?;
        let is_taken = resource.extents.iter().any(|extent| extent.name == index.value);
        if is_taken || ACCESSOR_NAMES.contains(&index.value.as_str()) {
            let message = format!("`{}` is a name beside this one in the buffer's accessors", index.value);
            return self.reader.stop(codes::ROW, &index.origin, message, "choose another, such as `slot` or `pixel`");
        }
        self.reader.sign(line, '<', SHAPE)?;
        let length = line.until(&[']']);
        self.reader.sign(line, ']', SHAPE)?;
        let symbols = self.symbols();
        self.reader.formula(&length, &symbols)?;
        self.reader.stands(Written::Length, &length);
        Ok(resource.by(&index.value, length.value))
    }

    /// `pass skeleton as anchor: buffer access, …`
    fn pass(&mut self, line: &mut Line<'_>) -> Read<()> {
        const SHAPE: &str = "`pass store: entries plain`";
        let skeleton = self.reader.word(line, "the pass", SHAPE)?;
        let anchor = match line.exactly("as") {
            true => self.reader.name(line, "the name of a pass", "`pass store as again: entries plain`")?,
            false => skeleton.clone(),
        };
        self.reader.sign(line, ':', SHAPE)?;
        let uses = self.uses(line)?;
        let is_anchor = |step: &Step| matches!(step, Step::Pass(pass) if pass.anchor == anchor.value);
        if let Some(first) = self.own.row.steps.iter().position(is_anchor) {
            let message = format!("two passes are called `{}`", anchor.value);
            let hint = format!("name one of them: `pass {} as another: …`", skeleton.value);
            let diagnostic = Diagnostic::new(codes::DUPLICATE, &anchor.origin, message, hint);
            self.reader.faults.push(diagnostic.label(&self.own.places.steps[first], "the first is here"));
            return Err(Stop);
        }
        self.own.row.steps.push(Step::Pass(Pass { uses, ..Pass::geometry(&anchor.value, &skeleton.value) }));
        self.own.places.steps.push(skeleton.origin);
        Ok(())
    }

    /// `host function: reads offsets[pixels], histogram, words[4 for 8]; sets fragments`
    fn host(&mut self, line: &mut Line<'_>) -> Read<()> {
        const SHAPE: &str = "`host allocate: reads offsets[pixels]; sets fragments`";
        let function = self.reader.word(line, "the host's function", SHAPE)?;
        self.reader.sign(line, ':', SHAPE)?;
        let mut host = Host::new(&function.value);
        loop {
            let verb = self.reader.word(line, "`reads` or `sets`", SHAPE)?;
            loop {
                host = match verb.value.as_str() {
                    "reads" => self.host_read(line, host, SHAPE)?,
                    "sets" => self.host_set(line, host, SHAPE)?,
                    other => {
                        let message = format!("the host cannot `{other}`");
                        return self.reader.stop(codes::ROW, &verb.origin, message, SHAPE);
                    }
                };
                if !line.sign(',') {
                    break;
                }
            }
            if !line.sign(';') {
                break;
            }
        }
        if host.sets.is_empty() {
            let message = format!("the host function `{}` sets nothing", function.value);
            return self.reader.stop(codes::ROW, &function.origin, message, SHAPE);
        }
        self.own.row.steps.push(Step::Host(host));
        self.own.places.steps.push(function.origin);
        Ok(())
    }

    /// `name`, all words of a buffer; `name[index]`, one; `name[first for count]`, some.
    fn host_read(&mut self, line: &mut Line<'_>, host: Host, shape: &str) -> Read<Host> {
        let name = self.reader.name(line, "a buffer", shape)?;
        self.used.push(name.clone());
        if !line.sign('[') {
            return Ok(host.reads_all(&name.value));
        }
        let words = line.until(&[']']);
        self.reader.sign(line, ']', shape)?;
        let (first, count) = words.value.split_once(" for ").unwrap_or((&words.value, "1"));
        let symbols = self.symbols();
        for formula in [first, count] {
            let formula = Spanned::new(formula.trim().to_owned(), words.origin.clone());
            self.reader.formula(&formula, &symbols)?;
            self.reader.stands(Written::Read, &formula);
        }
        Ok(host.reads_some(&name.value, first.trim().to_owned(), count.trim().to_owned()))
    }

    fn host_set(&mut self, line: &mut Line<'_>, host: Host, shape: &str) -> Read<Host> {
        let symbol = self.reader.word(line, "a symbol", shape)?;
        let known: Vec<(&str, &str)> = host_symbols().map(|name| (name, name)).collect();
        let name = self.reader.one_of(&symbol, &known, "no symbol that a host step sets")?;
        Ok(host.sets(name))
    }

    /// What formulas of the row may name: everything that has a value before a pass runs and is not a slice's or an iteration's
    /// own, and the row's constants so far.
    fn symbols(&self) -> Vec<String> {
        let known = SYMBOLS.iter().filter(|symbol| symbol.when != When::Round).map(|symbol| symbol.name.to_owned());
        known.chain(self.own.row.parameters.iter().map(|parameter| parameter.constant.to_string())).collect()
    }

    /// `buffer access, buffer atomic rechecked, …`
    fn uses(&mut self, line: &mut Line<'_>) -> Read<Vec<Use>> {
        let mut uses = Vec::new();
        while !line.is_done() {
            let name = self.reader.word(line, "a buffer", "`entries plain, counts atomic`")?;
            let access = self.reader.word(line, "how it is touched", "`read`, `plain`, `atomic` or `coherent`")?;
            let mut usage = Use::new(&name.value, self.reader.one_of(&access, &ACCESSES, "no way to touch a buffer")?);
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

    /// `suits axis value, …`
    fn suits(&mut self, line: &mut Line<'_>) -> Read<()> {
        loop {
            let axis = self.reader.word(line, "an axis", "`suits cull early`")?;
            let value = self.reader.word(line, "a value", "`suits cull early`")?;
            self.once(&format!("suits {}", axis.value), &axis.origin, "leave one of them out")?;
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
        let name = self.reader.word(line, "the option's name", SHAPE)?;
        self.once(&format!("parameter {}", name.value), &name.origin, "give one of the options another name")?;
        let constant = self.constant(line, SHAPE)?;
        self.reader.sign(line, '=', SHAPE)?;
        let default = line.until(&[',']);
        let generation = SYMBOLS.iter().filter(|symbol| symbol.when <= When::Generation);
        let generation: Vec<&str> = generation.map(|symbol| symbol.name).collect();
        self.reader.formula(&default, &generation)?;
        self.reader.stands(Written::Default, &default);
        if !line.sign(',') || !line.exactly("from") {
            return self.reader.unexpected(line, "`, from`", SHAPE);
        }
        let least = self.reader.number(line)?;
        if !line.exactly("to") {
            return self.reader.unexpected(line, "`to`", SHAPE);
        }
        let greatest = self.reader.number(line)?;
        if greatest.value < least.value {
            let message = format!("nothing lies between {} and {}", least.value, greatest.value);
            let hint = format!("write `from {} to {}`", greatest.value, least.value);
            return self.reader.stop(codes::ROW, &greatest.origin, message, hint);
        }
        self.own.row.parameters.push(Parameter {
            name: name.value.into(),
            constant: constant.value.into(),
            takes: Takes::Number,
            default: default.value.into(),
            range: (least.value, greatest.value),
            summary: summary(line).into(),
        });
        self.own.places.parameters.push(constant.origin);
        Ok(())
    }

    /// The constant of a parameter, which formulas name beside the symbols that every row has.
    fn constant(&mut self, line: &mut Line<'_>, shape: &str) -> Read<Spanned<String>> {
        let constant = self.reader.name(line, "a generated constant", shape)?;
        if !is_word_of_formulas(&constant.value) {
            self.reader.stands(Written::Constant, &constant);
            return Ok(constant);
        }
        let message = format!("`{}` means something else in every formula", constant.value);
        let hint = format!("choose another name, such as `OWN_{}`", constant.value.to_ascii_uppercase());
        self.reader.stop(codes::ROW, &constant.origin, message, hint)
    }

    /// `defines pixels = ceil_div(width, 4) * 4 * height`
    fn defines(&mut self, line: &mut Line<'_>) -> Read<()> {
        const SHAPE: &str = "`defines pixels = ceil_div(width, 4) * 4 * height`";
        let name = self.reader.word(line, "a symbol", SHAPE)?;
        let symbol = self.reader.one_of(&name, &[("pixels", "pixels")], "no symbol that a row defines")?;
        self.once(&format!("defines {symbol}"), &name.origin, "leave one of them out")?;
        self.reader.sign(line, '=', SHAPE)?;
        let value = line.until(&[]);
        self.reader.formula(&value, &["width", "height"])?;
        self.reader.stands(Written::Definition, &value);
        self.own.row.defines.push(Definition { symbol: symbol.into(), value: value.value.into() });
        Ok(())
    }
}

/// What stands behind ` -- `.
pub(super) fn summary(line: &Line<'_>) -> String {
    line.summary.unwrap_or("of the user's own").to_owned()
}

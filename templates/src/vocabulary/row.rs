//! One row of the registry: a value on an axis, and all that the rules and the plan need to know of it.

use super::{
    Capability, Condition, Edit, Fact, Formula, Given, Hazard, HostFunction, Kept, Merges, Resource, Step, Text, Use,
};

/// One way to choose: `storage`, `sync`, `sort`, …
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The word of the language.
    pub key: &'static str,
    /// What is chosen.
    pub summary: &'static str,
    /// The value taken when neither the description, the preset nor another row's defaults say one.
    pub default: Option<&'static str>,
    /// Whether a user chooses on it; the others (`pass`, `shared`) hold texts that plans refer to.
    pub chosen: bool,
}

/// One value on an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The word of the language, and the stem of the template's file.
    pub key: String,
    /// Its axis.
    pub axis: String,
    /// What it does, in one line.
    pub summary: Text,
    /// Where it comes from: paper and section.
    pub paper: Text,
    /// The template; `None` where the row only changes plans or constants.
    pub template: Option<Template>,
    /// What it keeps in memory.
    pub resources: Vec<Resource>,
    /// How a pass that calls this row touches the row's own resources. A row with steps says so in its passes instead.
    pub uses: Vec<Use>,
    /// The steps of a frame, for the row that a plan starts from (a storage).
    pub steps: Vec<Step>,
    /// Contracts that the template calls, by axis.
    pub calls: Vec<&'static str>,
    /// What it gives to the other rows.
    pub offers: Vec<Fact>,
    /// (condition, fact): what it offers only where the description meets a condition.
    pub implies: Vec<(Formula, Fact)>,
    /// What it needs from them.
    pub requires: Vec<Fact>,
    /// What it needs of the description.
    pub conditions: Vec<Condition>,
    /// What it needs of the target and the device.
    pub needs: Vec<Capability>,
    /// What it changes in the steps of others.
    pub edits: Vec<Edit>,
    /// Values on other axes that suit it, taken when nothing else is said.
    pub defaults: Vec<(Text, Text)>,
    /// Words that every fragment carries beside the description's payload.
    pub carries: Vec<Carried>,
    /// What a user can set on it.
    pub parameters: Vec<Parameter>,
    /// The least that an option may be for what is kept, as (option, formula over `k`). Defaults must meet it.
    pub least: Vec<(Text, Formula)>,
    /// Symbols of formulas that it gives a value.
    pub defines: Vec<Definition>,
    /// Which fragments stay, said more closely than by a fact that it offers; `None`: by a fact, or not at all.
    pub keeps: Option<Kept>,
    /// How entries become one.
    pub merges: Option<Merges>,
    /// What can go wrong by design.
    pub hazards: Vec<Hazard>,
    /// What its safety under concurrency rests on.
    pub soundness: Soundness,
    /// The order it imposes on fragments with equal keys, for an axis that says so.
    pub order: Option<Order>,
    /// The function that the host calls, for a row of the axis `host`.
    pub host: Option<HostFunction>,
    /// For a row in a user's file: where its names and formulas stand.
    pub places: Vec<Place>,
}

/// What a row in a user's file writes somewhere.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Written {
    /// The name of a buffer.
    Resource,
    /// The length of an extent.
    Length,
    /// The words that a host step reads: the first, or how many.
    Read,
    /// The constant of a parameter.
    Constant,
    /// The default of a parameter.
    Default,
    /// The formula of a definition.
    Definition,
}

/// Where a row in a user's file writes a name or a formula. Lines and columns count from 1, columns in characters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Place {
    /// What it is.
    pub what: Written,
    /// The name or formula.
    pub text: Text,
    /// Its line.
    pub line: u32,
    /// Its first column.
    pub column: u32,
    /// Its length in characters.
    pub length: u32,
}

/// A whole WGSL file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Template {
    /// Its path under `templates/`; a user's file as the description names it.
    pub path: Text,
    /// Its text.
    pub text: Text,
    /// For a file of the user's own: what messages call it.
    pub own: Option<Text>,
}

/// A word that every fragment carries beside the description's payload: a member `u32` of `Fragment`, a word of an entry.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Carried {
    /// The member. No attribute of a user's is spelled so.
    pub name: Text,
    /// The WGSL built-in of fragment shaders that gives its value; a caller's own shader gives it in module form.
    pub built_in: Text,
}

/// What is written as the value of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// A whole number.
    Number,
    /// A power of two.
    PowerOfTwo,
    /// The name of an attribute, which stands for its place among the attributes.
    Attribute,
}

/// A number that a user can set on a row; it becomes a generated constant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// The word in `{ name: value }`.
    pub name: Text,
    /// The generated constant.
    pub constant: Text,
    /// What a user writes.
    pub takes: Takes,
    /// The value when nothing is said, over the symbols of generation time.
    pub default: Formula,
    /// Least and greatest.
    pub range: (u32, u32),
    /// What it does.
    pub summary: Text,
}

/// A symbol of formulas that a row gives a value, over the symbols of allocation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Definition {
    /// The symbol.
    pub symbol: Text,
    /// Its value.
    pub value: Formula,
}

/// What the safety of a row under concurrency rests on. The weakest of the chosen rows decides the tier on a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Soundness {
    /// Nothing concurrent, or single-object atomics and pass borders: T1.
    Atomics,
    /// Interlock: T2.
    Interlock,
    /// A lock, or plain words that others read once they see an atomic one: T3 with fences, T4 without.
    Lock,
    /// Nothing: T5.
    Racy,
}

/// How fragments with equal keys are ordered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Order {
    /// By their remaining words: the result depends on the multiset of fragments alone.
    Payload,
    /// As `Payload`, the words of the attribute that the row's parameter names before all others.
    Attribute,
    /// By their order of submission.
    Submission,
    /// Not at all: whichever comes first.
    Unordered,
}

impl Soundness {
    /// Every kind, the strongest first.
    pub const ALL: [Soundness; 4] = [Soundness::Atomics, Soundness::Interlock, Soundness::Lock, Soundness::Racy];

    /// The word of plans and of rows in files.
    pub fn word(self) -> String {
        format!("{self:?}").to_lowercase()
    }
}

impl Template {
    /// A file of fragbuf's own, or one that code has made.
    pub fn new(path: impl Into<Text>, text: impl Into<Text>) -> Self {
        Template { path: path.into(), text: text.into(), own: None }
    }
}

impl Parameter {
    /// A whole number.
    pub fn number(
        name: impl Into<Text>,
        constant: impl Into<Text>,
        default: impl Into<Formula>,
        range: (u32, u32),
        summary: impl Into<Text>,
    ) -> Self {
        let (name, constant, summary) = (name.into(), constant.into(), summary.into());
        Parameter { name, constant, takes: Takes::Number, default: default.into(), range, summary }
    }
}

impl Row {
    /// Whether it offers a fact to a description that gives this.
    pub fn offers_to(&self, given: &Given, fact: Fact) -> bool {
        self.offers.contains(&fact) || self.implies.iter().any(|(when, then)| *then == fact && given.meets(when))
    }

    /// Which fragments stay of those that it is handed; `None`: it does not say, or does not store.
    pub fn kept(&self) -> Option<Kept> {
        let by_fact = [(Fact::KeepsAll, Kept::all()), (Fact::KeepsBest, Kept::best()), (Fact::Streams, Kept::worst())];
        let by_fact = || by_fact.into_iter().find(|(fact, _)| self.offers.contains(fact)).map(|(_, kept)| kept);
        self.keeps.clone().or_else(by_fact)
    }

    /// Whether it offers a fact to some description.
    pub fn may_offer(&self, fact: Fact) -> bool {
        self.offers.contains(&fact) || self.implies.iter().any(|(_, implied)| *implied == fact)
    }

    /// A row with nothing but its names.
    pub fn new(axis: &str, key: &str, summary: impl Into<Text>, paper: impl Into<Text>) -> Self {
        Row {
            key: key.to_owned(),
            axis: axis.to_owned(),
            summary: summary.into(),
            paper: paper.into(),
            template: None,
            resources: Vec::new(),
            uses: Vec::new(),
            steps: Vec::new(),
            calls: Vec::new(),
            offers: Vec::new(),
            implies: Vec::new(),
            requires: Vec::new(),
            conditions: Vec::new(),
            needs: Vec::new(),
            edits: Vec::new(),
            defaults: Vec::new(),
            carries: Vec::new(),
            parameters: Vec::new(),
            least: Vec::new(),
            defines: Vec::new(),
            keeps: None,
            merges: None,
            hazards: Vec::new(),
            soundness: Soundness::Atomics,
            order: None,
            host: None,
            places: Vec::new(),
        }
    }
}

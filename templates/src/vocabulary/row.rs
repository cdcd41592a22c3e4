//! A row of the registry: one value on an axis, with the data that the legality rules and the plan read.

use super::{
    Capability, Condition, DescriptionValues, Edit, Feature, Formula, Hazard, HostFunction, KeptFragments, Merges,
    Resource, Step, Text, Use,
};

/// One choice that a description makes: `storage`, `sync`, `sort`, …
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// The keyword of the language.
    pub key: &'static str,
    /// What is chosen.
    pub summary: &'static str,
    /// The value if neither the description, the preset nor another row's defaults give one.
    pub default: Option<&'static str>,
    /// Whether a description can choose a value. The other axes (`pass`, `host`) hold rows that plans refer to.
    pub chosen: bool,
}

/// One value on an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Row {
    /// The keyword of the language, and the stem of the template's file name.
    pub key: String,
    /// A former key, which descriptions may still use.
    pub former_key: Option<&'static str>,
    /// The axis.
    pub axis: String,
    /// What the row does, in one line.
    pub summary: Text,
    /// The source: paper and section.
    pub paper: Text,
    /// The template; `None` if the row only changes plans or constants.
    pub template: Option<Template>,
    /// The resources that the row keeps in memory.
    pub resources: Vec<Resource>,
    /// How a pass that calls this row accesses the row's resources. A row with steps declares this in its passes
    /// instead.
    pub uses: Vec<Use>,
    /// The steps of a frame, for the row that a plan starts from (a storage).
    pub steps: Vec<Step>,
    /// Contracts that the template calls, by axis.
    pub calls: Vec<&'static str>,
    /// Capabilities that the row provides to the other rows.
    pub provides: Vec<Capability>,
    /// (condition, capability): capabilities that the row provides only if the description meets a condition.
    pub implies: Vec<(Formula, Capability)>,
    /// Capabilities that the row requires of the other rows.
    pub requires: Vec<Capability>,
    /// What the row requires of the description.
    pub conditions: Vec<Condition>,
    /// Features that the row requires of the target and the device.
    pub needs: Vec<Feature>,
    /// (condition, feature): features that the row requires only under a condition on the description and on its own options, by the
    /// names of their constants.
    pub needs_if: Vec<(Formula, Feature)>,
    /// Changes to the steps of other rows.
    pub edits: Vec<Edit>,
    /// Values on other axes that are used if the description gives none.
    pub defaults: Vec<(Text, Text)>,
    /// Words that the row adds to every fragment.
    pub extra_words: Vec<ImplicitAttribute>,
    /// The options of the row.
    pub parameters: Vec<Parameter>,
    /// Constants that the row generates for other rows, over its parameters. Their names are in formulas too.
    pub constants: Vec<Definition>,
    /// (option, formula over `k`): the least value of an option. Defaults must meet it.
    pub least: Vec<(Text, Formula)>,
    /// Symbols of formulas that the row defines.
    pub defines: Vec<Definition>,
    /// Which fragments are kept, if no capability describes it; `None`: a capability does, or nothing does.
    pub keeps: Option<KeptFragments>,
    /// How entries are merged.
    pub merges: Option<Merges>,
    /// What can go wrong by design.
    pub hazards: Vec<Hazard>,
    /// What safety under concurrency depends on.
    pub soundness: Soundness,
    /// The order of fragments with equal keys, for rows of the axis `ties`.
    pub order: Option<TieBreak>,
    /// The function that the host calls, for rows of the axis `host`.
    pub host: Option<HostFunction>,
    /// The spans of names and formulas, for a row in a user's file.
    pub item_spans: Vec<RowItemSpan>,
}

/// A name or formula in the header of a user's file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RowItem {
    /// The name of a buffer.
    Resource,
    /// The length of an extent.
    Length,
    /// The words that a host step reads: the index of the first, or their number.
    Read,
    /// The constant of a parameter.
    Constant,
    /// The default of a parameter.
    Default,
    /// The formula of a definition.
    Definition,
}

/// The span of a name or formula in a user's file. Lines and columns count from 1, columns in characters.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RowItemSpan {
    /// The kind of item.
    pub item: RowItem,
    /// The name or formula.
    pub text: Text,
    /// The line.
    pub line: u32,
    /// The first column.
    pub column: u32,
    /// The length in characters.
    pub length: u32,
}

/// A complete WGSL file.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Template {
    /// The path under `templates/`; for a user's file, the path that the description gives.
    pub path: Text,
    /// The WGSL source.
    pub source: Text,
    /// For a user's file, its name in messages.
    pub user_file: Option<Text>,
}

/// A word that a row adds to every fragment: a member `u32` of `Fragment`, one word of an entry.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ImplicitAttribute {
    /// The member. No attribute of a description can have this name.
    pub name: Text,
    /// The WGSL built-in of fragment shaders that gives the value. In module form the caller's shader gives it.
    pub built_in: Text,
}

/// The type of a parameter's value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ParameterType {
    /// A whole number.
    Number,
    /// A power of two.
    PowerOfTwo,
    /// The name of an attribute, which stands for its index among the attributes.
    Attribute,
}

/// An option of a row. It becomes a generated constant.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Parameter {
    /// The name in `{ name: value }`.
    pub name: Text,
    /// The generated constant.
    pub constant: Text,
    /// The type of the value.
    pub kind: ParameterType,
    /// The default, over the symbols of generation time.
    pub default: Formula,
    /// The least and the greatest value.
    pub range: (u32, u32),
    /// Whether it limits the attempts of a fragment, which then times out and is counted. A timeout is no failure if the limit is
    /// low. A row that declares timeouts as a hazard needs no mark.
    pub is_retry_limit: bool,
    /// What it does.
    pub summary: Text,
}

/// A symbol or a constant that a row defines. Symbols are over those of allocation, constants over those of generation.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Definition {
    /// The symbol.
    pub symbol: Text,
    /// The value.
    pub value: Formula,
}

/// What the safety of a row under concurrency depends on. The weakest of the chosen rows decides the tier on a target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Soundness {
    /// Nothing concurrent, or atomics on single objects and pass boundaries: T1.
    Atomics,
    /// Interlock: T2.
    Interlock,
    /// A lock, or plain words that others read after they have seen an atomic one: T3 with fences, T4 without.
    Lock,
    /// Nothing: T5.
    Racy,
}

/// How fragments with equal keys are ordered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TieBreak {
    /// By their remaining words: the result depends only on the multiset of fragments.
    Payload,
    /// As `Payload`, but the words of the attribute that the row's parameter names come first.
    Attribute,
    /// By their order of submission.
    Submission,
    /// By their order of arrival.
    Unordered,
}

impl Soundness {
    /// Every value, the strongest first.
    pub const ALL: [Soundness; 4] = [Soundness::Atomics, Soundness::Interlock, Soundness::Lock, Soundness::Racy];

    /// Returns the name in plans and in row headers.
    pub fn name(self) -> String {
        format!("{self:?}").to_lowercase()
    }
}

impl Template {
    /// Makes a template of fragbuf or of generated source.
    pub fn new(path: impl Into<Text>, source: impl Into<Text>) -> Self {
        Template { path: path.into(), source: source.into(), user_file: None }
    }
}

impl Parameter {
    /// Makes a parameter whose value is a whole number.
    pub fn number(
        name: impl Into<Text>,
        constant: impl Into<Text>,
        default: impl Into<Formula>,
        range: (u32, u32),
        summary: impl Into<Text>,
    ) -> Self {
        let (name, constant, summary) = (name.into(), constant.into(), summary.into());
        let (kind, default) = (ParameterType::Number, default.into());
        Parameter { name, constant, kind, default, range, is_retry_limit: false, summary }
    }

    /// Makes a parameter that limits the attempts of a fragment, which then times out and is counted.
    pub fn retry_limit(
        name: impl Into<Text>,
        constant: impl Into<Text>,
        default: impl Into<Formula>,
        range: (u32, u32),
        summary: impl Into<Text>,
    ) -> Self {
        Parameter { is_retry_limit: true, ..Parameter::number(name, constant, default, range, summary) }
    }
}

impl Row {
    /// Returns whether the row provides a capability to a description with these values.
    pub fn provides_to(&self, given: &DescriptionValues, capability: Capability) -> bool {
        self.provides.contains(&capability)
            || self.implies.iter().any(|(when, then)| *then == capability && given.meets(when))
    }

    /// Returns which of the stored fragments the row keeps; `None` if the row does not declare it, or does not store.
    pub fn kept(&self) -> Option<KeptFragments> {
        let by_capability = [
            (Capability::KeepsAll, KeptFragments::all()),
            (Capability::KeepsBest, KeptFragments::best()),
            (Capability::Streams, KeptFragments::worst()),
        ];
        let by_capability = || {
            by_capability.into_iter().find(|(capability, _)| self.provides.contains(capability)).map(|(_, kept)| kept)
        };
        self.keeps.clone().or_else(by_capability)
    }

    /// Returns whether the row provides a capability to some description.
    pub fn may_provide(&self, capability: Capability) -> bool {
        self.provides.contains(&capability) || self.implies.iter().any(|(_, implied)| *implied == capability)
    }

    /// Makes a row that has only names and texts.
    pub fn new(axis: &str, key: &str, summary: impl Into<Text>, paper: impl Into<Text>) -> Self {
        Row {
            key: key.to_owned(),
            former_key: None,
            axis: axis.to_owned(),
            summary: summary.into(),
            paper: paper.into(),
            template: None,
            resources: Vec::new(),
            uses: Vec::new(),
            steps: Vec::new(),
            calls: Vec::new(),
            provides: Vec::new(),
            implies: Vec::new(),
            requires: Vec::new(),
            conditions: Vec::new(),
            needs: Vec::new(),
            needs_if: Vec::new(),
            edits: Vec::new(),
            defaults: Vec::new(),
            extra_words: Vec::new(),
            parameters: Vec::new(),
            least: Vec::new(),
            constants: Vec::new(),
            defines: Vec::new(),
            keeps: None,
            merges: None,
            hazards: Vec::new(),
            soundness: Soundness::Atomics,
            order: None,
            host: None,
            item_spans: Vec::new(),
        }
    }
}

//! Loads a description: the key of a technique or the text of a file, with changes from outside and the files that it names.

use std::path::Path;

pub use fragbuf_model::SET;
use fragbuf_model::{Choice, Diagnostics, Draft, MissingFeature, SourceSpan, Spanned, Variant};
use fragbuf_syntax::{Parsed, parse};
use fragbuf_targets::{Request, Target, select};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Row;

use crate::source_file;
use crate::user_file::{self, UserFiles};

/// A description to load.
#[derive(Clone, Debug)]
pub enum Description {
    /// A technique of the registry.
    Technique(String),
    /// The text of a file. Paths in it are relative to the file.
    Text {
        /// The name of the file in messages.
        file: String,
        /// The text.
        text: String,
    },
}

impl Description {
    /// Reads the file at `path` ([`source_file`]). Messages name it by this path.
    pub fn read(path: &Path) -> std::io::Result<Self> {
        Ok(Description::Text { file: path.display().to_string(), text: source_file::read(path)? })
    }

    /// Returns the name in messages.
    pub fn name(&self) -> &str {
        match self {
            Description::Technique(key) => key,
            Description::Text { file, .. } => file,
        }
    }
}

/// A loaded description.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The variant, or every error.
    pub variant: Result<Variant, Diagnostics>,
    /// Every source that was read, by its name in messages. The first is the description.
    pub sources: Vec<(String, String)>,
    /// The changes from outside as sources of one line per change, by their names in messages. They are not files.
    pub changes: Vec<(String, String)>,
}

impl Loaded {
    /// Returns every source that messages may quote, by its name in messages.
    pub fn all_sources(&self) -> Vec<(String, String)> {
        self.sources.iter().chain(&self.changes).cloned().collect()
    }
}

/// Loads and checks a description, and reads the files that it names.
///
/// `set` changes it: each is a name and a value, as in `--set name=value`. `defaults` are choices on axes on which neither the
/// description nor `set` chooses.
pub fn load(
    description: &Description,
    set: &[(String, String)],
    defaults: &[(&str, &str)],
    registry: &Registry,
) -> Loaded {
    let text = match description {
        Description::Technique(key) => key,
        Description::Text { text, .. } => text,
    };
    let set = &user_file::with_relative_paths(set);
    let mut sources = vec![(description.name().to_owned(), text.clone())];
    let variant = draft(description).and_then(|(mut draft, mut diagnostics)| {
        change(&mut draft, set, defaults, registry, &mut diagnostics);
        let checked = check_with_files(draft, diagnostics, description.name(), registry);
        sources.extend(checked.sources);
        checked.variant
    });
    let lines = |changes: &mut dyn Iterator<Item = (&str, &str)>| -> String {
        changes.map(|(name, value)| format!("{name}={value}\n")).collect()
    };
    let set = lines(&mut set.iter().map(|(name, value)| (name.as_str(), value.as_str())));
    let changes = vec![(SET.to_owned(), set), (DEFAULTS.to_owned(), lines(&mut defaults.iter().copied()))];
    Loaded { variant, sources, changes }
}

/// A draft that is checked with the user files that it names.
pub(crate) struct CheckedWithFiles {
    /// The variant, or every error.
    pub(crate) variant: Result<Variant, Diagnostics>,
    /// The sources of the files by their names in messages.
    pub(crate) sources: Vec<(String, String)>,
    /// The registry with the rows of the files.
    pub(crate) registry: Registry,
}

/// Reads the files that a draft names, and checks it with their rows. `diagnostics` are the errors so far, and `name` is the name of the
/// description in messages.
pub(crate) fn check_with_files(
    mut draft: Draft,
    mut diagnostics: Diagnostics,
    name: &str,
    registry: &Registry,
) -> CheckedWithFiles {
    let UserFiles { registry, sources, diagnostics: errors, warnings } = user_file::read(&draft, registry);
    draft.file_warnings = warnings;
    if !errors.is_empty() {
        // Without the row of a file, its capabilities are unknown: the check would report all of them as missing.
        diagnostics.extend(errors);
        return CheckedWithFiles { variant: Err(diagnostics), sources, registry };
    }
    let variant = check_without_files(&Parsed { draft: Some(draft), diagnostics }, name, &registry, true);
    CheckedWithFiles { variant, sources, registry }
}

/// Checks a draft whose user files are rows of the registry. `finds_files`: errors about unknown values name user files of the same name.
pub(crate) fn check_without_files(
    parsed: &Parsed,
    name: &str,
    registry: &Registry,
    finds_files: bool,
) -> Result<Variant, Diagnostics> {
    let checked = parsed.check(registry);
    match (checked, &parsed.draft) {
        (Err(errors), Some(draft)) if finds_files => Err(user_file::near_names(draft, name, registry).named_in(errors)),
        (checked, _) => checked,
    }
}

/// Whether a draft names user files.
pub(crate) fn names_files(draft: &Draft) -> bool {
    draft.choices.iter().flat_map(|choice| &choice.alternatives).any(|alternative| alternative.file().is_some())
}

/// Loads a description and returns the variant alone.
pub fn variant(
    description: &Description,
    set: &[(String, String)],
    registry: &Registry,
) -> Result<Variant, Diagnostics> {
    load(description, set, &[], registry).variant
}

/// Returns the changes `axis=value else other` after which one of the targets supports the description, for each feature that a target lacks.
pub fn alternatives(
    description: &Description,
    set: &[(String, String)],
    registry: &Registry,
    unsupported: &[(&'static Target, MissingFeature)],
    request: &Request<'_>,
) -> Vec<(String, String)> {
    let mut found: Vec<(String, String)> = Vec::new();
    for (target, missing) in unsupported {
        let is_chosen = registry.axis(&missing.axis).is_some_and(|axis| axis.chosen);
        if !is_chosen || found.iter().any(|(axis, _)| *axis == missing.axis) {
            continue;
        }
        let current = chosen_values(description, set, registry, &missing.axis);
        let others = registry.rows_of(&missing.axis).filter(|row| !Registry::is_of_closures(row));
        let supported = others.filter(|row| {
            let more = [set, &[(missing.axis.clone(), format!("{current} else {}", row.key))]].concat();
            variant(description, &more, registry).is_ok_and(|variant| select(&variant, target, request).is_ok())
        });
        // The one that provides most of what the first choice does: the others may lose what it keeps.
        let first = current.split(" else ").next().and_then(|key| registry.row(&missing.axis, key));
        let lacking = |row: &&Row| {
            let wanted = first.iter().flat_map(|first| &first.provides);
            wanted.filter(|capability| !row.provides.contains(capability)).count()
        };
        let closest = supported.min_by_key(lacking);
        found.extend(closest.map(|row| (missing.axis.clone(), format!("{current} else {}", row.key))));
    }
    found
}

/// Returns the alternatives that a description has on an axis, as `a else b`.
fn chosen_values(description: &Description, set: &[(String, String)], registry: &Registry, axis: &str) -> String {
    let variant = variant(description, set, registry);
    let chosen = variant.iter().flat_map(|variant| &variant.choices).find(|chosen| chosen.axis == axis);
    let keys = chosen.into_iter().flat_map(|chosen| &chosen.alternatives).map(|selected| selected.row.key.as_str());
    keys.collect::<Vec<_>>().join(" else ")
}

fn draft(description: &Description) -> Result<(Draft, Diagnostics), Diagnostics> {
    match description {
        Description::Technique(key) => {
            let span = SourceSpan::new(key.as_str(), 1, 1).with_length(key.chars().count() as u32);
            Ok((Draft::from_technique(key, &span), Diagnostics::new()))
        }
        Description::Text { file, text } => {
            let parsed = parse(text, file);
            parsed.draft.map(|draft| (draft, parsed.diagnostics.clone())).ok_or(parsed.diagnostics)
        }
    }
}

/// The source name of `defaults` in messages.
const DEFAULTS: &str = "chosen by the command";

/// Applies `set`, then `defaults`.
fn change(
    draft: &mut Draft,
    set: &[(String, String)],
    defaults: &[(&str, &str)],
    registry: &Registry,
    diagnostics: &mut Diagnostics,
) {
    let length = |name: &str, value: &str| name.chars().count() as u32 + 1 + value.chars().count() as u32;
    for (line, (name, value)) in (1..).zip(set) {
        let span = SourceSpan::new(SET, line, 1).with_length(length(name, value));
        match choice_with_options(name, value, &span, registry) {
            Some(Ok(choice)) => draft.choose(choice),
            Some(Err(errors)) => diagnostics.extend(errors),
            None => {
                if let Err(error) = draft.set(name, value, &span) {
                    diagnostics.push(*error);
                }
            }
        }
    }
    for (line, (name, value)) in (1..).zip(defaults) {
        let is_chosen = match name.split_once('.') {
            Some(("fragment", _)) => !draft.attributes.is_empty(),
            _ => draft.choices.iter().any(|choice| choice.axis.value == *name),
        };
        if !is_chosen {
            // A choice on an axis accepts any text here; `check` validates it.
            let _ = draft.set(name, value, &SourceSpan::new(DEFAULTS, line, 1).with_length(length(name, value)));
        }
    }
}

/// Returns the choice of a change whose value has options or names a user file. `None`: it is a name, or no choice on an axis.
fn choice_with_options(
    name: &str,
    value: &str,
    span: &SourceSpan,
    registry: &Registry,
) -> Option<Result<Choice, Diagnostics>> {
    let is_axis = registry.axis(name).is_some_and(|axis| axis.chosen);
    let has_more = value.contains(['{', '(', '"']) || value.contains(".wgsl");
    if !is_axis || !has_more {
        return None;
    }
    let axis = Spanned::new(name.to_owned(), span.clone().with_length(name.chars().count() as u32));
    let start = SourceSpan::new(SET, span.line, name.chars().count() as u32 + 2);
    Some(fragbuf_syntax::choice(&axis, value, &start))
}

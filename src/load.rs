//! A technique's key or a description's text, with changes from outside and the files that it names, becomes a variant.

use std::path::Path;

use fragbuf_model::{Diagnostic, Diagnostics, Draft, Origin, Variant, codes};
use fragbuf_syntax::{Parsed, parse};
use fragbuf_templates::Registry;

use crate::own;

/// A description to load.
#[derive(Clone, Debug)]
pub enum Description {
    /// A technique of the registry.
    Technique(String),
    /// A file's name, as messages give it, and its text. Files that it names lie beside it.
    Text {
        /// The name.
        file: String,
        /// The text.
        text: String,
    },
}

impl Description {
    /// The file at `path`, which messages call by this path.
    pub fn read(path: &Path) -> std::io::Result<Self> {
        Ok(Description::Text { file: path.display().to_string(), text: std::fs::read_to_string(path)? })
    }

    /// What messages call it.
    pub fn name(&self) -> &str {
        match self {
            Description::Technique(key) => key,
            Description::Text { file, .. } => file,
        }
    }
}

/// A description and what it led to.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The variant, or everything that is wrong.
    pub variant: Result<Variant, Diagnostics>,
    /// Every text that was read, by its name in messages; the description's is the first.
    pub sources: Vec<(String, String)>,
    /// The changes as texts with a line for each, by their names in messages. They are no files.
    pub changes: Vec<(String, String)>,
}

impl Loaded {
    /// Every text that messages may point to, by its name there.
    pub fn texts(&self) -> Vec<(String, String)> {
        self.sources.iter().chain(&self.changes).cloned().collect()
    }
}

/// Checks a description after the changes `set`, each a name and a value as in `--set name=value`, and with the choices
/// `unless_said` on axes of which neither the description nor `set` says anything. The files that it names are read.
pub fn load(
    description: &Description,
    set: &[(String, String)],
    unless_said: &[(&str, &str)],
    registry: &Registry,
) -> Loaded {
    let text = match description {
        Description::Technique(key) => key,
        Description::Text { text, .. } => text,
    };
    let mut sources = vec![(description.name().to_owned(), text.clone())];
    let variant = drafted(description).and_then(|(mut draft, mut diagnostics)| {
        change(&mut draft, set, unless_said, &mut diagnostics);
        let own = own::read(&draft, registry);
        sources.extend(own.sources);
        if !own.diagnostics.is_empty() {
            // Without its row nothing is known of what a choice offers: every fact would look unmet.
            diagnostics.extend(own.diagnostics);
            return Err(diagnostics);
        }
        Parsed { draft: Some(draft), diagnostics }.check(&own.registry)
    });
    let lines = |changes: &mut dyn Iterator<Item = (&str, &str)>| -> String {
        changes.map(|(name, value)| format!("{name}={value}\n")).collect()
    };
    let set = lines(&mut set.iter().map(|(name, value)| (name.as_str(), value.as_str())));
    let changes = vec![(SET.to_owned(), set), (UNLESS_SAID.to_owned(), lines(&mut unless_said.iter().copied()))];
    Loaded { variant, sources, changes }
}

/// The variant alone, after the changes `set`.
pub fn variant(
    description: &Description,
    set: &[(String, String)],
    registry: &Registry,
) -> Result<Variant, Diagnostics> {
    load(description, set, &[], registry).variant
}

fn drafted(description: &Description) -> Result<(Draft, Diagnostics), Diagnostics> {
    match description {
        Description::Technique(key) => {
            Ok((Draft::from_technique(key, &Origin::new(key.as_str(), 1, 1)), Diagnostics::new()))
        }
        Description::Text { file, text } => {
            let parsed = parse(text, file);
            parsed.draft.map(|draft| (draft, parsed.diagnostics.clone())).ok_or(parsed.diagnostics)
        }
    }
}

/// What stands for a file where a change from outside is at fault: a line for each.
const SET: &str = "--set";

/// The same for what a command chooses where nobody does.
const UNLESS_SAID: &str = "chosen by the command";

fn change(draft: &mut Draft, set: &[(String, String)], unless_said: &[(&str, &str)], diagnostics: &mut Diagnostics) {
    let whole = |name: &str, value: &str| name.chars().count() as u32 + 1 + value.chars().count() as u32;
    for (line, (name, value)) in (1..).zip(set) {
        let origin = Origin::new(SET, line, 1).with_length(whole(name, value));
        if let Err(wanted) = draft.set(name, value, &origin) {
            diagnostics.push(Diagnostic::new(
                codes::BAD_OPTION,
                &origin,
                format!("`{value}` is no value for `{name}`"),
                format!("give {wanted}"),
            ));
        }
    }
    for (line, (name, value)) in (1..).zip(unless_said) {
        let said = match name.split_once('.') {
            Some(("fragment", _)) => !draft.attributes.is_empty(),
            _ => draft.choices.iter().any(|choice| choice.axis.value == *name),
        };
        if !said {
            // A choice on an axis takes any text; the rules judge it.
            let _ = draft.set(name, value, &Origin::new(UNLESS_SAID, line, 1).with_length(whole(name, value)));
        }
    }
}

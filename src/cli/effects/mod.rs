//! Effects: descriptions of `examples/effects` that `render --effect` draws with their default arguments.
//!
//! Input: the words of a command line. Output: the same with the arguments of the effect that the command line does not give. A new effect is
//! a file of `examples/effects` and a row in `rows.rs`.

mod missing;
mod rows;

use std::ffi::OsString;

use fragbuf_model::nearest_name;

pub(crate) use missing::MissingFragments;
pub(crate) use rows::EFFECTS;

/// An effect.
#[derive(Debug)]
pub(crate) struct Effect {
    pub(crate) name: &'static str,
    pub(crate) summary: &'static str,
    /// The paper and its section.
    pub(crate) source: &'static str,
    /// The path of its description, relative to the repository.
    pub(crate) path: &'static str,
    /// The description.
    pub(crate) text: &'static str,
    /// The nearest fragments of a pixel that the effect reads; `None`: all.
    pub(crate) reads: Option<u32>,
    /// The arguments of `render`, each an option and its value.
    pub(crate) arguments: &'static [(&'static str, &'static str)],
}

/// The option that names an effect.
const OPTION: &str = "--effect";

/// The options that a command may have several times. Of equal names, the last value counts.
const REPEATED: [&str; 4] = ["--set", "--uniform", "--attribute", "--texture"];

/// Finds an effect by its name.
pub(crate) fn parse(name: &str) -> Result<&'static Effect, String> {
    let found = EFFECTS.iter().find(|effect| effect.name == name);
    found.ok_or_else(|| {
        let names: Vec<&str> = EFFECTS.iter().map(|effect| effect.name).collect();
        let nearest = nearest_name(name, &names);
        let nearest = nearest.map_or(String::new(), |nearest| format!("did you mean `{nearest}`? "));
        format!("{nearest}effects are {}", names.join(", "))
    })
}

/// Adds the arguments of the effect that a command line names, before those that it gives. Other command lines do not change.
pub(crate) fn with_arguments(mut words: Vec<OsString>) -> Vec<OsString> {
    let Some(at) = words.iter().position(|word| word == OPTION || is_value_of(word, OPTION)) else { return words };
    let word = words.get(at).and_then(|word| word.to_str()).unwrap_or_default();
    let name = match word.split_once('=') {
        Some((_, name)) => name,
        None => words.get(at + 1).and_then(|word| word.to_str()).unwrap_or_default(),
    };
    let Ok(effect) = parse(name) else { return words };
    let is_given = |option: &str| words.iter().any(|word| word == option || is_value_of(word, option));
    let missing = effect.arguments.iter().filter(|(option, _)| REPEATED.contains(option) || !is_given(option));
    let added: Vec<OsString> = missing.map(|(option, value)| OsString::from(format!("{option}={value}"))).collect();
    words.splice(at..at, added);
    words
}

/// Whether a word is an option with its value behind `=`.
fn is_value_of(word: &OsString, option: &str) -> bool {
    word.to_str().and_then(|word| word.strip_prefix(option)).is_some_and(|rest| rest.starts_with('='))
}

#[cfg(feature = "playground")]
impl Effect {
    /// Returns the caption of its picture: its name and what it shows.
    pub(crate) fn caption(&self) -> String {
        let name = self.name.replace('_', " ");
        let (first, rest) = name.split_at(1);
        format!("{}{rest}: {}", first.to_uppercase(), self.summary)
    }
}

/// Returns the table of effects as Markdown.
pub(crate) fn markdown() -> String {
    let row = |effect: &Effect| {
        let arguments: Vec<String> =
            effect.arguments.iter().map(|(option, value)| format!("{option} {value}")).collect();
        format!("| `{}` | {} | {} | `{}` |\n", effect.name, effect.summary, effect.source, arguments.join(" "))
    };
    let rows: String = EFFECTS.iter().map(row).collect();
    format!("| effect | | source | arguments, which others replace |\n|---|---|---|---|\n{rows}")
}

/// Returns the list of effects that the help shows.
pub(crate) fn help() -> String {
    let row = |effect: &Effect| format!("  {:18}{}\n", effect.name, effect.summary);
    format!("Effects:\n{}", EFFECTS.iter().map(row).collect::<String>())
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<OsString> {
        text.split_whitespace().map(OsString::from).collect()
    }

    #[test]
    fn given_options_replace_those_of_an_effect() {
        let effect = &EFFECTS[0];
        let (option, value) = effect.arguments.iter().find(|(option, _)| !REPEATED.contains(option)).unwrap();
        let added = format!("{option}={value}");
        let has = |given: &str| with_arguments(words(given)).iter().any(|word| *word == *added);
        let command = format!("fragbuf render --effect {} --out x.png", effect.name);
        assert!(has(&command) && has(&command.replace("--effect ", "--effect=")));
        assert!(!has(&format!("{command} {option} other")) && !has(&format!("{command} {option}=other")));
        assert!(!has("fragbuf render --effect nothing --out x.png") && !has("fragbuf render ab --out x.png"));
    }

    /// A value that the command line gives follows that of the effect, so that it counts.
    #[test]
    fn given_values_follow_those_of_an_effect() {
        for effect in EFFECTS {
            let given = format!("fragbuf render --effect {} --uniform a=7", effect.name);
            let all = with_arguments(words(&given));
            assert_eq!(all.last(), Some(&OsString::from("a=7")));
            let defaults: Vec<OsString> =
                effect.arguments.iter().map(|(option, value)| format!("{option}={value}").into()).collect();
            assert_eq!(all.get(2..2 + defaults.len()), Some(&defaults[..]), "{}", effect.name);
        }
    }

    #[test]
    fn names_and_files_agree() {
        for effect in EFFECTS {
            assert_eq!(effect.path, format!("examples/effects/{}.fragbuf", effect.name));
            assert!(parse(effect.name).is_ok_and(|found| found.name == effect.name));
        }
        let message = parse("transparancy").unwrap_err();
        assert!(message.contains("did you mean `transparency`?"), "{message}");
    }
}

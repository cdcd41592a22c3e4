//! The pictures of the site, each with the command that draws it.
//!
//! Input: the techniques of the site. Output: commands as a user writes them, and the pictures that they draw. The command that is shown is
//! the one that runs, on the CPU device, so that no picture depends on a driver.

use std::ffi::OsString;

use clap::{Args as _, Command as Parser, FromArgMatches as _};

use super::Entry;
use crate::cli::effects::{EFFECTS, Effect, with_arguments};
use crate::cli::output::Failure;
use crate::cli::playground::example;
use crate::cli::render::Render;

/// The folder of the pictures.
const FOLDER: &str = "pictures";

/// A picture of the gallery.
pub(super) struct Command {
    /// The name of the file, without its extension.
    pub(super) name: String,
    /// What it shows.
    pub(super) caption: String,
    /// The whole command.
    pub(super) text: String,
    /// The technique whose picture it is; `None`: it is a larger scene.
    pub(super) technique: Option<String>,
}

/// A picture of a larger scene: name, caption and the command without its output.
type Scene = (&'static str, &'static str, &'static str);

/// Pictures of larger scenes beside those of the effects. The README shows them, too.
const SCENES: &[Scene] = &[
    (
        "glass",
        "Coloured glass: the effect is a closure of eight lines",
        "examples/glass.fragbuf --scene builtin:marbles,n=160 --uniform eye=0.45,0.37,0.81 --size 960x540",
    ),
    (
        "most_visible",
        "A criterion of one line: the eight most visible fragments",
        "examples/most_visible.fragbuf --scene builtin:cubes --uniform far=1 --uniform eye=0.45,0.37,0.81 --size 320x240",
    ),
    ("hairball", "2.16 million triangles; every fragment is kept", "ab_ll --scene builtin:hairball --size 320x240"),
    (
        "needles",
        "40,000 needles, some 100 layers; k = 16",
        "kplus_array --set k=16 --scene builtin:needles --size 320x240",
    ),
    (
        "slabs",
        "24 translucent slabs that intersect",
        "kplus_array --set k=16 --scene builtin:slabs,n=24 --size 320x240",
    ),
    (
        "behind",
        "Glass in front of an opaque scene",
        "kplus_array --scene builtin:marbles --opaque builtin:cubes --size 320x240",
    ),
    (
        "races",
        "Races of a k-buffer without synchronisation, with fragments in random order",
        "kb --scene builtin:marbles --size 320x240 --order shuffle:1",
    ),
];

/// Returns the commands: one for each technique, and those of the effects and the larger scenes if `scenes`.
pub(super) fn commands(entries: &[Entry], scenes: bool) -> Vec<Command> {
    let large = |name: &str, caption: &str, arguments: &str| Command {
        name: name.to_owned(),
        caption: caption.to_owned(),
        text: format!("fragbuf render {arguments} --out {name}.png"),
        technique: None,
    };
    let effect = |effect: &Effect| large(effect.name, &effect.caption(), &format!("--effect {}", effect.name));
    let effects = EFFECTS.iter().filter(|_| scenes).map(effect);
    let large = SCENES.iter().filter(|_| scenes).map(|(name, caption, arguments)| large(name, caption, arguments));
    let techniques = entries.iter().map(|Entry { key, title, .. }| Command {
        name: key.clone(),
        caption: (*title).to_owned(),
        text: format!("fragbuf render {key} --scene builtin:marbles --size 320x240 --out {key}.png"),
        technique: Some(key.clone()),
    });
    effects.chain(large).chain(techniques).collect()
}

/// Returns the path of a picture.
pub(super) fn picture(name: &str) -> String {
    format!("{FOLDER}/{name}.png")
}

impl Command {
    /// Returns the path of the picture.
    pub(super) fn path(&self) -> String {
        picture(&self.name)
    }

    /// Draws the picture. Returns it as a PNG.
    pub(super) fn png(&self) -> Result<Vec<u8>, Failure> {
        self.parsed()?.png()
    }

    /// Parses the command. An example is read from this program.
    fn parsed(&self) -> Result<Render, Failure> {
        let words: Vec<&str> = self.text.split_whitespace().skip(1).collect();
        let all = with_arguments(words.iter().map(OsString::from).collect());
        let matches = Render::augment_args(Parser::new("render")).try_get_matches_from(all);
        let render = matches.and_then(|matches| Render::from_arg_matches(&matches));
        let render = render.map_err(|error| Failure::Usage(format!("`{}`: {error}", self.text)))?;
        let file = words.get(1).and_then(|word| word.strip_prefix("examples/")?.strip_suffix(".fragbuf"));
        Ok(match file.and_then(example) {
            Some(text) => render.with_text(text),
            None => render,
        })
    }

    /// Returns the size of the picture.
    pub(super) fn size(&self) -> Result<(u32, u32), Failure> {
        Ok(self.parsed()?.size())
    }
}

#[cfg(test)]
mod tests {
    use super::commands;

    #[test]
    fn every_command_is_one_that_the_program_has() {
        let commands = commands(&[], true);
        assert!(commands.len() >= 6 && commands.iter().all(|command| command.size().is_ok()));
    }
}

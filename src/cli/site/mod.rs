//! `fragbuf site`: static pages for any web host: a gallery, a page per technique, and a player that draws by WebGPU.
//!
//! Input: techniques of the registry. Output: a folder of files that refer to each other by relative paths alone, so that it works under any
//! address. Everything is generated before the first file is written, and the same program writes the same bytes. `variants` generates the
//! passes that the player chooses from, `scenes` the triangles that it draws, `gallery` the pictures, `pages` the text. Nothing here reads
//! from a network, and no file is removed that an earlier run did not write.

mod files;
mod folder;
mod gallery;
mod html;
mod markdown;
mod pages;
mod pieces;
mod player;
mod scenes;
mod variants;

use std::path::PathBuf;

use fragbuf::vocabulary::Technique;
use fragbuf::{Form, Generation, Registry, Request, TARGETS, Target, generate};
use serde_json::{Value, json};

use self::files::Files;
use self::folder::Folder;
use self::scenes::Scenes;
use super::generate::on_all_cores;
use super::input::Input;
use super::list;
use super::output::{self, Failure};
use super::page;
use super::progress::Progress;

#[derive(clap::Args)]
pub(crate) struct Site {
    /// Output folder: a new one, an empty one, or one of an earlier `fragbuf site`, whose files are replaced
    #[arg(long, value_name = "DIR")]
    out: PathBuf,
    /// Techniques of the site. The gallery then has their pictures alone [default: every technique, and larger scenes]
    #[arg(long = "technique", value_name = "KEY", num_args = 1.., value_delimiter = ',')]
    techniques: Vec<String>,
}

/// A technique of the site.
struct Entry {
    key: String,
    title: &'static str,
    /// What `fragbuf list --json` prints.
    facts: Value,
    /// Its page in Markdown.
    page: String,
    /// What the player reads of it.
    player: Value,
}

impl Site {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let registry = Registry::builtin();
        let techniques = self.techniques(&registry)?;
        let folder = Folder::open(&self.out)?;
        let progress = Progress::new();
        let mut files = Files::default();
        progress.set_message("generating variants".to_owned());
        let generated = on_all_cores(&techniques, |technique| Entry::of(technique, &registry));
        let entries = generated.into_iter().collect::<Result<Vec<Entry>, Failure>>()?;
        progress.set_message("generating scenes".to_owned());
        let scenes = Scenes::of(&entries, &mut files)?;
        player::add(&entries, &scenes, &mut files)?;
        let commands = gallery::commands(&entries, self.techniques.is_empty());
        for (number, command) in commands.iter().enumerate() {
            progress.set_message(format!("picture {} of {}: {}", number + 1, commands.len(), command.name));
            files.add(command.path(), command.png()?);
        }
        drop(progress);
        pages::add(&entries, &commands, &registry, &mut files)?;
        folder.write(&files)?;
        let index = self.out.join("index.html");
        output::print(&format!("{}: {} files, {} bytes\n", index.display(), files.count(), files.bytes()))?;
        output::note("a web server must send the folder: browsers load no scripts from files");
        Ok(())
    }

    /// Returns the techniques of the site in the order of the registry.
    fn techniques<'r>(&self, registry: &'r Registry) -> Result<Vec<&'r Technique>, Failure> {
        let known: Vec<&str> = registry.techniques().iter().map(|technique| technique.key.as_str()).collect();
        for key in &self.techniques {
            if registry.technique(key).is_none() {
                return Err(Failure::unknown("technique", key, &known));
            }
        }
        let is_chosen = |key: &String| self.techniques.is_empty() || self.techniques.contains(key);
        Ok(registry.techniques().iter().filter(|technique| is_chosen(&technique.key)).collect())
    }
}

impl Entry {
    /// Generates a technique for every target, and the variants of the player.
    fn of(technique: &Technique, registry: &Registry) -> Result<Self, Failure> {
        let Technique { key, title, paper, summary, .. } = technique;
        let generation = whole(technique, registry)?;
        let player = json!({
            "key": key,
            "title": title,
            "paper": paper,
            "summary": summary,
            "picture": gallery::picture(key),
            "page": format!("techniques/{key}.html"),
        });
        Ok(Entry {
            key: key.clone(),
            title,
            facts: list::facts(technique, &generation),
            page: page::page(&generation, registry),
            player: merged(player, variants::variants(key, registry)),
        })
    }
}

/// Generates a technique for every target.
fn whole(technique: &Technique, registry: &Registry) -> Result<Generation, Failure> {
    let mut input = Input::read(&technique.key, registry)?;
    let variant = input.variant(&[], registry)?;
    let targets: Vec<&'static Target> = TARGETS.iter().collect();
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    generate(&variant, &request, registry).map_err(|errors| input.failure(errors))
}

/// Returns an object with the fields of both.
fn merged(mut first: Value, second: Value) -> Value {
    if let (Value::Object(first), Value::Object(second)) = (&mut first, second) {
        first.extend(second);
    }
    first
}

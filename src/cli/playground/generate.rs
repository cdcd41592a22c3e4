//! Answers the files of a description: those of one target as text, or those of several in an archive.

use std::io::{Cursor, Write as _};

use fragbuf::{File, Form, Generation, Registry, Request, TARGETS, Target, generate, manifest, target};
use fragbuf_codegen::{LineSource, Linking, PassSource, link};
use serde::Deserialize;
use serde_json::{Value, json};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

use super::description::{Folder, NAME, sentence};
use super::problem::Problem;
use crate::cli::targets::names;

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Generate {
    text: String,
    target: String,
    #[serde(default)]
    form: FormName,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Download {
    text: String,
    /// None: every target that supports the description.
    #[serde(default)]
    targets: Vec<String>,
    #[serde(default)]
    form: FormName,
}

#[derive(Clone, Copy, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
enum FormName {
    #[default]
    Program,
    Module,
}

impl FormName {
    fn form(self) -> Form {
        match self {
            FormName::Program => Form::Program,
            FormName::Module => Form::Module,
        }
    }
}

impl Generate {
    /// Returns the manifest and the text of every file, with the origins of its lines if it is the linked WGSL. SPIR-V has no text.
    pub(super) fn answer(&self, folder: &Folder) -> Result<Value, Problem> {
        let targets = [found(&self.target)?];
        let generation = generation(folder, &self.text, &targets, self.form)?;
        if let Some((target, missing)) = generation.unsupported.first() {
            return Err(Problem::input(format!(
                "the target `{}` does not support this description: {missing}",
                target.name
            )));
        }
        let sources = linked(&generation, targets[0]);
        let file = |file: &File| {
            let text = std::str::from_utf8(&file.bytes).ok().filter(|text| !text.contains('\0'));
            let source = sources.iter().find(|source| source.text.as_bytes() == file.bytes);
            let (lines, templates) = source.map(origins).unwrap_or_default();
            json!({
                "path": file.path,
                "pass": file.pass,
                "text": text,
                "bytes": file.bytes.len(),
                "lines": lines,
                "templates": templates,
            })
        };
        let files: Vec<Value> = generation.files.iter().map(file).collect();
        Ok(json!({ "manifest": manifest(&generation, 0), "files": files }))
    }
}

impl Download {
    /// Returns a ZIP archive with the manifest and every file.
    pub(super) fn answer(&self, folder: &Folder) -> Result<Vec<u8>, Problem> {
        let targets: Vec<&'static Target> = match self.targets.as_slice() {
            [] => TARGETS.iter().collect(),
            names => names.iter().map(|name| found(name)).collect::<Result<_, _>>()?,
        };
        let generation = generation(folder, &self.text, &targets, self.form)?;
        if generation.files.is_empty() {
            return Err(Problem::input("none of these targets supports the description: choose another target"));
        }
        let manifest = format!("{:#}\n", manifest(&generation, 0));
        let whole = [("manifest.json", manifest.as_bytes()), (NAME, self.text.as_bytes())];
        let files = generation.files.iter().map(|file| (file.path.as_str(), file.bytes.as_slice()));
        archive(whole.into_iter().chain(files)).map_err(|error| Problem::server(format!("the archive: {error}")))
    }
}

/// Returns the passes of a target as they were linked. Printers of other languages keep no origins, so that the files differ from them.
fn linked(generation: &Generation, target: &Target) -> Vec<PassSource> {
    let Some(planned) = generation.plans.first() else { return Vec::new() };
    let linking = Linking { profile: target.profile, form: generation.form, prefix: String::new(), group: 0 };
    link(&planned.plan, &linking, &Registry::builtin()).map_or(Vec::new(), |program| program.passes)
}

/// Returns for every line the line of the description, and the place in a template, that it comes from; null for none.
fn origins(source: &PassSource) -> (Vec<Option<u32>>, Vec<Option<String>>) {
    let origin = |line: usize| match source.lines.source(line) {
        LineSource::Description(span) => (Some(span.line), None),
        LineSource::Source { name, line } => (None, Some(format!("{name}:{line}"))),
        _ => (None, None),
    };
    (1..=source.text.lines().count()).map(origin).unzip()
}

/// Returns the target of this name.
pub(super) fn found(name: &str) -> Result<&'static Target, Problem> {
    target(name).ok_or_else(|| Problem::request(format!("no target `{name}`: give one of {}", names().join(", "))))
}

fn generation(folder: &Folder, text: &str, targets: &[&'static Target], form: FormName) -> Result<Generation, Problem> {
    let registry = Registry::builtin();
    let variant = folder.variant(text, &registry)?;
    let request = Request { targets, form: form.form(), prefix: "", group: 0 };
    generate(&variant, &request, &registry).map_err(|errors| Problem::input(sentence(&errors)))
}

fn archive<'a>(files: impl Iterator<Item = (&'a str, &'a [u8])>) -> zip::result::ZipResult<Vec<u8>> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    // The time of a file is that of the format's epoch: equal descriptions give equal archives.
    let options = SimpleFileOptions::default();
    for (path, bytes) in files {
        writer.start_file(path, options)?;
        writer.write_all(bytes)?;
    }
    Ok(writer.finish()?.into_inner())
}

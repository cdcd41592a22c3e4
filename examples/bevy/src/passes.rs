//! Generates the passes of a description in portable WGSL.
//!
//! Input: the text of a description. Output: the manifest, the text of each file, and the attributes of a fragment. Nothing here needs a
//! device.

use std::collections::BTreeMap;

use fragbuf_codegen::{Form, Plan};
use fragbuf_follow::Error;
use fragbuf_model::Variant;
use fragbuf_targets::{Request, generate, manifest, target};
use fragbuf_templates::Registry;

/// The target whose files Bevy runs.
pub const TARGET: &str = "wgsl";

/// What goes before the names of passes in module form, and `_`.
pub const PREFIX: &str = "fragbuf";

/// The bind group of passes in module form. Bevy has the groups 0 to 2 for views and meshes; that of the material comes behind it.
pub const GROUP: u32 = 3;

/// Generated passes.
#[derive(Debug)]
pub struct Passes {
    /// The name of the buffer.
    pub name: String,
    /// The text of `manifest.json`.
    pub manifest: String,
    /// The attributes of a fragment, in the order of the members of `Fragment`.
    pub attributes: Vec<Attribute>,
    files: BTreeMap<String, String>,
    plan: Option<Plan>,
}

/// A member of `Fragment`.
#[derive(Clone, Debug)]
pub struct Attribute {
    /// Its name.
    pub name: String,
    /// Its type in WGSL.
    pub kind: String,
    /// The built-in value of WGSL that it has; `None`: the material computes it.
    pub built_in: Option<String>,
}

impl Passes {
    /// Generates programs, which draw vertices with the attributes of the description.
    pub fn program(description: &str) -> Result<Self, Error> {
        Self::of(&checked(description)?, Form::Program)
    }

    /// Generates functions that materials call.
    pub fn module(description: &str) -> Result<Self, Error> {
        Self::of(&checked(description)?, Form::Module)
    }

    /// Generates the passes of a checked description.
    pub fn of(variant: &Variant, form: Form) -> Result<Self, Error> {
        let (prefix, group) = if form == Form::Module { (PREFIX, GROUP) } else { ("", 0) };
        let targets: Vec<_> = target(TARGET).into_iter().collect();
        let request = Request { targets: &targets, form, prefix, group };
        let generation =
            generate(variant, &request, &Registry::builtin()).map_err(|errors| Error(errors.to_string()))?;
        if let Some((target, missing)) = generation.unsupported.first() {
            return Err(Error(format!("the target `{}` does not have these passes: {missing}", target.name)));
        }
        let rows = generation.plans.iter().flat_map(|planned| &planned.plan.selection.rows);
        let implicit = rows.flat_map(|selected| &selected.row.extra_words);
        let given = variant.attributes.iter().map(|attribute| {
            let kind = attribute.format.value.wgsl_type().to_owned();
            Attribute { name: attribute.name.value.clone(), kind, built_in: None }
        });
        let implicit = implicit.map(|word| {
            let built_in = Some(word.built_in.to_string());
            Attribute { name: word.name.to_string(), kind: "u32".to_owned(), built_in }
        });
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        Ok(Passes {
            name: variant.name.value.clone(),
            manifest: manifest(&generation, group).to_string(),
            attributes: given.chain(implicit).collect(),
            plan: generation.plans.first().map(|planned| planned.plan.clone()),
            files: generation.files.iter().map(|file| (file.path.clone(), text(&file.bytes))).collect(),
        })
    }

    /// The plan that the files implement, if the target has them.
    pub fn plan(&self) -> Option<&Plan> {
        self.plan.as_ref()
    }

    /// Returns the text of a file that the manifest names.
    pub fn file(&self, path: &str) -> Result<&str, Error> {
        self.files.get(path).map(String::as_str).ok_or_else(|| Error(format!("{path}: there is no such file")))
    }
}

fn checked(description: &str) -> Result<Variant, Error> {
    let parsed = fragbuf_syntax::parse(description, "the description");
    parsed.check(&Registry::builtin()).map_err(|errors| Error(errors.to_string()))
}

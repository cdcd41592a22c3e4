//! naga reads and validates a linked text. What it refuses in a user's closure is reported at the user's line; what it
//! refuses elsewhere is a defect of ours and says so, with the template's line.

use fragbuf_codegen::{LineOrigin, PassText, Profile};
use fragbuf_model::{Diagnostic, Diagnostics, Origin, codes};
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

/// A pass that naga took. Made by [`check`] only.
#[derive(Clone, Debug)]
pub struct Checked {
    pass: PassText,
    module: naga::Module,
    info: ModuleInfo,
}

impl Checked {
    /// The text.
    pub fn pass(&self) -> &PassText {
        &self.pass
    }

    /// What naga made of it.
    pub fn module(&self) -> &naga::Module {
        &self.module
    }

    /// naga's proof.
    pub fn info(&self) -> &ModuleInfo {
        &self.info
    }
}

/// What naga may accept in a text of this profile.
pub(crate) fn capabilities(profile: Profile) -> Capabilities {
    match profile {
        Profile::Portable => Capabilities::empty(),
        Profile::Native => Capabilities::MEMORY_DECORATION_COHERENT,
    }
}

/// Checks one pass; `description` is the place to name when no line of the user's is at fault.
pub fn check(pass: PassText, profile: Profile, description: &Origin) -> Result<Checked, Diagnostics> {
    let capabilities = capabilities(profile);
    let mut frontend = naga::front::wgsl::Frontend::new_with_options(naga::front::wgsl::Options {
        parse_doc_comments: true,
        capabilities,
    });
    let module = frontend.parse(&pass.text).map_err(|error| {
        let line = error.location(&pass.text).map(|location| location.line_number as usize);
        refused(&pass, line, error.message(), description)
    })?;
    let info = Validator::new(ValidationFlags::all(), capabilities).validate(&module).map_err(|error| {
        let line = error.location(&pass.text).map(|location| location.line_number as usize);
        refused(&pass, line, &chain(error.as_inner()), description)
    })?;
    Ok(Checked { pass, module, info })
}

fn refused(pass: &PassText, line: Option<usize>, message: &str, description: &Origin) -> Diagnostics {
    let (origin, place) = match line.map(|line| (line, pass.lines.origin(line))) {
        Some((_, LineOrigin::User(origin))) => (origin, "this line".to_owned()),
        Some((_, LineOrigin::Source { name, line })) => (description.clone(), format!("{name}:{line}")),
        Some((line, LineOrigin::None)) => (description.clone(), format!("line {line}")),
        None => (description.clone(), "the generated text".to_owned()),
    };
    let message = format!("naga refuses {place} of pass `{}`: {message}", pass.anchor);
    let hint = "this is a defect of fragbuf: report it with the description; `show --dump wgsl` prints the text";
    Diagnostic::new(codes::INTERNAL, &origin, message, hint).into()
}

/// An error and all that caused it, on one line.
fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        text.push_str(": ");
        text.push_str(&error.to_string());
        cause = error.source();
    }
    text
}

//! naga reads and validates a linked text. What it refuses in a user's own file is the user's mistake, at the user's line
//! and column. What it refuses elsewhere is a defect of ours and says so: in a closure with the user's line, in a template
//! with the template's.

use fragbuf_codegen::{LineOrigin, PassText, Profile};
use fragbuf_model::{Diagnostic, Diagnostics, Origin, codes};
use naga::SourceLocation;
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
        Profile::Native => {
            Capabilities::MEMORY_DECORATION_COHERENT
                | Capabilities::PRIMITIVE_INDEX
                | Capabilities::SHADER_INT64
                | Capabilities::SHADER_INT64_ATOMIC_MIN_MAX
                | Capabilities::SHADER_INT64_ATOMIC_ALL_OPS
                | Capabilities::EARLY_DEPTH_TEST
        }
    }
}

/// Checks one pass; `description` is the place to name when no line of the user's is at fault.
pub fn check(pass: PassText, profile: Profile, description: &Origin) -> Result<Checked, Diagnostics> {
    let capabilities = capabilities(profile);
    let mut frontend = naga::front::wgsl::Frontend::new_with_options(naga::front::wgsl::Options {
        parse_doc_comments: true,
        capabilities,
    });
    let module = frontend
        .parse(&pass.text)
        .map_err(|error| refused(&pass, error.location(&pass.text), error.message(), description))?;
    let info = Validator::new(ValidationFlags::all(), capabilities)
        .validate(&module)
        .map_err(|error| refused(&pass, error.location(&pass.text), &chain(error.as_inner()), description))?;
    Ok(Checked { pass, module, info })
}

fn refused(pass: &PassText, location: Option<SourceLocation>, message: &str, description: &Origin) -> Diagnostics {
    let line = location.map(|location| location.line_number as usize);
    let (origin, place) = match line.map(|line| (line, pass.lines.origin(line))) {
        Some((_, LineOrigin::Own(line))) => return refused_own(pass, location, message, &line),
        Some((_, LineOrigin::User(origin))) => (origin, "this line".to_owned()),
        Some((_, LineOrigin::Source { name, line })) => (description.clone(), format!("{name}:{line}")),
        Some((line, LineOrigin::None)) => (description.clone(), format!("line {line}")),
        None => (description.clone(), "the generated text".to_owned()),
    };
    let message = format!("naga refuses {place} of pass `{}`: {message}", pass.anchor);
    let hint = "this is a defect of fragbuf: report it with the description; `show --dump wgsl` prints the text";
    Diagnostic::new(codes::INTERNAL, &origin, message, hint).into()
}

/// A mistake in a file of the user's own. The same line of several passes is one mistake, so the pass is not named.
fn refused_own(pass: &PassText, location: Option<SourceLocation>, message: &str, line: &Origin) -> Diagnostics {
    let origin = location.and_then(|location| narrowed(pass, location, line)).unwrap_or_else(|| line.clone());
    let hint = "in scope are the file's own names, the contracts' functions, and the accessors of the row's buffers: \
                `x_load`, `x_store` where a pass writes, `x_atomic_…` where it says `x atomic`";
    Diagnostic::new(codes::REFUSED, &origin, message, hint).into()
}

/// naga's place inside a line of the user's. `None` where renaming has changed the line's length.
fn narrowed(pass: &PassText, location: SourceLocation, line: &Origin) -> Option<Origin> {
    let text = pass.text.lines().nth(location.line_number.checked_sub(1)? as usize)?;
    let indent = text.chars().count() - text.trim_start().chars().count();
    let is_same = indent as u32 + 1 == line.column && text.trim().chars().count() == line.length as usize;
    let before = text.get(..location.line_position.checked_sub(1)? as usize)?.chars().count() as u32;
    let most = (line.column + line.length).checked_sub(before + 1)?;
    let origin = Origin::new(line.file.clone(), line.line, before + 1).with_length(location.length.min(most));
    is_same.then_some(origin)
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

//! Parses and validates linked WGSL with naga. An error in a user file is the user's, at the user's line and column. An error
//! elsewhere is a defect of fragbuf and is reported as one: in a closure with the user's line, in a template with the template's.

use fragbuf_codegen::{LineSource, PassSource, Profile};
use fragbuf_model::{Diagnostic, Diagnostics, SourceSpan, codes};
use naga::SourceLocation;
use naga::valid::{Capabilities, ModuleInfo, ValidationFlags, Validator};

use crate::Workgroup;
use crate::user_file_error::user_file_error;

/// A pass that naga accepts. Only [`check`] constructs it.
#[derive(Clone, Debug)]
pub struct Checked {
    pass: PassSource,
    module: naga::Module,
    info: ModuleInfo,
}

impl Checked {
    /// Returns the WGSL source.
    pub fn pass(&self) -> &PassSource {
        &self.pass
    }

    /// Returns naga's module.
    pub fn module(&self) -> &naga::Module {
        &self.module
    }

    /// Returns naga's result of validation.
    pub fn info(&self) -> &ModuleInfo {
        &self.info
    }

    /// Returns the workgroup of its compute shader.
    pub fn workgroup(&self) -> Option<Workgroup> {
        let is_compute = |entry: &&naga::EntryPoint| entry.stage == naga::ShaderStage::Compute;
        let entry = self.module.entry_points.iter().find(is_compute)?;
        let shared =
            self.module.global_variables.iter().filter(|(_, global)| global.space == naga::AddressSpace::WorkGroup);
        // Each variable may be aligned to 16 bytes.
        let bytes = shared.map(|(_, global)| self.module.types[global.ty].inner.size(self.module.to_ctx()));
        let bytes = bytes.map(|bytes| bytes.next_multiple_of(16)).sum();
        Some(Workgroup { size: entry.workgroup_size, bytes })
    }
}

/// Returns the naga capabilities that sources of this profile may use.
pub(crate) fn capabilities(profile: Profile) -> Capabilities {
    // pack2x16float and its kin belong to WGSL without extensions; naga has a capability for them.
    let portable = Capabilities::SHADER_FLOAT16_IN_FLOAT32;
    match profile {
        Profile::Portable => portable,
        Profile::Native => {
            portable
                | Capabilities::MEMORY_DECORATION_COHERENT
                | Capabilities::PRIMITIVE_INDEX
                | Capabilities::SHADER_INT64
                | Capabilities::SHADER_INT64_ATOMIC_MIN_MAX
                | Capabilities::SHADER_INT64_ATOMIC_ALL_OPS
                | Capabilities::EARLY_DEPTH_TEST
        }
    }
}

/// Checks one pass. Errors that are at no line of the user's are reported at `description`.
pub fn check(pass: PassSource, profile: Profile, description: &SourceSpan) -> Result<Checked, Diagnostics> {
    match validate(&pass.text, profile) {
        Ok((module, info)) => Ok(Checked { pass, module, info }),
        Err(Rejection { location, message }) => Err(error_at(&pass, location, &message, description)),
    }
}

/// Why naga rejects a source.
#[derive(Clone, Debug)]
pub struct Rejection {
    /// The place in the source, if naga gives one.
    pub location: Option<SourceLocation>,
    /// The error and its causes.
    pub message: String,
}

/// Parses and validates a source with naga.
pub fn validate(text: &str, profile: Profile) -> Result<(naga::Module, ModuleInfo), Rejection> {
    let capabilities = capabilities(profile);
    let options = naga::front::wgsl::Options { parse_doc_comments: true, capabilities };
    let module = naga::front::wgsl::Frontend::new_with_options(options)
        .parse(text)
        .map_err(|error| Rejection { location: error.location(text), message: error.message().to_owned() })?;
    let info = Validator::new(ValidationFlags::all(), capabilities)
        .validate(&module)
        .map_err(|error| Rejection { location: error.location(text), message: causes(error.as_inner()) })?;
    Ok((module, info))
}

fn error_at(
    pass: &PassSource,
    location: Option<SourceLocation>,
    message: &str,
    description: &SourceSpan,
) -> Diagnostics {
    let line = location.map(|location| location.line_number as usize);
    let (span, at) = match line.map(|line| (line, pass.lines.source(line))) {
        Some((_, LineSource::UserFile(line))) => return user_file_error(pass, location, message, &line),
        Some((_, LineSource::Description(span))) => (span, "this line".to_owned()),
        Some((_, LineSource::Source { name, line })) => (description.clone(), format!("{name}:{line}")),
        Some((line, LineSource::None)) => (description.clone(), format!("line {line}")),
        None => (description.clone(), "the generated source".to_owned()),
    };
    let message = format!("naga rejects {at} of pass `{}`: {message}", pass.name);
    let help = "this is a defect of fragbuf: report it with the description; `show --dump wgsl` prints the source";
    Diagnostic::new(codes::INTERNAL, &span, message, help).into()
}

/// Returns an error and its causes on one line.
pub fn causes(error: &dyn std::error::Error) -> String {
    let causes = std::iter::successors(error.source(), |cause| cause.source());
    causes.fold(error.to_string(), |text, cause| format!("{text}: {cause}"))
}

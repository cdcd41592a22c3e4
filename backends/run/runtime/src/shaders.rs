//! The code of every pass of one plan, in a form that wgpu accepts: linked WGSL, or SPIR-V that is passed through.
//!
//! Input: a linked program, or the files of one target. Output: modules by pass and stage, and the features that they need. This
//! module compiles nothing.

use fragbuf_codegen::{EntryPoint, Linking, Plan, Profile, Program, Stage};
use fragbuf_targets::{Generation, TARGETS, target};
use fragbuf_templates::vocabulary::{Access, Feature};

use crate::samples::sample_count;
use crate::unsupported::check;
use crate::words::from_bytes;
use crate::{Error, Interlock, ModuleFunction};

/// The code of one plan.
#[derive(Clone, Debug)]
pub struct Shaders {
    /// The plan that the code implements.
    pub plan: Plan,
    /// The bind group of all declarations.
    pub group: u32,
    /// The language features that the code may use.
    pub profile: Profile,
    /// At least one per pass. In a geometry pass without a module, the caller's draw function sets the pipeline.
    pub modules: Vec<Module>,
    /// The functions of geometry passes in module form, in WGSL.
    pub functions: Vec<ModuleFunction>,
}

/// One shader module.
#[derive(Clone, Debug)]
pub struct Module {
    /// The pass.
    pub pass: String,
    /// Its entry points.
    pub entry_points: Vec<EntryPoint>,
    /// The code.
    pub code: Code,
}

/// A module's code.
#[derive(Clone, Debug)]
pub enum Code {
    /// WGSL, parsed and validated by wgpu.
    Wgsl(String),
    /// SPIR-V words, passed to the driver unchanged. Clip space is as in WGSL: y up, z from 0 to 1.
    SpirV(Vec<u32>),
}

impl Shaders {
    /// Returns the linked WGSL of `plan`.
    pub fn from_program(plan: &Plan, program: &Program) -> Self {
        let (mut modules, mut functions) = (Vec::new(), Vec::new());
        for pass in &program.passes {
            functions.extend(pass.exports.iter().map(|name| function(&pass.name, name, &pass.text)));
            if !pass.entry_points.is_empty() {
                let code = Code::Wgsl(pass.text.clone());
                modules.push(Module { pass: pass.name.clone(), entry_points: pass.entry_points.clone(), code });
            }
        }
        let Linking { group, profile, .. } = program.linking;
        Shaders { plan: plan.clone(), group, profile, modules, functions }
    }

    /// Returns the files of one target, generated with bind group `group`. The target's language must be WGSL or SPIR-V.
    pub fn from_generation(generation: &Generation, target_name: &str, group: u32) -> Result<Self, Error> {
        let not_generated = || {
            let missing = generation.unsupported.iter().find(|(target, _)| target.name == target_name);
            let what = format!("target `{target_name}` of this generation");
            match missing {
                // The form of the generation lacks it: no other target has it.
                Some((_, missing)) if !has_target_with(missing.feature) => {
                    Error::Unsupported { what, help: missing.to_string() }
                }
                Some((_, missing)) => Error::Unsupported { what, help: format!("{missing}; {}", runnable(generation)) },
                None => Error::Unsupported { what, help: format!("it was not requested; {}", runnable(generation)) },
            }
        };
        let planned = generation.plans.iter().find(|planned| planned.targets.iter().any(|t| t.name == target_name));
        let plan = planned.ok_or_else(not_generated)?.plan.clone();
        let profile = target(target_name).ok_or_else(not_generated)?.profile;
        let (mut modules, mut functions) = (Vec::new(), Vec::new());
        for file in generation.files.iter().filter(|file| file.target == target_name) {
            let exports = file.entry_points.iter().filter(|(stage, _)| *stage == "module");
            let source = String::from_utf8_lossy(&file.bytes);
            functions.extend(exports.map(|(_, name)| function(&file.pass, name, &source)));
            let entry_points = file
                .entry_points
                .iter()
                .filter_map(|(stage, name)| stage_of(stage).map(|stage| EntryPoint { name: name.clone(), stage }));
            let entry_points: Vec<EntryPoint> = entry_points.collect();
            if !entry_points.is_empty() {
                let code = code(&file.path, &file.bytes, generation)?;
                modules.push(Module { pass: file.pass.clone(), entry_points, code });
            }
        }
        Ok(Shaders { plan, group, profile, modules, functions })
    }

    /// Returns the features that the device needs for these shaders, for `required_features` of its descriptor. The adapter also
    /// needs `DownlevelFlags::FRAGMENT_WRITABLE_STORAGE`, which is no feature.
    pub fn features(&self) -> wgpu::Features {
        let mut features = wgpu::Features::empty();
        let passed_through = self.modules.iter().any(|module| matches!(module.code, Code::SpirV(_)));
        let passes = &self.plan.passes;
        let coherent = passes
            .iter()
            .any(|pass| pass.uses.iter().any(|usage| matches!(usage.access, Access::Coherent | Access::Hinted)));
        if passed_through {
            features |= wgpu::Features::PASSTHROUGH_SHADERS;
        } else if coherent && self.profile == Profile::Native {
            features |= wgpu::Features::MEMORY_DECORATION_COHERENT;
        }
        for count in passes.iter().filter_map(|pass| sample_count(&self.plan, pass).ok()) {
            // Every device supports 1 and 4 samples.
            if count != 1 && count != 4 {
                features |= wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES;
            }
        }
        for feature in &self.plan.requires {
            features |= match feature {
                Feature::U64Atomics => wgpu::Features::SHADER_INT64 | wgpu::Features::SHADER_INT64_ATOMIC_ALL_OPS,
                Feature::EarlyDepth => wgpu::Features::SHADER_EARLY_DEPTH_TEST,
                _ => wgpu::Features::empty(),
            };
        }
        features
    }

    /// Checks that the runtime supports the plan on some device. An error names the unsupported step or resource.
    pub fn check(&self) -> Result<(), Error> {
        check(&self.plan)
    }

    /// Checks that a device with or without interlock can run these shaders. wgpu has no feature for interlock.
    pub fn check_interlock(&self, device: Interlock) -> Result<(), Error> {
        if device == Interlock::Absent && self.plan.requires.contains(&Feature::Interlock) {
            return Err(Error::Unsupported {
                what: "fragment shader interlock on a device that was created without it".to_owned(),
                help: "create the device with `headless::open_device` if the driver has \
                       `VK_EXT_fragment_shader_interlock` and set `Settings::interlock`, or write \
                       `sync: interlock else spin_lock`"
                    .to_owned(),
            });
        }
        Ok(())
    }

    /// Whether the code contains user functions, from the description or from user files. They run with wgpu's runtime checks.
    pub(crate) fn has_user_functions(&self) -> bool {
        let variant = &self.plan.variant;
        let closures = variant.criterion.is_some() || variant.resolve.is_some() || !variant.constraints.is_empty();
        closures || !variant.helpers.is_empty() || self.plan.selection.user_files().next().is_some()
    }
}

fn function(pass: &str, name: &str, source: &str) -> ModuleFunction {
    ModuleFunction { pass: pass.to_owned(), name: name.to_owned(), source: source.to_owned() }
}

fn stage_of(name: &str) -> Option<Stage> {
    match name {
        "vertex" => Some(Stage::Vertex),
        "fragment" => Some(Stage::Fragment),
        "compute" => Some(Stage::Compute),
        _ => None,
    }
}

/// Whether a target has a feature by itself.
fn has_target_with(feature: Feature) -> bool {
    TARGETS.iter().any(|target| target.provides.contains(&feature))
}

/// Returns which targets of a generation the runtime can run.
fn runnable(generation: &Generation) -> String {
    let is_run = |name: &str| {
        let of_target = |path: &str| path.ends_with(".wgsl") || path.ends_with(".spv");
        generation.files.iter().any(|file| file.target == name && of_target(&file.path))
    };
    let planned = generation.plans.iter().flat_map(|planned| &planned.targets);
    let names: Vec<String> =
        planned.filter(|target| is_run(target.name)).map(|target| format!("`{}`", target.name)).collect();
    match names.as_slice() {
        [] => "generate `wgsl`, `wgsl-native` or `spirv`, which wgpu accepts".to_owned(),
        names => format!("the runtime can run {} of it", names.join(", ")),
    }
}

fn code(path: &str, bytes: &[u8], generation: &Generation) -> Result<Code, Error> {
    let source = std::str::from_utf8(bytes);
    match (path.rsplit('.').next(), source) {
        (Some("wgsl"), Ok(source)) => Ok(Code::Wgsl(source.to_owned())),
        (Some("spv"), _) => Ok(Code::SpirV(from_bytes(bytes))),
        _ => Err(Error::Unsupported {
            what: format!("`{path}`"),
            help: format!(
                "wgpu accepts WGSL and SPIR-V: {}, or compile GLSL to SPIR-V and fill in `Shaders::modules`",
                runnable(generation)
            ),
        }),
    }
}

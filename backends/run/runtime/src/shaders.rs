//! The code of every pass of one plan, in a form that wgpu takes: linked WGSL, or SPIR-V that is passed through.
//!
//! In: a linked program, or the files of one target. Out: modules by pass and stage, and the features that they need.
//! Nothing is compiled here.

use fragbuf_targets::{Generation, target};
use fragbuf_codegen::{EntryPoint, Plan, Profile, Program, Stage};
use fragbuf_templates::vocabulary::{Access, Capability};

use crate::fixed_function::sample_count;
use crate::refusals::check;
use crate::words::from_bytes;
use crate::{Error, Interlock};

/// The code of one plan.
#[derive(Clone, Debug)]
pub struct Shaders {
    /// What the code does.
    pub plan: Plan,
    /// The bind group that everything is declared in.
    pub group: u32,
    /// What the code may use.
    pub profile: Profile,
    /// At least one per pass. A geometry pass without any is the caller's: its draw function sets the pipeline.
    pub modules: Vec<Module>,
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
    /// SPIR-V words, given to the driver as they are. Clip space is WGSL's: y up, z from 0 to 1.
    SpirV(Vec<u32>),
}

impl Shaders {
    /// The WGSL of `plan`, linked.
    pub fn from_program(plan: &Plan, program: &Program) -> Self {
        let modules = program.passes.iter().map(|pass| Module {
            pass: pass.anchor.clone(),
            entry_points: pass.entry_points.clone(),
            code: Code::Wgsl(pass.text.clone()),
        });
        Shaders {
            plan: plan.clone(),
            group: program.linking.group,
            profile: program.linking.profile,
            modules: modules.collect(),
        }
    }

    /// The files of one target, generated with bind group `group`. Targets in WGSL and SPIR-V can be run.
    pub fn from_generation(generation: &Generation, target_name: &str, group: u32) -> Result<Self, Error> {
        let not_generated = || Error::Unsupported {
            what: format!("target `{target_name}` of this generation"),
            hint: "it was not asked for, or refused: see `refusals`".to_owned(),
        };
        let planned = generation.plans.iter().find(|planned| planned.targets.iter().any(|t| t.name == target_name));
        let plan = planned.ok_or_else(not_generated)?.plan.clone();
        let profile = target(target_name).ok_or_else(not_generated)?.profile;
        let mut modules = Vec::new();
        for file in generation.files.iter().filter(|file| file.target == target_name) {
            let entry_points = file
                .entry_points
                .iter()
                .filter_map(|(stage, name)| stage_of(stage).map(|stage| EntryPoint { name: name.clone(), stage }));
            let entry_points: Vec<EntryPoint> = entry_points.collect();
            if !entry_points.is_empty() {
                modules.push(Module { pass: file.pass.clone(), entry_points, code: code(&file.path, &file.bytes)? });
            }
        }
        Ok(Shaders { plan, group, profile, modules })
    }

    /// What the device must have for these shaders. Storage written by fragment shaders is a matter of the adapter:
    /// `DownlevelFlags::FRAGMENT_WRITABLE_STORAGE`.
    pub fn features(&self) -> wgpu::Features {
        let mut features = wgpu::Features::empty();
        let passed_through = self.modules.iter().any(|module| matches!(module.code, Code::SpirV(_)));
        let passes = &self.plan.passes;
        let coherent = passes.iter().any(|pass| pass.uses.iter().any(|usage| usage.access == Access::Coherent));
        if passed_through {
            features |= wgpu::Features::PASSTHROUGH_SHADERS;
        } else if coherent && self.profile == Profile::Native {
            features |= wgpu::Features::MEMORY_DECORATION_COHERENT;
        }
        for count in passes.iter().filter_map(|pass| sample_count(&self.plan, pass).ok()) {
            // One and four are what every device has.
            if count != 1 && count != 4 {
                features |= wgpu::Features::TEXTURE_ADAPTER_SPECIFIC_FORMAT_FEATURES;
            }
        }
        for capability in &self.plan.requires {
            features |= match capability {
                Capability::U64Atomics => wgpu::Features::SHADER_INT64 | wgpu::Features::SHADER_INT64_ATOMIC_ALL_OPS,
                Capability::EarlyDepth => wgpu::Features::SHADER_EARLY_DEPTH_TEST,
                _ => wgpu::Features::empty(),
            };
        }
        features
    }

    /// Whether the runtime runs such plans on some device: `Err` names the step or the resource that it does not know.
    pub fn check(&self) -> Result<(), Error> {
        check(&self.plan)
    }

    /// Whether a device with or without interlock runs these shaders. wgpu has no feature for it.
    pub fn check_interlock(&self, device: Interlock) -> Result<(), Error> {
        if device == Interlock::Absent && self.plan.requires.contains(&Capability::Interlock) {
            return Err(Error::Unsupported {
                what: "fragment shader interlock, on a device made without it,".to_owned(),
                hint: "make the device by `headless::open_device` where the driver has \
                       `VK_EXT_fragment_shader_interlock` and say so in `Settings::interlock`, or write \
                       `sync: interlock else spin_lock`"
                    .to_owned(),
            });
        }
        Ok(())
    }

    /// Whether functions of the description's author are in the code, from the description or from files that it names:
    /// they run with wgpu's runtime checks.
    pub(crate) fn has_user_functions(&self) -> bool {
        let variant = &self.plan.variant;
        let closures = variant.criterion.is_some() || variant.resolve.is_some() || !variant.constraints.is_empty();
        closures || !variant.helpers.is_empty() || self.plan.selection.own_files().next().is_some()
    }
}

fn stage_of(name: &str) -> Option<Stage> {
    match name {
        "vertex" => Some(Stage::Vertex),
        "fragment" => Some(Stage::Fragment),
        "compute" => Some(Stage::Compute),
        _ => None,
    }
}

fn code(path: &str, bytes: &[u8]) -> Result<Code, Error> {
    let text = std::str::from_utf8(bytes);
    match (path.rsplit('.').next(), text) {
        (Some("wgsl"), Ok(text)) => Ok(Code::Wgsl(text.to_owned())),
        (Some("spv"), _) => Ok(Code::SpirV(from_bytes(bytes))),
        _ => Err(Error::Unsupported {
            what: format!("`{path}`"),
            hint: "wgpu takes WGSL and SPIR-V; compile GLSL to SPIR-V first and fill in `Shaders::modules`".to_owned(),
        }),
    }
}

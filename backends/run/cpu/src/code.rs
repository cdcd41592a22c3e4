//! A variant as programs for the interpreter, a stage of a pass each.
//!
//! In: a variant and the registry that it was checked with. Out: its plan and a program per entry point. What this device
//! offers decides where an `else` is taken, as for every target.

use fragbuf_targets::{Checked, check};
use fragbuf_codegen::{Form, Linking, Plan, Profile, Stage, link, plan};
use fragbuf_interpreter::{Marker, Options, Program};
use fragbuf_model::Variant;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Capability;

use crate::Error;

/// A plan and its programs.
#[derive(Clone, Debug)]
pub struct Code {
    /// What is run.
    pub plan: Plan,
    /// In the order of the plan's passes.
    pub(crate) passes: Vec<PassCode>,
}

/// The stages of one pass.
#[allow(clippy::large_enum_variant, reason = "a plan has a dozen passes, and most draw")]
#[derive(Clone, Debug)]
pub(crate) enum PassCode {
    Draw { vertex: Program, fragment: Program },
    Compute(Program),
}

/// What this device can express. Fragments of a pixel run in the order of submission, so an interlock is kept without
/// effort; where they are interleaved, the scheduler keeps it.
const OFFERS: &[Capability] = &[
    Capability::FragmentAtomics,
    Capability::Fences,
    Capability::Coherent,
    Capability::Interlock,
    Capability::U64Atomics,
    Capability::EarlyDepth,
    Capability::MinMaxBlend,
    Capability::SampleMask,
    Capability::Coverage,
    Capability::OwnEntryPoints,
    Capability::PrimitiveIndex,
];

/// What templates have no word of WGSL for.
const MARKERS: &[(&str, Marker)] = &[
    ("memory_fence", Marker::Fence),
    ("is_helper_lane", Marker::HelperLane),
    ("critical_begin", Marker::CriticalBegin),
    ("critical_end", Marker::CriticalEnd),
];

impl Code {
    /// Plans, links, checks and compiles the variant.
    pub fn of(variant: &Variant, registry: &Registry) -> Result<Self, Error> {
        let selection = variant.select(OFFERS).map_err(Error::Refused)?;
        let plan = plan(variant, &selection, registry)?;
        let linking = Linking { profile: Profile::Native, form: Form::Program, prefix: String::new(), group: 0 };
        let mut passes = Vec::new();
        for text in link(&plan, &linking, registry)?.passes {
            passes.push(compiled(&check(text, linking.profile, &variant.name.origin)?)?);
        }
        Ok(Code { plan, passes })
    }
}

fn compiled(checked: &Checked) -> Result<PassCode, Error> {
    let compute = checked.pass().entry_points.iter().any(|entry| entry.stage == Stage::Compute);
    if compute {
        return Ok(PassCode::Compute(program(checked, Stage::Compute)?));
    }
    Ok(PassCode::Draw { vertex: program(checked, Stage::Vertex)?, fragment: program(checked, Stage::Fragment)? })
}

fn program(checked: &Checked, stage: Stage) -> Result<Program, Error> {
    let pass = checked.pass();
    let refused = |what: String| Error::Shader { pass: pass.anchor.clone(), what };
    let Some(entry) = pass.entry_points.iter().find(|entry| entry.stage == stage) else {
        return Err(refused(format!("a pass without an entry point of the stage {stage:?}")));
    };
    let options = Options { markers: MARKERS, written_first: &pass.written_first };
    Program::entry_point(checked.module(), checked.info(), &entry.name, &options).map_err(|faults| {
        let faults: Vec<String> = faults.into_iter().map(|fault| fault.what).collect();
        refused(faults.join(", "))
    })
}

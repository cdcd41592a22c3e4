//! Compiles a variant for the interpreter: plans it, links it, and compiles every stage of every pass.
//!
//! The features of this device decide the alternatives of each `else`, as for every target.

use fragbuf_codegen::{Form, Linking, PassSource, Plan, Profile, Stage, link, plan};
use fragbuf_interpreter::{Bytecode, Marker, Options};
use fragbuf_model::Variant;
use fragbuf_targets::{Checked, check};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::Feature;

use crate::Error;

/// A plan and its programs.
#[derive(Clone, Debug)]
pub struct Code {
    /// The plan.
    pub plan: Plan,
    /// The programs, in the order of the passes.
    pub(crate) passes: Vec<PassCode>,
    /// Their sources, which errors locate instructions in.
    sources: Vec<PassSource>,
}

/// The programs of one pass.
#[allow(clippy::large_enum_variant, reason = "a plan has a dozen passes, and most draw")]
#[derive(Clone, Debug)]
pub(crate) enum PassCode {
    Draw { vertex: Bytecode, fragment: Bytecode },
    Compute(Bytecode),
}

/// The features of this device. Fragments of a pixel run in submission order, which satisfies an interlock; if they are
/// interleaved, the scheduler enforces it.
const FEATURES: &[Feature] = &[
    Feature::FragmentAtomics,
    Feature::Fences,
    Feature::Coherent,
    Feature::Interlock,
    Feature::U64Atomics,
    Feature::EarlyDepth,
    Feature::MinMaxBlend,
    Feature::SampleMask,
    Feature::Coverage,
    Feature::OwnEntryPoints,
    Feature::PrimitiveIndex,
    Feature::SampleCounts,
];

/// The functions of templates that stand for constructs that WGSL lacks.
const MARKERS: &[(&str, Marker)] = &[
    ("memory_fence", Marker::Fence),
    ("is_helper_lane", Marker::HelperLane),
    ("critical_begin", Marker::CriticalBegin),
    ("critical_end", Marker::CriticalEnd),
];

impl Code {
    /// Plans, links, checks and compiles the variant.
    pub fn of(variant: &Variant, registry: &Registry) -> Result<Self, Error> {
        let selection = variant.select(FEATURES).map_err(Error::MissingFeature)?;
        let plan = plan(variant, &selection, registry)?;
        let linking = Linking { profile: Profile::Native, form: Form::Program, prefix: String::new(), group: 0 };
        let (mut passes, mut sources) = (Vec::new(), Vec::new());
        for source in link(&plan, &linking, registry)?.passes {
            let checked = check(source, linking.profile, &variant.name.span)?;
            passes.push(compiled(&checked)?);
            sources.push(checked.pass().clone());
        }
        Ok(Code { plan, passes, sources })
    }

    /// Returns the error for an invocation of a pass that reached the limit of backward jumps at an instruction.
    pub(crate) fn endless(&self, pass: usize, program: &Bytecode, at: u32) -> Error {
        let source = &self.sources[pass];
        let lines = program.trace(at).into_iter().map(|span| span.location(&source.text).line_number as usize);
        let location = source.lines.location(&lines.collect::<Vec<_>>());
        Error::NotTerminating {
            pass: source.name.clone(),
            reason: "an invocation loops without end, or too long",
            location,
        }
    }
}

fn compiled(checked: &Checked) -> Result<PassCode, Error> {
    let compute = checked.pass().entry_points.iter().any(|entry| entry.stage == Stage::Compute);
    if compute {
        return Ok(PassCode::Compute(program(checked, Stage::Compute)?));
    }
    Ok(PassCode::Draw { vertex: program(checked, Stage::Vertex)?, fragment: program(checked, Stage::Fragment)? })
}

fn program(checked: &Checked, stage: Stage) -> Result<Bytecode, Error> {
    let pass = checked.pass();
    let error = |what: String| Error::Shader { pass: pass.name.clone(), what };
    let Some(entry) = pass.entry_points.iter().find(|entry| entry.stage == stage) else {
        return Err(error(format!("a pass without an entry point for the {stage:?} stage")));
    };
    let options = Options {
        markers: MARKERS,
        written_first: &pass.written_first,
        writes_workgroup_first: true,
        ..Options::default()
    };
    Bytecode::entry_point(checked.module(), checked.info(), &entry.name, &options).map_err(|constructs| {
        let constructs: Vec<String> = constructs.into_iter().map(|construct| construct.what).collect();
        error(constructs.join(", "))
    })
}

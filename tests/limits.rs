//! The limits of plans, compared with the generated WGSL.

use fragbuf::vocabulary::Kind;
use fragbuf::{Form, Generation, Limit, Needed, Registry, Request, generate, limits, target};

use crate::cases::{checked, named};

/// Returns the portable WGSL of every named case that has it.
fn generations() -> Vec<(&'static str, Generation)> {
    let registry = Registry::builtin();
    let targets = [target("wgsl").unwrap()];
    let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
    let generated = |(name, description, set): (&'static str, _, Vec<_>)| {
        let variant = checked(&description, &set).unwrap_or_else(|diagnostics| panic!("{name}: {diagnostics}"));
        let generation = generate(&variant, &request, &registry).unwrap_or_else(|errors| panic!("{name}: {errors}"));
        (name, generation)
    };
    let all: Vec<(&'static str, Generation)> = named().into_iter().map(generated).collect();
    all.into_iter().filter(|(_, generation)| !generation.plans.is_empty()).collect()
}

fn number(limits: &[Limit], is_wanted: impl Fn(&Limit) -> bool) -> u64 {
    match limits.iter().find(|limit| is_wanted(limit)).map(|limit| &limit.needed) {
        Some(Needed::Number(number)) => *number,
        Some(Needed::Formula(formula)) => panic!("{formula}"),
        None => 0,
    }
}

/// The numbers of storage buffers are at least those that a shader declares, and at most those that a pass uses: a buffer is in the layout of
/// a pass that uses it, also where no function of the pass accesses it. A buffer without words has no declaration.
#[test]
fn storage_buffers_are_those_that_shaders_declare() {
    let (mut without_words, mut exact) = (0, 0);
    for (name, generation) in generations() {
        let plan = &generation.plans[0].plan;
        let most = |in_compute: Option<bool>| {
            let is_counted = |pass: &str| {
                let pass = plan.passes.iter().find(|planned| planned.name == pass).unwrap();
                in_compute.is_none_or(|wanted| matches!(pass.kind, Kind::Compute { .. }) == wanted)
            };
            let sources = generation.files.iter().filter(|file| is_counted(&file.pass));
            let declared =
                sources.map(|file| String::from_utf8_lossy(&file.bytes).matches(" var<storage").count() as u64);
            declared.max().unwrap_or(0)
        };
        let limits = limits(plan, 0, &generation.plans[0].workgroups);
        let of_opengl = |wanted| number(&limits, |limit| limit.opengl == Some(wanted));
        let all = number(&limits, |limit| limit.is_of_webgpu("maxStorageBuffersPerShaderStage"));
        let used = plan.passes.iter().map(|pass| pass.uses.len() as u64).max().unwrap_or(0);
        let bounds = |declared: u64| declared..=used.max(declared);
        assert!(bounds(most(None)).contains(&all), "{name}: {all}");
        let fragment = of_opengl("GL_MAX_FRAGMENT_SHADER_STORAGE_BLOCKS");
        assert!(bounds(most(Some(false))).contains(&fragment), "{name}: {fragment}");
        let compute = of_opengl("GL_MAX_COMPUTE_SHADER_STORAGE_BLOCKS");
        assert!(bounds(most(Some(true))).contains(&compute), "{name}: {compute}");
        exact += usize::from(all == most(None));
        without_words += usize::from(!plan.resources.iter().all(|planned| plan.is_declared(planned)));
    }
    assert!(without_words > 0, "no case has a buffer without words");
    assert!(exact > 30, "the number is exact in {exact} cases only");
}

/// Stencil routing keeps words in the samples of integer textures, and a coverage mask is a variable of fragment stages.
#[test]
fn samples_and_built_in_inputs_are_counted() {
    let (mut routed, mut covered) = (0, 0);
    for (name, generation) in generations() {
        let plan = &generation.plans[0].plan;
        let limits = limits(plan, 0, &[]);
        let samples = number(&limits, |limit| limit.opengl == Some("GL_MAX_INTEGER_SAMPLES"));
        if samples > 0 {
            routed += 1;
            assert_eq!(samples, u64::from(plan.capacity()), "{name}");
        }
        let variables = number(&limits, |limit| limit.is_of_webgpu("maxInterStageShaderVariables"));
        let inputs = plan.variant.attributes.len() as u64 - 1;
        let reads_mask =
            generation.files.iter().any(|file| String::from_utf8_lossy(&file.bytes).contains("@builtin(sample_mask)"));
        assert_eq!(variables, inputs + u64::from(reads_mask), "{name}");
        covered += u32::from(reads_mask);
    }
    assert!(routed > 0 && covered > 0, "{routed} cases with samples, {covered} with coverage");
}

//! What generating costs, per technique and target, against the floor: naga's parse, validation and writing of the same
//! texts. Both are printed; the ratio is the figure to watch.
#![allow(
    missing_docs,
    clippy::unwrap_used,
    clippy::panic,
    clippy::print_stdout,
    reason = "a bench prints, and fails by panicking"
)]

use std::path::Path;
use std::time::{Duration, Instant};

use criterion::{Criterion, criterion_group, criterion_main};
use fragbuf::load::{Description, load, variant};
use fragbuf::{Form, Generation, Profile, Registry, Request, TARGETS, Target, Variant, generate};
use naga::back::{glsl, hlsl, msl, spv};
use naga::valid::{Capabilities, ValidationFlags, Validator};

fn generated(variant: &Variant, target: &'static Target, registry: &Registry) -> Generation {
    let request = Request { targets: &[target], form: Form::Program, prefix: "", group: 0 };
    generate(variant, &request, registry).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
}

/// The linked texts of a profile: the floor reads the same ones.
fn texts(variant: &Variant, profile: Profile, registry: &Registry) -> Vec<String> {
    let target = TARGETS.iter().find(|target| target.profile == profile && target.name.starts_with("wgsl")).unwrap();
    generated(variant, target, registry).files.into_iter().map(|file| String::from_utf8(file.bytes).unwrap()).collect()
}

/// Parse, validate, and write what naga itself writes for the target. WGSL needs no writing: the text is the target. `None`: naga
/// cannot write it.
fn floor(texts: &[String], target: &Target) -> Option<()> {
    for text in texts {
        let options = naga::front::wgsl::Options { parse_doc_comments: true, capabilities: Capabilities::all() };
        let module = naga::front::wgsl::Frontend::new_with_options(options).parse(text).unwrap();
        let info = Validator::new(ValidationFlags::all(), Capabilities::all()).validate(&module).unwrap();
        match target.name {
            "wgsl" | "wgsl-native" => {}
            "hlsl" => {
                let (options, pipeline) = (hlsl::Options::default(), hlsl::PipelineOptions::default());
                let mut out = String::new();
                hlsl::Writer::new(&mut out, &options, &pipeline).write(&module, &info, None).ok()?;
            }
            "msl" => {
                let options = msl::Options { lang_version: (2, 4), ..msl::Options::default() };
                drop(msl::write_string(&module, &info, &options, &msl::PipelineOptions::default()).ok()?);
            }
            "spirv" => {
                for entry in &module.entry_points {
                    let pipeline = spv::PipelineOptions { shader_stage: entry.stage, entry_point: entry.name.clone() };
                    spv::write_vec(&module, &info, &spv::Options::default(), Some(&pipeline)).ok()?;
                }
            }
            _ => {
                for entry in &module.entry_points {
                    let options = glsl::Options { version: glsl::Version::Desktop(450), ..glsl::Options::default() };
                    let pipeline = glsl::PipelineOptions {
                        shader_stage: entry.stage,
                        entry_point: entry.name.clone(),
                        multiview: None,
                    };
                    let mut out = String::new();
                    let policies = naga::proc::BoundsCheckPolicies::default();
                    let mut writer = glsl::Writer::new(&mut out, &module, &info, &options, &pipeline, policies).ok()?;
                    writer.write().ok()?;
                }
            }
        }
    }
    Some(())
}

/// The least of several runs: what the work costs when nothing disturbs it.
fn least(mut work: impl FnMut()) -> Duration {
    let runs = (0..60).map(|_| {
        let start = Instant::now();
        work();
        start.elapsed()
    });
    runs.min().unwrap_or_default()
}

fn ratios(criterion: &mut Criterion) {
    let registry = Registry::builtin();
    println!("{:12} {:12} {:>10} {:>10} {:>6}", "technique", "target", "ours µs", "floor µs", "ratio");
    for technique in registry.techniques() {
        let variant = variant(&Description::Technique(technique.key.clone()), &[], &registry).unwrap();
        for target in TARGETS {
            let texts = texts(&variant, target.profile, &registry);
            if generated(&variant, target, &registry).files.is_empty() {
                continue;
            }
            let ours = least(|| drop(generated(&variant, target, &registry)));
            if floor(&texts, target).is_none() {
                println!("{:12} {:12} {:>10} {:>10} {:>6}", technique.key, target.name, ours.as_micros(), "none", "");
                continue;
            }
            let floor = least(|| _ = floor(&texts, target));
            let ratio = ours.as_secs_f64() / floor.as_secs_f64();
            let (ours, floor) = (ours.as_micros(), floor.as_micros());
            println!("{:12} {:12} {ours:>10} {floor:>10} {ratio:>6.2}", technique.key, target.name);
        }
    }
    let variant = variant(&Description::Technique("kplus_array".to_owned()), &[], &registry).unwrap();
    criterion.bench_function("kplus_array to every target", |bencher| {
        let targets: Vec<&'static Target> = TARGETS.iter().collect();
        let request = Request { targets: &targets, form: Form::Program, prefix: "", group: 0 };
        bencher.iter(|| generate(&variant, &request, &registry).unwrap());
    });
    let text = include_str!("../../examples/most_visible.fragbuf");
    criterion.bench_function("most_visible.fragbuf to a draft", |bencher| {
        bencher.iter(|| fragbuf::parse(text, "most_visible.fragbuf"));
    });
    let described = Description::Text { file: "most_visible.fragbuf".to_owned(), text: text.to_owned() };
    criterion.bench_function("most_visible.fragbuf to a variant", |bencher| {
        bencher.iter(|| load(&described, &[], &[], &registry).variant.unwrap());
    });
    let own = Description::read(Path::new("examples/user_storage/first_k.fragbuf")).unwrap();
    criterion.bench_function("first_k.fragbuf with its own storage to a variant", |bencher| {
        bencher.iter(|| load(&own, &[], &[], &registry).variant.unwrap());
    });
}

criterion_group!(benches, ratios);
criterion_main!(benches);

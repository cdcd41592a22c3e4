//! Every technique, every row of every axis and every k: the pixels are those of the reference, or of the CPU device.

use std::collections::BTreeSet;

use fragbuf_codegen::{Arrival, Form, SymbolId};
use fragbuf_model::Variant;
use fragbuf_opengl_host::{Api, Context};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Feature, KeepDefault};

use crate::draw::{NotDrawn, compare, context, expected, generated, host, render};
use crate::hosts::numbers::Numbers;
use crate::hosts::rows::{NO_TECHNIQUE, draw_rows};
use crate::hosts::scene::{first_difference, quads};
use crate::hosts::technique::{is_parallel, k_of, variant};

/// Odd and even sizes, a single pixel, and a single row and column.
const SIZES: [[u32; 2]; 6] = [[13, 7], [16, 16], [1, 1], [31, 1], [1, 9], [37, 23]];

/// Sizes for the other API and form. What depends on the size alone is the same text there.
const FEW_SIZES: [[u32; 2]; 2] = [[13, 7], [1, 1]];

/// Extensions that no software driver of OpenGL has, and the techniques that need them in each form.
const EXTENSIONS: [(&str, Form, &[&str]); 3] = [
    ("GL_ARB_fragment_shader_interlock", Form::Program, &["kb_ps", "depth_partition", "kb_stream"]),
    ("GL_NV_shader_atomic_int64", Form::Program, &["kb_mdt64"]),
    ("GL_NV_shader_atomic_int64", Form::Module, &["kb_mdt64"]),
];

/// Features that OpenGL ES lacks, and the techniques that need them. The command line reports them as `unsupported-target`.
const LACKING_IN_ES: [(Feature, &[&str]); 3] =
    [(Feature::U64Atomics, &["kb_mdt64"]), (Feature::SampleMask, &["kb_sr"]), (Feature::EarlyDepth, &["f2b_3p"])];

/// Techniques that have entry points of their own, in program form alone. The same code.
const WITHOUT_MODULE: [&str; 5] = ["z_buffer", "kb_sr", "f2b", "f2b2", "f2b_3p"];

/// Returns the extension that a technique needs and the driver lacks.
fn missing_extension(context: &Context, form: Form, technique: &str) -> Option<&'static str> {
    let mut needed = EXTENSIONS.iter().filter(|(_, of, techniques)| *of == form && techniques.contains(&technique));
    needed.find(|(name, ..)| context.api == Api::OpenGl && !context.has(name)).map(|(name, ..)| *name)
}

/// Tests whether a technique may be left out because of an extension that the driver lacks, or a feature that the target lacks.
fn is_explained(context: &Context, form: Form, technique: &str, why: &NotDrawn) -> bool {
    match why {
        NotDrawn::Failed(error) => {
            missing_extension(context, form, technique).is_some_and(|name| error.to_string().contains(name))
        }
        NotDrawn::Unsupported(missing) if missing.feature == Feature::OwnEntryPoints => {
            form == Form::Module && WITHOUT_MODULE.contains(&technique)
        }
        NotDrawn::Unsupported(missing) => {
            let mut rows = LACKING_IN_ES.iter();
            let is_listed = rows.any(|(feature, listed)| *feature == missing.feature && listed.contains(&technique));
            context.api == Api::OpenGlEs && is_listed
        }
    }
}

/// Draws every technique. Returns the keys of those that the target rejects.
fn draw_all(api: Api, form: Form, sizes: &[[u32; 2]]) -> Vec<String> {
    let context = context(api);
    println!("{}", context.name);
    let (mut rejected, mut unexplained) = (Vec::new(), Vec::new());
    for technique in Registry::builtin().techniques() {
        let k = k_of(technique);
        let set = k.map(|k| k.to_string());
        let set: Vec<(&str, &str)> = set.iter().map(|k| ("k", k.as_str())).collect();
        let variant = variant(&technique.key, &set).unwrap();
        let Err(why) = compare(&context, form, (&technique.key, &variant, k), sizes) else {
            let missing = missing_extension(&context, form, &technique.key);
            unexplained.extend(missing.map(|name| format!("{} is drawn without {name}", technique.key)));
            continue;
        };
        if !is_explained(&context, form, &technique.key, &why) {
            unexplained.push(format!("{}: {why}", technique.key));
        }
        if matches!(why, NotDrawn::Unsupported(_)) {
            rejected.push(technique.key.clone());
        }
    }
    assert!(unexplained.is_empty(), "{api}, {form:?}: {unexplained:#?}");
    rejected.sort();
    rejected
}

/// The keys of the lists, in order.
fn sorted(lists: &[&[&str]]) -> Vec<String> {
    let keys: BTreeSet<String> = lists.iter().flat_map(|list| list.iter().map(|key| (*key).to_owned())).collect();
    keys.into_iter().collect()
}

#[test]
fn every_technique() {
    assert_eq!(draw_all(Api::OpenGl, Form::Program, &SIZES), sorted(&[]));
}

#[test]
fn every_technique_in_es() {
    let lacking = LACKING_IN_ES.map(|(_, techniques)| techniques);
    assert_eq!(draw_all(Api::OpenGlEs, Form::Program, &FEW_SIZES), sorted(&lacking));
}

#[test]
fn every_technique_with_a_material() {
    assert_eq!(draw_all(Api::OpenGl, Form::Module, &FEW_SIZES), sorted(&[&WITHOUT_MODULE]));
}

#[test]
fn every_technique_with_a_material_in_es() {
    let [wide, samples, early] = LACKING_IN_ES.map(|(_, techniques)| techniques);
    let rejected = draw_all(Api::OpenGlEs, Form::Module, &FEW_SIZES);
    assert_eq!(rejected, sorted(&[&WITHOUT_MODULE, wide, samples, early]));
}

/// Rows that are not drawn, each with the reason: an extension that the driver lacks, or no technique takes it.
const ROWS_LEFT_OUT: [(&str, &str, &str); 7] = [
    ("storage", "wide_cascade", "GL_NV_shader_atomic_int64"),
    ("sync", "interlock", "GL_ARB_fragment_shader_interlock"),
    ("sync", "interlock_ordered", "GL_ARB_fragment_shader_interlock"),
    ("ties", "submission", "GL_ARB_fragment_shader_interlock"),
    ("resolve", "closure", NO_TECHNIQUE),
    ("resolve", "pairs", NO_TECHNIQUE),
    ("resolve", "after_images", NO_TECHNIQUE),
];

/// Rows that need a feature that OpenGL ES lacks.
const ROWS_LEFT_OUT_IN_ES: [(&str, &str, Feature); 9] = [
    ("sync", "interlock", Feature::Interlock),
    ("sync", "interlock_ordered", Feature::Interlock),
    ("ties", "submission", Feature::Interlock),
    ("storage", "wide_cascade", Feature::U64Atomics),
    ("storage", "stencil_routed", Feature::SampleMask),
    ("cull", "occupancy_early", Feature::EarlyDepth),
    ("opaque", "early_depth", Feature::EarlyDepth),
    ("peeling", "id_pairs_tested", Feature::EarlyDepth),
    ("samples", "coverage", Feature::Coverage),
];

/// Draws one technique per row.
fn draw_every_row(api: Api) {
    let context = context(api);
    let draw = |what: &str, variant: &Variant, k| {
        compare(&context, Form::Program, (what, variant, k), &[[13, 7]]).map_err(|why| why.to_string())
    };
    let left_out = |axis: &str, key: &str| {
        let mut in_es = ROWS_LEFT_OUT_IN_ES.iter().filter(|_| api == Api::OpenGlEs);
        if let Some((.., feature)) = in_es.find(|(of, row, _)| (*of, *row) == (axis, key)) {
            return Some(format!("requires {}", feature.meaning()));
        }
        let mut rows = ROWS_LEFT_OUT.iter().filter(|(.., reason)| !context.has(reason));
        rows.find(|(of, row, _)| (*of, *row) == (axis, key)).map(|(.., reason)| (*reason).to_owned())
    };
    let wrong = draw_rows(&draw, &left_out);
    assert!(wrong.is_empty(), "{api}: {wrong:#?}");
}

#[test]
fn every_row_of_every_axis() {
    draw_every_row(Api::OpenGl);
}

#[test]
fn every_row_of_every_axis_in_es() {
    draw_every_row(Api::OpenGlEs);
}

/// Memory is that of the capacity; k is a symbol of the frame.
#[test]
fn every_k_below_the_capacity() {
    let (context, size, form) = (context(Api::OpenGl), [13, 7], Form::Program);
    let plan_of = |variant: &Variant| generated(context.api, form, variant, &Registry::builtin());
    let mut compared = 0;
    for technique in Registry::builtin().techniques() {
        let KeepDefault::Best(most) = technique.keep else { continue };
        let with_k = |k: u32| variant(&technique.key, &[("k", &k.to_string())]);
        let capacity = most.min(8);
        let opened = plan_of(&with_k(capacity).unwrap()).and_then(|generation| Ok(host(&context, &generation, size)?));
        let mut host = match opened {
            Ok(host) => host,
            Err(why) => {
                assert!(is_explained(&context, form, &technique.key, &why), "{}: {why}", technique.key);
                continue;
            }
        };
        for k in 1..=capacity {
            // Some storages take only some k: sample counts are powers of two.
            let Some(variant) = with_k(k) else { continue };
            let plan = plan_of(&variant).unwrap_or_else(|why| panic!("{why}")).plans.remove(0).plan;
            if is_parallel(&context.name) && plan.arrival() == Arrival::Race {
                println!("{}: not compared, because races change its image", technique.key);
                continue;
            }
            // A host step of the frame decides k.
            if plan.frame.decisions().any(|decision| decision.sets.contains(&SymbolId::K)) {
                continue;
            }
            host.set_symbol("k", k.into()).unwrap_or_else(|e| panic!("{}: {e}", technique.key));
            let quads = quads(9, size, &mut Numbers::seeded(k.into()));
            compared += 1;
            let seen = render(&mut host, form, &quads, size).unwrap_or_else(|e| panic!("{}: {e}", technique.key));
            let difference = first_difference(&seen, &expected(&plan, &host, &quads, Some(k), size));
            assert!(difference.is_none(), "{}, k = {k} of {capacity}: {}", technique.key, difference.unwrap());
        }
    }
    println!("{compared} compared");
    assert!(compared >= 20, "{compared}");
}

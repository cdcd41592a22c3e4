//! Every technique on every target that the device runs, with many fragments of each pixel in flight.
//!
//! Where the tier of a target promises order independence (T1 to T3), every pixel is that of the reference. Fences are missing on T4 and
//! mutual exclusion on T5, so there wrong pixels are counted and printed. A software driver runs the fragments of a pixel one after the
//! other: there every frame is right, and this test shows only that all targets run. `FRAGBUF_TEST_DEVICE=auto` selects a GPU.

use std::collections::{BTreeMap, BTreeSet};

use fragbuf_codegen::{Arrival, Form};
use fragbuf_model::{Draft, SourceSpan, Variant, check};
use fragbuf_runtime::headless::Headless;
use fragbuf_runtime::{Error, Interlock, PoolSize, Settings, Shaders, Sizing};
use fragbuf_targets::{Request, TARGETS, generate, tier};
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, KeepDefault};

use crate::drivers::draw;
use crate::drivers::scene::{Quad, first_difference, image};
use crate::order::Numbers;
use crate::stage::{self, BACKGROUND, FORMAT, read_counters};

/// The drawing orders of a technique, and the side and quads of a frame: on a software driver, and on a GPU. All fragments of a small frame
/// are in flight at once; those of a large one keep all locks busy.
const ON_A_CPU: &[(u32, u32, u32)] = &[(1, 16, 12)];
const ON_A_GPU: &[(u32, u32, u32)] = &[(24, 16, 48), (4, 192, 48)];

/// One technique on one target.
struct Case {
    name: String,
    tier: &'static str,
    /// Whether the image is that of the k nearest in any order.
    is_exact: bool,
    k: Option<u32>,
    shaders: Shaders,
}

/// Returns the cases of a technique: every target with the interlock, and with the technique's own `sync`.
fn cases(key: &str, keep: KeepDefault) -> Vec<Case> {
    let k = match keep {
        KeepDefault::All => None,
        KeepDefault::Best(most) => Some(most.min(8)),
    };
    let number = k.map(|k| k.to_string());
    let set: Vec<(&str, &str)> = number.iter().map(|k| ("k", k.as_str())).collect();
    let mut cases = Vec::new();
    for sync in [None, Some("spin_lock"), Some("interlock"), Some("interlock_ordered")] {
        let Some(variant) = variant(key, &set, sync) else { continue };
        for target in TARGETS {
            let request = Request { targets: &[target], form: Form::Program, prefix: "", group: 0 };
            let Ok(generation) = generate(&variant, &request, &Registry::builtin()) else { continue };
            let Ok(shaders) = Shaders::from_generation(&generation, target.name, 0) else { continue };
            let plan = &generation.plans[0].plan;
            let provides = plan.selection.provides();
            let keeps = [Capability::KeepsAll, Capability::KeepsBest].iter().any(|kept| provides.contains(kept));
            cases.push(Case {
                name: format!("{key} {} {}", plan.selection.row("sync").map_or("", |row| &row.row.key), target.name),
                tier: tier(plan.soundness, target),
                is_exact: keeps && plan.arrival() == Arrival::Any,
                k,
                shaders,
            });
        }
    }
    let mut names = BTreeSet::new();
    cases.retain(|case| names.insert(case.name.clone()));
    cases
}

fn variant(key: &str, set: &[(&str, &str)], sync: Option<&str>) -> Option<Variant> {
    let span = SourceSpan::new(key, 1, 1);
    let mut draft = Draft::from_technique(key, &span);
    for (name, value) in set.iter().copied().chain(sync.map(|sync| ("sync", sync))) {
        draft.set(name, value, &span).unwrap();
    }
    check(&draft, &Registry::builtin()).ok()
}

/// Opaque and transparent quads of most of the frame, so that neighbouring pixels have different lists. Some depths are equal.
fn quads(count: u32, side: u32, numbers: &mut Numbers) -> Vec<Quad> {
    let quad = |id| {
        let low = |numbers: &mut Numbers| numbers.below(side / 8);
        let (left, right, top, bottom) = (low(numbers), side - low(numbers), low(numbers), side - low(numbers));
        let color = std::array::from_fn(|_| numbers.below(256) as u8);
        Quad { x: [left, right], y: [top, bottom], depth: numbers.below(64) as f32 / 64.0, color, id }
    };
    (0..count).map(quad).collect()
}

/// The scene of all cases, and its images by k.
struct Scene {
    orders: u32,
    side: u32,
    quads: Vec<Quad>,
    images: BTreeMap<Option<u32>, Vec<[f64; 3]>>,
}

impl Scene {
    fn new((orders, side, count): (u32, u32, u32)) -> Self {
        Scene {
            orders,
            side,
            quads: quads(count, side, &mut Numbers::seeded(u64::from(side))),
            images: BTreeMap::new(),
        }
    }

    fn image(&mut self, k: Option<u32>) -> Vec<[f64; 3]> {
        let Scene { side, quads, images, .. } = self;
        images.entry(k).or_insert_with(|| image(quads, [*side; 2], k, BACKGROUND)).clone()
    }
}

/// Draws the scene in several orders. Returns the wrong pixels, and the counted losses.
fn wrong_pixels(stage: &Headless, case: &Case, scene: &mut Scene) -> Result<(u64, u64), Error> {
    let (side, mut quads) = (scene.side, scene.quads.clone());
    // Twice the fragments of the frame, because lists of pages leak some of their pages.
    let settings = Settings {
        sizing: Sizing::Capacity(PoolSize::Fragments(2 * quads.len() as u32 * side * side)),
        interlock: stage.interlock,
        ..Settings::new(FORMAT, side, side)
    };
    let mut renderer = stage::renderer(stage, &case.shaders, &settings)?;
    let mut numbers = Numbers::seeded(u64::from(side));
    let expected = scene.image(case.k);
    let (mut wrong, mut lost) = (0, 0);
    for _ in 0..scene.orders {
        let seen = draw(stage, &mut renderer, &quads, [side; 2])?;
        let differs = |(seen, expected): (&[f32; 4], &[f64; 3])| {
            first_difference(std::slice::from_ref(seen), std::slice::from_ref(expected)).is_some()
        };
        wrong += seen.iter().zip(&expected).filter(|pair| differs(*pair)).count() as u64;
        lost += read_counters(stage, &renderer).lost();
        numbers.shuffle(&mut quads);
    }
    Ok((wrong, lost))
}

#[test]
fn concurrent_fragments_give_the_image_that_the_tier_promises() {
    let stage = stage::chosen_device();
    let is_cpu = stage.info.device_type == wgpu::DeviceType::Cpu;
    println!("driver: {}, {:?}", stage.info.name, stage.interlock);
    let mut scenes: Vec<Scene> = if is_cpu { ON_A_CPU } else { ON_A_GPU }.iter().copied().map(Scene::new).collect();
    let (mut right, mut broken, mut tiers) = (0, Vec::new(), BTreeSet::new());
    for technique in Registry::builtin().techniques() {
        for case in cases(&technique.key, technique.keep) {
            let seen = scenes.iter_mut().try_fold((0, 0), |(wrong, lost), scene| {
                wrong_pixels(&stage, &case, scene).map(|(more_wrong, more_lost)| (wrong + more_wrong, lost + more_lost))
            });
            let Case { name, tier, is_exact, .. } = &case;
            let printed = seen.as_ref().map(|(wrong, lost)| format!("{wrong} pixels wrong, {lost} losses counted"));
            let printed = printed.unwrap_or_else(|error| error.to_string());
            println!("{name}: {tier}, {}: {printed}", if *is_exact { "exact" } else { "not exact" });
            let promises = *is_exact && (is_cpu || ["T1", "T2", "T3"].contains(tier));
            match seen {
                Ok((0, 0)) => {
                    right += 1;
                    tiers.insert(*tier);
                }
                Ok(wrong) if promises => broken.push(format!("{name}, {tier}: {wrong:?}")),
                Ok(_) => {}
                Err(Error::MissingFeatures(_)) => {}
                Err(error) => {
                    let needs_interlock = error.to_string().contains("fragment shader interlock");
                    assert!(needs_interlock && stage.interlock == Interlock::Absent, "{name}: {error}");
                }
            }
        }
    }
    assert!(broken.is_empty(), "wrong pixels and counted losses: {broken:#?}");
    assert!(right > 40 && tiers.contains("T1") && tiers.contains("T3"), "{right} cases are right, of tiers {tiers:?}");
}

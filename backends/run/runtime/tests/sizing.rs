//! Sizing: allocated bytes, suspended frames, and pool overflow.

use fragbuf_codegen::PlannedResource;
use fragbuf_runtime::headless::{Headless, Offscreen};
use fragbuf_runtime::{Buckets, Error, Output, PoolSize, Recorded, Renderer, Settings, Sizing, block_on};

use crate::capture::scattered;
use crate::oracle::{PLAIN, kept_words, total};
use crate::quads::{Quad, SIZE, vertices};
use crate::stage::{FORMAT, device, draw_over, render_frame, renderer, settings, shaders, technique};

const PIXELS: u64 = (SIZE * SIZE) as u64;
/// The words of the counters.
const COUNTERS: u64 = fragbuf_templates::COUNTERS.len() as u64;

fn open(stage: &Headless, key: &str, set: &[(&str, &str)], sizing: Sizing) -> Result<Renderer, Error> {
    renderer(stage, &shaders(&technique(key, set), "wgsl"), &Settings { sizing, ..settings() })
}

#[test]
fn allocated_bytes_match_the_papers() {
    let stage = device();
    let quads = scattered(8, 3);
    let fragments = total(&PLAIN, &quads) as u64;
    let reserve = Sizing::Reserve(PoolSize::Fragments(1000));
    let best: u64 = kept_words(&PLAIN, &quads, Some(5)).iter().map(|kept| kept.len() as u64).sum();
    // Keys and entries, then a count and a lock if there are any: 2k + 2, 2k, 3f + 1, 2f + 2 and 2 min(f, k) + 3 words per pixel.
    let expected = [
        ("kplus_array", "5", Sizing::Auto, (2 * 5 + 2) * PIXELS + COUNTERS),
        ("kb", "5", Sizing::Auto, 2 * 5 * PIXELS + COUNTERS),
        ("kb_mdt32", "5", Sizing::Auto, 2 * 5 * PIXELS + COUNTERS),
        ("kplus_array_revised", "5", Sizing::Auto, (2 * 5 + 2) * PIXELS + COUNTERS),
        ("depth_partition", "5", Sizing::Auto, (2 * 5 + 1) * PIXELS + COUNTERS),
        ("kplus_ab_sb", "5", Sizing::Exact, 3 * PIXELS + 1 + 1 + 2 * best + COUNTERS),
        ("kb_ll", "5", reserve, PIXELS + 1 + 3 * 1000 + COUNTERS),
        ("ab_ll", "all", reserve, PIXELS + 1 + 3 * 1000 + COUNTERS),
        ("ab_ll", "all", Sizing::Auto, PIXELS + 1 + 3 * 8 * PIXELS + COUNTERS),
        // A page of four for every pixel, and one with its link for every four fragments: 9f/4 + 9.
        ("ab_ll_paged", "all", reserve, PIXELS + 1 + 250 + 8 * (PIXELS + 250) + COUNTERS),
        // Five heads and two ends of a range: 3f + 7.
        ("ab_ll_bun", "all", reserve, 7 * PIXELS + 1 + 3 * 1000 + COUNTERS),
        // A colour of four words, the key that was emitted last, and the lock.
        ("kb_stream", "5", Sizing::Auto, (2 * 5 + 6) * PIXELS + COUNTERS),
        ("kb_mha", "5", Sizing::Auto, 2 * 5 * PIXELS + COUNTERS),
        ("ab_sb", "all", reserve, PIXELS + (PIXELS + 1) + 1 + 2 * 1000 + COUNTERS),
        ("ab_sb", "all", Sizing::Exact, PIXELS + (PIXELS + 1) + 1 + 2 * fragments + COUNTERS),
    ];
    for (key, k, sizing, words) in expected {
        let mut renderer = open(&stage, key, &[("k", k)], sizing).unwrap();
        render_frame(&stage, &mut renderer, &quads);
        assert_eq!(renderer.allocated_bytes(), 4 * words, "{key} {sizing:?}");
        let by_formula = renderer.plan().resources.iter().map(|planned| 4 * words_of(&renderer, planned));
        assert_eq!(renderer.allocated_bytes(), by_formula.sum::<u64>(), "{key} {sizing:?}");
        for planned in &renderer.plan().resources {
            let bytes = renderer.buffer(&planned.resource.name).map_or(0, wgpu::Buffer::size);
            assert_eq!(bytes, 4 * words_of(&renderer, planned));
        }
    }
}

#[test]
fn a_pool_size_in_bytes_covers_all_pools() {
    let stage = device();
    // An entry of ab_ll is three words: key, colour, link; one of ab_sb two.
    for (key, bytes, fragments) in [("ab_ll", 1200, 100), ("ab_ll", 1211, 100), ("ab_ll", 11, 0), ("ab_sb", 1200, 150)]
    {
        let reserved = |size| open(&stage, key, &[], Sizing::Reserve(size)).unwrap();
        let (with, without) = (reserved(PoolSize::Bytes(bytes)), reserved(PoolSize::Fragments(0)));
        assert_eq!(with.symbol("fragments"), Some(fragments), "{key}, {bytes} bytes");
        let more = with.allocated_bytes() - without.allocated_bytes();
        assert!(more <= bytes && bytes - more < 12, "{key}: {more} of {bytes} bytes");
    }
}

#[test]
fn every_k_uses_one_bucket_that_is_generated_once() {
    let stage = device();
    let quads = scattered(24, 4);
    let mut generated = Vec::new();
    let make = |capacity: u32| {
        generated.push(capacity);
        Ok(shaders(&technique("kplus_array", &[("k", &capacity.to_string())]), "wgsl"))
    };
    let settings = settings();
    let buckets = Buckets::new(&stage.device, &stage.queue, &settings, 3, make);
    let mut buckets = block_on(&stage.device, buckets).unwrap().unwrap();
    for k in [3, 4, 2, 9, 16, 1, 3, 10, 2] {
        block_on(&stage.device, buckets.set_k(k)).unwrap().unwrap();
        let renderer = buckets.renderer();
        assert_eq!((renderer.k(), renderer.capacity()), (Some(k), k.next_power_of_two()));
        assert_eq!(render_frame(&stage, renderer, &quads).kept, kept_words(&PLAIN, &quads, Some(k)), "k = {k}");
    }
    assert!(block_on(&stage.device, buckets.set_k(0)).unwrap().is_err());
    drop(buckets);
    assert_eq!(generated, [4, 2, 16, 1]);
}

#[test]
fn an_overflowing_pool_counts_every_lost_fragment() {
    let stage = device();
    let quads = scattered(8, 5);
    let fragments = total(&PLAIN, &quads);
    for size in [0, 1, fragments / 2, fragments - 1, fragments, fragments + 1] {
        for key in ["ab_ll", "ab_sb", "ab_ll_bun"] {
            let sizing = Sizing::Reserve(PoolSize::Fragments(size as u32));
            let mut renderer = open(&stage, key, &[("counters", "all")], sizing).unwrap();
            let seen = render_frame(&stage, &mut renderer, &quads);
            let lost = fragments.saturating_sub(size);
            assert_eq!(
                seen.counters.get("pool_exhausted") as usize,
                lost,
                "{key} with capacity for {size} of {fragments}"
            );
            assert_eq!(seen.counters.get("generated") as usize, fragments);
            assert_eq!(seen.counters.lost() as usize, lost);
            let all = kept_words(&PLAIN, &quads, None);
            assert_eq!(seen.kept.iter().map(Vec::len).sum::<usize>(), fragments - lost);
            for (kept, all) in seen.kept.iter().zip(all) {
                assert!(kept.iter().all(|words| all.contains(words)), "{key} keeps a fragment that was not drawn");
            }
        }
    }
}

/// Every pixel has its own page, and the pool has one page for every four fragments of its size. So at least that many fragments fit
/// in any distribution.
#[test]
fn pages_fit_the_pool_size_in_any_distribution() {
    let stage = device();
    let color = [9, 90, 200, 60];
    let piled = |count: u32| (0..count).map(|id| Quad::whole(0.5, color).at(3, 3, 5, 4).named(id)).collect::<Vec<_>>();
    for quads in [scattered(8, 5), scattered(30, 6), piled(4), piled(5), piled(21)] {
        let fragments = total(&PLAIN, &quads);
        let wanted: usize = kept_words(&PLAIN, &quads, None).iter().map(|all| all.len().saturating_sub(1) / 4).sum();
        for size in [0, 4, fragments / 2, 4 * wanted.saturating_sub(1), 4 * wanted, fragments] {
            let sizing = Sizing::Reserve(PoolSize::Fragments(size as u32));
            let mut renderer = open(&stage, "ab_ll_paged", &[("counters", "all")], sizing).unwrap();
            let seen = render_frame(&stage, &mut renderer, &quads);
            let (kept, lost) = (seen.kept.iter().map(Vec::len).sum::<usize>(), seen.counters.lost() as usize);
            assert_eq!(seen.counters.get("pool_exhausted") as usize, lost, "{:?}", seen.counters);
            assert_eq!((kept + lost, lost == 0), (fragments, size / 4 >= wanted), "capacity for {size} of {fragments}");
            assert_eq!(seen.counters.get("pages_leaked"), 0, "fragments run sequentially");
            for (kept, all) in seen.kept.iter().zip(kept_words(&PLAIN, &quads, None)) {
                assert!(kept.iter().all(|words| all.contains(words)) && kept.len() <= all.len());
                assert!(kept.len() == all.len() || kept.len() >= 4, "the first page belongs to the pixel");
            }
        }
    }
}

/// Regions that end beyond the pool: a pixel over its capacity needs its whole region, any other uses the slots in the pool.
#[test]
fn regions_beyond_the_pool_count_every_lost_fragment() {
    let stage = device();
    let quads = scattered(8, 5);
    let best = kept_words(&PLAIN, &quads, Some(3));
    let wanted: usize = best.iter().map(Vec::len).sum();
    for size in [0, 1, wanted / 2, wanted - 1, wanted, wanted + 1] {
        let sizing = Sizing::Reserve(PoolSize::Fragments(size as u32));
        let mut renderer = open(&stage, "kplus_ab_sb", &[("k", "3"), ("counters", "all")], sizing).unwrap();
        let seen = render_frame(&stage, &mut renderer, &quads);
        let count = |name| seen.counters.get(name) as usize;
        let kept: usize = seen.kept.iter().map(Vec::len).sum();
        assert!(kept <= size && (kept == wanted || size < wanted), "{kept} kept of {wanted} with capacity for {size}");
        let gone = count("culled") + count("displaced") + count("pool_exhausted");
        assert_eq!(count("generated"), kept + gone, "{:?}", seen.counters);
        for (kept, best) in seen.kept.iter().zip(&best) {
            assert!(kept.iter().all(|words| best.contains(words)), "{kept:?} of {best:?} with capacity for {size}");
        }
    }
}

#[test]
fn kept_culled_and_displaced_fragments_are_all_fragments() {
    let stage = device();
    let quads = scattered(8, 9);
    let plain = ["1", "2", "5"].map(|k| [("kplus_array", k), ("kb", k)]);
    let others = ["1", "2", "5"].map(|k| [("kplus_array_revised", k), ("kb_ll", k), ("kplus_ab_sb", k)]);
    for (key, k) in plain.into_iter().flatten().chain(others.into_iter().flatten()) {
        let mut renderer = open(&stage, key, &[("k", k), ("counters", "all")], Sizing::Auto).unwrap();
        let seen = render_frame(&stage, &mut renderer, &quads);
        let count = |name| seen.counters.get(name) as usize;
        let kept: usize = seen.kept.iter().map(Vec::len).sum();
        assert_eq!(count("generated"), total(&PLAIN, &quads), "{key}");
        assert_eq!(count("generated"), kept + count("culled") + count("displaced"), "{key}");
    }
}

#[test]
fn exact_sizing_follows_the_scene() {
    let stage = device();
    let mut renderer = open(&stage, "ab_sb", &[], Sizing::Exact).unwrap();
    let layers = |count: u32| (0..count).map(|id| Quad::whole(0.5, [9, 9, 9, 9]).named(id)).collect::<Vec<_>>();
    // The pool grows as needed, keeps up to twice the need, and releases more.
    for (count, size) in [(4, 4), (5, 5), (3, 5), (2, 2), (0, 0), (1, 1)] {
        render_frame(&stage, &mut renderer, &layers(count));
        assert_eq!(renderer.symbol("fragments"), Some(size * PIXELS), "{count} layers");
    }
}

#[test]
fn a_frame_is_suspended_only_where_the_host_must_read() {
    let stage = device();
    let cases = [
        ("ab_sb", Sizing::Auto, 1),
        ("ab_sb", Sizing::Reserve(PoolSize::Fragments(99)), 0),
        ("ab_ll", Sizing::Auto, 0),
        ("kplus_array", Sizing::Exact, 0),
    ];
    for (key, sizing, expected) in cases {
        let mut renderer = open(&stage, key, &[], sizing).unwrap();
        let offscreen = Offscreen::new(&stage.device, FORMAT, SIZE, SIZE).unwrap();
        let output = Output { view: offscreen.view(), load: wgpu::LoadOp::Load };
        let mut frame = renderer.begin().unwrap();
        let mut suspensions = 0;
        loop {
            let mut encoder = stage.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            let recorded = frame.record(&renderer, &mut encoder, &output, &mut |_, _| {}).unwrap();
            stage.queue.submit([encoder.finish()]);
            let Recorded::Suspended(suspended) = recorded else { break };
            suspensions += 1;
            // An event loop would do other work here.
            while !suspended.is_ready() {
                stage.device.poll(wgpu::PollType::Poll).unwrap();
            }
            frame = block_on(&stage.device, suspended.resume(&mut renderer)).unwrap().unwrap();
        }
        assert_eq!(suspensions, expected, "{key} {sizing:?}");
    }
}

#[test]
fn a_resized_renderer_works() {
    let stage = device();
    for key in ["kplus_array", "ab_ll", "ab_sb"] {
        let small = Settings { width: 3, height: 2, ..settings() };
        let mut renderer = renderer(&stage, &shaders(&technique(key, &[]), "wgsl"), &small).unwrap();
        block_on(&stage.device, renderer.resize(SIZE, SIZE)).unwrap().unwrap();
        let quads = scattered(6, 1);
        assert_eq!(render_frame(&stage, &mut renderer, &quads).kept, kept_words(&PLAIN, &quads, renderer.k()), "{key}");
    }
}

#[test]
fn passes_are_timed() {
    let stage = device();
    assert!(stage.device.features().contains(wgpu::Features::TIMESTAMP_QUERY), "the CPU's adapter has timestamps");
    let settings = Settings { timestamps: true, ..settings() };
    let mut renderer = renderer(&stage, &shaders(&technique("ab_sb", &[]), "wgsl"), &settings).unwrap();
    render_frame(&stage, &mut renderer, &scattered(8, 1));
    let mut encoder = stage.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let times = renderer.pass_times(&mut encoder).unwrap();
    stage.queue.submit([encoder.finish()]);
    let times = times.wait(&stage.device).unwrap();
    let passes: Vec<&str> = times.iter().map(|time| time.pass.as_str()).collect();
    assert_eq!(passes, ["count", "scan_blocks", "scan_sums", "scan_add", "store", "resolve"]);
    assert!(times.iter().all(|time| (0.0..1000.0).contains(&time.milliseconds)), "{times:?}");
    assert!(times.iter().any(|time| time.milliseconds > 0.0), "{times:?}");
}

/// A query set has at most 4096 queries, so it can time 2048 runs of a frame. The other runs are counted as untimed.
#[test]
fn runs_beyond_the_query_limit_are_counted_as_untimed() {
    const SLICES: u32 = 1024;
    let stage = device();
    let settings = Settings { width: 1, height: SLICES, slice: Some(1), timestamps: true, ..settings() };
    let mut renderer = renderer(&stage, &shaders(&technique("kplus_array", &[]), "wgsl"), &settings).unwrap();
    let offscreen = Offscreen::new(&stage.device, FORMAT, 1, SLICES).unwrap();
    draw_over(&stage, &mut renderer, &[Quad::whole(0.5, [9, 9, 9, 9])], &offscreen).unwrap();
    let mut encoder = stage.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let times = renderer.pass_times(&mut encoder).unwrap();
    stage.queue.submit([encoder.finish()]);
    let times = times.wait(&stage.device).unwrap();
    // Of 3 * 1024 runs, 2048 are timed: three passes in each of 682 slices, and two in the next.
    let untimed: Vec<(&str, u32)> = times.iter().map(|time| (time.pass.as_str(), time.untimed)).collect();
    assert_eq!(untimed, [("reset", 341), ("store", 341), ("resolve", 342)]);
    assert!(times.iter().all(|time| time.milliseconds > 0.0), "{times:?}");
}

#[test]
fn several_frames_in_flight_use_their_own_scenes() {
    let stage = device();
    let mut renderer = open(&stage, "kplus_array", &[], Sizing::Auto).unwrap();
    let targets: Vec<Offscreen> = (0..3).map(|_| Offscreen::new(&stage.device, FORMAT, SIZE, SIZE).unwrap()).collect();
    let scenes: Vec<Vec<Quad>> = (0..3).map(|seed| scattered(5, seed)).collect();
    for (quads, target) in scenes.iter().zip(&targets) {
        assert!(!vertices(quads, renderer.vertex_inputs()).is_empty());
        draw_over(&stage, &mut renderer, quads, target).unwrap();
    }
    for (quads, target) in scenes.iter().zip(&targets) {
        let alone = render_frame(&stage, &mut renderer, quads).pixels;
        assert_eq!(target.colors(&stage.device, &stage.queue).unwrap(), alone);
    }
}

/// Returns the words of a resource by its formula.
fn words_of(renderer: &Renderer, planned: &PlannedResource) -> u64 {
    planned.words.formula().evaluate(&|symbol| renderer.symbol(symbol)).unwrap()
}

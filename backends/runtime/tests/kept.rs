//! What the storages keep, read from their buffers as their templates' heads describe them.

use std::collections::BTreeMap;

use fragbuf_codegen::Plan;
use fragbuf_runtime::Renderer;
use fragbuf_templates::vocabulary::Element;

use crate::oracle::Words;
use crate::quads::SIZE;

const EMPTY: u32 = u32::MAX;

/// A device after a frame.
pub trait Drawn {
    fn plan(&self) -> &Plan;
    fn k(&self) -> Option<u32>;
    fn symbol(&self, name: &str) -> Option<u64>;
}

impl Drawn for Renderer {
    fn plan(&self) -> &Plan {
        self.plan()
    }

    fn k(&self) -> Option<u32> {
        self.k()
    }

    fn symbol(&self, name: &str) -> Option<u64> {
        self.symbol(name)
    }
}

impl Drawn for fragbuf_cpu::Device {
    fn plan(&self) -> &Plan {
        self.plan()
    }

    fn k(&self) -> Option<u32> {
        self.k()
    }

    fn symbol(&self, name: &str) -> Option<u64> {
        self.symbol(name)
    }
}

const PIXELS: usize = (SIZE * SIZE) as usize;

/// The kept fragments of every pixel, each pixel's in ascending order of their words. `buffers`: all words by resource.
pub fn kept(renderer: &dyn Drawn, buffers: &BTreeMap<String, Vec<u32>>) -> Vec<Vec<Words>> {
    let plan = renderer.plan();
    let storage = plan.selection.row("storage").unwrap().row.key.clone();
    let (words, beside) = (plan.layout.entry_words() as usize, plan.layout.beside_words() as usize);
    let k = renderer.k().unwrap_or(0) as usize;
    // Textures are as large as the frame, whatever its slices.
    let has_textures = plan.resources.iter().any(|planned| matches!(planned.resource.element, Element::Texture(_)));
    let places = if has_textures { PIXELS } else { renderer.symbol("pixels").unwrap() as usize };
    let buffer = |name: &str| buffers.get(name).map_or(&[][..], Vec::as_slice);
    let slot = |slot: usize, pixel: usize| {
        let at = slot * places + pixel;
        let rest = &buffer("entries")[at * beside..][..beside];
        [&[buffer("keys")[at]], rest].concat()
    };
    let entry = |name: &str, at: usize| buffer(name)[at * words..][..words].to_vec();
    let of_pixel = |pixel: usize| -> Vec<Words> {
        match storage.as_str() {
            "max_array" | "max_heap" => {
                let filled = buffer("filled")[pixel] as usize;
                assert!(filled <= k, "pixel {pixel} holds {filled} of {k}");
                assert!(filled == k || buffer("keys")[pixel] == EMPTY, "slot 0 of pixel {pixel} is taken too early");
                let parents_first = |index: usize| slot((index - 1) / 2, pixel) >= slot(index, pixel);
                let is_heap = storage != "max_heap" || filled < k || (1..k).all(parents_first);
                assert!(is_heap, "pixel {pixel} is no heap");
                (k - filled..k).map(|index| slot(index, pixel)).collect()
            }
            "cascade" => {
                let tail = |index: usize| &buffer("tails")[(index * places + pixel) * beside..][..beside];
                let slots = (0..k).map(|index| [&[buffer("keys")[index * places + pixel]], tail(index)].concat());
                let kept: Vec<Words> = slots.filter(|words| words[0] != EMPTY).collect();
                assert!(kept.is_sorted(), "pixel {pixel} is not in order: {kept:?}");
                kept
            }
            "distinct_cascade" => {
                let kept: Vec<Words> =
                    (0..k).map(|index| slot(index, pixel)).take_while(|words| words[0] != EMPTY).collect();
                let rest = (kept.len()..k).map(|index| slot(index, pixel)[0]);
                assert!(rest.clone().all(|key| key == EMPTY), "pixel {pixel} has a gap: {kept:?}");
                assert!(kept.is_sorted_by(|a, b| a[0] < b[0]), "pixel {pixel} is not in strict order: {kept:?}");
                kept
            }
            "wide_cascade" => {
                let wide = |index: usize| &buffer("slots")[2 * (index * places + pixel)..][..2];
                let slots = (0..k).map(wide).take_while(|wide| wide[1] != EMPTY);
                // Without a word beside the key the lower one is nobody's.
                let kept: Vec<Words> = slots.map(|wide| [wide[1], wide[0]][..words].to_vec()).collect();
                assert!(kept.is_sorted(), "pixel {pixel} is not in order: {kept:?}");
                kept
            }
            "revised_array" => {
                let asked = (buffer("tickets")[pixel] as usize).min(k);
                let slots: Vec<Words> = (0..k).map(|index| slot(index, pixel)).collect();
                let (empty, kept) = slots.split_at(k - asked);
                assert!(empty.iter().all(|words| words[0] == EMPTY), "pixel {pixel}: {slots:?} of {asked}");
                let is_worst_first = asked < k || kept.iter().all(|words| *words <= kept[0]);
                assert!(is_worst_first, "slot 0 of pixel {pixel} is not the worst: {slots:?}");
                kept.to_vec()
            }
            "depth_ranges" => {
                let slots = (0..k).map(|index| slot(index, pixel));
                let kept: Vec<Words> = slots.filter(|words| words[0] != EMPTY).collect();
                assert!(kept.is_sorted_by(|a, b| a[0] < b[0]), "ranges of pixel {pixel} are not in order: {kept:?}");
                kept
            }
            "repeated_array" => {
                let slots = (0..k).map(|index| slot(index, pixel));
                let mut kept: Vec<Words> = slots.filter(|words| words[0] != EMPTY).collect();
                kept.sort();
                assert!(kept.is_sorted_by(|a, b| a[0] < b[0]), "pixel {pixel} holds a key twice: {kept:?}");
                kept
            }
            "stencil_routed" => {
                let word = |name: &str, sample: usize| buffer(name)[sample * PIXELS + pixel];
                let routed = 256 - plan.capacity();
                let fields = || std::iter::once("key").chain(plan.layout.beside.iter().map(|word| word.field.as_str()));
                let samples = (0..k).take_while(|sample| word("routing", *sample) < routed);
                samples
                    .map(|sample| fields().map(|field| word(&format!("entries_{field}"), sample)).collect())
                    .collect()
            }
            "depth_tested" => {
                let fields = plan.layout.beside.iter().map(|word| buffer(&format!("entries_{}", word.field))[pixel]);
                let depth = buffer("depths")[pixel];
                if depth == 1.0_f32.to_bits() {
                    Vec::new()
                } else {
                    vec![std::iter::once(depth).chain(fields).collect()]
                }
            }
            "ordered_list" => {
                let link = |word: u32| word.checked_sub(1);
                let nodes =
                    std::iter::successors(link(buffer("heads")[pixel]), |node| link(buffer("links")[*node as usize]));
                let list: Vec<Words> = nodes.map(|node| entry("nodes", node as usize)).collect();
                assert!(list.is_sorted(), "the list of pixel {pixel} is not in order: {list:?}");
                list.into_iter().take(k).collect()
            }
            "bounded_regions" => {
                let room = renderer.symbol("kept").unwrap() as u32;
                let (begin, end) = (buffer("offsets")[pixel].min(room), buffer("offsets")[pixel + 1].min(room));
                let (count, size) = (buffer("counts")[pixel], end - begin);
                let at = |place: u32| {
                    let rest = &buffer("region_entries")[place as usize * beside..][..beside];
                    [&[buffer("region_keys")[place as usize]], rest].concat()
                };
                let slots: Vec<Words> = (begin..end).map(at).collect();
                if count == 1 << 31 {
                    assert!(buffer("offsets")[pixel + 1] > room, "crowded pixel {pixel} has room and keeps nothing");
                    return Vec::new();
                }
                if count >> 30 == 2 {
                    assert_eq!((count & 0x3fff_ffff, size as usize), (size, k), "crowded pixel {pixel} is not full");
                    assert!(slots.iter().all(|words| *words <= slots[0]), "slot 0 of pixel {pixel} is not the worst");
                } else {
                    assert_eq!(count, 0, "pixel {pixel} still waits for fragments");
                }
                slots
            }
            "fixed_array" => {
                let slots = (buffer("counts")[pixel] as usize).min(renderer.symbol("n").unwrap() as usize);
                (0..slots).map(|index| entry("entries", index * places + pixel)).collect()
            }
            "sorted_array" => {
                let kept: Vec<Words> =
                    (0..k).map(|index| slot(index, pixel)).filter(|words| words[0] != EMPTY).collect();
                assert!(kept.is_sorted(), "pixel {pixel} is not in order: {kept:?}");
                kept
            }
            "linked_list" => {
                let link = |word: u32| word.checked_sub(1);
                let nodes =
                    std::iter::successors(link(buffer("heads")[pixel]), |node| link(buffer("links")[*node as usize]));
                nodes.map(|node| entry("nodes", node as usize)).collect()
            }
            "paged_list" => {
                let page = parameter(plan, "PAGE_ENTRIES");
                let mut kept = Vec::new();
                let mut end = buffer("cursors")[pixel] as usize;
                while end > 0 {
                    let first = (end - 1) / page * page;
                    kept.extend((first..end).map(|place| entry("entries", place)));
                    let pooled = (first / page).checked_sub(PIXELS);
                    assert!(pooled.is_some() || first == pixel * page, "pixel {pixel} is in another's page");
                    end = pooled.map_or(0, |number| buffer("links")[number] as usize);
                    assert!(end.is_multiple_of(page), "a link of pixel {pixel} leads to a page that is not full");
                }
                kept
            }
            "bucket_lists" => {
                let link = |word: u32| word.checked_sub(1);
                let bucket = |number: usize| -> Vec<Words> {
                    let head = link(buffer("heads")[number * PIXELS + pixel]);
                    let nodes = std::iter::successors(head, |node| link(buffer("links")[*node as usize]));
                    nodes.map(|node| entry("nodes", node as usize)).collect()
                };
                let buckets: Vec<Vec<Words>> = (0..5).map(bucket).collect();
                let ends = |list: &Vec<Words>| Some((list.iter().min()?[0], list.iter().max()?[0]));
                let ends: Vec<(u32, u32)> = buckets.iter().filter_map(ends).collect();
                assert!(ends.is_sorted_by(|a, b| a.1 < b.0), "buckets of pixel {pixel} overlap: {buckets:?}");
                buckets.concat()
            }
            "stream_array" => {
                let kept: Vec<Words> =
                    (0..k).map(|index| slot(index, pixel)).take_while(|words| words[0] != EMPTY).collect();
                let rest = (kept.len()..k).map(|index| slot(index, pixel)[0]);
                assert!(rest.clone().all(|key| key == EMPTY), "pixel {pixel} has a gap: {kept:?}");
                assert!(kept.is_sorted(), "pixel {pixel} is not in order: {kept:?}");
                kept
            }
            "checked_array" => {
                let open = |words: Words| [&[words[0] & 0x3fff_ffff], &words[1..]].concat();
                let slots = (0..k).map(|index| slot(index, pixel)).filter(|words| words[0] != EMPTY);
                let kept: Vec<Words> = slots.map(open).collect();
                assert!(kept.is_sorted_by(|a, b| a < b), "pixel {pixel} is not in strict order: {kept:?}");
                kept
            }
            "exact_regions" => {
                let offsets = buffer("offsets");
                let end = offsets[pixel + 1].min(renderer.symbol("fragments").unwrap() as u32);
                (offsets[pixel]..end).map(|place| entry("entries", place as usize)).collect()
            }
            other => panic!("this test cannot read `{other}`"),
        }
    };
    let by_place: Vec<Vec<Words>> = (0..places).map(of_pixel).collect();
    let addressing = plan.selection.row("addressing").unwrap().row.key.clone();
    let pixels = (0..SIZE * SIZE).map(|pixel| {
        let mut kept = by_place[place(&addressing, pixel % SIZE, pixel / SIZE)].clone();
        kept.sort();
        kept
    });
    pixels.collect()
}

/// A parameter of the chosen rows.
fn parameter(plan: &Plan, constant: &str) -> usize {
    let found = plan.constants.iter().find(|(name, _)| name == constant);
    found.unwrap_or_else(|| panic!("no parameter `{constant}`")).1 as usize
}

/// Where the words of a pixel lie, as the heads of the templates describe it. `SIZE` is a multiple of every tile.
fn place(addressing: &str, x: u32, y: u32) -> usize {
    let tile = |width: u32, height: u32| ((y / height * (SIZE / width) + x / width) * width * height) as usize;
    match addressing {
        "linear" => (y * SIZE + x) as usize,
        "tiled" => tile(2, 8) + (y % 8 * 2 + x % 2) as usize,
        "morton" => {
            let bit = |number: u32, bit: u32| (number >> bit & 1) as usize;
            tile(8, 8) + (0..3).map(|at| bit(x, at) << (2 * at) | bit(y, at) << (2 * at + 1)).sum::<usize>()
        }
        other => panic!("this test cannot address `{other}`"),
    }
}

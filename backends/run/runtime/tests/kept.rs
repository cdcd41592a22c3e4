//! Reads the kept fragments of every pixel through the functions of the storage, and checks them against what its rows declare.
//! This file names no storage: the expectations follow from the rows' capabilities and declared hazards.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use fragbuf_checker::{FrameMemory, ReadOut};
use fragbuf_codegen::{Plan, Profile};
use fragbuf_runtime::Renderer;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Capability, Equivalence};

use crate::oracle::{Words, fragments, pixels};
use crate::quads::{Quad, SIZE};

const EMPTY: u32 = u32::MAX;

/// A device after a frame.
pub trait FrameView {
    fn plan(&self) -> &Plan;
    fn k(&self) -> Option<u32>;
    fn symbol(&self, name: &str) -> Option<u64>;
}

impl FrameView for Renderer {
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

impl FrameView for fragbuf_cpu::Device {
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

/// Returns the kept fragments of every pixel, each pixel's in ascending order of their words. `buffers`: all words by resource.
/// `quads`: the scene.
pub fn kept(frame: &dyn FrameView, buffers: &BTreeMap<String, Vec<u32>>, quads: &[Quad]) -> Vec<Vec<Words>> {
    let plan = frame.plan();
    let read_out = read_out(plan);
    let invariants = PixelInvariants::of(plan, frame.k());
    let words = |name: &str| buffers.get(name).cloned();
    // Memory may be sized for a greater k than that of the frame.
    let symbol = |name: &str| if name == "k" { frame.k().map(u64::from) } else { frame.symbol(name) };
    let mut memory = FrameMemory::new(plan, [SIZE, SIZE], symbol, words);
    let mut of_pixel = |(x, y)| {
        let seen =
            read_out.pixel(&mut memory, [x, y]).and_then(|kept| Ok((kept, read_out.bound(&mut memory, [x, y])?)));
        let (mut kept, bound) = seen.unwrap_or_else(|error| panic!("pixel {x}, {y}: {error}"));
        invariants.check(&kept, bound, fragments(quads, x, y).len(), &format!("pixel {x}, {y}"));
        kept.sort();
        kept
    };
    pixels().map(&mut of_pixel).collect()
}

/// What holds for every pixel of any scene.
struct PixelInvariants {
    /// The greatest number of kept fragments.
    most: usize,
    /// Keys ascend in the order of reading.
    is_sorted: bool,
    has_distinct_keys: bool,
    has_distinct_entries: bool,
    /// Every fragment reaches the storage, or has a key greater than the bound.
    sees_all: bool,
}

impl PixelInvariants {
    fn of(plan: &Plan, k: Option<u32>) -> Self {
        let storage = &plan.selection.row("storage").unwrap().row;
        let alike = plan.hazards.iter().map(|hazard| hazard.permits.one_of).max().unwrap_or_default();
        let has_groups = storage.keeps.as_ref().is_some_and(|kept| kept.group.is_some());
        // Rows of these axes with memory of their own reject fragments before the storage.
        let has_memory = |axis: &&str| plan.selection.row(axis).is_some_and(|chosen| !chosen.row.resources.is_empty());
        let limit = k.filter(|_| !storage.provides.contains(&Capability::KeepsAll));
        PixelInvariants {
            most: limit.map_or(usize::MAX, |k| k as usize),
            is_sorted: storage.may_provide(Capability::Sorted),
            has_distinct_keys: alike == Equivalence::Keys || has_groups,
            has_distinct_entries: matches!(alike, Equivalence::Fragments | Equivalence::Ids),
            sees_all: plan.variant.constraints.is_empty() && !["cull", "opaque"].iter().any(has_memory),
        }
    }

    fn check(&self, kept: &[Words], bound: Option<u32>, drawn: usize, at: &str) {
        assert!(kept.len() <= self.most, "{at} holds {} of {}", kept.len(), self.most);
        let keys: Vec<u32> = kept.iter().map(|words| words[0]).collect();
        assert!(!self.is_sorted || keys.is_sorted(), "{at} is not in order: {kept:?}");
        let distinct: BTreeSet<u32> = keys.iter().copied().collect();
        assert!(!self.has_distinct_keys || distinct.len() == keys.len(), "{at} holds a key twice: {kept:?}");
        let entries: BTreeSet<&Words> = kept.iter().collect();
        assert!(!self.has_distinct_entries || entries.len() == kept.len(), "{at} holds a fragment twice: {kept:?}");
        // With fewer than k fragments, any fragment may be one of the k best. With k of them, the worst key is the bound once
        // more fragments came; with exactly k the storage may have no bound yet. With k = 0 there is no worst key.
        let Some(bound) = bound.filter(|_| self.most > 0) else { return };
        assert!(kept.len() == self.most || bound == EMPTY, "{at} holds {} and is bounded by {bound:x}", kept.len());
        let worst = keys.into_iter().max().unwrap_or(0);
        assert!(bound == EMPTY || bound == worst, "{at} is bounded by {bound:x}, and its worst key is {worst:x}");
        let is_over_capacity = self.sees_all && drawn > self.most && kept.len() == self.most;
        assert!(!is_over_capacity || bound == worst, "{at} had more than {} fragments and no bound", self.most);
    }
}

/// Returns the plan's programs. The last two plans of this thread are cached, because most tests draw many frames of one plan.
fn read_out(plan: &Plan) -> Rc<ReadOut> {
    thread_local! {
        static LAST: RefCell<Vec<(Plan, Rc<ReadOut>)>> = const { RefCell::new(Vec::new()) };
    }
    LAST.with_borrow_mut(|last| {
        if let Some((_, known)) = last.iter().find(|(known, _)| known == plan) {
            return known.clone();
        }
        // Some tests alternate between two devices.
        last.truncate(1);
        let new = ReadOut::new(plan, Profile::Native, &Registry::builtin())
            .unwrap_or_else(|diagnostics| panic!("{diagnostics}"));
        last.insert(0, (plan.clone(), Rc::new(new)));
        last[0].1.clone()
    })
}

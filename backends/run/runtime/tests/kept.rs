//! What a frame left in every pixel, read through the storage's own functions, and what its rows promise of that. No storage
//! is named here: what is expected follows from what rows offer and from the hazards that they state.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::rc::Rc;

use fragbuf_checker::{FrameMemory, ReadOut};
use fragbuf_codegen::{Plan, Profile};
use fragbuf_runtime::Renderer;
use fragbuf_templates::Registry;
use fragbuf_templates::vocabulary::{Alike, Fact, Row};

use crate::oracle::{Words, pixels};
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

/// The kept fragments of every pixel, each pixel's in ascending order of their words. `buffers`: all words by resource.
pub fn kept(drawn: &dyn Drawn, buffers: &BTreeMap<String, Vec<u32>>) -> Vec<Vec<Words>> {
    let plan = drawn.plan();
    let read_out = read_out(plan);
    let promise = Promise::of(plan, drawn.k());
    let words = |name: &str| buffers.get(name).cloned();
    // Memory may be sized for a greater k than the frame was drawn with.
    let symbol = |name: &str| if name == "k" { drawn.k().map(u64::from) } else { drawn.symbol(name) };
    let mut memory = FrameMemory::new(plan, [SIZE, SIZE], symbol, words);
    let mut of_pixel = |(x, y)| {
        let seen =
            read_out.pixel(&mut memory, [x, y]).and_then(|kept| Ok((kept, read_out.bound(&mut memory, [x, y])?)));
        let (mut kept, bound) = seen.unwrap_or_else(|error| panic!("pixel {x}, {y}: {error}"));
        promise.is_kept(&kept, bound, &format!("pixel {x}, {y}"));
        kept.sort();
        kept
    };
    pixels().map(&mut of_pixel).collect()
}

/// What holds of every pixel, whatever was drawn.
struct Promise {
    most: usize,
    /// Keys ascend along a walk.
    is_sorted: bool,
    has_distinct_keys: bool,
    has_distinct_entries: bool,
}

impl Promise {
    fn of(plan: &Plan, k: Option<u32>) -> Self {
        let storage = &plan.selection.row("storage").unwrap().row;
        let alike = plan.hazards.iter().map(|hazard| hazard.permits.one_of).max().unwrap_or_default();
        let has_groups = storage.keeps.as_ref().is_some_and(|kept| kept.group.is_some());
        let limit = k.filter(|_| !storage.offers.contains(&Fact::KeepsAll));
        Promise {
            most: limit.map_or(usize::MAX, |k| k as usize),
            is_sorted: walks_in_order(storage),
            has_distinct_keys: alike == Alike::Keys || has_groups,
            has_distinct_entries: alike == Alike::Fragments,
        }
    }

    fn is_kept(&self, kept: &[Words], bound: Option<u32>, at: &str) {
        assert!(kept.len() <= self.most, "{at} holds {} of {}", kept.len(), self.most);
        let keys: Vec<u32> = kept.iter().map(|words| words[0]).collect();
        assert!(!self.is_sorted || keys.is_sorted(), "{at} is not in order: {kept:?}");
        let distinct: BTreeSet<u32> = keys.iter().copied().collect();
        assert!(!self.has_distinct_keys || distinct.len() == keys.len(), "{at} holds a key twice: {kept:?}");
        let entries: BTreeSet<&Words> = kept.iter().collect();
        assert!(!self.has_distinct_entries || entries.len() == kept.len(), "{at} holds a fragment twice: {kept:?}");
        // Until there are k, any fragment may be one of the best; then none behind the worst is. Of none there is no worst.
        let Some(bound) = bound.filter(|_| self.most > 0) else { return };
        assert!(kept.len() == self.most || bound == EMPTY, "{at} holds {} and is bounded by {bound:x}", kept.len());
        let worst = keys.into_iter().max().unwrap_or(0);
        assert!(bound == EMPTY || bound == worst, "{at} is bounded by {bound:x}, and its worst key is {worst:x}");
    }
}

/// A row whose fragments are in the order of depth where depth is the key keeps them in the order of their keys.
fn walks_in_order(storage: &Row) -> bool {
    storage.offers.contains(&Fact::Sorted) || storage.implies.iter().any(|(_, implied)| *implied == Fact::Sorted)
}

/// The plan's programs: those of the last plan on this thread are kept, because most tests draw many frames of one.
fn read_out(plan: &Plan) -> Rc<ReadOut> {
    thread_local! {
        static LAST: RefCell<Vec<(Plan, Rc<ReadOut>)>> = const { RefCell::new(Vec::new()) };
    }
    LAST.with_borrow_mut(|last| {
        if let Some((_, known)) = last.iter().find(|(known, _)| known == plan) {
            return known.clone();
        }
        // Two devices may take turns.
        last.truncate(1);
        let made =
            ReadOut::new(plan, Profile::Native, &Registry::builtin()).unwrap_or_else(|faults| panic!("{faults}"));
        last.insert(0, (plan.clone(), Rc::new(made)));
        last[0].1.clone()
    })
}

//! Axis `sync`: how concurrent fragments of the same pixel are synchronised.

use crate::vocabulary::{Access, Capability, Edit, Element, Feature, Parameter, Resource, Row, Soundness, Use};

pub(crate) fn rows() -> Vec<Row> {
    vec![none(), slot_counter(), spin_lock(), interlock(), interlock_ordered(), fixed_function()]
}

fn none() -> Row {
    Row {
        template: Some(template!("sync/none")),
        calls: vec!["storage"],
        provides: vec![Capability::Unsynchronised, Capability::SyncInShader],
        requires: vec![Capability::RaceTolerant],
        soundness: Soundness::Racy,
        ..Row::new("sync", "none", "not at all: the hazards of the storage remain", "B06 §3.1")
    }
}

fn slot_counter() -> Row {
    Row {
        template: Some(template!("sync/none")),
        calls: vec!["storage"],
        provides: vec![Capability::SyncInShader],
        requires: vec![Capability::LockFree],
        soundness: Soundness::Atomics,
        ..Row::new("sync", "slot_counter", "by the atomic operations of the storage, without a lock", "K15 §2")
    }
}

fn fixed_function() -> Row {
    Row {
        provides: vec![Capability::SyncByFixedFunction],
        requires: vec![Capability::FixedFunction],
        ..Row::new(
            "sync",
            "fixed_function",
            "by depth test, stencil test or blending, in submission order",
            "Catmull 1974; Myers & Bavoil 2007",
        )
    }
}

fn spin_lock() -> Row {
    Row {
        template: Some(template!("sync/spin_lock")),
        resources: vec![Resource::new("locks", Element::Word, "0: free, 1: taken").by("pixel", "pixels").cleared(0)],
        uses: vec![Use::new("locks", Access::Atomic)],
        calls: vec!["storage", "overflow", "counters"],
        provides: vec![Capability::MutualExclusion, Capability::SyncInShader],
        needs: vec![Feature::FragmentAtomics],
        parameters: vec![Parameter::retry_limit(
            "limit",
            "SPIN_LIMIT",
            "16384",
            (1, 1 << 24),
            "tries before a fragment times out and is counted",
        )],
        soundness: Soundness::Lock,
        ..Row::new("sync", "spin_lock", "by a lock word per pixel, with a bounded number of tries", "K15 §3.2")
    }
}

/// Fragments of one pixel run in the order of their primitives, which is the submission order; ties may then follow it.
fn interlock_ordered() -> Row {
    let any = interlock();
    Row {
        provides: vec![Capability::MutualExclusion, Capability::OrderedMutualExclusion, Capability::SyncInShader],
        needs: [any.needs.as_slice(), &[Feature::OrderedInterlock]].concat(),
        key: "interlock_ordered".to_owned(),
        summary: "by fragment shader interlock, in submission order".into(),
        ..any
    }
}

fn interlock() -> Row {
    Row {
        provides: vec![Capability::MutualExclusion, Capability::SyncInShader],
        needs: vec![Feature::Interlock, Feature::Coherent, Feature::FragmentAtomics, Feature::OwnEntryPoints],
        edits: vec![Edit::FormOfSkeleton("store".to_owned(), "ordered".to_owned())],
        soundness: Soundness::Interlock,
        ..Row::new(
            "sync",
            "interlock",
            "by fragment shader interlock, in any order",
            "Salvi 2013 (pixel sync); K15 §3.2",
        )
    }
}

//! Axis `sync`: how writers of the same pixel are kept apart.

use crate::vocabulary::{Access, Capability, Edit, Element, Fact, Parameter, Resource, Row, Soundness, Use};

pub(crate) fn rows() -> Vec<Row> {
    vec![none(), slot_counter(), spin_lock(), interlock(), interlock_ordered(), fixed_function()]
}

fn none() -> Row {
    Row {
        template: Some(template!("sync/none")),
        calls: vec!["storage"],
        offers: vec![Fact::Race, Fact::LeftToShaders],
        requires: vec![Fact::SurvivesRaces],
        soundness: Soundness::Racy,
        ..Row::new("sync", "none", "not at all: the hazards of the storage are kept", "B06 §3.1")
    }
}

fn slot_counter() -> Row {
    Row {
        template: Some(template!("sync/none")),
        calls: vec!["storage"],
        offers: vec![Fact::LeftToShaders],
        requires: vec![Fact::OwnAtomics],
        soundness: Soundness::Atomics,
        ..Row::new(
            "sync",
            "slot_counter",
            "by the storage's own counters: every fragment gets a place of its own",
            "K15 §2",
        )
    }
}

fn fixed_function() -> Row {
    Row {
        offers: vec![Fact::LeftToTests],
        requires: vec![Fact::FixedFunction],
        ..Row::new(
            "sync",
            "fixed_function",
            "by depth test, stencil or blending, in the order of submission",
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
        offers: vec![Fact::Critical, Fact::LeftToShaders],
        needs: vec![Capability::FragmentAtomics],
        parameters: vec![Parameter::number(
            "limit",
            "SPIN_LIMIT",
            "4096",
            (1, 1 << 24),
            "tries before a fragment is given up and counted",
        )],
        soundness: Soundness::Lock,
        ..Row::new("sync", "spin_lock", "by a lock word per pixel, tried a bounded number of times", "K15 §3.2")
    }
}

/// Writers of one pixel come in the order of their primitives: the order of submission, which ties may then follow.
fn interlock_ordered() -> Row {
    let any = interlock();
    Row {
        offers: vec![Fact::Critical, Fact::OrderedCritical, Fact::LeftToShaders],
        needs: [any.needs.as_slice(), &[Capability::OrderedInterlock]].concat(),
        key: "interlock_ordered".to_owned(),
        summary: "by fragment shader interlock, in the order of submission".into(),
        ..any
    }
}

fn interlock() -> Row {
    Row {
        offers: vec![Fact::Critical, Fact::LeftToShaders],
        needs: vec![
            Capability::Interlock,
            Capability::Coherent,
            Capability::FragmentAtomics,
            Capability::OwnEntryPoints,
        ],
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

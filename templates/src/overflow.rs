//! Axis `overflow`: what happens to a fragment that is not kept.

use crate::conditions::{ADD_COLOR, color, depth_key};
use crate::vocabulary::{
    Access, BlendedEntries, Capability, Element, Feature, Hazard, Merges, Permits, PromisedKeys, Resource, Row,
    Template, Text, Use,
};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            provides: vec![Capability::DropsDisplaced],
            ..row("drop", "it is dropped and counted", "", template!("overflow/drop"))
        },
        Row {
            resources: vec![
                Resource::new(
                    "tail",
                    Element::Word,
                    "sums over the fragments that were not kept: r, g, b, alpha, opacity",
                )
                .by("part", "5")
                .by("pixel", "pixels")
                .cleared(0),
            ],
            uses: vec![Use::new("tail", Access::Atomic)],
            calls: vec!["counters", "samples"],
            requires: vec![Capability::ReportsWholeFragments, Capability::OneResolve],
            conditions: vec![color(ADD_COLOR)],
            needs: vec![Feature::FragmentAtomics],
            ..row(
                "weighted_tail",
                "it contributes to a mean colour behind the kept fragments; the same for every order of arrival",
                "Maule et al. 2013; McGuire & Bavoil 2013",
                template!("overflow/weighted_tail"),
            )
        },
        tail_blend(),
        merge_last(),
        merge_closest(),
        Row {
            resources: vec![
                Resource::new("failed", Element::Word, "1: a fragment did not fit, or timed out at a lock")
                    .cleared(0)
                    .over_iterations(),
            ],
            uses: vec![Use::new("failed", Access::Atomic)],
            needs: vec![Feature::FragmentAtomics],
            ..row(
                "fail",
                "the whole frame is magenta if a fragment does not fit or times out at a lock",
                "",
                template!("overflow/fail"),
            )
        },
    ]
}

/// Blends into plain words of a pixel inside the critical section.
fn tail_blend() -> Row {
    let tail = Resource::new("blended", Element::Word, "the premultiplied colour of the fragments not kept, as floats");
    Row {
        resources: vec![tail.by("channel", "4").by("pixel", "pixels").cleared(0)],
        uses: vec![Use::new("blended", Access::Coherent)],
        requires: vec![
            Capability::ReportsWholeFragments,
            Capability::DisplacesUnderLock,
            Capability::MutualExclusion,
            Capability::NoCull,
        ],
        conditions: vec![color(ADD_COLOR)],
        needs: vec![Feature::FragmentAtomics],
        calls: vec!["counters", "samples"],
        hazards: vec![Hazard::new(
            "order-dependent",
            "fragments that are not kept are blended in the order of arrival, as if later ones were nearer",
            Permits::ORDER_DEPENDENT,
        )],
        ..row(
            "tail_blend",
            "it is blended behind the kept fragments, over earlier lost ones: approximate, depends on arrival order",
            "Maule et al. 2013; nvpro (vk_order_independent_transparency)",
            template!("overflow/tail_blend"),
        )
    }
}

fn merge_last() -> Row {
    Row {
        merges: Some(MERGED_FARTHEST),
        hazards: vec![Hazard::new(
            "merged-farthest",
            "the colour of the farthest kept fragment is blended over those of lost fragments, in an order that \
             depends on arrival",
            Permits::NOTHING,
        )],
        ..merging(
            Capability::CanReplace,
            row(
                "merge_last",
                "it is merged with the farthest kept fragment: transmittance does not depend on arrival order",
                "Salvi & Vaidyanathan 2014 (MLAB)",
                template!("overflow/merge_last"),
            ),
        )
    }
}

fn merge_closest() -> Row {
    Row {
        merges: Some(MERGED_NEIGHBOURS),
        hazards: vec![Hazard::new(
            "merged-neighbours",
            "if a pixel has more than k fragments, the two closest in depth are merged, with the depth and the other \
             attributes of the nearer; which two depends on the order of arrival",
            Permits::NOTHING,
        )],
        ..merging(
            Capability::OrderedSlots,
            row(
                "merge_closest",
                "of it and the kept fragments, the two closest in depth are merged: transmittance does not change",
                "Jouppi & Chang 1999 (Z3)",
                template!("overflow/merge_closest"),
            ),
        )
    }
}

/// The merging of lost fragments into the farthest entry. Their order of blending depends on arrival.
pub(crate) const MERGED_FARTHEST: Merges =
    Merges { attribute: Text::Borrowed("color"), keys: PromisedKeys::All, blended: BlendedEntries::Worst };

/// The merging of two neighbours: the nearer is kept, with the colours of both. The nearest of all is always kept.
pub(crate) const MERGED_NEIGHBOURS: Merges =
    Merges { attribute: Text::Borrowed("color"), keys: PromisedKeys::Best, blended: BlendedEntries::Any };

/// Adds what all rows share that merge colours of kept fragments; `slots` is the capability they require of the
/// storage.
fn merging(slots: Capability, row: Row) -> Row {
    Row {
        requires: vec![
            Capability::ReportsWholeFragments,
            Capability::DisplacesUnderLock,
            slots,
            // Two fragments that cover different samples cannot be merged.
            Capability::OneSample,
            Capability::MutualExclusion,
            Capability::NoCull,
        ],
        conditions: vec![color(ADD_COLOR), depth_key()],
        needs: vec![Feature::FragmentAtomics],
        calls: vec!["counters", "storage"],
        ..row
    }
}

fn row(key: &str, summary: &'static str, paper: &'static str, template: Template) -> Row {
    Row { template: Some(template), calls: vec!["counters"], ..Row::new("overflow", key, summary, paper) }
}

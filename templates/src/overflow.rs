//! Axis `overflow`: what becomes of a fragment that finds no place.

use crate::conditions::{ADD_COLOR, color, depth_key};
use crate::vocabulary::{
    Access, Blended, Capability, Element, Fact, Hazard, Merges, Permits, PromisedKeys, Resource, Row, Template, Text,
    Use,
};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        row("drop", "it is dropped, and counted", "", template!("overflow/drop")),
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
            requires: vec![Fact::LosesWhole, Fact::OneResolve],
            conditions: vec![color(ADD_COLOR)],
            needs: vec![Capability::FragmentAtomics],
            ..row(
                "weighted_tail",
                "it counts in a mean colour behind what is kept; the same for every order of arrival",
                "Maule et al. 2013; McGuire & Bavoil 2013",
                template!("overflow/weighted_tail"),
            )
        },
        tail_blend(),
        merge_last(),
        merge_closest(),
        Row {
            resources: vec![
                Resource::new("failed", Element::Word, "1: a fragment found no room, or a lock was not free")
                    .cleared(0),
            ],
            uses: vec![Use::new("failed", Access::Atomic)],
            needs: vec![Capability::FragmentAtomics],
            ..row(
                "fail",
                "the whole frame is magenta if one found no room, or a lock was not free in time",
                "",
                template!("overflow/fail"),
            )
        },
    ]
}

/// Plain words of a pixel, read and written by turns.
fn tail_blend() -> Row {
    let tail = Resource::new("blended", Element::Word, "the premultiplied colour of the fragments not kept, as floats");
    Row {
        resources: vec![tail.by("channel", "4").by("pixel", "pixels").cleared(0)],
        uses: vec![Use::new("blended", Access::Coherent)],
        requires: vec![Fact::LosesWhole, Fact::DisplacesInTurn, Fact::Critical, Fact::CullsNothing],
        conditions: vec![color(ADD_COLOR)],
        needs: vec![Capability::FragmentAtomics],
        calls: vec!["counters", "samples"],
        hazards: vec![Hazard::new(
            "shows-arrival",
            "what is not kept is blended in the order of arrival, as if whatever comes later lay before the rest",
            Permits::SHOWS_ARRIVAL,
        )],
        ..row(
            "tail_blend",
            "it is blended behind what is kept, over those that came before it: approximate, by the order of arrival",
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
            "the colour of the farthest kept fragment is its own over those of fragments that are not kept, in an order \
             that depends on arrival",
            Permits::NOTHING,
        )],
        ..merging(
            Fact::CanReplace,
            row(
                "merge_last",
                "it becomes one with the farthest that is kept: the pixel's transmittance stays, whatever the order",
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
            "where there are more than k, the two nearest to each other in depth become one, with the depth and the other \
             attributes of the nearer; which two depends on arrival",
            Permits::NOTHING,
        )],
        ..merging(
            Fact::OrderedSlots,
            row(
                "merge_closest",
                "of it and those that are kept, the two closest in depth become one: the pixel's transmittance stays",
                "Jouppi & Chang 1999 (Z3)",
                template!("overflow/merge_closest"),
            ),
        )
    }
}

/// Colours of fragments that are not kept go into the farthest entry: which of them lies before which depends on arrival.
pub(crate) const MERGED_FARTHEST: Merges =
    Merges { attribute: Text::Borrowed("color"), keys: PromisedKeys::All, blended: Blended::Worst };

/// Of two neighbours the nearer stays, with the colours of both; the nearest of all is never gone.
pub(crate) const MERGED_NEIGHBOURS: Merges =
    Merges { attribute: Text::Borrowed("color"), keys: PromisedKeys::Best, blended: Blended::Any };

/// What rows share that merge colours of kept fragments; `slots` is what they need of the storage.
fn merging(slots: Fact, row: Row) -> Row {
    Row {
        requires: vec![
            Fact::LosesWhole,
            Fact::DisplacesInTurn,
            slots,
            // Two fragments that cover different samples are not one.
            Fact::OneSample,
            Fact::Critical,
            Fact::CullsNothing,
        ],
        conditions: vec![color(ADD_COLOR), depth_key()],
        needs: vec![Capability::FragmentAtomics],
        calls: vec!["counters", "storage"],
        ..row
    }
}

fn row(key: &str, summary: &'static str, paper: &'static str, template: Template) -> Row {
    Row { template: Some(template), calls: vec!["counters"], ..Row::new("overflow", key, summary, paper) }
}

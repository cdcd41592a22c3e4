//! How much room a case has, and how many of its fragments may find none.
//!
//! In: a subject, the fragments of a case. Out: rooms, each with the range of losses that is right. The range is one number
//! wherever the order of arrival does not matter. Where fragments can be turned away before they ask for room it does:
//! then fragments that fewer than k others precede whatever the order ask in any case, and once one has found no room,
//! those behind it may ask too.

use std::ops::RangeInclusive;

use fragbuf_codegen::SymbolId;
use fragbuf_frame::{Room as Reserve, Sizing, Values, values};
use fragbuf_templates::vocabulary::Fact;

use crate::fragments::Fragment;
use crate::frame::WIDTH;
use crate::subject::Subject;

/// Room for the fragments of a case.
#[derive(Clone, Debug)]
pub(crate) struct Room {
    pub(crate) values: Values,
    /// The most that host steps allocate.
    pub(crate) reserved: Option<u32>,
    /// How many fragments of the pixel may find none.
    pub(crate) short: RangeInclusive<u32>,
    /// Fragments of the neighbour that find none.
    pub(crate) neighbours_lost: u32,
    /// Whether earlier geometry passes did not see the last new fragment.
    pub(crate) has_unseen: bool,
    /// In words; empty where there is enough.
    pub(crate) what: &'static str,
}

/// The fragments that ask for room.
pub(crate) struct Asking<'a> {
    pub(crate) prior: &'a [Fragment],
    pub(crate) new: &'a [Fragment],
    pub(crate) k: Option<u32>,
    /// Whether fragments may be given up, so that those behind them ask.
    pub(crate) may_give_up: bool,
    /// The pixel that they come to.
    pub(crate) pixel: u32,
}

impl Asking<'_> {
    fn total(&self) -> u32 {
        (self.prior.len() + self.new.len()) as u32
    }

    /// Fragments that ask if nobody is turned away but behind k others; and how many of them do in any order. Prior ones,
    /// which come one after the other, do or do not. Of the others those do that k fragments never precede, and as many as
    /// are kept.
    fn askers(&self) -> (u32, u32) {
        let k = self.k.unwrap_or(u32::MAX) as usize;
        let ahead = |of: &Fragment, others: &[Fragment]| others.iter().filter(|other| other.words <= of.words).count();
        let prior = (0..self.prior.len()).filter(|at| ahead(&self.prior[*at], &self.prior[..*at]) < k).count();
        let new = |least: usize| {
            let asks = |of: &&Fragment| ahead(of, self.prior) + least * (ahead(of, self.new) - 1) < k;
            self.new.iter().filter(asks).count()
        };
        let kept = k.min(self.prior.len() + self.new.len());
        ((prior + new(0)) as u32, kept.max(prior + new(1)) as u32)
    }
}

/// Every room that a case is tried in. `is_behind`: a geometry pass has come before the one under test.
pub(crate) fn rooms(subject: &Subject, asking: &Asking<'_>, is_behind: bool) -> Result<Vec<Room>, String> {
    let plan = &subject.plan;
    let is_counted = plan.frame.decisions().flat_map(|decision| &decision.sets).any(|id| *id != SymbolId::K);
    let has_slots = plan.has_field(SymbolId::N);
    let is_pooled = plan.has_field(SymbolId::FRAGMENTS) && !is_counted;
    let mut rooms = match (is_counted, has_slots, is_pooled) {
        (true, _, _) => counted(subject, asking, is_behind),
        (_, true, _) => slots(subject, asking),
        (_, _, true) => pool(subject, asking),
        _ => Ok(vec![enough(subject, asking.k, Sizing::Exact)?]),
    }?;
    if subject.is_handed_the_best() {
        // Those beyond the k best may be turned away before they ask for room.
        let beyond = asking.total().saturating_sub(asking.k.unwrap_or(u32::MAX));
        for room in &mut rooms {
            room.short = room.short.start().saturating_sub(beyond)..=*room.short.end();
        }
    }
    Ok(rooms)
}

/// Room for fragments that are not there, such as are asked for the words that they become.
pub(crate) fn plenty(subject: &Subject) -> Result<Values, String> {
    Ok(enough(subject, Some(1), Sizing::Reserve(Reserve::Fragments(16)))?.values)
}

fn enough(subject: &Subject, k: Option<u32>, sizing: Sizing) -> Result<Room, String> {
    let (mut values, _) = values(&subject.plan, (WIDTH, 1), sizing).map_err(|error| error.to_string())?;
    if let Some(k) = k {
        values.set(SymbolId::K, k.into());
    }
    Ok(Room { values, reserved: None, short: 0..=0, neighbours_lost: 0, has_unseen: false, what: "" })
}

/// Room that the host makes for what a pass has counted: all there is, too little, and one fragment that was not counted.
fn counted(subject: &Subject, asking: &Asking<'_>, is_behind: bool) -> Result<Vec<Room>, String> {
    let room = enough(subject, asking.k, Sizing::Exact)?;
    let mut rooms = vec![room.clone()];
    // Where the host decides k too, what is too little for the fragments that it keeps is known only then.
    let sets_k = subject.plan.frame.decisions().any(|decision| decision.sets.contains(&SymbolId::K));
    if !is_behind || sets_k {
        return Ok(rooms);
    }
    let (total, k) = (asking.total(), asking.k.unwrap_or(u32::MAX));
    let wanted = total.min(k);
    // Where writers take turns they may need the whole room, and none be kept without it.
    let short = 1..=if total <= k { 1 } else { total };
    let what = "room reserved for one less";
    if asking.pixel == 0 {
        // The room of the neighbour, who comes behind, is gone first.
        let neighbours_lost = 1;
        rooms.push(Room { reserved: Some(wanted), neighbours_lost, what: "no room for the neighbour", ..room.clone() });
        rooms.push(Room { reserved: Some(wanted - 1), short, neighbours_lost, what, ..room.clone() });
    } else {
        rooms.push(Room { reserved: Some(wanted), short, what, ..room.clone() });
        let what = "no room but the neighbour's";
        rooms.push(Room { reserved: Some(1), short: total..=total, what, ..room.clone() });
    }
    // Among more than k of them it makes no difference who was counted.
    let short = u32::from(total - 1 <= k);
    rooms.push(Room { has_unseen: true, short: short..=short, what: "one not seen by the pass before", ..room });
    Ok(rooms)
}

/// Slots of each pixel's own: the neighbour has as many, and room enough.
fn slots(subject: &Subject, asking: &Asking<'_>) -> Result<Vec<Room>, String> {
    let room = |slots: u32| enough(subject, asking.k, Sizing::Reserve(Reserve::Fragments(WIDTH * slots)));
    let total = asking.total();
    Ok(vec![room(total)?, Room { short: 1..=1, what: "room for one less", ..room(total - 1)? }])
}

/// One pool for all pixels: room for everybody, for those that ask, and for one less than ask in any case.
fn pool(subject: &Subject, asking: &Asking<'_>) -> Result<Vec<Room>, String> {
    let room = |nodes: u32| enough(subject, asking.k, Sizing::Reserve(Reserve::Fragments(nodes + WIDTH - 1)));
    let total = asking.total();
    let spares = subject.plan.selection.offers().contains(&Fact::SparesRoom);
    let (most, least) = match (subject.keeps_best(), spares) {
        (false, _) => (total, total),
        (true, true) => asking.askers(),
        (true, false) => (total, total.min(asking.k.unwrap_or(u32::MAX))),
    };
    let mut rooms = vec![room(total)?];
    if let Some(page) = page(subject, &rooms[0])? {
        // Who finds that another has made room leaks what it has taken.
        let ample = room(total + page * asking.new.len() as u32)?;
        let short = total.saturating_sub(page);
        let what = "no room but each pixel's own";
        let none = enough(subject, asking.k, Sizing::Reserve(Reserve::Fragments(0)))?;
        return Ok(vec![ample, Room { short: short..=short, what, ..none }]);
    }
    if most < total && !asking.may_give_up {
        rooms.push(Room { what: "room for those that ask", ..room(most)? });
    }
    let nodes = least - 1;
    let short = least - nodes..=total - nodes;
    rooms.push(Room { short, what: "room for one less than ask", ..room(nodes)? });
    Ok(rooms)
}

/// Fragments of the pieces in which room is given, where every pixel has one of its own even if there is room for none.
fn page(subject: &Subject, room: &Room) -> Result<Option<u32>, String> {
    let words = |fragments: u32| {
        let values = room.values.with(SymbolId::FRAGMENTS, fragments.into());
        let mut pooled = subject.plan.resources.iter().filter(|planned| planned.words.mentions(SymbolId::FRAGMENTS));
        let words = pooled.by_ref().map(|planned| values.evaluate(&planned.words, &planned.resource.name));
        words.sum::<Result<u64, _>>().map_err(|error| error.to_string())
    };
    let least = words(0)?;
    if least == 0 {
        return Ok(None);
    }
    for fragments in 1..=LARGEST_PAGE {
        if words(fragments)? > least {
            return Ok(Some(fragments));
        }
    }
    Err("the storage gives room in pieces of too many fragments".to_owned())
}

const LARGEST_PAGE: u32 = 1 << 10;

//! The fragments that a stream storage emits: each once, and of those that the pixel holds the nearest first.
//!
//! Input: the fragments of a pixel in order of arrival; the new ones may arrive in any order. Output: every colour that the
//! pixel may emit, with the number of fragments that arrived out of order. The storage is modelled here independently of
//! its template. The resolve row's own function composites two neighbours onto a colour.

use fragbuf_interpreter::{Exit, Machine};

use crate::kept_set::KeptSet;
use crate::memory::Memory;
use crate::programs::StreamPrograms;
use crate::sequential::{run_alone, set_arguments};

/// The most new fragments for which the possible colours are enumerated.
const MOST_COLORED: usize = 4;

/// What a pixel may have emitted.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Emitted {
    /// Fragments that arrived after a farther one had been emitted.
    pub(crate) out_of_order: u32,
    /// Premultiplied, as floats; `None`: not enumerated.
    pub(crate) color: Option<Vec<u32>>,
}

/// The model of a stream storage. The order of arrival changes only what it emits, not what it holds.
pub(crate) struct Stream<'a> {
    pub(crate) programs: &'a StreamPrograms,
    pub(crate) kept_set: &'a KeptSet,
    /// The most fragments that the pixel holds.
    pub(crate) most: usize,
}

/// A pixel after some fragments.
struct Arrived {
    count: usize,
    kept: Vec<Vec<u32>>,
    /// The key of the farthest fragment that was emitted; 0 if none was.
    farthest_emitted: u32,
}

impl Stream<'_> {
    /// Returns what may have been emitted when `prior` have arrived in order, and `new` in any order; by the number of new
    /// fragments that were dropped.
    pub(crate) fn emitted(
        &self,
        (prior, new): (&[Vec<u32>], &[Vec<u32>]),
        memory: &mut Memory,
    ) -> Result<Vec<Vec<Emitted>>, String> {
        let color = (new.len() <= MOST_COLORED).then(|| vec![0; 4]);
        let mut first = Emitted { out_of_order: 0, color };
        for at in 0..prior.len() {
            first = self.after(&first, &self.arrived(prior[..at].to_vec()), &prior[at], memory)?;
        }
        // Indexed by the set of new fragments that have arrived, because what the pixel holds depends on that set only.
        let mut by_set: Vec<Vec<Emitted>> = vec![Vec::new(); 1 << new.len()];
        by_set[0].push(first);
        for set in 0..by_set.len() {
            let mut arrived = prior.to_vec();
            arrived.extend(members(set, new).map(|(_, fragment)| fragment.clone()));
            let arrived = self.arrived(arrived);
            let missing = !set & (by_set.len() - 1);
            for (at, fragment) in members(missing, new) {
                for emitted in by_set[set].clone() {
                    let next = self.after(&emitted, &arrived, fragment, memory)?;
                    let known = &mut by_set[set | 1 << at];
                    if !known.contains(&next) {
                        known.push(next);
                    }
                }
            }
        }
        let mut by_dropped: Vec<Vec<Emitted>> = vec![Vec::new(); new.len() + 1];
        for (set, emitted) in by_set.into_iter().enumerate() {
            by_dropped[new.len() - set.count_ones() as usize].extend(emitted);
        }
        Ok(by_dropped)
    }

    /// Returns what the pixel holds, and has emitted, after these fragments.
    fn arrived(&self, mut fragments: Vec<Vec<u32>>) -> Arrived {
        let kept = self.kept_set.kept_of(fragments.clone());
        fragments.sort();
        let farthest_emitted = fragments.len().checked_sub(kept.len() + 1).map_or(0, |at| fragments[at][0]);
        Arrived { count: fragments.len(), kept, farthest_emitted }
    }

    /// Returns what has been emitted when `fragment` has arrived after `arrived`.
    fn after(
        &self,
        emitted: &Emitted,
        arrived: &Arrived,
        fragment: &[u32],
        memory: &mut Memory,
    ) -> Result<Emitted, String> {
        if arrived.count < self.most {
            return Ok(emitted.clone());
        }
        let mut nearest = arrived.kept.clone();
        nearest.push(fragment.to_vec());
        nearest.sort();
        let is_out_of_order = nearest[0][0] < arrived.farthest_emitted;
        let color = match &emitted.color {
            Some(color) => Some(self.composited(color, &nearest[0], &nearest[1], memory)?),
            None => None,
        };
        Ok(Emitted { out_of_order: emitted.out_of_order + u32::from(is_out_of_order), color })
    }

    fn composited(&self, color: &[u32], front: &[u32], back: &[u32], memory: &mut Memory) -> Result<Vec<u32>, String> {
        let mut machine = Machine::new(&self.programs.composite);
        set_arguments(&mut machine, &[color, front, back].concat());
        match run_alone(&mut machine, memory)? {
            Exit::Ended => Ok(machine.result().to_vec()),
            _ => Err("compositing two fragments does not end".to_owned()),
        }
    }
}

fn members(set: usize, of: &[Vec<u32>]) -> impl Iterator<Item = (usize, &Vec<u32>)> {
    of.iter().enumerate().filter(move |(at, _)| set >> at & 1 == 1)
}

//! What leaves a storage that hands fragments on: each fragment once, nearest first of those that are there.
//!
//! In: the fragments of a pixel in the order in which they came, those of them that may come in any. Out: every colour that
//! they may leave, and how many of them came too late for it. The storage is stated here anew: what two neighbours add to a
//! colour is the resolve's affair, and asked of it.

use fragbuf_interpreter::{Exit, Machine, Program};

use crate::fragments::set_all;
use crate::frame::{Memory, run_alone};
use crate::promise::Promise;

/// Of more fragments at once the colours are beyond counting.
const COLORED: usize = 4;

/// What may have left a pixel.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Left {
    /// Fragments that came after one behind them had left.
    pub(crate) late: u32,
    /// Premultiplied, as floats; `None`: not followed.
    pub(crate) color: Option<Vec<u32>>,
}

/// The programs that a stream is asked with.
#[derive(Debug)]
pub(crate) struct StreamPrograms {
    /// The colour of what has left a pixel.
    pub(crate) streamed: Program,
    /// A colour with what lies from one fragment to the next behind it.
    pub(crate) composite: Program,
}

/// A pixel on its way: in which order its fragments came decides nothing but what has left.
pub(crate) struct Stream<'a> {
    pub(crate) programs: &'a StreamPrograms,
    pub(crate) promise: &'a Promise,
    /// The most that stay.
    pub(crate) most: usize,
}

impl Stream<'_> {
    /// What may have left where `prior` have come one after the other, and of `new` all but `gone` in any order.
    pub(crate) fn left(
        &self,
        (prior, new): (&[Vec<u32>], &[Vec<u32>]),
        gone: usize,
        memory: &mut Memory,
    ) -> Result<Vec<Left>, String> {
        let color = (new.len() <= COLORED).then(|| vec![0; 4]);
        let mut first = Left { late: 0, color };
        for at in 0..prior.len() {
            first = self.after(&first, &prior[..at], &prior[at], memory)?;
        }
        // By the set of those that have come: what stays follows from it.
        let mut by_set: Vec<Vec<Left>> = vec![Vec::new(); 1 << new.len()];
        by_set[0].push(first);
        for set in 0..by_set.len() {
            let mut there = prior.to_vec();
            there.extend(members(set, new).map(|(_, fragment)| fragment.clone()));
            let missing = !set & (by_set.len() - 1);
            for (at, fragment) in members(missing, new) {
                for left in by_set[set].clone() {
                    let next = self.after(&left, &there, fragment, memory)?;
                    let known = &mut by_set[set | 1 << at];
                    if !known.contains(&next) {
                        known.push(next);
                    }
                }
            }
        }
        let is_end = |set: &usize| set.count_ones() as usize + gone == new.len();
        Ok((0..by_set.len()).filter(is_end).flat_map(|set| by_set[set].clone()).collect())
    }

    /// What has left when `fragment` has come to `there`.
    fn after(&self, left: &Left, there: &[Vec<u32>], fragment: &[u32], memory: &mut Memory) -> Result<Left, String> {
        if there.len() < self.most {
            return Ok(left.clone());
        }
        let stays = self.promise.best_of(there.to_vec());
        let mut all = there.to_vec();
        all.sort();
        let farthest = all.len().checked_sub(stays.len() + 1).map_or(0, |at| all[at][0]);
        let mut nearest = stays;
        nearest.push(fragment.to_vec());
        nearest.sort();
        let is_late = nearest[0][0] < farthest;
        let color = match &left.color {
            Some(color) => Some(self.composited(color, &nearest[0], &nearest[1], memory)?),
            None => None,
        };
        Ok(Left { late: left.late + u32::from(is_late), color })
    }

    fn composited(&self, color: &[u32], front: &[u32], back: &[u32], memory: &mut Memory) -> Result<Vec<u32>, String> {
        let mut machine = Machine::new(&self.programs.composite);
        set_all(&mut machine, &[color, front, back].concat());
        match run_alone(&mut machine, memory)? {
            Exit::Ended => Ok(machine.result().to_vec()),
            _ => Err("compositing two fragments never ends".to_owned()),
        }
    }
}

fn members(set: usize, of: &[Vec<u32>]) -> impl Iterator<Item = (usize, &Vec<u32>)> {
    of.iter().enumerate().filter(move |(at, _)| set >> at & 1 == 1)
}

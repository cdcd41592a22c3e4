//! The graph of visited states, by number: how each was reached, and which cannot reach a final state.
//!
//! Input: states and steps, as a search finds them. Output: the schedule of a state, and the states from which the fragments
//! cannot all end.

use crate::search::Step;

/// The graph.
#[derive(Debug, Default)]
pub(crate) struct StateGraph {
    /// Per state, the state before it and the step from there.
    parents: Vec<(u32, u8, u32)>,
    /// Every step: from state, to state, and whether it changes anything but the status of its fragment.
    edges: Vec<(u32, u32, bool)>,
    final_states: Vec<u32>,
}

/// States from which no steps lead to a final state.
#[derive(Debug)]
pub(crate) struct Endless {
    /// The first that was visited.
    pub(crate) first: u32,
    /// Those from which no steps change anything but the status of their fragments, in the order of visits.
    pub(crate) idle: Vec<u32>,
}

const NO_PARENT: u32 = u32::MAX;

impl StateGraph {
    /// Returns the number of states.
    pub(crate) fn count(&self) -> u32 {
        self.parents.len() as u32
    }

    pub(crate) fn push(&mut self, from: Option<(u32, Step)>) {
        let (parent, (fragment, choice)) = from.unwrap_or((NO_PARENT, (0, 0)));
        self.parents.push((parent, fragment as u8, choice));
    }

    pub(crate) fn connect(&mut self, from: u32, to: u32, has_effect: bool) {
        self.edges.push((from, to, has_effect));
    }

    /// Records that a state is final.
    pub(crate) fn end(&mut self, state: u32) {
        self.final_states.push(state);
    }

    /// Returns the states from which the fragments cannot all end. `None`: there is none.
    pub(crate) fn endless(&mut self) -> Option<Endless> {
        self.edges.sort_unstable_by_key(|(_, to, _)| *to);
        let terminates = self.leading_to(self.final_states.clone());
        let first = terminates.iter().position(|terminates| !terminates)? as u32;
        let is_endless = |state: &u32| !terminates[*state as usize];
        let effects = self.edges.iter().filter(|(from, _, has_effect)| *has_effect && is_endless(from));
        let changes = self.leading_to(effects.map(|(from, ..)| *from).collect());
        let idle = (0..self.count()).filter(|state| is_endless(state) && !changes[*state as usize]).collect();
        Some(Endless { first, idle })
    }

    /// Returns, per state, whether steps lead from it to one of these states. Edges are sorted by their ends.
    fn leading_to(&self, mut states: Vec<u32>) -> Vec<bool> {
        let mut leads = vec![false; self.parents.len()];
        states.iter().for_each(|state| leads[*state as usize] = true);
        while let Some(state) = states.pop() {
            let first = self.edges.partition_point(|(_, to, _)| *to < state);
            for (from, ..) in self.edges[first..].iter().take_while(|(_, to, _)| *to == state) {
                if !std::mem::replace(&mut leads[*from as usize], true) {
                    states.push(*from);
                }
            }
        }
        leads
    }

    /// Returns the steps that lead to a state.
    pub(crate) fn path(&self, mut number: u32) -> Vec<Step> {
        let mut steps = Vec::new();
        while let Some(&(parent, fragment, choice)) = self.parents.get(number as usize) {
            if parent == NO_PARENT {
                break;
            }
            steps.push((usize::from(fragment), choice));
            number = parent;
        }
        steps.reverse();
        steps
    }
}

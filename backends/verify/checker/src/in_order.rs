//! Runs numbered tasks on several threads, and hands over their results in the order of their numbers.
//!
//! The calling thread runs tasks too, so a check makes progress even if every thread of the pool is busy.

use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::channel;

/// Returns how many tasks run at a time.
pub(crate) fn threads() -> usize {
    rayon::current_num_threads()
}

/// Runs the tasks 0 to `count` - 1. `record` receives each number, first without a result when the task is the oldest that has not
/// been recorded, then with it. If `record` breaks, no other task begins.
pub(crate) fn run_in_order<T: Send>(
    count: usize,
    run: impl Fn(usize) -> T + Sync,
    mut record: impl FnMut(usize, Option<T>) -> ControlFlow<()>,
) {
    let next = AtomicUsize::new(0);
    let take = || Some(next.fetch_add(1, Ordering::Relaxed)).filter(|number| *number < count);
    let (sender, receiver) = channel();
    rayon::in_place_scope(|scope| {
        for _ in 1..threads().min(count) {
            let (sender, take, run) = (sender.clone(), &take, &run);
            scope.spawn(move |_| {
                while let Some(number) = take() {
                    if sender.send((number, run(number))).is_err() {
                        return;
                    }
                }
            });
        }
        drop(sender);
        let mut results = BTreeMap::new();
        for number in 0..count {
            let mut end = record(number, None);
            while end.is_continue() {
                results.extend(receiver.try_iter());
                if let Some(result) = results.remove(&number) {
                    end = record(number, Some(result));
                    break;
                }
                let (other, result) = match take() {
                    Some(other) => (other, run(other)),
                    None => match receiver.recv() {
                        Ok(received) => received,
                        // A task has panicked, and the scope passes that on.
                        Err(_) => return,
                    },
                };
                results.insert(other, result);
            }
            if end.is_break() {
                next.store(count, Ordering::Relaxed);
                return;
            }
        }
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_recorded_in_order_up_to_the_one_that_ends_it() {
        let mut recorded = Vec::new();
        run_in_order(
            100,
            |number| number * number,
            |number, result| {
                recorded.extend(result);
                if number == 40 && result.is_some() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) }
            },
        );
        assert_eq!(recorded, (0..=40).map(|number| number * number).collect::<Vec<_>>());
    }
}

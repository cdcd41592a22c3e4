// Counts every event. All pixels increment the same few words: for statistics, not for timing.

fn count_event(counter: u32) {
    counters_atomic_add(counter, 1u);
}

fn count_loss(counter: u32) {
    counters_atomic_add(counter, 1u);
}

fn count_losses(counter: u32, number: u32) {
    counters_atomic_add(counter, number);
}

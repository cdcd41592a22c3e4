// Losses are counted, other events are not: a frame that loses nothing never touches the counters.

/// Events that are no loss are not counted here.
fn count_event(counter: u32) {}

fn count_loss(counter: u32) {
    counters_atomic_add(counter, 1u);
}

fn count_losses(counter: u32, number: u32) {
    if number > 0u {
        counters_atomic_add(counter, number);
    }
}

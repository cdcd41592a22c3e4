// Counts losses and no other events: a frame without losses never accesses the counters. A fragment that better ones
// displace is no loss, because the description limits how many a pixel keeps.

/// Does nothing: an event is not a loss.
fn count_event(counter: u32) {}

fn count_loss(counter: u32) {
    if counter != DISPLACED {
        counters_atomic_add(counter, 1u);
    }
}

fn count_losses(counter: u32, number: u32) {
    if number > 0u {
        counters_atomic_add(counter, number);
    }
}

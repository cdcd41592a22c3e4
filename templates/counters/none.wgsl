// Nothing is counted.

/// Not counted here.
fn count_event(counter: u32) {}

/// Not counted here.
fn count_loss(counter: u32) {}

/// Not counted here.
fn count_losses(counter: u32, number: u32) {}

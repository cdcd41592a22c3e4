// Counts nothing.

/// Does nothing.
fn count_event(counter: u32) {}

/// Does nothing.
fn count_loss(counter: u32) {}

/// Does nothing.
fn count_losses(counter: u32, number: u32) {}

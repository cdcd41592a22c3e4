//! Axis `host`: what the host decides between two submissions. No template: the row is a function.

use crate::vocabulary::{HostCall, HostFunction, Row};

pub(crate) fn rows() -> Vec<Row> {
    vec![Row {
        host: Some(HostFunction(allocate)),
        ..Row::new("host", "allocate", "the symbols are the words read: memory for as many as were counted", "")
    }]
}

/// Memory for as many as were counted.
fn allocate(call: &HostCall<'_>) -> Vec<u64> {
    call.reads.iter().flat_map(|words| words.iter().copied().map(u64::from)).collect()
}

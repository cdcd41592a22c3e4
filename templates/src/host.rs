//! Axis `host`: decisions of the host between two submissions. These rows have a function and no template.

use crate::vocabulary::{HostCall, HostFunction, Row};

pub(crate) fn rows() -> Vec<Row> {
    vec![Row {
        host: Some(HostFunction(allocate)),
        ..Row::new("host", "allocate", "sets the symbols to the words read: memory for the counted fragments", "")
    }]
}

/// Returns the words read, so that memory is allocated for the counted fragments.
fn allocate(call: &HostCall<'_>) -> Vec<u64> {
    call.reads.iter().flat_map(|words| words.iter().copied().map(u64::from)).collect()
}

//! Axis `host`: decisions of the host between two submissions. These rows have a function and no template.

use crate::importance::share_k;
use crate::prediction::predict_k;
use crate::vocabulary::{HostCall, HostFunction, Row};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row {
            host: Some(HostFunction(allocate)),
            ..Row::new("host", "allocate", "sets the symbols to the words read: memory for the counted fragments", "")
        },
        Row {
            host: Some(HostFunction(predict_k)),
            ..Row::new(
                "host",
                "predict_k",
                "sets k by a histogram, a budget and a hit ratio",
                "K15 §4.2, Eq. 4-7, corrected",
            )
        },
        Row {
            host: Some(HostFunction(share_k)),
            ..Row::new("host", "share_k", "sets k by a budget and the importance of pixels", "Vasilakis et al. 2017")
        },
    ]
}

/// Returns the words read, so that memory is allocated for the counted fragments.
fn allocate(call: &HostCall<'_>) -> Result<Vec<u64>, String> {
    Ok(call.reads.iter().flat_map(|words| words.iter().copied().map(u64::from)).collect())
}

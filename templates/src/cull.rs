//! Axis `cull`: which fragments are turned away before they reach the storage.

use crate::vocabulary::{Fact, Row};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row { template: Some(template!("cull/none")), ..Row::new("cull", "none", "no fragment is turned away", "") },
        Row {
            template: Some(template!("cull/early")),
            calls: vec!["storage"],
            requires: vec![Fact::BoundAnyInstant],
            ..Row::new("cull", "early", "fragments worse than the worst kept one, tested before the lock", "K15 §3.2")
        },
    ]
}

//! Axis `select`: when the k best are selected, if a description limits the fragments kept.

use crate::conditions::limited;
use crate::vocabulary::{Capability, Edit, Row};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row::new("select", "on_store", "when fragments are stored", ""),
        Row {
            requires: vec![Capability::KeepsAll],
            conditions: vec![limited()],
            provides: vec![Capability::SelectsBest],
            edits: vec![Edit::SetSkeleton("resolve".to_owned(), "resolve_selected".to_owned())],
            ..Row::new(
                "select",
                "on_resolve",
                "in the resolve pass, among all fragments that the storage kept",
                "K15 §2 (KB-AB); Yu et al. 2012",
            )
        },
    ]
}

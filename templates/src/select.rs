//! Axis `select`: when the k best are chosen, where a description keeps no more.

use crate::conditions::limited;
use crate::vocabulary::{Edit, Fact, Row};

pub(crate) fn rows() -> Vec<Row> {
    vec![
        Row::new("select", "on_store", "as fragments are stored", ""),
        Row {
            requires: vec![Fact::KeepsAll],
            conditions: vec![limited()],
            offers: vec![Fact::SelectsBest],
            edits: vec![Edit::SetSkeleton("resolve".to_owned(), "resolve_selected".to_owned())],
            ..Row::new(
                "select",
                "on_resolve",
                "by the resolve pass, among all that the storage kept",
                "K15 §2 (KB-AB); Yu et al. 2012",
            )
        },
    ]
}

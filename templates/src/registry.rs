//! All rows, and the look-ups that checking and planning need. Order is the order of the tables: it decides the order of
//! everything that is printed.

use crate::vocabulary::{Axis, Fact, Row, Technique, Template};
use crate::{
    addressing, counters, cull, host, opaque, overflow, pass, resolve, samples, select, shared, sort, storage, sync,
    technique, ties,
};

/// Rows by axis, techniques, and shared texts.
#[derive(Clone, Debug, PartialEq)]
pub struct Registry {
    axes: Vec<Axis>,
    rows: Vec<Row>,
    techniques: Vec<Technique>,
    shared: Vec<Template>,
}

/// The axes, in the order in which their edits apply.
const AXES: [Axis; 14] = [
    axis("storage", "where the fragments of a pixel are kept", None),
    axis("sync", "how writers of the same pixel are kept apart", Some("none")),
    axis("cull", "which fragments are turned away before they reach the storage", Some("none")),
    axis("opaque", "what becomes of fragments behind opaque surfaces", Some("none")),
    axis("select", "when the k best are chosen", Some("on_store")),
    axis("overflow", "what becomes of a fragment that finds no place", Some("drop")),
    axis("ties", "which of two fragments with equal keys is better", Some("payload")),
    axis("addressing", "where a pixel's words lie in memory", Some("linear")),
    axis("counters", "what is counted while the passes run", Some("losses")),
    axis(
        "samples",
        "how many samples a pixel has, and what is kept of a fragment that covers some of them",
        Some("one"),
    ),
    axis("sort", "how the kept fragments are put in the order of depth", Some("insertion")),
    axis("resolve", "what is made of the kept fragments", Some("over")),
    Axis { key: "pass", summary: "the entry points of a pass", default: None, chosen: false },
    Axis { key: "host", summary: "what the host decides between two submissions", default: None, chosen: false },
];

const fn axis(key: &'static str, summary: &'static str, default: Option<&'static str>) -> Axis {
    Axis { key, summary, default, chosen: true }
}

impl Registry {
    /// The value on the axis `resolve` that stands for the description's own closure.
    pub const CLOSURE: &str = "closure";

    /// The axis on which a closure stands for a value.
    pub const CLOSURE_AXIS: &str = "resolve";

    /// Every row of fragbuf's own.
    pub fn builtin() -> Self {
        let rows = [
            storage::rows(),
            sync::rows(),
            cull::rows(),
            opaque::rows(),
            select::rows(),
            overflow::rows(),
            ties::rows(),
            addressing::rows(),
            counters::rows(),
            samples::rows(),
            sort::rows(),
            resolve::rows(),
            pass::rows(),
            host::rows(),
        ];
        Registry {
            axes: AXES.to_vec(),
            rows: rows.into_iter().flatten().collect(),
            techniques: technique::techniques(),
            shared: shared::TEMPLATES.to_vec(),
        }
    }

    /// The same with one row more, or another in place of the row of that axis and key.
    pub fn with(mut self, row: Row) -> Self {
        self.rows.retain(|old| (&old.axis, &old.key) != (&row.axis, &row.key));
        self.rows.push(row);
        self
    }

    /// The same with one technique more, or another in place of the technique of that key.
    pub fn with_technique(mut self, technique: Technique) -> Self {
        self.techniques.retain(|old| old.key != technique.key);
        self.techniques.push(technique);
        self
    }

    /// The same with one axis more, before the axis `before` in the order of edits; at the end where there is none.
    pub fn with_axis(mut self, axis: Axis, before: &str) -> Self {
        let index = self.axes.iter().position(|other| other.key == before).unwrap_or(self.axes.len());
        self.axes.insert(index, axis);
        self
    }

    /// The axes, in the order in which their edits apply.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// The axis of this name.
    pub fn axis(&self, key: &str) -> Option<&Axis> {
        self.axes.iter().find(|axis| axis.key == key)
    }

    /// Every row of every axis.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// The rows of one axis.
    pub fn rows_of<'a>(&'a self, axis: &'a str) -> impl Iterator<Item = &'a Row> {
        self.rows.iter().filter(move |row| row.axis == axis)
    }

    /// One row.
    pub fn row(&self, axis: &str, key: &str) -> Option<&Row> {
        self.rows.iter().find(|row| row.axis == axis && row.key == key)
    }

    /// The rows that offer `fact`, on axes that a user chooses on.
    pub fn offering(&self, fact: Fact) -> impl Iterator<Item = &Row> {
        self.rows
            .iter()
            .filter(move |row| row.offers.contains(&fact) && self.axis(&row.axis).is_some_and(|axis| axis.chosen))
    }

    /// The techniques.
    pub fn techniques(&self) -> &[Technique] {
        &self.techniques
    }

    /// One technique.
    pub fn technique(&self, key: &str) -> Option<&Technique> {
        self.techniques.iter().find(|technique| technique.key == key)
    }

    /// Texts that any template may call.
    pub fn shared(&self) -> &[Template] {
        &self.shared
    }
}

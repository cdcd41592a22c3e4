//! All rows, and the look-ups that checking and planning need. Everything that is printed is in the order of these
//! tables.

use crate::vocabulary::{Axis, Capability, Row, Technique, Template};
use crate::{
    addressing, allocation, counters, cull, host, objects, opaque, overflow, pass, peeling, resolve, samples, select,
    shared, sort, storage, sync, technique, ties,
};

/// The registry: axes, rows, techniques and shared templates.
#[derive(Clone, Debug, PartialEq)]
pub struct Registry {
    axes: Vec<Axis>,
    rows: Vec<Row>,
    techniques: Vec<Technique>,
    shared: Vec<Template>,
}

/// The axes, in the order in which their edits apply.
const AXES: [Axis; 17] = [
    axis("storage", "where the fragments of a pixel are stored", None),
    axis("sync", "how concurrent fragments of the same pixel are synchronised", Some("none")),
    axis("cull", "which fragments are rejected before they reach the storage", Some("none")),
    axis("opaque", "how opaque surfaces occlude fragments", Some("none")),
    axis("select", "when the k best are selected", Some("on_store")),
    axis("peeling", "whether the scene is drawn again for the fragments that are not kept", Some("none")),
    axis("objects", "which objects of the scene are drawn", Some("all")),
    axis("allocation", "how many fragments per pixel memory is allocated for", Some("described")),
    axis("overflow", "what happens to a fragment that is not kept", Some("drop")),
    axis("ties", "which of two fragments with equal keys is better", Some("payload")),
    axis("addressing", "how pixels map to memory", Some("linear")),
    axis("counters", "what is counted while the passes run", Some("losses")),
    axis("samples", "how many samples a pixel has, and whether fragments store coverage", Some("one")),
    axis("sort", "how the kept fragments are sorted by depth", Some("insertion")),
    axis("resolve", "what is computed from the kept fragments", Some("over")),
    Axis { key: "pass", summary: "the entry points of a pass", default: None, chosen: false },
    Axis { key: "host", summary: "decisions of the host between two submissions", default: None, chosen: false },
];

const fn axis(key: &'static str, summary: &'static str, default: Option<&'static str>) -> Axis {
    Axis { key, summary, default, chosen: true }
}

impl Registry {
    /// The value on the axis `resolve` that stands for the closure of the description.
    pub const CLOSURE: &str = resolve::CLOSURE;

    /// The value on the axis `resolve` that stands for a closure over two neighbouring fragments.
    pub const BETWEEN: &str = resolve::BETWEEN;

    /// The value on the axis `resolve` that stands for a closure that reads images, which are computed first.
    pub const STEPS: &str = resolve::STEPS;

    /// The axis on which a closure is a value.
    pub const CLOSURE_AXIS: &str = "resolve";

    /// Whether a row stands for closures of the description, so that a description cannot choose it by name.
    pub fn is_of_closures(row: &Row) -> bool {
        row.axis == Self::CLOSURE_AXIS && [Self::CLOSURE, Self::BETWEEN, Self::STEPS].contains(&row.key.as_str())
    }

    /// Makes the registry of all rows of fragbuf.
    pub fn builtin() -> Self {
        let rows = [
            storage::rows(),
            sync::rows(),
            cull::rows(),
            opaque::rows(),
            select::rows(),
            peeling::rows(),
            objects::rows(),
            allocation::rows(),
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

    /// Adds a row. It replaces the row of the same axis and key.
    pub fn with(mut self, row: Row) -> Self {
        self.rows.retain(|old| (&old.axis, &old.key) != (&row.axis, &row.key));
        self.rows.push(row);
        self
    }

    /// Adds a technique. It replaces the technique of the same key.
    pub fn with_technique(mut self, technique: Technique) -> Self {
        self.techniques.retain(|old| old.key != technique.key);
        self.techniques.push(technique);
        self
    }

    /// Adds an axis before the axis `before` in the order of edits, or at the end if there is no such axis.
    pub fn with_axis(mut self, axis: Axis, before: &str) -> Self {
        let index = self.axes.iter().position(|other| other.key == before).unwrap_or(self.axes.len());
        self.axes.insert(index, axis);
        self
    }

    /// Returns the axes, in the order in which their edits apply.
    pub fn axes(&self) -> &[Axis] {
        &self.axes
    }

    /// Returns the axis of this name.
    pub fn axis(&self, key: &str) -> Option<&Axis> {
        self.axes.iter().find(|axis| axis.key == key)
    }

    /// Returns every row of every axis.
    pub fn rows(&self) -> &[Row] {
        &self.rows
    }

    /// Returns the rows of one axis.
    pub fn rows_of<'a>(&'a self, axis: &'a str) -> impl Iterator<Item = &'a Row> {
        self.rows.iter().filter(move |row| row.axis == axis)
    }

    /// Returns the row of this axis and key, or former key.
    pub fn row(&self, axis: &str, key: &str) -> Option<&Row> {
        self.rows.iter().find(|row| row.axis == axis && (row.key == key || row.former_key == Some(key)))
    }

    /// Returns the rows that provide `capability`, on axes whose value a description chooses.
    pub fn providers_of(&self, capability: Capability) -> impl Iterator<Item = &Row> {
        self.rows.iter().filter(move |row| {
            let is_chosen = self.axis(&row.axis).is_some_and(|axis| axis.chosen) && !Self::is_of_closures(row);
            row.provides.contains(&capability) && is_chosen
        })
    }

    /// Returns the techniques.
    pub fn techniques(&self) -> &[Technique] {
        &self.techniques
    }

    /// Returns the technique of this key.
    pub fn technique(&self, key: &str) -> Option<&Technique> {
        self.techniques.iter().find(|technique| technique.key == key)
    }

    /// Returns the templates that any template may call.
    pub fn shared(&self) -> &[Template] {
        &self.shared
    }
}

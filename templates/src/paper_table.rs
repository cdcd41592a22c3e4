//! Tables in which papers state properties of techniques, for comparison with those of the plans.

/// A property of a technique, which the plan has too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Property {
    /// How often the scene is drawn at most.
    GeometryPasses,
    /// Whether the image depends on the order in which fragments arrive: primitives should be sorted.
    PrimitivesInOrder,
    /// The same, apart from fragments of equal depths.
    PrimitivesByDepth,
    /// When fragments are sorted: `store` or `resolve`.
    FragmentsSorted,
    /// Whether the resolve pass sorts fragments.
    ResolveSorts,
    /// The greatest k.
    MostK,
    /// Possible artefacts of the image.
    Artifacts,
    /// Words per pixel.
    Words,
    /// Whether memory use is independent of the scene.
    FixedMemory,
    /// How many fragments of a pixel an iteration of the outermost loop stores; without a loop, a frame.
    FragmentsPerIteration,
    /// How often the scene is drawn in an iteration of the outermost loop; without a loop, in a frame.
    PassesPerIteration,
    /// How often the scene is drawn, by the depths D of a pixel and their fragments c.
    TotalPasses,
    /// Whether fragments of equal depths are all kept.
    KeepsEqualDepths,
    /// The fragments kept over those generated, R_h.
    HitRatio,
}

/// A column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Column {
    /// The heading in files and sentences.
    pub heading: &'static str,
    /// What the plan's value is.
    pub property: Property,
}

/// A table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PaperTable {
    /// The columns, in order.
    pub columns: &'static [Column],
    /// The rows, in the paper's order.
    pub rows: &'static [PaperRow],
}

/// One row of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PaperRow {
    /// The key of the technique.
    pub key: &'static str,
    /// The paper's name for it.
    pub name: &'static str,
    /// The values, in the order of the columns. Columns past the last have no value of the paper; `?` and `–`:
    /// illegible. Several values are separated by `; `: those of a technique without and with attributes packed.
    pub cells: &'static [&'static str],
    /// How many iterations a frame takes, as a formula: D depths in the deepest pixel, each of c fragments; empty: the
    /// plan has no loop that a condition ends.
    pub iterations: &'static str,
    /// Why the plan has another value, by property.
    pub reasons: &'static [(Property, &'static str)],
}

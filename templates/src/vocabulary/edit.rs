//! Changes that rows of other axes make to the steps of a storage. Plans apply them.

use super::{DepthState, Formula, Implementation, Repeat, Resource, Samples, State, Step, Use};

/// A change that a row makes to the steps of the storage. Edits apply in the order of the axes.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// Inserts steps before all others.
    First(Vec<Step>),
    /// Inserts steps before the pass of this name.
    Before(String, Vec<Step>),
    /// Inserts steps after the pass of this name.
    After(String, Vec<Step>),
    /// Sets the fixed-function state of the pass of this name.
    SetState(String, State),
    /// Sets the depth test of the pass of this name, and leaves its other state.
    SetDepth(String, DepthState),
    /// Adds this depth test to every geometry pass. An error if a geometry pass has a depth test.
    TestDepth(DepthState),
    /// Sets the skeleton of the pass of this name.
    SetSkeleton(String, String),
    /// Selects another form of the skeleton of the pass of this name: (`store`, `ordered`) changes `x` to `x_ordered`.
    FormOfSkeleton(String, String),
    /// Adds a resource.
    AddResource(Resource),
    /// Adds a use to the pass of this name.
    AddUse(String, Use),
    /// Lets the passes over the scene of the loop with this query draw only the objects that are visible in it.
    DrawVisible(String),
    /// Moves all steps up to the pass of this name into a loop, before the steps of its body.
    Repeat(String, Repeat),
    /// Splits a pass into several.
    Split(Split),
    /// Inserts a pass for each image of the description before the pass of this name: that pass with the form `image` of its skeleton,
    /// which writes a buffer in place of targets. Later passes can read the buffer.
    Images(String),
    /// Sets the samples of every pass over the scene.
    Samples(Samples),
}

/// The division of a pass into several that run in order, each with its own constants.
#[derive(Clone, Debug, PartialEq)]
pub struct Split {
    /// The pass.
    pub name: String,
    /// The number of copies, over the constants of the chosen rows.
    pub copies: Formula,
    /// The generated constants of each copy, over `copy` (from 0), `copies` and the constants of the chosen rows. The
    /// value of the first constant is the suffix of the copy's name: `resolve_8`, `resolve_16`, ….
    pub constants: Vec<(String, Formula)>,
    /// Other implementations of contracts in all copies but the last.
    pub before_last: Vec<Implementation>,
}

//! What the rows of other axes change in a storage's steps. In: what rows say. Out: nothing; plans apply it.

use super::{DepthState, Formula, Resource, Role, Samples, State, Step};

/// A change that the row of another axis makes to a technique's steps. Edits apply in the order of the axes.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// New steps before an anchor.
    Before(String, Vec<Step>),
    /// New steps after an anchor.
    After(String, Vec<Step>),
    /// The fixed-function state of an anchor.
    SetState(String, State),
    /// Every geometry pass tests the depth of its fragments so, whatever its anchor. Refused where one tests already.
    TestDepth(DepthState),
    /// The skeleton of an anchor.
    SetSkeleton(String, String),
    /// Another form of the skeleton that an anchor has: (`store`, `ordered`) makes `x_ordered` of `x`.
    FormOfSkeleton(String, String),
    /// The technique keeps one resource more.
    AddResource(Resource),
    /// One pass becomes several.
    Split(Split),
    /// Every pass over the scene has these samples.
    Samples(Samples),
}

/// One pass becomes several, one after the other, each with constants of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Split {
    /// The pass.
    pub anchor: String,
    /// How many there are, over the constants of the chosen rows.
    pub copies: Formula,
    /// Generated constants of each, over `copy` (from 0), `copies` and the constants of the chosen rows. The value of the first
    /// tells the anchors apart: `resolve_8`, `resolve_16`, ….
    pub constants: Vec<(String, Formula)>,
    /// Who fulfils contracts otherwise in every one but the last.
    pub before_last: Vec<Role>,
}

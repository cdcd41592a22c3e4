//! What the rows of other axes change in a storage's steps. In: what rows say. Out: nothing; plans apply it.

use super::{Classes, DepthState, Repeat, Resource, Role, Samples, State, Step, Use};

/// A change that the row of another axis makes to a technique's steps. Edits apply in the order of the axes.
#[derive(Clone, Debug, PartialEq)]
pub enum Edit {
    /// New steps before an anchor.
    Before(String, Vec<Step>),
    /// New steps after an anchor.
    After(String, Vec<Step>),
    /// The steps from the first anchor to the second become the body of a loop.
    Around(String, String, Repeat),
    /// The fixed-function state of an anchor.
    SetState(String, State),
    /// Every geometry pass tests the depth of its fragments so, whatever its anchor. Refused where one tests already.
    TestDepth(DepthState),
    /// The skeleton of an anchor.
    SetSkeleton(String, String),
    /// Another form of the skeleton that an anchor has: (`store`, `ordered`) makes `x_ordered` of `x`.
    FormOfSkeleton(String, String),
    /// A contract of an anchor, bound to an instance.
    SetRole(String, Role),
    /// A pass touches one resource more.
    AddUse(String, Use),
    /// The technique keeps one resource more.
    AddResource(Resource),
    /// A pass is repeated for classes of pixels.
    Classes(Classes),
    /// Every pass over the scene has these samples.
    Samples(Samples),
}

//! The types that a row, and so a plan, is made of.
//!
//! Rows are data. If these types cannot express a pass, a resource or a legality rule, extend the types: code never
//! compares a key.

mod capability;
mod condition;
mod dimension;
mod edit;
mod feature;
mod formula;
mod formula_error;
mod hazard;
mod host;
mod names;
mod pass;
mod polynomial;
mod reference;
mod resource;
mod row;
mod state;
mod symbol;
mod technique;

/// A string that is built in or from a user's file.
pub type Text = std::borrow::Cow<'static, str>;

pub use capability::Capability;
pub use condition::{Condition, DescriptionValues};
pub use dimension::TextureDimension;
pub use edit::{Edit, Split};
pub use feature::Feature;
pub use formula::{Expression, Formula, apply};
pub use formula_error::{FormulaError, Limit};
pub use hazard::Hazard;
pub use host::{BytesOf, Host, HostCall, HostFunction, Read, Words};
pub use pass::{
    Access, Implementation, Instance, InstanceMemory, Kind, Loads, Objects, Pass, Repeat, Step, Until, Use,
};
pub use polynomial::Polynomial;
pub use reference::{
    BlendedEntries, Equivalence, KEY_SYMBOLS, KeptFragments, Merges, Permits, PromisedKeys, Side, Tearing,
};
pub use resource::{Element, Extent, Init, Lifetime, Resource, TextureFormat};
pub use row::{
    Axis, Definition, ImplicitAttribute, Parameter, ParameterType, Row, RowItem, RowItemSpan, Soundness, Template,
    TieBreak,
};
pub use state::{Blend, ColorTarget, Compare, Coverage, DepthState, Samples, State, StencilOperation, StencilState};
pub use symbol::{BindingTime, SYMBOLS, Setter, Symbol, is_reserved_in_formulas};
pub use technique::{KeepDefault, Technique};

//! What a row, and so a plan, can say.
//!
//! Rows are data: a pass, a resource or a legality rule that cannot be said in these words is a reason to widen the words,
//! never to compare a key in code.

mod capability;
mod condition;
mod edit;
mod fact;
mod formula;
mod formula_error;
mod hazard;
mod host;
mod pass;
mod polynomial;
mod reference;
mod resource;
mod row;
mod state;
mod symbol;
mod technique;
mod words;

/// A text that a row includes, or that a user's file gave.
pub type Text = std::borrow::Cow<'static, str>;

pub use capability::Capability;
pub use condition::{Condition, Given};
pub use edit::{Edit, Split};
pub use fact::Fact;
pub use formula::{Expression, Formula, apply, is_word_of_formulas};
pub use formula_error::{FormulaError, Limit};
pub use hazard::Hazard;
pub use host::{Host, HostCall, HostFunction, Read, Words};
pub use pass::{Access, Instance, Kind, Loads, Memory, Objects, Pass, Repeat, Role, Step, Until, Use};
pub use polynomial::Polynomial;
pub use reference::{Alike, Blended, KEY_SYMBOLS, Kept, Merges, Permits, PromisedKeys, Side, Torn};
pub use resource::{Element, Extent, Init, Life, Resource, TextureFormat};
pub use row::{Axis, Carried, Definition, Order, Parameter, Place, Row, Soundness, Takes, Template, Written};
pub use state::{Blend, Compare, Coverage, DepthState, Samples, State, StencilOperation, StencilState, Target};
pub use symbol::{SYMBOLS, SetBy, Symbol, When};
pub use technique::{KeepDefault, Technique};

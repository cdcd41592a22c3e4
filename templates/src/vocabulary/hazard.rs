//! Hazards: what can go wrong by design. The name and description are for people; the permits are for the checker.

use super::{Capability, Permits, Text};

/// Something that can go wrong by design and that a row declares.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hazard {
    /// The name, for people.
    pub name: Text,
    /// What happens.
    pub description: Text,
    /// What a pixel may then hold. The checker accepts this and nothing else.
    pub permits: Permits,
    /// The hazard exists only if no chosen row provides this capability.
    pub unless: Option<Capability>,
}

impl Hazard {
    /// Makes a hazard that no capability prevents.
    pub fn new(name: impl Into<Text>, description: impl Into<Text>, permits: Permits) -> Self {
        Hazard { name: name.into(), description: description.into(), permits, unless: None }
    }

    /// Limits the hazard to combinations in which no row provides `capability`.
    pub fn unless(self, capability: Capability) -> Self {
        Hazard { unless: Some(capability), ..self }
    }
}

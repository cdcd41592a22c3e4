//! What can go wrong by design. In: what rows say. Out: hazards, whose names are for people and whose permits are for checks.

use super::{Fact, Permits, Text};

/// What can go wrong by design, and is kept.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Hazard {
    /// Its name, for people.
    pub name: Text,
    /// What happens.
    pub what: Text,
    /// What a pixel may hold then; a check lets it do this and nothing else.
    pub permits: Permits,
    /// The hazard exists only while this is not offered.
    pub unless: Option<Fact>,
}

impl Hazard {
    /// One that nothing prevents.
    pub fn new(name: impl Into<Text>, what: impl Into<Text>, permits: Permits) -> Self {
        Hazard { name: name.into(), what: what.into(), permits, unless: None }
    }

    /// The same, where nothing offers `fact`.
    pub fn unless(self, fact: Fact) -> Self {
        Hazard { unless: Some(fact), ..self }
    }
}

//! A pass for pixels of few fragments, and others for those of more. In: what rows say. Out: nothing; plans repeat the pass.

use super::Role;

/// One pass becomes several, for pixels of few and of many fragments: the constant takes the values `least`, twice that,
/// and so on below its own, and its own at last. In each pass the constants `CLASS_ABOVE` and `CLASS_MOST` say which pixels
/// it serves, by their fragments: those of more than the class before holds, and no more than its own; the last serves all
/// others. Anchors become `resolve_8`, `resolve_16`, ….
#[derive(Clone, Debug, PartialEq)]
pub struct Classes {
    /// The pass.
    pub anchor: String,
    /// The generated constant.
    pub constant: String,
    /// Its least value.
    pub least: u32,
    /// Who fulfils contracts otherwise in every pass but the last.
    pub before_last: Vec<Role>,
}

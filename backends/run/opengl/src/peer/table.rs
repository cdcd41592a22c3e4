//! The descriptions of peers: one file per technique of a project.

/// A project whose shaders are compared with ours.
#[derive(Clone, Copy, Debug)]
pub struct Project {
    /// Its short name.
    pub name: &'static str,
    /// Its paper.
    pub paper: &'static str,
    /// Its repository on GitHub, and the commit that the corrections are for.
    pub source: &'static str,
    /// Texts that [`super::Description::parse`] reads.
    pub descriptions: &'static [&'static str],
}

/// The projects.
pub const PROJECTS: [Project; 1] = [Project {
    name: "MFR",
    paper: "Vasilakis, Vardis & Papaioannou 2020",
    source: "cgaueb/MFR at f5ca734",
    descriptions: &[
        include_str!("../../peers/mfr/kb_ps.json"),
        include_str!("../../peers/mfr/kb_ll.json"),
        include_str!("../../peers/mfr/kplus_array.json"),
        include_str!("../../peers/mfr/kplus_heap.json"),
        include_str!("../../peers/mfr/ab_sb.json"),
        include_str!("../../peers/mfr/kb_ab_ll.json"),
        include_str!("../../peers/mfr/ab_array.json"),
        include_str!("../../peers/mfr/ab_ll.json"),
        include_str!("../../peers/mfr/ab_ll_bun.json"),
        include_str!("../../peers/mfr/kb_mdt32.json"),
    ],
}];

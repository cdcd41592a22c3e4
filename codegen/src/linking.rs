//! Parameters of linking.

/// The parameters of linking.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Linking {
    /// The WGSL features that the source may use.
    pub profile: Profile,
    /// Programs or modules.
    pub form: Form,
    /// Prefix of every name except entry points, so that two buffers can share a shader.
    pub prefix: String,
    /// The bind group of all declared resources.
    pub group: u32,
}

/// The WGSL features that a source may use.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Profile {
    /// The WGSL standard, as browsers accept it.
    Portable,
    /// Also naga's extensions, such as coherent buffers.
    Native,
}

/// The use of a source.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Entry points for every pass.
    Program,
    /// Geometry passes as functions for the caller's shader; the other passes with entry points.
    Module,
}

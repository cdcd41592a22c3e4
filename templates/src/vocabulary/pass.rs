//! Steps of a frame: passes, loops, and operations between passes.

use super::{Blend, ColorTarget, Formula, Host, State};

/// One step of a frame, in order.
#[allow(clippy::large_enum_variant, reason = "a plan has a dozen steps, and most are passes")]
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// A draw or dispatch.
    Pass(Pass),
    /// Sets every word of a resource.
    Clear {
        /// The resource.
        resource: String,
        /// The word.
        value: u32,
    },
    /// Copies a resource to another of the same size.
    Copy {
        /// The source.
        from: String,
        /// The destination.
        to: String,
    },
    /// Exchanges the memory of two resources, without a copy.
    Swap(String, String),
    /// Repeats a body.
    Repeat(Repeat),
    /// Calls a host function. The frame waits for the words that the function reads.
    Host(Host),
}

/// A loop over steps. Inside, the symbol `iteration` counts from 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Repeat {
    /// The steps to repeat.
    pub body: Vec<Step>,
    /// When the loop ends.
    pub until: Until,
    /// The limit of iterations. Reaching it before the loop ends is counted.
    pub at_most: Formula,
    /// Whether every iteration begins with cleared memory: the resources of the lifetime `Frame` that its passes use.
    pub restarts: bool,
}

impl Repeat {
    /// Makes a loop over `body` until `until`, at most `at_most` times. Memory keeps its content from one iteration to the next.
    pub fn new(body: Vec<Step>, until: Until, at_most: impl Into<Formula>) -> Self {
        Repeat { body, until, at_most: at_most.into(), restarts: false }
    }
}

/// When a loop ends. A device that does not wait for the condition runs further iterations, whose passes may draw or not, while their clears,
/// copies and exchanges happen: they must change nothing that a step after the loop reads.
#[derive(Clone, Debug, PartialEq)]
pub enum Until {
    /// After this many iterations.
    Times(Formula),
    /// When this resource of one word is zero after an iteration.
    WordIsZero(String),
    /// When no sample passed in the pass with this name.
    NoSamples(String),
}

/// One draw or dispatch.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    /// The name in edits, manifests and files.
    pub name: String,
    /// What is drawn or dispatched.
    pub kind: Kind,
    /// The template with the entry points: a key of the axis `pass`.
    pub skeleton: String,
    /// Implementations of contracts that differ from the variant's choice on the axis of that name.
    pub implementations: Vec<Implementation>,
    /// Generated constants of this pass.
    pub constants: Vec<(String, u32)>,
    /// The resources that it accesses, and how.
    pub uses: Vec<Use>,
    /// Fixed-function state.
    pub state: State,
    /// The objects that a geometry pass draws.
    pub objects: Objects,
}

/// What a pass draws or dispatches.
#[derive(Clone, Debug, PartialEq)]
pub enum Kind {
    /// The caller's scene.
    Geometry,
    /// One triangle over the whole frame.
    Fullscreen,
    /// Workgroups.
    Compute {
        /// The numbers of workgroups along x, y and z.
        groups: [Formula; 3],
    },
}

/// Which objects a geometry pass draws.
#[derive(Clone, Debug, PartialEq)]
pub enum Objects {
    /// All of them.
    All,
    /// The bounding box of each, in an occlusion query. Dropped objects are not queried again.
    Boxes,
    /// The objects whose box passed the last occlusion query of the pass with this name in the frame; before the first
    /// query, all. A box that intersects the near plane passes. Objects that fail are dropped until the frame ends.
    Visible(String),
}

/// A contract and the template instance that implements it.
#[derive(Clone, Debug, PartialEq)]
pub struct Implementation {
    /// The contract, by the name of its axis.
    pub contract: String,
    /// The instance.
    pub instance: Instance,
}

/// A template instance in a program. Two instances of one template have different names.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// The row.
    pub row: String,
    /// The name of the instance. It replaces the contract's name in exported names and is the prefix of private names.
    /// An instance with the name of its contract keeps the names of the template.
    pub name: String,
    /// The memory that it accesses.
    pub memory: InstanceMemory,
}

/// The memory that an instance accesses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InstanceMemory {
    /// The resources of the row, with the instance's name as prefix.
    Own,
    /// The memory of the pass's storage, whose template defines functions with the names of the row's accessors.
    Delegated,
}

/// The access of a pass to a resource. It decides the declared type of the resource in the pass.
#[derive(Clone, Debug, PartialEq)]
pub struct Use {
    /// The resource.
    pub resource: String,
    /// The kind of access.
    pub access: Access,
    /// The required strength of loads.
    pub loads: Loads,
    /// The access if the selection provides mutual exclusion, and otherwise `access`.
    pub exclusive: Option<Access>,
}

/// Kinds of access to a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Read only.
    Read,
    /// Reads and writes, never of one word by two concurrent invocations.
    Plain,
    /// Atomic operations.
    Atomic,
    /// Reads and writes inside the critical section of a pixel: coherent if the target supports it, else atomic.
    Coherent,
    /// Like `Coherent`, but words that `<name>_publish` stores may also be read outside of the critical section, by `<name>_hint`.
    /// Only these two are atomic where a target can mix both: `<name>_load` and `<name>_store` are plain accesses of a coherent word.
    Hinted,
    /// Bound as a render target.
    Attachment,
    /// Read as a texture.
    Sampled,
    /// Read as the arguments of an indirect draw or dispatch.
    Indirect,
}

/// The required strength of loads of an atomic resource on a target without atomic loads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loads {
    /// As strong as an atomic load.
    Exact,
    /// A hint, or repeated inside the critical section: a plain load of a volatile word is sufficient.
    Rechecked,
}

impl Pass {
    /// Makes a geometry pass.
    pub fn geometry(name: &str, skeleton: &str) -> Self {
        Self::new(name, Kind::Geometry, skeleton)
    }

    /// Makes a pass over the whole frame.
    pub fn fullscreen(name: &str, skeleton: &str) -> Self {
        Self::new(name, Kind::Fullscreen, skeleton)
    }

    /// Makes a compute pass of `x` × `y` workgroups.
    pub fn compute(name: &str, skeleton: &str, x: impl Into<Formula>, y: impl Into<Formula>) -> Self {
        Self::new(name, Kind::Compute { groups: [x.into(), y.into(), Formula::from("1")] }, skeleton)
    }

    fn new(name: &str, kind: Kind, skeleton: &str) -> Self {
        Pass {
            name: name.to_owned(),
            kind,
            skeleton: skeleton.to_owned(),
            implementations: Vec::new(),
            constants: Vec::new(),
            uses: Vec::new(),
            state: State::default(),
            objects: Objects::All,
        }
    }

    /// Adds a use of `resource` by `access`.
    pub fn uses(mut self, resource: &str, access: Access) -> Self {
        self.uses.push(Use::new(resource, access));
        self
    }

    /// Adds a use of `resource` by `access`, or by `exclusive` if the selection provides mutual exclusion.
    pub fn uses_exclusively(mut self, resource: &str, access: Access, exclusive: Access) -> Self {
        self.uses.push(Use { exclusive: Some(exclusive), ..Use::new(resource, access) });
        self
    }

    /// Adds an atomic use of `resource` whose loads are hints, or are repeated inside the critical section.
    pub fn uses_rechecked(mut self, resource: &str) -> Self {
        self.uses.push(Use::rechecked(resource));
        self
    }

    /// Binds `contract` to the row `row` under the name `name`.
    pub fn implementation(mut self, contract: &str, row: &str, name: &str) -> Self {
        let instance = Instance { row: row.to_owned(), name: name.to_owned(), memory: InstanceMemory::Own };
        self.implementations.push(Implementation { contract: contract.to_owned(), instance });
        self
    }

    /// Lets the storage delegate to the functions of the row `row` under the name `name`, on the storage's memory.
    pub fn delegates_to(mut self, name: &str, row: &str) -> Self {
        let instance = Instance { row: row.to_owned(), name: name.to_owned(), memory: InstanceMemory::Delegated };
        self.implementations.push(Implementation { contract: name.to_owned(), instance });
        self
    }

    /// Returns whether the pass uses, tests or draws to `resource`.
    pub fn accesses(&self, resource: &str) -> bool {
        let state = &self.state;
        self.uses.iter().any(|usage| usage.resource == resource)
            || state.targets.iter().any(|target| target.resource == resource)
            || state.depth.as_ref().is_some_and(|depth| depth.resource == resource)
            || state.stencil.as_ref().is_some_and(|stencil| stencil.resource == resource)
    }

    /// Adds the colour target `resource` with `blend`.
    pub fn target(mut self, resource: &str, blend: Blend) -> Self {
        self.state.targets.push(ColorTarget { resource: resource.to_owned(), blend });
        self
    }
}

impl Implementation {
    /// Implements `contract` by the row `row` of the axis of that name.
    pub fn of(contract: &str, row: &str) -> Self {
        let instance = Instance { row: row.to_owned(), name: contract.to_owned(), memory: InstanceMemory::Own };
        Implementation { contract: contract.to_owned(), instance }
    }
}

impl Use {
    /// Makes a use of `resource` by `access` with exact loads.
    pub fn new(resource: &str, access: Access) -> Self {
        Use { resource: resource.to_owned(), access, loads: Loads::Exact, exclusive: None }
    }

    /// Makes an atomic use of `resource` whose loads are hints, or of words that no invocation of the pass changes.
    pub fn rechecked(resource: &str) -> Self {
        Use { loads: Loads::Rechecked, ..Use::new(resource, Access::Atomic) }
    }
}

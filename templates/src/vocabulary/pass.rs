//! What a technique does: passes and the steps around them.

use super::{Blend, Formula, Host, State, Target};

/// One step of a frame, in order.
#[allow(clippy::large_enum_variant, reason = "a plan has a dozen steps, and most are passes")]
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Draw or dispatch.
    Pass(Pass),
    /// Set every word of a resource.
    Clear {
        /// The resource.
        resource: String,
        /// The word.
        value: u32,
    },
    /// Copy one resource over another of the same shape.
    Copy {
        /// Read.
        from: String,
        /// Written.
        to: String,
    },
    /// Exchange the roles of two resources.
    Swap(String, String),
    /// Do the body again and again.
    Repeat(Repeat),
    /// The host decides: what it reads must have arrived before the frame goes on.
    Host(Host),
}

/// A loop over steps. Inside, the symbol `iteration` counts from 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Repeat {
    /// What is repeated.
    pub body: Vec<Step>,
    /// When it ends.
    pub until: Until,
    /// The bound that holds in any case; reaching it before the end is counted.
    pub at_most: Formula,
}

/// When a loop ends.
#[derive(Clone, Debug, PartialEq)]
pub enum Until {
    /// After this many rounds.
    Times(Formula),
    /// When this one-word resource is zero after a round.
    Zero(String),
    /// When no sample passed in the pass with this anchor.
    NoSamples(String),
}

/// One draw or dispatch.
#[derive(Clone, Debug, PartialEq)]
pub struct Pass {
    /// The name that edits, manifests and files use.
    pub anchor: String,
    /// What is drawn or dispatched.
    pub kind: Kind,
    /// The template with the entry points, a key of the axis `pass`.
    pub skeleton: String,
    /// Contracts bound otherwise than by the variant's own choice on the axis of that name.
    pub roles: Vec<Role>,
    /// Generated constants whose value is this pass's own.
    pub constants: Vec<(String, u32)>,
    /// The resources it touches, and how.
    pub uses: Vec<Use>,
    /// Fixed-function state.
    pub state: State,
    /// What is drawn, for a geometry pass.
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
        /// How many along x, y and z.
        groups: [Formula; 3],
    },
}

/// Which objects a geometry pass draws.
#[derive(Clone, Debug, PartialEq)]
pub enum Objects {
    /// All of them.
    All,
    /// The box of each instead, with an occlusion query each: those that have been dropped are asked for no more.
    Boxes,
    /// Those whose box passed the occlusion query of the pass with this anchor, whenever it was last asked in the frame; all, before it
    /// was. A box that crosses the near plane passes. The objects that fail are dropped until the frame ends.
    Visible(String),
}

/// A contract and the template instance that fulfils it.
#[derive(Clone, Debug, PartialEq)]
pub struct Role {
    /// The contract, by the name of its axis.
    pub contract: String,
    /// Who fulfils it.
    pub instance: Instance,
}

/// One use of a template in a program. Two instances of one template have different names.
#[derive(Clone, Debug, PartialEq)]
pub struct Instance {
    /// The row.
    pub row: String,
    /// What replaces the contract's name in the names that the template exports, and precedes its private names. An
    /// instance named after its contract keeps the template's names.
    pub name: String,
    /// Whose memory it works on.
    pub memory: Memory,
}

/// Whose memory an instance works on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Memory {
    /// The row's resources, named for the instance.
    Own,
    /// The pass's own storage's: its template has functions of the names of the row's accessors.
    Borrowed,
}

/// How a pass touches a resource: this decides the type it is declared with there.
#[derive(Clone, Debug, PartialEq)]
pub struct Use {
    /// The resource.
    pub resource: String,
    /// How.
    pub access: Access,
    /// What its loads must be.
    pub loads: Loads,
}

/// Ways to touch a resource.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Read only.
    Read,
    /// Read and written, never the same word by two invocations at once.
    Plain,
    /// Atomic operations.
    Atomic,
    /// Words that the critical section of one pixel reads and writes: coherent where the target has it, else atomic.
    Coherent,
    /// Bound as a render target.
    Attachment,
    /// Read as a texture.
    Sampled,
    /// Read as the arguments of an indirect draw or dispatch.
    Indirect,
}

/// What the loads of an atomic resource must be on a target without atomic loads.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Loads {
    /// As strong as the atomic load that was checked.
    Exact,
    /// A hint only, or made again inside the critical section: a plain load of a volatile word will do.
    Rechecked,
}

impl Pass {
    /// A geometry pass.
    pub fn geometry(anchor: &str, skeleton: &str) -> Self {
        Self::new(anchor, Kind::Geometry, skeleton)
    }

    /// A pass over the whole frame.
    pub fn fullscreen(anchor: &str, skeleton: &str) -> Self {
        Self::new(anchor, Kind::Fullscreen, skeleton)
    }

    /// A compute pass of `x` × `y` workgroups.
    pub fn compute(anchor: &str, skeleton: &str, x: impl Into<Formula>, y: impl Into<Formula>) -> Self {
        Self::new(anchor, Kind::Compute { groups: [x.into(), y.into(), Formula::from("1")] }, skeleton)
    }

    fn new(anchor: &str, kind: Kind, skeleton: &str) -> Self {
        Pass {
            anchor: anchor.to_owned(),
            kind,
            skeleton: skeleton.to_owned(),
            roles: Vec::new(),
            constants: Vec::new(),
            uses: Vec::new(),
            state: State::default(),
            objects: Objects::All,
        }
    }

    /// Touches `resource` by `access`.
    pub fn uses(mut self, resource: &str, access: Access) -> Self {
        self.uses.push(Use::new(resource, access));
        self
    }

    /// Touches `resource` atomically; its loads are hints, or made again inside the critical section.
    pub fn uses_rechecked(mut self, resource: &str) -> Self {
        self.uses.push(Use { loads: Loads::Rechecked, ..Use::new(resource, Access::Atomic) });
        self
    }

    /// Binds `contract` to the row `row` under the name `name`.
    pub fn role(mut self, contract: &str, row: &str, name: &str) -> Self {
        let instance = Instance { row: row.to_owned(), name: name.to_owned(), memory: Memory::Own };
        self.roles.push(Role { contract: contract.to_owned(), instance });
        self
    }

    /// Lets the storage call the functions of the row `row` under the name `name`, on memory of its own.
    pub fn borrows(mut self, name: &str, row: &str) -> Self {
        let instance = Instance { row: row.to_owned(), name: name.to_owned(), memory: Memory::Borrowed };
        self.roles.push(Role { contract: name.to_owned(), instance });
        self
    }

    /// Whether it uses, tests or draws to `resource`.
    pub fn touches(&self, resource: &str) -> bool {
        let state = &self.state;
        self.uses.iter().any(|usage| usage.resource == resource)
            || state.targets.iter().any(|target| target.resource == resource)
            || state.depth.as_ref().is_some_and(|depth| depth.resource == resource)
            || state.stencil.as_ref().is_some_and(|stencil| stencil.resource == resource)
    }

    /// Writes to `resource` with `blend`.
    pub fn target(mut self, resource: &str, blend: Blend) -> Self {
        self.state.targets.push(Target { resource: resource.to_owned(), blend });
        self
    }
}

impl Role {
    /// `contract`, fulfilled by the row `row` of the axis of that name.
    pub fn of(contract: &str, row: &str) -> Self {
        let instance = Instance { row: row.to_owned(), name: contract.to_owned(), memory: Memory::Own };
        Role { contract: contract.to_owned(), instance }
    }
}

impl Use {
    /// `resource` by `access`, loads exact.
    pub fn new(resource: &str, access: Access) -> Self {
        Use { resource: resource.to_owned(), access, loads: Loads::Exact }
    }
}

//! What a step of a program reads and writes, as far as the order of steps depends on it.
//!
//! In: expressions and statements. Out: for each its [`Footprint`]; two steps whose footprints do not conflict may trade
//! places. Textures and uniforms never appear: nothing writes them while a shader reads them.

use std::collections::{BTreeMap, BTreeSet};

use naga::{
    AddressSpace, Block, Expression, Function, GlobalVariable, Handle, LocalVariable, Module, Statement, StorageAccess,
    TypeInner,
};

use crate::Marker;

/// A piece of memory that is read or written as one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Place {
    Local(Handle<LocalVariable>),
    /// What a pointer parameter points to.
    Parameter(u32),
    /// A global of this invocation alone.
    Private(Handle<GlobalVariable>),
    /// A global that other invocations see.
    Global(Handle<GlobalVariable>),
    /// All globals that other invocations see: what atomics and fences order.
    Memory,
}

impl Place {
    fn overlaps(self, other: Self) -> bool {
        let global = |place| matches!(place, Self::Global(_) | Self::Memory);
        self == other || (global(self) && global(other) && (self == Self::Memory || other == Self::Memory))
    }
}

/// What one step touches.
#[derive(Clone, Debug, Default)]
pub struct Footprint {
    pub reads: Vec<Place>,
    pub writes: Vec<Place>,
    /// Depends on which invocations take part (derivatives, implicit mip levels): may not move into a branch.
    pub uniform: bool,
}

impl Footprint {
    pub fn reading(place: Place) -> Self {
        Self { reads: vec![place], ..Self::default() }
    }

    pub fn writing(place: Place) -> Self {
        Self { writes: vec![place], ..Self::default() }
    }

    /// Whether the step does nothing but compute: it may be evaluated anywhere, or not at all.
    pub fn is_pure(&self) -> bool {
        self.reads.is_empty() && self.writes.is_empty() && !self.uniform
    }

    pub fn has_effect(&self) -> bool {
        !self.writes.is_empty()
    }

    pub fn join(&mut self, other: &Self) {
        self.reads.extend(&other.reads);
        self.writes.extend(&other.writes);
        self.uniform |= other.uniform;
    }

    pub fn conflicts(&self, other: &Self) -> bool {
        let meet = |a: &[Place], b: &[Place]| a.iter().any(|x| b.iter().any(|y| x.overlaps(*y)));
        meet(&self.writes, &other.reads) || meet(&self.writes, &other.writes) || meet(&self.reads, &other.writes)
    }
}

/// The variable that a pointer points into.
pub fn root(module: &Module, function: &Function, mut pointer: Handle<Expression>) -> Option<Place> {
    loop {
        match function.expressions[pointer] {
            Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => pointer = base,
            Expression::LocalVariable(local) => return Some(Place::Local(local)),
            Expression::GlobalVariable(global) => {
                let private = module.global_variables[global].space == AddressSpace::Private;
                return Some(if private { Place::Private(global) } else { Place::Global(global) });
            }
            Expression::FunctionArgument(index) => return Some(Place::Parameter(index)),
            _ => return None,
        }
    }
}

/// Whether what the pointer points to can change while the shader runs.
fn is_mutable(module: &Module, place: Place) -> bool {
    let Place::Global(global) = place else { return true };
    match module.global_variables[global].space {
        AddressSpace::Uniform | AddressSpace::Handle | AddressSpace::Immediate => false,
        AddressSpace::Storage { access } => access.intersects(StorageAccess::STORE | StorageAccess::ATOMIC),
        _ => true,
    }
}

/// What evaluating an expression touches, its operands apart.
pub fn of_expression(module: &Module, function: &Function, expression: Handle<Expression>) -> Footprint {
    match function.expressions[expression] {
        Expression::Load { pointer } => match root(module, function, pointer) {
            Some(place) if is_mutable(module, place) => Footprint::reading(place),
            Some(_) => Footprint::default(),
            None => Footprint::reading(Place::Memory),
        },
        Expression::ImageSample { .. } | Expression::Derivative { .. } => {
            Footprint { uniform: true, ..Footprint::default() }
        }
        // A storage texture may be written by this very shader.
        Expression::ImageLoad { image, .. } if is_storage_image(module, function, image) => {
            Footprint::reading(Place::Memory)
        }
        _ => Footprint::default(),
    }
}

fn is_storage_image(module: &Module, function: &Function, image: Handle<Expression>) -> bool {
    let ty = match function.expressions[image] {
        Expression::GlobalVariable(global) => module.global_variables[global].ty,
        Expression::FunctionArgument(index) => function.arguments[index as usize].ty,
        _ => return true,
    };
    matches!(module.types[ty].inner, TypeInner::Image { class: naga::ImageClass::Storage { .. }, .. })
}

/// What calling each function touches, its pointer arguments apart.
pub type Calls = BTreeMap<Handle<Function>, Footprint>;

/// Footprints of all functions; naga keeps callees before callers.
pub fn of_functions(module: &Module, marker: impl Fn(Handle<Function>) -> Option<Marker>) -> Calls {
    let mut calls = Calls::new();
    for (handle, function) in module.functions.iter() {
        let footprint = match marker(handle) {
            Some(Marker::HelperLane) => Footprint::default(),
            Some(_) => Footprint::writing(Place::Memory),
            None => of_body(module, function, &calls),
        };
        calls.insert(handle, footprint);
    }
    calls
}

fn of_body(module: &Module, function: &Function, calls: &Calls) -> Footprint {
    let mut whole = Footprint::default();
    visit(&function.body, &mut |statement| {
        if let Statement::Emit(range) = statement {
            range.clone().for_each(|expression| whole.join(&of_expression(module, function, expression)));
        } else {
            whole.join(&of_statement(module, function, statement, calls));
        }
    });
    // The caller cannot see locals, and knows better what parameters point to.
    let outward = |places: &[Place]| {
        let seen: BTreeSet<Place> = places.iter().copied().filter(|place| !matches!(place, Place::Local(_))).collect();
        seen.into_iter().collect()
    };
    Footprint { reads: outward(&whole.reads), writes: outward(&whole.writes), uniform: whole.uniform }
}

/// Visits every statement, outer ones first.
pub fn visit<'m>(block: &'m Block, act: &mut impl FnMut(&'m Statement)) {
    for statement in block {
        act(statement);
        for inner in inner_blocks(statement) {
            visit(inner, act);
        }
    }
}

/// The blocks directly inside a statement, in order.
pub fn inner_blocks(statement: &Statement) -> Vec<&Block> {
    match statement {
        Statement::Block(block) => vec![block],
        Statement::If { accept, reject, .. } => vec![accept, reject],
        Statement::Switch { cases, .. } => cases.iter().map(|case| &case.body).collect(),
        Statement::Loop { body, continuing, .. } => vec![body, continuing],
        _ => Vec::new(),
    }
}

/// What executing a statement touches: the statement itself, without its operands and inner blocks.
pub fn of_statement(module: &Module, function: &Function, statement: &Statement, calls: &Calls) -> Footprint {
    match *statement {
        Statement::Store { pointer, .. } => {
            let place = root(module, function, pointer).unwrap_or(Place::Memory);
            let inner = &function.expressions[pointer];
            // Storing to an atomic is ordered like every other atomic operation, below.
            let atomic = !matches!(inner, Expression::LocalVariable(_)) && is_atomic(module, function, pointer);
            Footprint::writing(if atomic { Place::Memory } else { place })
        }
        Statement::Call { function: callee, ref arguments, .. } => {
            let Some(summary) = calls.get(&callee) else { return Footprint::writing(Place::Memory) };
            let bind = |places: &[Place]| {
                let bound = |place: &Place| match *place {
                    Place::Parameter(index) => arguments
                        .get(index as usize)
                        .and_then(|pointer| root(module, function, *pointer))
                        .unwrap_or(Place::Memory),
                    other => other,
                };
                places.iter().map(bound).collect::<Vec<_>>()
            };
            Footprint { reads: bind(&summary.reads), writes: bind(&summary.writes), uniform: summary.uniform }
        }
        // Atomics and barriers order what other invocations see, so nothing that touches memory may pass them.
        Statement::Atomic { .. }
        | Statement::ImageStore { .. }
        | Statement::ImageAtomic { .. }
        | Statement::ControlBarrier(_)
        | Statement::MemoryBarrier(_)
        | Statement::WorkGroupUniformLoad { .. } => Footprint::writing(Place::Memory),
        // Ending the invocation is an effect of the function that does it.
        Statement::Kill => Footprint::writing(Place::Memory),
        // Leaving: an effect must not move from before to after it.
        Statement::Return { .. } | Statement::Break | Statement::Continue => Footprint::reading(Place::Memory),
        Statement::Emit(_)
        | Statement::Block(_)
        | Statement::If { .. }
        | Statement::Switch { .. }
        | Statement::Loop { .. } => Footprint::default(),
        _ => Footprint::writing(Place::Memory),
    }
}

/// Whether a pointer points to an atomic.
pub fn is_atomic(module: &Module, function: &Function, pointer: Handle<Expression>) -> bool {
    pointee(module, function, pointer).is_some_and(|ty| matches!(module.types[ty].inner, TypeInner::Atomic(_)))
}

/// The type a pointer points to, where the module has a handle for it.
fn pointee(module: &Module, function: &Function, pointer: Handle<Expression>) -> Option<Handle<naga::Type>> {
    let behind = |ty: Handle<naga::Type>| match module.types[ty].inner {
        TypeInner::Pointer { base, .. } => base,
        _ => ty,
    };
    match function.expressions[pointer] {
        Expression::GlobalVariable(global) => Some(module.global_variables[global].ty),
        Expression::LocalVariable(local) => Some(function.local_variables[local].ty),
        Expression::FunctionArgument(index) => {
            function.arguments.get(index as usize).map(|argument| behind(argument.ty))
        }
        Expression::Access { base, .. } => match module.types[pointee(module, function, base)?].inner {
            TypeInner::Array { base, .. } => Some(base),
            _ => None,
        },
        Expression::AccessIndex { base, index } => match module.types[pointee(module, function, base)?].inner {
            TypeInner::Array { base, .. } => Some(base),
            TypeInner::Struct { ref members, .. } => members.get(index as usize).map(|member| member.ty),
            _ => None,
        },
        _ => None,
    }
}

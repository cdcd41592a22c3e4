//! Computes the memory that a step reads and writes. It decides which steps may be reordered.
//!
//! Input: expressions and statements. Output: the [`Footprint`] of each. Two steps whose footprints do not conflict may be
//! swapped. Footprints omit textures and uniforms, because nothing writes them while a shader reads them.

use std::collections::{BTreeMap, BTreeSet};

use naga::{
    AddressSpace, Block, Expression, Function, GlobalVariable, Handle, LocalVariable, Module, Statement, StorageAccess,
    TypeInner,
};

use crate::options::Marker;

/// A memory object: the unit of reads and writes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum MemoryObject {
    Local(Handle<LocalVariable>),
    /// The pointee of a pointer parameter.
    Parameter(u32),
    /// A global that only this invocation accesses.
    Private(Handle<GlobalVariable>),
    /// A global that other invocations access.
    Global(Handle<GlobalVariable>),
    /// All globals that other invocations access, which atomics and fences order.
    Memory,
}

impl MemoryObject {
    /// Tests whether two objects share memory.
    fn overlaps(self, other: Self) -> bool {
        let global = |object| matches!(object, Self::Global(_) | Self::Memory);
        self == other || (global(self) && global(other) && (self == Self::Memory || other == Self::Memory))
    }
}

/// The memory that one step reads and writes.
#[derive(Clone, Debug, Default)]
pub struct Footprint {
    pub reads: Vec<MemoryObject>,
    pub writes: Vec<MemoryObject>,
    /// True for derivatives and implicit mip levels: the result depends on the active invocations, so it may not move into
    /// a branch.
    pub uniform: bool,
}

impl Footprint {
    /// Returns the footprint of reading an object.
    pub fn reading(object: MemoryObject) -> Self {
        Self { reads: vec![object], ..Self::default() }
    }

    /// Returns the footprint of writing an object.
    pub fn writing(object: MemoryObject) -> Self {
        Self { writes: vec![object], ..Self::default() }
    }

    /// Tests whether the step is pure: it may be evaluated anywhere, or not at all.
    pub fn is_pure(&self) -> bool {
        self.reads.is_empty() && self.writes.is_empty() && !self.uniform
    }

    /// Tests whether the step writes memory.
    pub fn has_effect(&self) -> bool {
        !self.writes.is_empty()
    }

    /// Adds another footprint to this one.
    pub fn join(&mut self, other: &Self) {
        self.reads.extend(&other.reads);
        self.writes.extend(&other.writes);
        self.uniform |= other.uniform;
    }

    /// Tests whether the order of two steps matters.
    pub fn conflicts(&self, other: &Self) -> bool {
        let meet = |a: &[MemoryObject], b: &[MemoryObject]| a.iter().any(|x| b.iter().any(|y| x.overlaps(*y)));
        meet(&self.writes, &other.reads) || meet(&self.writes, &other.writes) || meet(&self.reads, &other.writes)
    }
}

/// Returns the variable that a pointer points into.
pub fn root(module: &Module, function: &Function, mut pointer: Handle<Expression>) -> Option<MemoryObject> {
    loop {
        match function.expressions[pointer] {
            Expression::Access { base, .. } | Expression::AccessIndex { base, .. } => pointer = base,
            Expression::LocalVariable(local) => return Some(MemoryObject::Local(local)),
            Expression::GlobalVariable(global) => {
                let private = module.global_variables[global].space == AddressSpace::Private;
                return Some(if private { MemoryObject::Private(global) } else { MemoryObject::Global(global) });
            }
            Expression::FunctionArgument(index) => return Some(MemoryObject::Parameter(index)),
            _ => return None,
        }
    }
}

/// Tests whether an object can change while the shader runs.
fn is_mutable(module: &Module, object: MemoryObject) -> bool {
    let MemoryObject::Global(global) = object else { return true };
    match module.global_variables[global].space {
        AddressSpace::Uniform | AddressSpace::Handle | AddressSpace::Immediate => false,
        AddressSpace::Storage { access } => access.intersects(StorageAccess::STORE | StorageAccess::ATOMIC),
        _ => true,
    }
}

/// Returns the footprint of evaluating an expression, without its operands.
pub fn of_expression(module: &Module, function: &Function, expression: Handle<Expression>) -> Footprint {
    match function.expressions[expression] {
        Expression::Load { pointer } => match root(module, function, pointer) {
            Some(object) if is_mutable(module, object) => Footprint::reading(object),
            Some(_) => Footprint::default(),
            None => Footprint::reading(MemoryObject::Memory),
        },
        Expression::ImageSample { .. } | Expression::Derivative { .. } => {
            Footprint { uniform: true, ..Footprint::default() }
        }
        // The same shader may write a storage texture.
        Expression::ImageLoad { image, .. } if is_storage_image(module, function, image) => {
            Footprint::reading(MemoryObject::Memory)
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

/// The footprint of calling each function, with pointer arguments as parameters.
pub type CallFootprints = BTreeMap<Handle<Function>, Footprint>;

/// Returns the footprints of `functions` and of all markers; naga stores callees before callers.
pub fn of_functions(
    module: &Module,
    functions: &BTreeSet<Handle<Function>>,
    marker: impl Fn(Handle<Function>) -> Option<Marker>,
) -> CallFootprints {
    let mut calls = CallFootprints::new();
    for (handle, function) in module.functions.iter() {
        let footprint = match marker(handle) {
            Some(Marker::HelperLane) => Footprint::default(),
            Some(_) => Footprint::writing(MemoryObject::Memory),
            None if functions.contains(&handle) => of_body(module, function, &calls),
            None => continue,
        };
        calls.insert(handle, footprint);
    }
    calls
}

/// Returns the footprint of a function, as its callers see it.
fn of_body(module: &Module, function: &Function, calls: &CallFootprints) -> Footprint {
    let mut whole = Footprint::default();
    visit(&function.body, &mut |statement| {
        if let Statement::Emit(range) = statement {
            range.clone().for_each(|expression| whole.join(&of_expression(module, function, expression)));
        } else {
            whole.join(&of_statement(module, function, statement, calls));
        }
    });
    // Callers cannot access the locals. They replace each parameter by the object that they pass.
    let visible = |objects: &[MemoryObject]| {
        let unique: BTreeSet<MemoryObject> =
            objects.iter().copied().filter(|object| !matches!(object, MemoryObject::Local(_))).collect();
        unique.into_iter().collect()
    };
    Footprint { reads: visible(&whole.reads), writes: visible(&whole.writes), uniform: whole.uniform }
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

/// Returns the blocks directly inside a statement, in order.
pub fn inner_blocks(statement: &Statement) -> Vec<&Block> {
    match statement {
        Statement::Block(block) => vec![block],
        Statement::If { accept, reject, .. } => vec![accept, reject],
        Statement::Switch { cases, .. } => cases.iter().map(|case| &case.body).collect(),
        Statement::Loop { body, continuing, .. } => vec![body, continuing],
        _ => Vec::new(),
    }
}

/// Returns the footprint of a statement, without its operands and inner blocks.
pub fn of_statement(module: &Module, function: &Function, statement: &Statement, calls: &CallFootprints) -> Footprint {
    match *statement {
        Statement::Store { pointer, .. } => {
            let object = root(module, function, pointer).unwrap_or(MemoryObject::Memory);
            let inner = &function.expressions[pointer];
            // A store to an atomic is ordered like the atomic operations below.
            let atomic = !matches!(inner, Expression::LocalVariable(_)) && is_atomic(module, function, pointer);
            Footprint::writing(if atomic { MemoryObject::Memory } else { object })
        }
        Statement::Call { function: callee, ref arguments, .. } => {
            let Some(summary) = calls.get(&callee) else { return Footprint::writing(MemoryObject::Memory) };
            let bind = |objects: &[MemoryObject]| {
                let bound = |object: &MemoryObject| match *object {
                    MemoryObject::Parameter(index) => arguments
                        .get(index as usize)
                        .and_then(|pointer| root(module, function, *pointer))
                        .unwrap_or(MemoryObject::Memory),
                    other => other,
                };
                objects.iter().map(bound).collect::<Vec<_>>()
            };
            Footprint { reads: bind(&summary.reads), writes: bind(&summary.writes), uniform: summary.uniform }
        }
        // Atomics and barriers order what other invocations observe, so no memory access may pass them.
        Statement::Atomic { .. }
        | Statement::ImageStore { .. }
        | Statement::ImageAtomic { .. }
        | Statement::ControlBarrier(_)
        | Statement::MemoryBarrier(_)
        | Statement::WorkGroupUniformLoad { .. } => Footprint::writing(MemoryObject::Memory),
        // Ending the invocation is an effect of the function.
        Statement::Kill => Footprint::writing(MemoryObject::Memory),
        // An effect before a jump must not move behind it.
        Statement::Return { .. } | Statement::Break | Statement::Continue => Footprint::reading(MemoryObject::Memory),
        Statement::Emit(_)
        | Statement::Block(_)
        | Statement::If { .. }
        | Statement::Switch { .. }
        | Statement::Loop { .. } => Footprint::default(),
        _ => Footprint::writing(MemoryObject::Memory),
    }
}

/// Tests whether a pointer points to an atomic.
pub fn is_atomic(module: &Module, function: &Function, pointer: Handle<Expression>) -> bool {
    pointee(module, function, pointer).is_some_and(|ty| matches!(module.types[ty].inner, TypeInner::Atomic(_)))
}

/// Returns the type that a pointer points to, if the module has a handle for it.
fn pointee(module: &Module, function: &Function, pointer: Handle<Expression>) -> Option<Handle<naga::Type>> {
    let target = |ty: Handle<naga::Type>| match module.types[ty].inner {
        TypeInner::Pointer { base, .. } => base,
        _ => ty,
    };
    match function.expressions[pointer] {
        Expression::GlobalVariable(global) => Some(module.global_variables[global].ty),
        Expression::LocalVariable(local) => Some(function.local_variables[local].ty),
        Expression::FunctionArgument(index) => {
            function.arguments.get(index as usize).map(|argument| target(argument.ty))
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

//! Values of a plan's symbols at one point of a frame. Values of generation time come from the plan, the frame's size and k from
//! the caller, and the rest from host steps or from the capacity that the caller reserves.

use std::sync::Arc;

use fragbuf_codegen::{Plan, Quantity, SymbolId, SymbolTable};

use crate::Error;

/// The values at one point of a frame. The height is that of a slice, because formulas and shaders see one slice at a time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Values {
    table: Arc<SymbolTable>,
    assignments: Vec<Assignment>,
    /// The rows of the whole frame.
    height: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Assignment {
    /// The value in the plan, if it has one.
    Unset,
    Constant(u64),
    /// A number for every pixel of a slice, without its padding.
    PerPixel(u32),
}

impl Values {
    /// Returns the values of a frame of this size, in one slice.
    pub fn new(plan: &Plan, (width, height): (u32, u32)) -> Self {
        let assignments = plan.symbols.iter().map(|_| Assignment::Unset).collect();
        let mut values = Values { table: plan.symbols.clone(), assignments, height };
        values.set(SymbolId::WIDTH, width.into());
        values.set(SymbolId::HEIGHT, height.into());
        values
    }

    /// Returns the values that the code fixes for frames of any size: k is the capacity of the code.
    pub fn of_code(plan: &Plan) -> Self {
        let assignments = plan.symbols.iter().map(|_| Assignment::Unset).collect();
        let mut values = Values { table: plan.symbols.clone(), assignments, height: 0 };
        values.set(SymbolId::K, plan.capacity().into());
        values
    }

    /// Sets the value of a symbol.
    pub fn set(&mut self, id: SymbolId, value: u64) {
        if let Some(assignment) = self.assignments.get_mut(id.index()) {
            *assignment = Assignment::Constant(value);
        }
    }

    /// Sets a symbol to `value` times the pixels of a slice, for slices of any height.
    pub fn set_per_pixel(&mut self, id: SymbolId, value: u32) {
        if let Some(assignment) = self.assignments.get_mut(id.index()) {
            *assignment = Assignment::PerPixel(value);
        }
    }

    /// Returns the same values except for one symbol.
    pub fn with(&self, id: SymbolId, value: u64) -> Self {
        let mut values = self.clone();
        values.set(id, value);
        values
    }

    /// Returns the values in an iteration of the innermost loop.
    pub fn in_iteration(&self, iteration: u32) -> Self {
        self.with(SymbolId::ITERATION, iteration.into())
    }

    /// Returns the values for slices of `rows` rows.
    pub fn with_rows(&self, rows: u32) -> Self {
        self.with(SymbolId::HEIGHT, rows.into())
    }

    /// Returns the values for a frame of another size, in one slice.
    pub fn resized(&self, width: u32, height: u32) -> Self {
        let mut values = self.with_rows(height);
        values.set(SymbolId::WIDTH, width.into());
        values.height = height;
        values
    }

    /// Returns the values for another plan of the same description, for example one of another capacity.
    pub fn of_plan(&self, plan: &Plan) -> Self {
        Values { table: plan.symbols.clone(), ..self.clone() }
    }

    /// Returns the value of a symbol; `None` if it has none yet.
    pub fn get(&self, id: SymbolId) -> Option<u64> {
        self.table.value(id, &|id| self.assigned(id)).ok()
    }

    /// Returns the value of a symbol whose name comes from the caller.
    pub fn named(&self, name: &str) -> Option<u64> {
        self.get(self.table.find(name)?)
    }

    fn assigned(&self, id: SymbolId) -> Option<u64> {
        match self.assignments.get(id.index())? {
            Assignment::Unset => None,
            Assignment::Constant(number) => Some(*number),
            Assignment::PerPixel(number) => Some(u64::from(*number).saturating_mul(self.pixels())),
        }
    }

    /// Returns the value of a formula. `what` names it in errors.
    pub fn evaluate(&self, quantity: &Quantity, what: &str) -> Result<u64, Error> {
        let value = self.table.evaluate(quantity, &|id| self.assigned(id));
        value.map_err(|error| Error::Formula { what: what.to_owned(), error })
    }

    /// Returns the value of a formula as a 32-bit word. `what` names it in errors.
    pub fn word(&self, quantity: &Quantity, what: &str) -> Result<u32, Error> {
        let needed = self.evaluate(quantity, what)?;
        u32::try_from(needed).map_err(|_| Error::TooLarge {
            what: what.to_owned(),
            needed,
            limit: u32::MAX.into(),
            limit_name: "a 32-bit word",
            help: "use a smaller frame, or split it",
            shrinks_with_rows: true,
        })
    }

    /// Returns the columns of the frame.
    pub fn width(&self) -> u32 {
        self.size_of(SymbolId::WIDTH)
    }

    /// Returns the rows of the whole frame.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Returns the rows of a slice.
    pub fn rows(&self) -> u32 {
        self.size_of(SymbolId::HEIGHT)
    }

    /// Returns the number of fragments that a pixel keeps; `None` if it keeps all.
    pub fn k(&self) -> Option<u32> {
        self.assigned(SymbolId::K).and_then(|k| u32::try_from(k).ok())
    }

    fn size_of(&self, id: SymbolId) -> u32 {
        match self.assignments.get(id.index()) {
            Some(Assignment::Constant(number)) => u32::try_from(*number).unwrap_or(u32::MAX),
            _ => 0,
        }
    }

    /// Returns the pixels of a slice, without its padding.
    pub fn pixels(&self) -> u64 {
        u64::from(self.width()) * u64::from(self.rows())
    }

    /// Returns the number of slices of the frame.
    pub fn slices(&self) -> u32 {
        self.height.div_ceil(self.rows().max(1))
    }

    /// Returns the shaders' uniform block of one slice and iteration: one word per field of the plan.
    pub fn frame_words(&self, plan: &Plan, slice: u32, iteration: u32) -> Result<Vec<u32>, Error> {
        let mut values = self.in_iteration(iteration);
        values.set(SymbolId::FIRST_ROW, u64::from(slice) * u64::from(self.rows()));
        let word = |id: &SymbolId| {
            let value = values.get(*id).unwrap_or(0);
            u32::try_from(value).map_err(|_| Error::TooLarge {
                what: format!("`{}`", plan.symbols.get(*id).name),
                needed: value,
                limit: u32::MAX.into(),
                limit_name: "a word of the frame's uniform buffer",
                help: "use a smaller frame, or split it",
                shrinks_with_rows: true,
            })
        };
        plan.fields.iter().map(word).collect()
    }
}

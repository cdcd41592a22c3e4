//! Values of a plan's symbols at one moment: those of generation time come from the plan, the frame's size and k from the
//! caller, and the rest from host steps or from what the caller reserves.

use std::sync::Arc;

use fragbuf_codegen::{Plan, Quantity, SymbolId, SymbolTable};

use crate::Error;

/// The values at one moment. Rows are those of a slice: formulas and shaders see one slice at a time.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Values {
    table: Arc<SymbolTable>,
    given: Vec<Assigned>,
    /// Rows of the whole frame.
    height: u32,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Assigned {
    /// What the plan says.
    Nothing,
    Number(u64),
    /// So many for every pixel of a slice, its padding apart.
    PerPixel(u32),
}

impl Values {
    /// The values of a frame of this size, in one slice.
    pub fn new(plan: &Plan, (width, height): (u32, u32)) -> Self {
        let given = plan.symbols.iter().map(|_| Assigned::Nothing).collect();
        let mut values = Values { table: plan.symbols.clone(), given, height };
        values.set(SymbolId::WIDTH, width.into());
        values.set(SymbolId::HEIGHT, height.into());
        values
    }

    /// What is fixed once code is made, whatever the frame: k is the greatest that the code serves.
    pub fn of_code(plan: &Plan) -> Self {
        let given = plan.symbols.iter().map(|_| Assigned::Nothing).collect();
        let mut values = Values { table: plan.symbols.clone(), given, height: 0 };
        values.set(SymbolId::K, plan.capacity().into());
        values
    }

    /// Gives a symbol a value.
    pub fn set(&mut self, id: SymbolId, value: u64) {
        if let Some(given) = self.given.get_mut(id.index()) {
            *given = Assigned::Number(value);
        }
    }

    /// Gives a symbol a value for every pixel of a slice, whatever its rows.
    pub fn set_per_pixel(&mut self, id: SymbolId, value: u32) {
        if let Some(given) = self.given.get_mut(id.index()) {
            *given = Assigned::PerPixel(value);
        }
    }

    /// The same with another value of a symbol.
    pub fn with(&self, id: SymbolId, value: u64) -> Self {
        let mut values = self.clone();
        values.set(id, value);
        values
    }

    /// The same in an iteration of the innermost loop.
    pub fn in_iteration(&self, iteration: u32) -> Self {
        self.with(SymbolId::ITERATION, iteration.into())
    }

    /// The same with slices of so many rows.
    pub fn with_rows(&self, rows: u32) -> Self {
        self.with(SymbolId::HEIGHT, rows.into())
    }

    /// The same for a frame of another size, in one slice.
    pub fn resized(&self, width: u32, height: u32) -> Self {
        let mut values = self.with_rows(height);
        values.set(SymbolId::WIDTH, width.into());
        values.height = height;
        values
    }

    /// The same for another plan of the same description, such as one of another capacity.
    pub fn of_plan(&self, plan: &Plan) -> Self {
        Values { table: plan.symbols.clone(), ..self.clone() }
    }

    /// The value of a symbol; `None`: it has none by now.
    pub fn get(&self, id: SymbolId) -> Option<u64> {
        self.table.value(id, &|id| self.given(id)).ok()
    }

    /// The value of a symbol by name, for what comes from outside.
    pub fn named(&self, name: &str) -> Option<u64> {
        self.get(self.table.find(name)?)
    }

    fn given(&self, id: SymbolId) -> Option<u64> {
        match self.given.get(id.index())? {
            Assigned::Nothing => None,
            Assigned::Number(number) => Some(*number),
            Assigned::PerPixel(number) => Some(u64::from(*number) * self.pixels()),
        }
    }

    /// The value of a formula, which is `what`.
    pub fn evaluate(&self, quantity: &Quantity, what: &str) -> Result<u64, Error> {
        let value = self.table.evaluate(quantity, &|id| self.given(id));
        value.map_err(|error| Error::Formula { what: what.to_owned(), error })
    }

    /// The same as a word.
    pub fn word(&self, quantity: &Quantity, what: &str) -> Result<u32, Error> {
        let needed = self.evaluate(quantity, what)?;
        u32::try_from(needed).map_err(|_| Error::TooLarge {
            what: what.to_owned(),
            needed,
            limit: u32::MAX.into(),
            limit_name: "a 32-bit word",
            hint: "take a smaller frame, or split it",
        })
    }

    /// Columns of the frame.
    pub fn width(&self) -> u32 {
        self.size_of(SymbolId::WIDTH)
    }

    /// Rows of the whole frame.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// Rows of a slice.
    pub fn rows(&self) -> u32 {
        self.size_of(SymbolId::HEIGHT)
    }

    /// Fragments that a pixel keeps; `None` where it keeps all.
    pub fn k(&self) -> Option<u32> {
        self.given(SymbolId::K).and_then(|k| u32::try_from(k).ok())
    }

    fn size_of(&self, id: SymbolId) -> u32 {
        match self.given.get(id.index()) {
            Some(Assigned::Number(number)) => u32::try_from(*number).unwrap_or(u32::MAX),
            _ => 0,
        }
    }

    /// Pixels of a slice, its padding apart.
    pub fn pixels(&self) -> u64 {
        u64::from(self.width()) * u64::from(self.rows())
    }

    /// Slices of the frame, from the top.
    pub fn slices(&self) -> u32 {
        self.height.div_ceil(self.rows().max(1))
    }

    /// The shaders' uniform block of one slice and iteration: one word per field of the plan.
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
                hint: "take a smaller frame, or split it",
            })
        };
        plan.fields.iter().map(word).collect()
    }
}

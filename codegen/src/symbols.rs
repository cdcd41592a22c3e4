//! The symbols of a plan, and the values of formulas over them.
//!
//! Input: the table of the vocabulary ([`SYMBOLS`]), the parameters of the selected rows, the symbols that rows define. Output: one
//! table with a handle per symbol, and formulas whose symbols are handles. The table has no values that a frame sets.

mod handle;
mod quantity;

use fragbuf_templates::vocabulary::{
    BindingTime, Expression, Formula, FormulaError, SYMBOLS, Setter, Symbol, Text, apply, is_reserved_in_formulas,
};

pub use handle::SymbolId;
pub use quantity::{Quantity, Term, is_boolean};

use crate::definitions::{DefinitionError, DefinitionProblem, NameTaken};

/// The symbols of a plan: those of the vocabulary in its order, then the parameters of rows, named by their constants.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SymbolTable {
    symbols: Vec<PlanSymbol>,
}

/// A symbol of a plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlanSymbol {
    /// The name in formulas.
    pub name: Text,
    /// The meaning.
    pub meaning: Text,
    /// When its value is set.
    pub when: BindingTime,
    /// What sets its value.
    pub set_by: Setter,
    /// The least and the greatest value.
    pub range: (u64, u64),
    /// Its value in the plan.
    pub value: PlanValue,
}

/// The value of a symbol in a plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PlanValue {
    /// A number.
    Number(u64),
    /// The value of this formula, unless a frame sets another value.
    Default(Quantity),
    /// No value: the frame sets it.
    Open,
}

impl SymbolTable {
    /// Creates the table of a plan. `number` returns the values that are known at generation; `definitions` are the formulas by which
    /// rows replace defaults. Parameters are added one by one ([`SymbolTable::add`]), because each may depend on the previous ones.
    pub(crate) fn new(
        number: &dyn Fn(&str) -> Option<u64>,
        definitions: &[(&str, &Formula)],
    ) -> Result<Self, DefinitionError> {
        let mut table = SymbolTable { symbols: SYMBOLS.iter().map(open).collect() };
        for symbol in &mut table.symbols {
            if let Some(number) = number(&symbol.name) {
                symbol.value = PlanValue::Number(number);
            }
        }
        for (index, (name, formula)) in definitions.iter().enumerate() {
            let error = |problem| DefinitionError { symbol: (*name).to_owned(), formula: (*formula).clone(), problem };
            let id = table.find(name).ok_or_else(|| error(DefinitionProblem::Unknown))?;
            if table.number(id).is_some() || definitions[..index].iter().any(|(other, _)| other == name) {
                return Err(error(DefinitionProblem::Duplicate));
            }
        }
        table.define(definitions)?;
        Ok(table)
    }

    /// Sets the formulas of symbols: those of rows, or else their defaults. Fails on a definition that depends on itself.
    fn define(&mut self, definitions: &[(&str, &Formula)]) -> Result<(), DefinitionError> {
        for (index, symbol) in SYMBOLS.iter().enumerate() {
            let definition =
                definitions.iter().find(|(name, _)| *name == symbol.name).map(|(_, formula)| (*formula).clone());
            let Some(formula) = definition.or_else(|| symbol.default_formula()) else { continue };
            let quantity = self.compile(&formula).map_err(|error| DefinitionError {
                symbol: symbol.name.to_owned(),
                formula,
                problem: DefinitionProblem::InvalidFormula(error),
            })?;
            self.symbols[index].value = PlanValue::Default(quantity);
        }
        for (name, formula) in definitions {
            if self.find(name).is_some_and(|id| self.depends_on_itself(id)) {
                let (symbol, formula) = ((*name).to_owned(), (*formula).clone());
                return Err(DefinitionError { symbol, formula, problem: DefinitionProblem::Circular });
            }
        }
        Ok(())
    }

    /// Tests whether the formula of a symbol depends on the symbol, directly or through other symbols.
    fn depends_on_itself(&self, id: SymbolId) -> bool {
        let formula_of = |id: SymbolId| match &self.get(id).value {
            PlanValue::Default(quantity) => quantity.symbols(),
            _ => Vec::new(),
        };
        let mut reached = formula_of(id);
        let mut index = 0;
        while let Some(next) = reached.get(index).copied() {
            reached.extend(formula_of(next).into_iter().filter(|id| !reached.contains(id)).collect::<Vec<_>>());
            index += 1;
        }
        reached.contains(&id)
    }

    /// Adds a parameter of a row. Fails if its name already has another meaning in formulas.
    pub(crate) fn add(
        &mut self,
        constant: &Text,
        meaning: &Text,
        range: (u32, u32),
        value: u32,
    ) -> Result<(), NameTaken> {
        if is_reserved_in_formulas(constant) || self.find(constant).is_some() {
            return Err(NameTaken);
        }
        self.symbols.push(PlanSymbol {
            name: constant.clone(),
            meaning: meaning.clone(),
            when: BindingTime::Generation,
            set_by: Setter::Description,
            range: (range.0.into(), range.1.into()),
            value: PlanValue::Number(value.into()),
        });
        Ok(())
    }

    /// Sets the range of a symbol that frames set, and its default.
    pub(crate) fn set_range(&mut self, id: SymbolId, range: (u64, u64), default: Option<Quantity>) {
        let symbol = &mut self.symbols[id.index()];
        symbol.range = range;
        if let Some(default) = default {
            symbol.value = PlanValue::Default(default);
        }
    }

    /// Returns a symbol.
    pub fn get(&self, id: SymbolId) -> &PlanSymbol {
        &self.symbols[id.index()]
    }

    /// Returns every symbol with its handle, in order.
    pub fn iter(&self) -> impl Iterator<Item = (SymbolId, &PlanSymbol)> {
        self.symbols.iter().enumerate().map(|(index, symbol)| (SymbolId(index as u16), symbol))
    }

    /// Returns the handle of a name.
    pub fn find(&self, name: &str) -> Option<SymbolId> {
        let index = self.symbols.iter().position(|symbol| symbol.name == name)?;
        Some(SymbolId(index as u16))
    }

    /// Returns the value of a symbol if it is known at generation.
    pub fn number(&self, id: SymbolId) -> Option<u64> {
        match self.get(id).value {
            PlanValue::Number(number) => Some(number),
            _ => None,
        }
    }

    /// Returns the value of a name if it is known at generation.
    pub fn number_of(&self, name: &str) -> Option<u64> {
        self.number(self.find(name)?)
    }

    /// Resolves the symbols of a formula. Fails if it cannot be parsed, names an unknown symbol, or has a part without a value in every
    /// frame.
    pub fn compile(&self, formula: &Formula) -> Result<Quantity, FormulaError> {
        let expression = formula.read()?;
        let resolved = self.term(&expression)?;
        let folded = self.term(&expression.folded(&|name| self.number_of(name))?)?;
        Ok(Quantity { text: formula.clone(), resolved, folded })
    }

    /// Resolves the symbols of a length. Fails if a number exceeds 32 bits, because shaders compute lengths in 32-bit words.
    pub fn length(&self, formula: &Formula) -> Result<Quantity, FormulaError> {
        let length = self.compile(formula)?;
        match length.folded.greatest_number() {
            Some(number) if number > u64::from(u32::MAX) => Err(FormulaError::Word(number)),
            _ => Ok(length),
        }
    }

    fn term(&self, expression: &Expression) -> Result<Term, FormulaError> {
        Ok(match expression {
            Expression::Number(number) => Term::Number(*number),
            Expression::Symbol(name) => {
                Term::Symbol(self.find(name).ok_or_else(|| FormulaError::Unbound(name.clone()))?)
            }
            Expression::Apply(operator, arguments) => {
                Term::Apply(operator, arguments.iter().map(|argument| self.term(argument)).collect::<Result<_, _>>()?)
            }
        })
    }

    /// Returns the value of a symbol: that of the plan if it is a number, or else that of the frame (`frame_value`), or else the default.
    pub fn value(&self, id: SymbolId, frame_value: &dyn Fn(SymbolId) -> Option<u64>) -> Result<u64, FormulaError> {
        match (&self.get(id).value, frame_value(id)) {
            (PlanValue::Number(number), _) => Ok(*number),
            (_, Some(value)) => Ok(value),
            (PlanValue::Default(quantity), None) => self.evaluate(quantity, frame_value),
            (PlanValue::Open, None) => Err(FormulaError::Unbound(self.get(id).name.to_string())),
        }
    }

    /// Returns the value of a formula, with the values of the frame (`frame_value`).
    pub fn evaluate(
        &self,
        quantity: &Quantity,
        frame_value: &dyn Fn(SymbolId) -> Option<u64>,
    ) -> Result<u64, FormulaError> {
        self.evaluate_term(&quantity.resolved, frame_value)
    }

    fn evaluate_term(&self, term: &Term, frame_value: &dyn Fn(SymbolId) -> Option<u64>) -> Result<u64, FormulaError> {
        match term {
            Term::Number(number) => Ok(*number),
            Term::Symbol(id) => self.value(*id, frame_value),
            Term::Apply(operator, arguments) => {
                let mut values = Vec::with_capacity(arguments.len());
                for argument in arguments {
                    values.push(self.evaluate_term(argument, frame_value)?);
                }
                apply(operator, &values).ok_or_else(|| FormulaError::Overflow(format!("{operator}{values:?}")))
            }
        }
    }
}

fn open(symbol: &Symbol) -> PlanSymbol {
    PlanSymbol {
        name: symbol.name.into(),
        meaning: symbol.meaning.into(),
        when: symbol.when,
        set_by: symbol.set_by,
        range: symbol.range,
        value: PlanValue::Open,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by panicking")]
mod tests {
    use super::*;

    fn table() -> SymbolTable {
        SymbolTable::new(&|name| (name == "entry_words").then_some(2), &[]).unwrap()
    }

    #[test]
    fn handles_are_indices_of_the_table() {
        let table = table();
        for (id, name) in [(SymbolId::WIDTH, "width"), (SymbolId::KEPT, "kept"), (SymbolId::VALUE_WORDS, "value_words")]
        {
            assert_eq!((table.get(id).name.as_ref(), table.find(name)), (name, Some(id)));
        }
    }

    #[test]
    fn defaults_depend_on_values_of_the_frame() {
        let table = table();
        let frame = |id| {
            [(SymbolId::WIDTH, 4), (SymbolId::HEIGHT, 3), (SymbolId::FRAGMENTS, 25)]
                .into_iter()
                .find(|(known, _)| *known == id)
                .map(|(_, value)| value)
        };
        assert_eq!(table.value(SymbolId::PIXELS, &frame), Ok(12));
        assert_eq!(table.value(SymbolId::N, &frame), Ok(3));
        let frame_value = |id| if id == SymbolId::N { Some(7) } else { frame(id) };
        assert_eq!(table.evaluate(&table.compile(&"n * entry_words * pixels".into()).unwrap(), &frame_value), Ok(168));
        assert_eq!(table.value(SymbolId::K, &frame), Err(FormulaError::Unbound("k".into())));
        assert_eq!(table.compile(&"2 * unknown".into()), Err(FormulaError::Unbound("unknown".into())));
    }

    #[test]
    fn invalid_definitions_are_rejected() {
        let new = |definitions: &[(&str, &'static str)]| {
            let formulas: Vec<(&str, Formula)> =
                definitions.iter().map(|(name, text)| (*name, (*text).into())).collect();
            let formulas: Vec<(&str, &Formula)> = formulas.iter().map(|(name, formula)| (*name, formula)).collect();
            let number = |name: &str| (name == "entry_words").then_some(2);
            SymbolTable::new(&number, &formulas).map(|_| ()).map_err(|error| (error.symbol, error.problem))
        };
        let circular = |name: &str| Err((name.to_owned(), DefinitionProblem::Circular));
        assert_eq!(new(&[("pixels", "width * 2")]), Ok(()));
        assert_eq!(new(&[("fragments", "kept"), ("kept", "pixels * 2")]), Ok(()));
        assert_eq!(new(&[("pixels", "pixels * 2")]), circular("pixels"));
        // Cycles through other definitions and defaults.
        assert_eq!(new(&[("fragments", "kept"), ("kept", "fragments")]), circular("fragments"));
        assert_eq!(new(&[("height", "n"), ("width", "1")]), circular("height"));
        assert_eq!(new(&[("pixel", "width")]), Err(("pixel".to_owned(), DefinitionProblem::Unknown)));
        for duplicate in [&[("pixels", "width"), ("pixels", "height")][..], &[("entry_words", "3")]] {
            assert_eq!(new(duplicate).map_err(|(_, problem)| problem), Err(DefinitionProblem::Duplicate));
        }
        let unparsable = new(&[("pixels", "width *")]);
        assert!(
            matches!(unparsable, Err((_, DefinitionProblem::InvalidFormula(FormulaError::Malformed { .. })))),
            "{unparsable:?}"
        );
    }

    #[test]
    fn parameters_cannot_have_the_name_of_a_symbol() {
        let mut table = table();
        let mut add = |name: &'static str| table.add(&name.into(), &"".into(), (1, 9), 3);
        assert_eq!(add("LIMIT"), Ok(()));
        for name in ["LIMIT", "pixels", "k", "keep", "key", "depth_millionths", "pow2"] {
            assert_eq!(add(name), Err(NameTaken), "{name}");
        }
        assert_eq!((table.number_of("LIMIT"), table.number_of("k")), (Some(3), None));
    }
}

//! The symbols of one plan, and formulas over them.
//!
//! In: the vocabulary's table ([`SYMBOLS`]), the parameters of the chosen rows, the symbols that rows define. Out: one table
//! with a handle per symbol, and formulas whose symbols are handles. What a frame gives the symbols is not here.

use std::fmt;

use fragbuf_templates::vocabulary::{Expression, Formula, FormulaError, SYMBOLS, SetBy, Symbol, Text, When, apply};

/// A symbol of a plan: the place in its [`SymbolTable`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SymbolId(u16);

impl SymbolId {
    /// Columns of the frame.
    pub const WIDTH: SymbolId = builtin("width");
    /// Rows of the frame, or of a slice.
    pub const HEIGHT: SymbolId = builtin("height");
    /// The row at which a slice begins.
    pub const FIRST_ROW: SymbolId = builtin("first_row");
    /// Pixels of the frame and of its padding.
    pub const PIXELS: SymbolId = builtin("pixels");
    /// Fragments that a pixel keeps.
    pub const K: SymbolId = builtin("k");
    /// Slots of every pixel of a fixed array.
    pub const N: SymbolId = builtin("n");
    /// Fragments that a pool has memory for.
    pub const FRAGMENTS: SymbolId = builtin("fragments");
    /// Fragments that exact regions have memory for.
    pub const KEPT: SymbolId = builtin("kept");
    /// The iteration of the innermost loop.
    pub const ITERATION: SymbolId = builtin("iteration");
    /// The greatest k that the code serves.
    pub const CAPACITY: SymbolId = builtin("capacity");
    /// Words of a stored fragment.
    pub const ENTRY_WORDS: SymbolId = builtin("entry_words");
    /// Words of a stored fragment without its key.
    pub const BESIDE_WORDS: SymbolId = builtin("beside_words");

    /// The place in the table.
    pub fn index(self) -> usize {
        usize::from(self.0)
    }
}

/// The handle of a symbol that every plan has. A name that is not in the table does not compile.
const fn builtin(name: &str) -> SymbolId {
    let mut index = 0;
    while index < SYMBOLS.len() {
        if is_equal(SYMBOLS[index].name.as_bytes(), name.as_bytes()) {
            return SymbolId(index as u16);
        }
        index += 1;
    }
    // Only ever evaluated by the compiler, which stops here.
    #[allow(clippy::panic, reason = "an error at compile time")]
    {
        panic!("not a symbol of the vocabulary")
    }
}

const fn is_equal(a: &[u8], b: &[u8]) -> bool {
    let mut at = 0;
    while at < a.len() && at < b.len() && a[at] == b[at] {
        at += 1;
    }
    at == a.len() && at == b.len()
}

/// The symbols of a plan: those of the vocabulary in its order, then parameters of rows by their constants.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SymbolTable {
    symbols: Vec<PlanSymbol>,
}

/// A symbol of a plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PlanSymbol {
    /// The word in formulas.
    pub name: Text,
    /// What it is.
    pub meaning: Text,
    /// When it gets its value.
    pub when: When,
    /// Who gives it its value.
    pub set_by: SetBy,
    /// The least and the greatest value.
    pub range: (u64, u64),
    /// What the plan itself says of its value.
    pub value: PlanValue,
}

/// What a plan says of a symbol's value.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PlanValue {
    /// A number.
    Number(u64),
    /// This formula, unless a frame sets another value.
    Default(Quantity),
    /// Nothing: the frame sets it.
    Open,
}

/// A formula over the symbols of one plan.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Quantity {
    text: Formula,
    term: Term,
}

/// A formula, resolved.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Term {
    /// A whole number.
    Number(u64),
    /// A symbol.
    Symbol(SymbolId),
    /// An operator or a function, by its spelling.
    Apply(&'static str, Vec<Term>),
}

impl SymbolTable {
    /// The table of a plan: `number` gives the values of generation time, `defined` the formulas that rows give instead of a
    /// default. Parameters are added one by one ([`SymbolTable::add`]), because each may rest on the former.
    pub(crate) fn new(
        number: &dyn Fn(&str) -> Option<u64>,
        defined: &[(&str, &Formula)],
    ) -> Result<Self, FormulaError> {
        let mut table = SymbolTable { symbols: SYMBOLS.iter().map(open).collect() };
        for symbol in &mut table.symbols {
            if let Some(number) = number(&symbol.name) {
                symbol.value = PlanValue::Number(number);
            }
        }
        // Formulas are over symbols that have none themselves, so that none goes round in a circle.
        let mut defaults = Vec::new();
        for (index, symbol) in SYMBOLS.iter().enumerate() {
            let own = defined.iter().find(|(name, _)| *name == symbol.name).map(|(_, formula)| (*formula).clone());
            if let Some(formula) = own.or_else(|| symbol.default_formula()) {
                defaults.push((index, table.compile(&formula)?));
            }
        }
        for (index, quantity) in defaults {
            let circular = |id: SymbolId| SYMBOLS.get(id.index()).is_some_and(|symbol| symbol.default.is_some());
            if let Some(id) = quantity.symbols().into_iter().find(|id| circular(*id)) {
                return Err(FormulaError::Unbound(table.get(id).name.to_string()));
            }
            table.symbols[index].value = PlanValue::Default(quantity);
        }
        Ok(table)
    }

    /// Adds a parameter of a row.
    pub(crate) fn add(&mut self, constant: &Text, meaning: &Text, range: (u32, u32), value: u64) {
        self.symbols.push(PlanSymbol {
            name: constant.clone(),
            meaning: meaning.clone(),
            when: When::Generation,
            set_by: SetBy::Description,
            range: (range.0.into(), range.1.into()),
            value: PlanValue::Number(value),
        });
    }

    /// Bounds a symbol that frames set, and says its value where none does.
    pub(crate) fn bound(&mut self, id: SymbolId, range: (u64, u64), default: Option<Quantity>) {
        let symbol = &mut self.symbols[id.index()];
        symbol.range = range;
        if let Some(default) = default {
            symbol.value = PlanValue::Default(default);
        }
    }

    /// A symbol.
    pub fn get(&self, id: SymbolId) -> &PlanSymbol {
        &self.symbols[id.index()]
    }

    /// Every symbol with its handle, in order.
    pub fn iter(&self) -> impl Iterator<Item = (SymbolId, &PlanSymbol)> {
        self.symbols.iter().enumerate().map(|(index, symbol)| (SymbolId(index as u16), symbol))
    }

    /// The handle of a name, for what comes from outside.
    pub fn find(&self, name: &str) -> Option<SymbolId> {
        // Of a built-in symbol and a parameter of its name the latter counts: parameters are the row's own.
        let index = self.symbols.iter().rposition(|symbol| symbol.name == name)?;
        Some(SymbolId(index as u16))
    }

    /// The value of a symbol, if it has one when code is generated.
    pub fn number(&self, id: SymbolId) -> Option<u64> {
        match self.get(id).value {
            PlanValue::Number(number) => Some(number),
            _ => None,
        }
    }

    /// The same by name.
    pub fn number_of(&self, name: &str) -> Option<u64> {
        self.number(self.find(name)?)
    }

    /// A formula with its symbols resolved. `Err`: it cannot be read, or names a symbol that there is not.
    pub fn compile(&self, formula: &Formula) -> Result<Quantity, FormulaError> {
        Ok(Quantity { text: formula.clone(), term: self.term(&formula.read()?)? })
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

    /// The value of a symbol where a frame has `given` it one, else what the plan says.
    pub fn value(&self, id: SymbolId, given: &dyn Fn(SymbolId) -> Option<u64>) -> Result<u64, FormulaError> {
        match (&self.get(id).value, given(id)) {
            (PlanValue::Number(number), _) => Ok(*number),
            (_, Some(value)) => Ok(value),
            (PlanValue::Default(quantity), None) => self.evaluate(quantity, given),
            (PlanValue::Open, None) => Err(FormulaError::Unbound(self.get(id).name.to_string())),
        }
    }

    /// The value of a formula where a frame has `given` symbols these values.
    pub fn evaluate(&self, of: &Quantity, given: &dyn Fn(SymbolId) -> Option<u64>) -> Result<u64, FormulaError> {
        self.evaluate_term(&of.term, given)
    }

    fn evaluate_term(&self, term: &Term, given: &dyn Fn(SymbolId) -> Option<u64>) -> Result<u64, FormulaError> {
        match term {
            Term::Number(number) => Ok(*number),
            Term::Symbol(id) => self.value(*id, given),
            Term::Apply(operator, arguments) => {
                let mut values = Vec::with_capacity(arguments.len());
                for argument in arguments {
                    values.push(self.evaluate_term(argument, given)?);
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

impl Quantity {
    /// The formula as it was written.
    pub fn formula(&self) -> &Formula {
        &self.text
    }

    /// The formula, resolved.
    pub fn term(&self) -> &Term {
        &self.term
    }

    /// Whether the formula itself names the symbol.
    pub fn mentions(&self, id: SymbolId) -> bool {
        self.symbols().contains(&id)
    }

    /// The symbols that the formula names.
    pub fn symbols(&self) -> Vec<SymbolId> {
        fn collect(term: &Term, symbols: &mut Vec<SymbolId>) {
            match term {
                Term::Number(_) => {}
                Term::Symbol(id) => symbols.push(*id),
                Term::Apply(_, arguments) => arguments.iter().for_each(|argument| collect(argument, symbols)),
            }
        }
        let mut symbols = Vec::new();
        collect(&self.term, &mut symbols);
        symbols
    }
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.text.fmt(f)
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
    fn handles_are_the_tables_places() {
        let table = table();
        for (id, name) in
            [(SymbolId::WIDTH, "width"), (SymbolId::KEPT, "kept"), (SymbolId::BESIDE_WORDS, "beside_words")]
        {
            assert_eq!((table.get(id).name.as_ref(), table.find(name)), (name, Some(id)));
        }
    }

    #[test]
    fn defaults_rest_on_what_the_frame_gives() {
        let table = table();
        let frame = |id| {
            [(SymbolId::WIDTH, 4), (SymbolId::HEIGHT, 3), (SymbolId::FRAGMENTS, 25)]
                .into_iter()
                .find(|(known, _)| *known == id)
                .map(|(_, value)| value)
        };
        assert_eq!(table.value(SymbolId::PIXELS, &frame), Ok(12));
        assert_eq!(table.value(SymbolId::N, &frame), Ok(3));
        let given = |id| if id == SymbolId::N { Some(7) } else { frame(id) };
        assert_eq!(table.evaluate(&table.compile(&"n * entry_words * pixels".into()).unwrap(), &given), Ok(168));
        assert_eq!(table.value(SymbolId::K, &frame), Err(FormulaError::Unbound("k".into())));
        assert_eq!(table.compile(&"2 * unknown".into()), Err(FormulaError::Unbound("unknown".into())));
    }

    #[test]
    fn a_definition_in_a_circle_is_refused() {
        let circle = Formula::from("pixels * 2");
        assert!(SymbolTable::new(&|_| None, &[("pixels", &circle)]).is_err());
    }
}

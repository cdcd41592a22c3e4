//! The symbols of one plan, and formulas over them.
//!
//! In: the vocabulary's table ([`SYMBOLS`]), the parameters of the chosen rows, the symbols that rows define. Out: one table
//! with a handle per symbol, and formulas whose symbols are handles. What a frame gives the symbols is not here.

use std::fmt;

use fragbuf_templates::vocabulary::{
    Expression, Formula, FormulaError, SYMBOLS, SetBy, Symbol, Text, When, apply, is_word_of_formulas,
};

use crate::definitions::{Misdefined, Misdefinition};

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
    /// The whole formula.
    whole: Term,
    /// The same with every part computed that has a value when code is generated.
    term: Term,
}

/// Whether an operator says that something holds, which texts do by a type of its own.
pub fn is_truth(operator: &str) -> bool {
    matches!(operator, "==" | "!=" | "<" | "<=" | ">" | ">=" | "&&" | "||")
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

/// The name of a parameter's constant has another meaning in formulas.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct NameTaken;

impl SymbolTable {
    /// The table of a plan: `number` gives the values of generation time, `defined` the formulas that rows give instead of a
    /// default. Parameters are added one by one ([`SymbolTable::add`]), because each may rest on the former.
    pub(crate) fn new(number: &dyn Fn(&str) -> Option<u64>, defined: &[(&str, &Formula)]) -> Result<Self, Misdefined> {
        let mut table = SymbolTable { symbols: SYMBOLS.iter().map(open).collect() };
        for symbol in &mut table.symbols {
            if let Some(number) = number(&symbol.name) {
                symbol.value = PlanValue::Number(number);
            }
        }
        for (at, (name, formula)) in defined.iter().enumerate() {
            let fault = |problem| Misdefined { symbol: (*name).to_owned(), formula: (*formula).clone(), problem };
            let id = table.find(name).ok_or_else(|| fault(Misdefinition::Unknown))?;
            if table.number(id).is_some() || defined[..at].iter().any(|(other, _)| other == name) {
                return Err(fault(Misdefinition::Twice));
            }
        }
        table.define(defined)?;
        Ok(table)
    }

    /// Gives symbols their formulas: those of rows, else their defaults. None may go round in a circle.
    fn define(&mut self, defined: &[(&str, &Formula)]) -> Result<(), Misdefined> {
        for (index, symbol) in SYMBOLS.iter().enumerate() {
            let own = defined.iter().find(|(name, _)| *name == symbol.name).map(|(_, formula)| (*formula).clone());
            let Some(formula) = own.or_else(|| symbol.default_formula()) else { continue };
            let quantity = self.compile(&formula).map_err(|error| Misdefined {
                symbol: symbol.name.to_owned(),
                formula,
                problem: Misdefinition::NoFormula(error),
            })?;
            self.symbols[index].value = PlanValue::Default(quantity);
        }
        for (name, formula) in defined {
            if self.find(name).is_some_and(|id| self.rests_on_itself(id)) {
                let (symbol, formula) = ((*name).to_owned(), (*formula).clone());
                return Err(Misdefined { symbol, formula, problem: Misdefinition::Circular });
            }
        }
        Ok(())
    }

    /// Whether the formula of a symbol leads back to it, through those of others too.
    fn rests_on_itself(&self, id: SymbolId) -> bool {
        let formula_of = |id: SymbolId| match &self.get(id).value {
            PlanValue::Default(quantity) => quantity.symbols(),
            _ => Vec::new(),
        };
        let mut reached = formula_of(id);
        let mut at = 0;
        while let Some(next) = reached.get(at).copied() {
            reached.extend(formula_of(next).into_iter().filter(|id| !reached.contains(id)).collect::<Vec<_>>());
            at += 1;
        }
        reached.contains(&id)
    }

    /// Adds a parameter of a row. `Err`: its name means something else in formulas already.
    pub(crate) fn add(
        &mut self,
        constant: &Text,
        meaning: &Text,
        range: (u32, u32),
        value: u32,
    ) -> Result<(), NameTaken> {
        if is_word_of_formulas(constant) || self.find(constant).is_some() {
            return Err(NameTaken);
        }
        self.symbols.push(PlanSymbol {
            name: constant.clone(),
            meaning: meaning.clone(),
            when: When::Generation,
            set_by: SetBy::Description,
            range: (range.0.into(), range.1.into()),
            value: PlanValue::Number(value.into()),
        });
        Ok(())
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
        let index = self.symbols.iter().position(|symbol| symbol.name == name)?;
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

    /// A formula with its symbols resolved. `Err`: it cannot be read, names a symbol that there is not, or has a part that has
    /// no value in any frame.
    pub fn compile(&self, formula: &Formula) -> Result<Quantity, FormulaError> {
        let expression = formula.read()?;
        let whole = self.term(&expression)?;
        let term = self.term(&expression.folded(&|name| self.number_of(name))?)?;
        Ok(Quantity { text: formula.clone(), whole, term })
    }

    /// The same for a length, which shaders compute in words of 32 bits.
    pub fn length(&self, formula: &Formula) -> Result<Quantity, FormulaError> {
        let length = self.compile(formula)?;
        match length.term.greatest_number() {
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
        self.evaluate_term(&of.whole, given)
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

impl Term {
    fn greatest_number(&self) -> Option<u64> {
        match self {
            Term::Number(number) => Some(*number),
            Term::Symbol(_) => None,
            Term::Apply(_, arguments) => arguments.iter().filter_map(Term::greatest_number).max(),
        }
    }
}

impl Quantity {
    /// The formula as it was written.
    pub fn formula(&self) -> &Formula {
        &self.text
    }

    /// The formula as texts say it: resolved, and every part computed that has a value when code is generated.
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
        collect(&self.whole, &mut symbols);
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
    fn definitions_that_give_no_value_are_refused() {
        let new = |defined: &[(&str, &'static str)]| {
            let formulas: Vec<(&str, Formula)> = defined.iter().map(|(name, text)| (*name, (*text).into())).collect();
            let formulas: Vec<(&str, &Formula)> = formulas.iter().map(|(name, formula)| (*name, formula)).collect();
            let number = |name: &str| (name == "entry_words").then_some(2);
            SymbolTable::new(&number, &formulas).map(|_| ()).map_err(|fault| (fault.symbol, fault.problem))
        };
        let circular = |name: &str| Err((name.to_owned(), Misdefinition::Circular));
        assert_eq!(new(&[("pixels", "width * 2")]), Ok(()));
        assert_eq!(new(&[("fragments", "kept"), ("kept", "pixels * 2")]), Ok(()));
        assert_eq!(new(&[("pixels", "pixels * 2")]), circular("pixels"));
        // Not through defaults alone.
        assert_eq!(new(&[("fragments", "kept"), ("kept", "fragments")]), circular("fragments"));
        assert_eq!(new(&[("height", "n"), ("width", "1")]), circular("height"));
        assert_eq!(new(&[("pixel", "width")]), Err(("pixel".to_owned(), Misdefinition::Unknown)));
        for twice in [&[("pixels", "width"), ("pixels", "height")][..], &[("entry_words", "3")]] {
            assert_eq!(new(twice).map_err(|(_, problem)| problem), Err(Misdefinition::Twice));
        }
        let unread = new(&[("pixels", "width *")]);
        assert!(matches!(unread, Err((_, Misdefinition::NoFormula(FormulaError::Malformed { .. })))), "{unread:?}");
    }

    #[test]
    fn no_parameter_takes_the_name_of_a_symbol() {
        let mut table = table();
        let mut add = |name: &'static str| table.add(&name.into(), &"".into(), (1, 9), 3);
        assert_eq!(add("LIMIT"), Ok(()));
        for name in ["LIMIT", "pixels", "k", "keep", "key", "depth_millionths", "pow2"] {
            assert_eq!(add(name), Err(NameTaken), "{name}");
        }
        assert_eq!((table.number_of("LIMIT"), table.number_of("k")), (Some(3), None));
    }
}

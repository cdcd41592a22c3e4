//! Lines that declare an option, the default of a symbol, or a word of every fragment.
//!
//! Input: a line after its keyword. Output: a parameter, definition or extra word of the row.

use fragbuf_model::{Spanned, codes};
use fragbuf_templates::vocabulary::{
    BindingTime, Definition, Feature, ImplicitAttribute, Parameter, ParameterType, RowItem, SYMBOLS, Setter, Symbol,
    is_reserved_in_formulas,
};

use super::line::Line;
use super::reader::Read;
use super::statements::{Statements, summary};

/// The built-in values of fragment shaders that a word can have, all `u32` in WGSL, and the features that they require.
const BUILT_INS: [(&str, Feature); 1] = [("sample_mask", Feature::Coverage)];

/// Returns the symbols whose default a row can define: those that a frame sets, apart from k, which the description limits.
fn definable() -> impl Iterator<Item = &'static Symbol> {
    SYMBOLS.iter().filter(|symbol| {
        let is_sized = symbol.when == BindingTime::Allocation && symbol.set_by == Setter::Description;
        is_sized || (symbol.when == BindingTime::Readback && symbol.set_by == Setter::Host)
    })
}

impl Statements {
    /// Parses `parameter name CONSTANT = formula, from least to greatest -- summary`. After the range, [restrictions](Self::restriction).
    pub(super) fn parameter(&mut self, line: &mut Line<'_>) -> Read<()> {
        const SHAPE: &str = "`parameter limit SPIN_LIMIT = 4096, from 1 to 65536`";
        let name = self.reader.name(line, "the option's name", SHAPE)?;
        self.once(&format!("parameter {}", name.value), &name.span, "rename one of the options")?;
        let constant = self.constant(line, SHAPE)?;
        self.reader.punct(line, '=', SHAPE)?;
        let default = line.formula(&[',']);
        let symbols = self.symbols_until(BindingTime::Generation);
        self.reader.formula(&default, &symbols)?;
        self.reader.record_span(RowItem::Default, &default);
        if !line.punct(',') {
            return self.reader.unexpected(line, "`, from`", SHAPE);
        }
        let (kind, range) = match line.keyword("attribute") {
            true => (ParameterType::Attribute, (0, u32::MAX)),
            false => (ParameterType::Number, self.range(line, SHAPE)?),
        };
        let mut parameter = Parameter {
            name: name.value.clone().into(),
            constant: constant.value.into(),
            kind,
            default: default.value.into(),
            range,
            is_retry_limit: false,
            summary: summary(line).into(),
        };
        while line.punct(',') {
            self.restriction(line, &mut parameter)?;
        }
        self.user_row.row.parameters.push(parameter);
        self.user_row.spans.parameters.push(constant.span);
        Ok(())
    }

    /// Parses `from least to greatest`.
    fn range(&mut self, line: &mut Line<'_>, shape: &str) -> Read<(u32, u32)> {
        if !line.keyword("from") {
            return self.reader.unexpected(line, "`from` or `attribute`", shape);
        }
        let least = self.reader.number(line)?;
        if !line.keyword("to") {
            return self.reader.unexpected(line, "`to`", shape);
        }
        let greatest = self.reader.number(line)?;
        if greatest.value < least.value {
            let message = format!("empty range from {} to {}", least.value, greatest.value);
            let help = format!("write `from {} to {}`", greatest.value, least.value);
            return self.reader.stop(codes::INVALID_ROW, &greatest.span, message, help);
        }
        Ok((least.value, greatest.value))
    }

    /// Parses `power of two`, `at least formula`, a formula over k, or `retry limit`.
    fn restriction(&mut self, line: &mut Line<'_>, parameter: &mut Parameter) -> Read<()> {
        const SHAPE: &str = "`, power of two`, `, at least k / 32 + 1` or `, retry limit`";
        let start = line.here();
        if line.keyword("power") && line.keyword("of") && line.keyword("two") {
            if parameter.kind == ParameterType::Attribute {
                let message = "an attribute is not a power of two".to_owned();
                return self.reader.stop(codes::INVALID_ROW, &start, message, "remove `power of two`");
            }
            parameter.kind = ParameterType::PowerOfTwo;
            return Ok(());
        }
        if line.keyword("retry") && line.keyword("limit") {
            if parameter.kind == ParameterType::Attribute {
                let message = "an attribute is not a number of attempts".to_owned();
                return self.reader.stop(codes::INVALID_ROW, &start, message, "remove `retry limit`");
            }
            parameter.is_retry_limit = true;
            return Ok(());
        }
        if !(line.keyword("at") && line.keyword("least")) {
            return self.reader.unexpected(line, "`power of two`, `at least` or `retry limit`", SHAPE);
        }
        let least = line.formula(&[',']);
        self.reader.formula(&least, &["k"])?;
        self.user_row.row.least.push((parameter.name.clone(), least.value.into()));
        Ok(())
    }

    /// Parses the constant of a parameter. Formulas use it in addition to the symbols that every row has.
    fn constant(&mut self, line: &mut Line<'_>, shape: &str) -> Read<Spanned<String>> {
        let constant = self.reader.wgsl_name(line, "a generated constant", shape)?;
        if !is_reserved_in_formulas(&constant.value) {
            self.reader.record_span(RowItem::Constant, &constant);
            return Ok(constant);
        }
        let message = format!("the name `{}` is reserved in formulas", constant.value);
        let help = format!("choose another name, such as `OWN_{}`", constant.value.to_ascii_uppercase());
        self.reader.stop(codes::INVALID_ROW, &constant.span, message, help)
    }

    /// Parses `defines pixels = ceil_div(width, 4) * 4 * height`.
    pub(super) fn defines(&mut self, line: &mut Line<'_>) -> Read<()> {
        const SHAPE: &str = "`defines pixels = ceil_div(width, 4) * 4 * height`";
        let name = self.reader.name(line, "a symbol", SHAPE)?;
        let known: Vec<(&str, &Symbol)> = definable().map(|symbol| (symbol.name, symbol)).collect();
        let symbol = self.reader.one_of(&name, &known, "a symbol that a row can define")?;
        self.once(&format!("defines {}", symbol.name), &name.span, "remove one of them")?;
        self.reader.punct(line, '=', SHAPE)?;
        let value = line.formula(&[]);
        // Options get their values after the symbols. A definition that depends on itself is an error of the plan.
        let earlier = SYMBOLS.iter().filter(|other| other.when <= symbol.when && other.name != symbol.name);
        let earlier: Vec<&str> = earlier.map(|other| other.name).collect();
        self.reader.formula(&value, &earlier)?;
        self.reader.record_span(RowItem::Definition, &value);
        self.user_row.row.defines.push(Definition { symbol: symbol.name.into(), value: value.value.into() });
        Ok(())
    }

    /// Parses `adds name from built-in`.
    pub(super) fn adds(&mut self, line: &mut Line<'_>) -> Read<()> {
        const SHAPE: &str = "`adds coverage from sample_mask`";
        let name = self.reader.wgsl_name(line, "the name of a word", SHAPE)?;
        self.once(&format!("adds {}", name.value), &name.span, "remove one of them")?;
        if !line.keyword("from") {
            return self.reader.unexpected(line, "`from`", SHAPE);
        }
        let built_in = self.reader.name(line, "a built-in value", SHAPE)?;
        let feature = self.reader.one_of(&built_in, &BUILT_INS, "a built-in value of fragment shaders")?;
        self.once(&format!("adds … from {}", built_in.value), &built_in.span, "read the word that has it already")?;
        let row = &mut self.user_row.row;
        row.needs.push(feature);
        row.extra_words.push(ImplicitAttribute { name: name.value.into(), built_in: built_in.value.into() });
        Ok(())
    }
}

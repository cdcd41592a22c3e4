//! A generated description: printed as a file, or given to the builder part by part.

use std::fmt::Write as _;

use fragbuf_dsl::Registry;
use fragbuf_dsl::builder::{
    Buffer, Closure, Format, Function, KeepCount, OptionValue, TextureDimension, UniformType, Value, value,
};
use fragbuf_templates::vocabulary::ParameterType;

/// A seeded generator (SplitMix64), the same on every machine.
pub struct Random(pub u64);

impl Random {
    pub fn below(&mut self, bound: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) % bound as u64) as usize
    }

    pub fn once_in(&mut self, times: usize) -> bool {
        self.below(times) == 0
    }

    pub fn choose_from<'a, T>(&mut self, list: &'a [T]) -> &'a T {
        &list[self.below(list.len())]
    }
}

type OptionEntry = (String, OptionValue);
type Choice = (String, Vec<(String, Vec<OptionEntry>)>);

#[derive(Default)]
pub struct Description {
    name: String,
    preset: Option<String>,
    attributes: Vec<(String, Format)>,
    uniforms: Vec<(String, UniformType)>,
    textures: Vec<(String, TextureDimension)>,
    images: Vec<(String, String)>,
    keep: Vec<(Option<u32>, Option<String>)>,
    constraints: Vec<String>,
    choices: Vec<Choice>,
    resolve: Option<String>,
    between: Option<String>,
    helpers: Vec<String>,
}

impl Description {
    pub fn from(preset: &str) -> Self {
        Description { name: "Any".to_owned(), preset: Some(preset.to_owned()), ..Description::default() }
    }

    pub fn choose(&mut self, axis: &str, value: &str) {
        let alternatives = value.split(" else ").map(|value| (value.to_owned(), Vec::new()));
        self.choices.push((axis.to_owned(), alternatives.collect()));
    }

    pub fn random(random: &mut Random, registry: &Registry) -> Self {
        let presets: Vec<&str> = registry.techniques().iter().map(|technique| technique.key.as_str()).collect();
        let name = if random.once_in(25) { "lower" } else { random.choose_from(&["Glass", "MostVisible", "A"]) };
        let mut description = Description { name: name.to_owned(), ..Description::default() };
        description.preset = (!random.once_in(8)).then(|| (*random.choose_from(&presets)).to_owned());
        description.rows(random);
        description.functions(random);
        for _ in 0..random.below(3) {
            description.choices.push(choice(random, registry));
        }
        description
    }

    fn rows(&mut self, random: &mut Random) {
        if !random.once_in(3) {
            self.attributes.push(("color".to_owned(), *random.choose_from(&[Format::Rgba8, Format::Vec4])));
            if !random.once_in(20) {
                self.attributes.push(("depth".to_owned(), Format::F32));
            }
            for name in ["id", "normal", "r#type", "sample", "heat"] {
                if random.once_in(3) {
                    self.attributes.push((name.to_owned(), *random.choose_from(&Format::ALL)));
                }
            }
            if random.once_in(12) {
                self.attributes
                    .push((random.choose_from(&["depth", "vec3", "match", "größe"]).to_string(), Format::F32));
            }
        }
        for name in ["lut", "volume", "far"] {
            if random.once_in(6) {
                self.textures.push((name.to_owned(), *random.choose_from(&TextureDimension::ALL)));
            }
        }
        for name in ["far", "eye", "steps", "texture"] {
            if random.once_in(2) {
                self.uniforms.push((name.to_owned(), *random.choose_from(&UniformType::ALL)));
            }
        }
    }

    fn functions(&mut self, random: &mut Random) {
        if !random.once_in(3) {
            let count = if random.once_in(5) { None } else { Some(random.below(12) as u32) };
            let criterion = (!random.once_in(3)).then(|| format!("|f, u| {}", self.number(random, 3)));
            self.keep.push((count, criterion));
            if random.once_in(30) {
                self.keep.push((Some(2), None));
            }
        }
        for _ in 0..random.below(3) {
            let (left, right) = (self.number(random, 2), self.number(random, 2));
            self.constraints.push(format!("|f: Fragment, u| -> bool {{ {left} < {right} }}"));
        }
        if random.once_in(2) {
            let name = random.choose_from(&["weight", "weight", "resolve", "vec2"]);
            let body = self.number(random, 2);
            self.helpers.push(format!("fn {name}(f: Fragment, u: Uniforms, x: f32) -> f32 {{ {body} + x }}"));
        }
        for name in ["near", "blurred", "lut"] {
            if random.once_in(10) {
                let value = self.number(random, 1).replace("f.", "fragments[0].");
                let earlier = random.choose_from(&["0.0", "0.0", "u.near.at(1, -1).x", "u.late.at(0, 0).y"]);
                let closure = format!("|fragments, u| Vec4::splat({value} + {earlier})");
                self.images.push((name.to_owned(), closure));
            }
        }
        if random.once_in(8) {
            let (front, back) = (self.number(random, 1), self.number(random, 1));
            let (front, back) = (front.replace("f.", "front."), back.replace("f.", "back."));
            self.between = Some(format!("|front, back, gap, u| Vec4::splat({front} * gap - {back})"));
        }
        if random.once_in(2) {
            let factor = self.number(random, 2);
            self.resolve = Some(format!(
                "|fragments, u| {{
                    let mut sum = Vec4::ZERO; // so far
                    for (i, f) in fragments.iter().enumerate() {{
                        if i > 6 {{ break; }}
                        sum += vec4({factor}, 0.0, 0.0, 1.0) * (1.0 - sum.w);
                    }}
                    sum
                }}"
            ));
        }
    }

    /// Returns an expression of type `f32`; one in 100 has an error.
    fn number(&self, random: &mut Random, depth: usize) -> String {
        if random.once_in(100) {
            return random
                .choose_from(&["f.deph", "1", "f.depth.round()", "true", "u.nothing", "x y", "&f.depth"])
                .to_string();
        }
        if depth == 0 {
            return self.leaf(random);
        }
        let (left, right) = (self.number(random, depth - 1), self.number(random, depth - 1));
        match random.below(7) {
            0 => format!("({left} + {right})"),
            1 => format!("{left} * {right}"),
            2 => format!("({left} - {right}).abs()"),
            3 => format!("f32::max({left}, {right})"),
            4 => format!("if {left} < {right} {{ {left} }} else {{ -{right} }}"),
            5 => format!("({{ let x: f32 = {left}; x * {right} }})"),
            _ => self.leaf(random),
        }
    }

    fn leaf(&self, random: &mut Random) -> String {
        let mut leaves = vec!["f.depth".to_owned(), "0.25".to_owned(), "2.5e-1_f32".to_owned(), "f32::MAX".to_owned()];
        leaves.extend(self.attributes.iter().map(|(name, format)| match format {
            Format::F32 => format!("f.{name}"),
            Format::U32 => format!("f.{name} as f32"),
            _ => format!("f.{name}.y"),
        }));
        leaves.extend(self.uniforms.iter().map(|(name, kind)| match kind {
            UniformType::F32 => format!("u.{name}"),
            UniformType::U32 | UniformType::I32 => format!("(u.{name} as f32)"),
            UniformType::Vec2 | UniformType::Vec3 | UniformType::Vec4 => format!("u.{name}.length()"),
        }));
        leaves.extend(self.textures.iter().map(|(name, dimension)| match dimension {
            TextureDimension::D2 => format!("u.{name}.sample(vec2(f.depth, 0.5)).x"),
            TextureDimension::D3 => format!("u.{name}.load(1, f.depth as i32, 0).w"),
        }));
        random.choose_from(&leaves).clone()
    }

    /// Returns the source of a `.fragbuf` file.
    pub fn source(&self) -> String {
        let mut source = format!("buffer {}", self.name);
        if let Some(preset) = &self.preset {
            let _ = write!(source, " from {preset}");
        }
        source.push_str(" {\n");
        let block = |keyword: &str, rows: Vec<String>| match rows.is_empty() {
            true => String::new(),
            false => format!("    {keyword} {{ {} }}\n", rows.join(", ")),
        };
        let rows = self.attributes.iter().map(|(name, format)| format!("{name}: {}", format.keyword()));
        source.push_str(&block("fragment", rows.collect()));
        let rows = self.uniforms.iter().map(|(name, kind)| format!("{name}: {}", kind.keyword()));
        source.push_str(&block("uniform", rows.collect()));
        let rows = self.textures.iter().map(|(name, dimension)| format!("{name}: {}", dimension.keyword()));
        source.push_str(&block("texture", rows.collect()));
        for (count, criterion) in &self.keep {
            let count = count.map_or("all".to_owned(), |count| count.to_string());
            let criterion = criterion.as_ref().map_or(String::new(), |criterion| format!(" least {criterion}"));
            let _ = writeln!(source, "    keep {count}{criterion};");
        }
        for constraint in &self.constraints {
            let _ = writeln!(source, "    where {constraint};");
        }
        for helper in &self.helpers {
            let _ = writeln!(source, "    {helper}");
        }
        for (axis, alternatives) in &self.choices {
            let alternatives: Vec<String> = alternatives.iter().map(alternative_source).collect();
            let _ = writeln!(source, "    {axis}: {};", alternatives.join(" else "));
        }
        for (name, closure) in &self.images {
            let _ = writeln!(source, "    image {name} {closure};");
        }
        if let Some(between) = &self.between {
            let _ = writeln!(source, "    between {between};");
        }
        if let Some(resolve) = &self.resolve {
            let _ = writeln!(source, "    resolve {resolve}");
        }
        source.push_str("}\n");
        source
    }

    /// Returns the same description in the builder.
    pub fn builder(&self) -> Buffer {
        let mut buffer = Buffer::named(&self.name);
        if let Some(preset) = &self.preset {
            buffer = buffer.from(preset);
        }
        for (name, format) in &self.attributes {
            buffer = buffer.attribute(name, *format);
        }
        for (name, kind) in &self.uniforms {
            buffer = buffer.uniform(name, *kind);
        }
        for (name, dimension) in &self.textures {
            buffer = buffer.texture(name, *dimension);
        }
        for (count, criterion) in &self.keep {
            let count = count.map_or(KeepCount::All, KeepCount::from);
            buffer = match criterion {
                Some(criterion) => buffer.keep_least(count, Closure::text(criterion)),
                None => buffer.keep(count),
            };
        }
        for constraint in &self.constraints {
            buffer = buffer.constraint(Closure::text(constraint));
        }
        for helper in &self.helpers {
            buffer = buffer.helper(Function::text(helper));
        }
        for (axis, alternatives) in &self.choices {
            let alternatives = alternatives.iter().map(|(key, options)| {
                options.iter().fold(value(key), |value, (name, option)| value.option(name, option.clone()))
            });
            buffer = buffer.choose(axis, alternatives.reduce(Value::or_else).unwrap());
        }
        for (name, closure) in &self.images {
            buffer = buffer.image(name, Closure::text(closure));
        }
        if let Some(between) = &self.between {
            buffer = buffer.between(Closure::text(between));
        }
        match &self.resolve {
            Some(resolve) => buffer.resolve(Closure::text(resolve)),
            None => buffer,
        }
    }
}

/// Returns an alternative as a description writes it.
fn alternative_source((value, options): &(String, Vec<OptionEntry>)) -> String {
    let option = |(name, value): &OptionEntry| match value {
        OptionValue::Number(number) => format!("{name}: {number}"),
        OptionValue::Name(value) => format!("{name}: {value}"),
    };
    match options.is_empty() {
        true => value.clone(),
        false => format!("{value} {{ {} }}", options.iter().map(option).collect::<Vec<_>>().join(", ")),
    }
}

fn choice(random: &mut Random, registry: &Registry) -> Choice {
    let axes: Vec<&str> = registry.axes().iter().filter(|axis| axis.chosen).map(|axis| axis.key).collect();
    let axis = if random.once_in(20) { "strage" } else { *random.choose_from(&axes) };
    let rows: Vec<_> = registry.rows_of(axis).collect();
    let mut alternatives = Vec::new();
    for _ in 0..1 + random.below(2) {
        if rows.is_empty() || random.once_in(15) {
            alternatives.push(("nothing".to_owned(), Vec::new()));
            continue;
        }
        let row = random.choose_from(&rows);
        let mut options: Vec<OptionEntry> = Vec::new();
        for parameter in &row.parameters {
            if random.once_in(2) {
                let number = match parameter.kind {
                    ParameterType::Number => OptionValue::Number(parameter.range.0 + random.below(3) as u32),
                    ParameterType::PowerOfTwo => OptionValue::Number(parameter.range.0 << random.below(2)),
                    ParameterType::Attribute => OptionValue::from("depth"),
                };
                let option = if random.once_in(10) { OptionValue::from("many") } else { number };
                options.push((parameter.name.to_string(), option.clone()));
                if random.once_in(10) {
                    options.push((parameter.name.to_string(), option));
                }
            }
        }
        alternatives.push((row.key.clone(), options));
    }
    (axis.to_owned(), alternatives)
}

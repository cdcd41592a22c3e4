//! Lines of a row about descriptions and end states: conditions, which fragments stay, hazards, soundness.

use fragbuf_model::{Spanned, codes};
use fragbuf_templates::Shorthand;
use fragbuf_templates::vocabulary::{Condition, Hazard, KEY_SYMBOLS, Kept, Permits, Side, Soundness};

use super::line::Line;
use super::reader::Read;
use super::statements::{Statements, summary};

impl Statements {
    /// `when condition -- how to meet it`
    pub(super) fn when(&mut self, line: &mut Line<'_>) -> Read<()> {
        let formula = self.reader.condition(line)?;
        let hint = line.summary.map_or_else(|| format!("change the description so that `{formula}`"), str::to_owned);
        let meaning = format!("`{formula}`");
        self.own.row.conditions.push(Condition::new(formula, meaning, hint));
        Ok(())
    }

    /// `implies fact when condition`
    pub(super) fn implies(&mut self, line: &mut Line<'_>) -> Read<()> {
        let then = self.reader.fact(line)?;
        if !line.exactly("when") {
            return self.reader.unexpected(line, "`when`", "`implies sorted when depth_key`");
        }
        let when = self.reader.condition(line)?;
        self.own.row.implies.push((when, then));
        Ok(())
    }

    /// `keeps best 1 of each key / 1000`
    pub(super) fn keeps(&mut self, line: &mut Line<'_>) -> Read<()> {
        const SHAPE: &str = "`keeps best k`, `keeps best 1 of each key / 1000`";
        let side = self.reader.word(line, "`best` or `worst`", SHAPE)?;
        let side = self.reader.one_of(&side, &[("best", Side::Best), ("worst", Side::Worst)], "no side")?;
        let text = line.until(&[]);
        let (most, group) = match text.value.split_once(" of each ") {
            Some((most, group)) => (most.trim(), Some(group.trim())),
            None => (text.value.as_str(), None),
        };
        let at = |part: &str| Spanned::new(part.to_owned(), text.origin.clone());
        self.reader.formula(&at(most), &["k"])?;
        if let Some(group) = group {
            let constants = self.own.row.parameters.iter().map(|parameter| parameter.constant.to_string());
            let symbols = ["k"].into_iter().chain(KEY_SYMBOLS).map(str::to_owned);
            let symbols: Vec<String> = symbols.chain(constants).collect();
            let symbols: Vec<&str> = symbols.iter().map(String::as_str).collect();
            self.reader.formula(&at(group), &symbols)?;
        }
        let (most, group) = (Some(most.to_owned().into()), group.map(|group| group.to_owned().into()));
        self.own.row.keeps = Some(Kept { side, most, group });
        Ok(())
    }

    /// `hazard name permits name, name unless fact -- what`
    pub(super) fn hazard(&mut self, line: &mut Line<'_>) -> Read<()> {
        let name = self.reader.word(line, "the hazard's name", "`hazard torn -- what happens`")?;
        let own = self.permits_of(&name)?;
        let permits = if line.exactly("permits") { self.permitted(line)? } else { vec![own] };
        let unless = if line.exactly("unless") { Some(self.reader.fact(line)?) } else { None };
        if unless.is_some() && matches!(Shorthand::of(&name.value), Some(Shorthand::Keeps(_) | Shorthand::Merges(_))) {
            let message = format!("`{}` says what the row does with fragments, whatever other rows offer", name.value);
            return self.reader.stop(codes::ROW, &name.origin, message, "leave `unless` and its fact out");
        }
        let (what, is_one) = (summary(line), permits.len() == 1);
        for permits in permits {
            let what = if is_one { what.clone() } else { format!("{what}, {}", when(&permits)) };
            self.own.row.hazards.push(Hazard { name: name.value.clone().into(), what: what.into(), permits, unless });
        }
        Ok(())
    }

    /// `name, name`: what is permitted, apart where the conditions are.
    fn permitted(&mut self, line: &mut Line<'_>) -> Read<Vec<Permits>> {
        let mut all: Vec<Permits> = Vec::new();
        loop {
            let word = self.reader.word(line, "what it permits", "`hazard mixed permits torn, stale`")?;
            let more = self.reader.permits(&word)?;
            match all.iter_mut().find_map(|permits| permits.and(&more).map(|joined| (permits, joined))) {
                Some((permits, joined)) => *permits = joined,
                None => all.push(more),
            }
            if !line.sign(',') {
                return Ok(all);
            }
        }
    }

    /// What a hazard's name permits by itself; some names say what the row keeps or merges, which a row says once.
    fn permits_of(&mut self, name: &Spanned<String>) -> Read<Permits> {
        const HINT: &str = "which fragments stay, and how they merge, is said once: leave one of the lines out";
        match Shorthand::of(&name.value) {
            Some(Shorthand::Permits(permits)) => return Ok(permits),
            Some(Shorthand::Keeps(kept)) => {
                self.once("keeps", &name.origin, HINT)?;
                self.own.row.keeps = Some(kept);
            }
            Some(Shorthand::Merges(merges)) => {
                self.once("merged", &name.origin, HINT)?;
                self.own.row.merges = Some(merges);
            }
            None => {}
        }
        Ok(Permits::NOTHING)
    }

    pub(super) fn soundness(&mut self, line: &mut Line<'_>) -> Read<()> {
        let word = self.reader.word(line, "what it rests on", "`soundness atomics`")?;
        let known = Soundness::ALL.map(|soundness| (soundness.word(), soundness));
        let known: Vec<(&str, Soundness)> = known.iter().map(|(word, soundness)| (word.as_str(), *soundness)).collect();
        self.own.row.soundness = self.reader.one_of(&word, &known, "no soundness")?;
        Ok(())
    }
}

/// When permits show, in words.
fn when(permits: &Permits) -> String {
    match &permits.where_counted {
        Some(counter) => format!("where `{counter}` is counted"),
        None if permits.needs_race => "in a race".to_owned(),
        None => "whatever the order".to_owned(),
    }
}

//! Lines of a row about descriptions and final states: conditions, kept fragments, hazards and soundness.
//!
//! Input: a line after its keyword. Output: a property of the row.

use fragbuf_model::{Spanned, codes};
use fragbuf_templates::Shorthand;
use fragbuf_templates::vocabulary::{Condition, Hazard, KEY_SYMBOLS, KeptFragments, Permits, Side, Soundness};

use super::line::Line;
use super::reader::Read;
use super::statements::{Statements, summary};

impl Statements {
    /// Parses `when condition -- fix`.
    pub(super) fn when(&mut self, line: &mut Line<'_>) -> Read<()> {
        let formula = self.reader.condition(line)?;
        let help = line.summary.map_or_else(|| format!("change the description so that `{formula}`"), str::to_owned);
        let meaning = format!("`{formula}`");
        self.user_row.row.conditions.push(Condition::new(formula, meaning, help));
        Ok(())
    }

    /// Parses `implies capability when condition`.
    pub(super) fn implies(&mut self, line: &mut Line<'_>) -> Read<()> {
        let then = self.reader.capability(line)?;
        if !line.keyword("when") {
            return self.reader.unexpected(line, "`when`", "`implies sorted when depth_key`");
        }
        let when = self.reader.condition(line)?;
        self.user_row.row.implies.push((when, then));
        Ok(())
    }

    /// Parses `keeps best 1 of each key / 1000 at most k`.
    pub(super) fn keeps(&mut self, line: &mut Line<'_>) -> Read<()> {
        const SHAPE: &str = "`keeps best k`, `keeps best 1 of each key / 1000`, `… at most k`";
        let side = self.reader.name(line, "`best` or `worst`", SHAPE)?;
        let side = self.reader.one_of(&side, &[("best", Side::Best), ("worst", Side::Worst)], "`best` or `worst`")?;
        let kept = line.formula(&[]);
        let (most, group) = match kept.value.split_once(" of each ") {
            Some((most, group)) => (most.trim(), Some(group.trim())),
            None => (kept.value.as_str(), None),
        };
        let (group, most_groups) = match group.and_then(|group| group.split_once(" at most ")) {
            Some((group, most)) => (Some(group.trim()), Some(most.trim())),
            None => (group, None),
        };
        let at = |part: &str| Spanned::new(part.to_owned(), kept.span.clone());
        for most in std::iter::once(most).chain(most_groups) {
            self.reader.formula(&at(most), &["k"])?;
        }
        if let Some(group) = group {
            let constants = self.user_row.row.parameters.iter().map(|parameter| parameter.constant.to_string());
            let symbols = ["k"].into_iter().chain(KEY_SYMBOLS).map(str::to_owned);
            let symbols: Vec<String> = symbols.chain(constants).collect();
            let symbols: Vec<&str> = symbols.iter().map(String::as_str).collect();
            self.reader.formula(&at(group), &symbols)?;
        }
        let formula = |text: Option<&str>| text.map(|text| text.to_owned().into());
        let (most, group, most_groups) = (formula(Some(most)), formula(group), formula(most_groups));
        self.user_row.row.keeps = Some(KeptFragments { side, most, group, most_groups });
        Ok(())
    }

    /// Parses `hazard name permits name, name unless capability -- description`.
    pub(super) fn hazard(&mut self, line: &mut Line<'_>) -> Read<()> {
        let name = self.reader.name(line, "the hazard's name", "`hazard torn -- what happens`")?;
        let by_name = self.permits_of(&name)?;
        let permits = if line.keyword("permits") { self.permitted(line)? } else { vec![by_name] };
        let unless = if line.keyword("unless") { Some(self.reader.capability(line)?) } else { None };
        if unless.is_some() && matches!(Shorthand::of(&name.value), Some(Shorthand::Keeps(_) | Shorthand::Merges(_))) {
            let message = format!("`{}` holds for every combination of rows, so it takes no `unless`", name.value);
            return self.reader.stop(codes::INVALID_ROW, &name.span, message, "remove `unless` and its capability");
        }
        let (what, is_one) = (summary(line), permits.len() == 1);
        for permits in permits {
            let what = if is_one { what.clone() } else { format!("{what}, {}", circumstances(&permits)) };
            self.user_row.row.hazards.push(Hazard {
                name: name.value.clone().into(),
                description: what.into(),
                permits,
                unless,
            });
        }
        Ok(())
    }

    /// Parses `name, name`; returns one entry per condition.
    fn permitted(&mut self, line: &mut Line<'_>) -> Read<Vec<Permits>> {
        let mut all: Vec<Permits> = Vec::new();
        loop {
            let name = self.reader.name(line, "a permitted effect", "`hazard mixed permits torn, stale`")?;
            let more = self.reader.permits(&name)?;
            match all.iter_mut().find_map(|permits| permits.and(&more).map(|joined| (permits, joined))) {
                Some((permits, joined)) => *permits = joined,
                None => all.push(more),
            }
            if !line.punct(',') {
                return Ok(all);
            }
        }
    }

    /// Returns what the name of a hazard permits. Some names set what the row keeps or merges, which a row sets once.
    fn permits_of(&mut self, name: &Spanned<String>) -> Read<Permits> {
        const HELP: &str = "a row sets once which fragments it keeps and how it merges them: remove one of the lines";
        match Shorthand::of(&name.value) {
            Some(Shorthand::Permits(permits)) => return Ok(permits),
            Some(Shorthand::Keeps(kept)) => {
                self.once("keeps", &name.span, HELP)?;
                self.user_row.row.keeps = Some(kept);
            }
            Some(Shorthand::Merges(merges)) => {
                self.once("merged", &name.span, HELP)?;
                self.user_row.row.merges = Some(merges);
            }
            None => {}
        }
        Ok(Permits::NOTHING)
    }

    /// Parses `soundness name`.
    pub(super) fn soundness(&mut self, line: &mut Line<'_>) -> Read<()> {
        let name = self.reader.name(line, "a soundness", "`soundness atomics`")?;
        let known = Soundness::ALL.map(|soundness| (soundness.name(), soundness));
        let known: Vec<(&str, Soundness)> = known.iter().map(|(name, soundness)| (name.as_str(), *soundness)).collect();
        self.user_row.row.soundness = self.reader.one_of(&name, &known, "a soundness")?;
        Ok(())
    }
}

/// Returns a description of when the permitted effects occur.
fn circumstances(permits: &Permits) -> String {
    match &permits.where_counted {
        Some(counter) => format!("where `{counter}` is counted"),
        None if permits.needs_race => "in a race".to_owned(),
        None => "in any order".to_owned(),
    }
}

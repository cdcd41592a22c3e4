//! `fragbuf explain`: prints the section of the guide about a diagnostic or a counter.

use fragbuf::guide;
use fragbuf_model::{codes, nearest_name};
#[cfg(feature = "pictures")]
use fragbuf_scene::WarningKind;
use fragbuf_templates::COUNTERS;

use super::output::{self, Failure};

#[derive(clap::Args)]
pub(crate) struct Explain {
    /// Code of a diagnostic, as in `error[unknown-field]`, or name of a counter, such as `timed_out` [default: list them]
    code: Option<String>,
}

impl Explain {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let Some(given) = &self.code else {
            let names = codes::ALL.iter().map(|code| code.name).chain(counters());
            let widest = names.map(str::len).max().unwrap_or(0);
            let lines = codes::ALL.iter().map(|code| format!("{:widest$}  {}\n", code.name, code.meaning));
            let models = model_codes().into_iter().filter(|name| codes::ALL.iter().all(|code| code.name != *name));
            let models = models.map(|name| format!("{name:widest$}  a warning about a model\n"));
            let counters = counters().map(|name| format!("{name:widest$}  a counter of a frame\n"));
            return output::print(&lines.chain(models).chain(counters).collect::<String>());
        };
        // `error[unknown-field]` is what the user copies.
        let inside = given.split_once('[').and_then(|(_, rest)| rest.split(']').next());
        let name = inside.unwrap_or(given);
        let Some(section) = guide::explanation(name) else {
            let known: Vec<&str> =
                codes::ALL.iter().map(|code| code.name).chain(model_codes()).chain(counters()).collect();
            let help = match nearest_name(name, &known) {
                Some(nearest) => format!("did you mean `{nearest}`?"),
                None => "`fragbuf explain` lists the codes and counters".to_owned(),
            };
            return Err(Failure::Usage(format!("no diagnostic or counter `{name}`: {help}")));
        };
        output::print(&section)
    }
}

/// Returns the names of the counters.
fn counters() -> impl Iterator<Item = &'static str> {
    COUNTERS.iter().map(|(name, ..)| *name)
}

/// Returns the codes of warnings about models.
fn model_codes() -> Vec<&'static str> {
    #[cfg(feature = "pictures")]
    return WarningKind::ALL.iter().map(|kind| kind.code()).collect();
    #[cfg(not(feature = "pictures"))]
    Vec::new()
}

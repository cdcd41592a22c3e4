//! `fragbuf explain`: prints the section of the guide about a diagnostic.

use fragbuf::guide;
use fragbuf_model::codes;

use super::output::{self, Failure};

#[derive(clap::Args)]
pub(crate) struct Explain {
    /// Code of the diagnostic, as in `error[unknown-field]` [default: list the codes]
    code: Option<String>,
}

impl Explain {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let Some(given) = &self.code else {
            let widest = codes::ALL.iter().map(|code| code.name.len()).max().unwrap_or(0);
            let lines = codes::ALL.iter().map(|code| format!("{:widest$}  {}\n", code.name, code.meaning));
            return output::print(&lines.collect::<String>());
        };
        // `error[unknown-field]` is what the user copies.
        let name = given.split_once('[').map_or(given.as_str(), |(_, rest)| rest.trim_end_matches(']'));
        let Some(section) = guide::explanation(name) else {
            let known: Vec<&str> = codes::ALL.iter().map(|code| code.name).collect();
            return Err(Failure::unknown("diagnostic", name, &known));
        };
        output::print(&section)
    }
}

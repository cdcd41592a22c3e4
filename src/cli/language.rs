//! `fragbuf language`: prints the reference of the closure language, computed from the type checker's tables.

use super::output::{self, Failure};

#[derive(clap::Args)]
pub(crate) struct Language {}

impl Language {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        output::print(&fragbuf_syntax::reference())
    }
}

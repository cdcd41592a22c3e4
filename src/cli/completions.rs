//! `fragbuf completions`: prints the completions for a shell.

use clap::CommandFactory as _;
use clap_complete::Shell;

use super::Arguments;
use super::output::{self, Failure};

#[derive(clap::Args)]
pub(crate) struct Completions {
    /// Shell
    #[arg(value_enum)]
    shell: Shell,
}

impl Completions {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut Arguments::command(), "fragbuf", &mut script);
        output::print(&String::from_utf8_lossy(&script))
    }
}

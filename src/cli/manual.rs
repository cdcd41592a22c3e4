//! `fragbuf man`: prints the manual page, or writes one page per command.

use std::path::PathBuf;

use clap::CommandFactory as _;
use clap_mangen::Man;

use super::Arguments;
use super::output::{self, Failure};

#[derive(clap::Args)]
pub(crate) struct Manual {
    /// Write fragbuf.1 and a page per command, fragbuf-render.1 and so on, to this folder
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
}

impl Manual {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let command = Arguments::command();
        let Some(folder) = &self.out else {
            let mut page = Vec::new();
            Man::new(command).render(&mut page).map_err(|error| Failure::Files(error.to_string()))?;
            return output::print(&String::from_utf8_lossy(&page));
        };
        Failure::unless_folder(folder)?;
        std::fs::create_dir_all(folder).map_err(|error| Failure::files(folder, &error))?;
        clap_mangen::generate_to(command, folder).map_err(|error| Failure::files(folder, &error))
    }
}

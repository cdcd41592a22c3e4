//! `fragbuf playground`: a page on the loopback interface to edit a description, see its picture, its cost and its text, and check it.
//!
//! `server` answers requests: `assets` are the files of the page, which are all in the binary, and the other modules answer one kind of
//! request each. Requests that take milliseconds run in this process; `child` runs the others as commands of this program, which are killed
//! when they take too long or their requests are cancelled. The page loads nothing from other hosts, and `guard` refuses requests of other
//! pages.

mod analyse;
mod assets;
mod child;
mod commands;
mod description;
mod editor;
mod generate;
mod geometry;
mod guard;
mod models;
mod problem;
mod scene;
mod server;
mod start;

pub(super) use assets::{HOST, asset};
pub(super) use description::NAME as DESCRIPTION;
pub(super) use geometry::triangles;
pub(super) use start::example;

use std::net::{Ipv4Addr, TcpListener};
use std::path::{Path, PathBuf};

use super::output::{self, Failure};

#[derive(clap::Args)]
pub(crate) struct Playground {
    /// Folder that descriptions read user files from. Without it they read none
    #[arg(value_name = "FOLDER")]
    folder: Option<PathBuf>,
    /// Port on 127.0.0.1 [default: a free one]
    #[arg(long, value_name = "PORT", default_value_t = 0, hide_default_value = true)]
    port: u16,
    /// Print the address of the page without opening a browser
    #[arg(long)]
    no_open: bool,
}

impl Playground {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let folder = self.folder.as_deref().map(existing).transpose()?;
        let listener = TcpListener::bind((Ipv4Addr::LOCALHOST, self.port)).map_err(|error| {
            Failure::Files(format!("port {}: {error}: leave out `--port` for a free one", self.port))
        })?;
        let address = listener.local_addr().map_err(|error| Failure::Files(format!("the server: {error}")))?;
        let url = format!("http://{address}/");
        output::print(&format!("{url}\n"))?;
        output::note("the page is open to this machine alone; Ctrl-C ends it");
        if !self.no_open
            && let Err(error) = open::that_detached(&url)
        {
            output::warn(&format!("no browser could be opened: {error}: open the address above"));
        }
        server::run(listener, address, folder).map_err(|error| Failure::Files(format!("the server: {error}")))
    }
}

/// Returns the folder without links and relative parts.
fn existing(folder: &Path) -> Result<PathBuf, Failure> {
    let found = folder.canonicalize().map_err(|error| Failure::files(folder, &error))?;
    match found.is_dir() {
        true => Ok(found),
        false => Err(Failure::Files(format!("{} is a file: give a folder", folder.display()))),
    }
}

//! Runs a command again whenever a file that it reads changes, for `--watch`.
//!
//! Input: the files that are known before the first run, and the run, which adds those that it reads. The files are polled: their
//! modification times and sizes, five times a second. Editors replace files, and network folders and containers report no events, so
//! polling is what works everywhere; a few files cost nothing measurable.

use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};

use fragbuf_model::counted;

use super::output::{self, Failure};

/// The time between two looks at the files.
const INTERVAL: Duration = Duration::from_millis(200);

/// Runs until the process is ended. An error of a run is printed, and the next change runs again. `help` states how to give a file to watch.
pub(crate) fn watch(
    mut files: Vec<PathBuf>,
    help: &str,
    mut run: impl FnMut(&mut Vec<PathBuf>) -> Result<(), Failure>,
) -> Result<(), Failure> {
    if files.is_empty() {
        return Err(Failure::Usage(format!("`--watch` has no file to watch: {help}")));
    }
    loop {
        // A file that changes during the run differs from its stamp afterwards.
        let mut stamps: Vec<Stamp> = files.iter().map(|file| stamp(file)).collect();
        let mut read = Vec::new();
        let outcome = run(&mut read);
        for file in read {
            if !files.contains(&file) {
                stamps.push(stamp(&file));
                files.push(file);
            }
        }
        let count = counted(files.len(), "file");
        match outcome {
            Ok(()) => output::note(&format!("done; watching {count}")),
            Err(failure) => {
                // Printed; the exit code is that of a run without `--watch`.
                let _ = failure.report();
                output::note(&format!("failed; watching {count}"));
            }
        }
        wait(&files, &stamps);
    }
}

/// What changes when a file is written; `None` if there is no such file.
type Stamp = Option<(SystemTime, u64)>;

fn stamp(file: &Path) -> Stamp {
    let metadata = std::fs::metadata(file).ok()?;
    Some((metadata.modified().ok()?, metadata.len()))
}

/// Returns when the files differ from their stamps, and have not changed for one interval: some editors write a file in several steps.
fn wait(files: &[PathBuf], stamps: &[Stamp]) {
    let stamps_now = || files.iter().map(|file| stamp(file)).collect::<Vec<Stamp>>();
    let mut before = stamps.to_vec();
    loop {
        std::thread::sleep(INTERVAL);
        let now = stamps_now();
        if now == before && now != stamps {
            return;
        }
        before = now;
    }
}

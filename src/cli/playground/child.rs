//! Runs a command of this program as another process.
//!
//! Input: arguments, and a description on stdin. Output: what the command prints. A command that takes too long is killed, and so is one
//! whose request is cancelled: then the future is dropped, and the process with it. A crash of the command ends nothing else.

use std::path::Path;
use std::process::{ExitStatus, Stdio};
use std::time::Duration;

use tokio::io::AsyncWriteExt as _;
use tokio::process::Command;
use tokio::sync::Semaphore;
use tokio::time::timeout;

use super::problem::Problem;

/// Commands that take seconds, and the greatest number of them that run at the same time. Others wait.
pub(super) static SHORT: Semaphore = Semaphore::const_new(4);

/// Lists of devices, for which a page waits when it is opened.
pub(super) static LISTS: Semaphore = Semaphore::const_new(2);

/// Commands that may take minutes: checks.
pub(super) static LONG: Semaphore = Semaphore::const_new(2);

/// What a command printed.
pub(super) struct Printed {
    pub(super) status: ExitStatus,
    pub(super) stdout: Vec<u8>,
    /// The messages, one JSON object per line.
    pub(super) stderr: String,
}

impl Printed {
    /// Returns the messages of the command in one text.
    pub(super) fn messages(&self) -> String {
        let message = |line: &str| {
            let Ok(parsed) = serde_json::from_str::<serde_json::Value>(line) else { return line.to_owned() };
            let message = parsed["message"].as_str().unwrap_or(line);
            parsed["help"].as_str().map_or_else(|| message.to_owned(), |help| format!("{message}: {help}"))
        };
        self.stderr.lines().map(message).collect::<Vec<_>>().join("\n")
    }
}

/// A command.
pub(super) struct Job<'a> {
    pub(super) arguments: &'a [String],
    /// The description on stdin.
    pub(super) text: &'a str,
    pub(super) folder: &'a Path,
    /// The time that it may take with the time that it waits for others.
    pub(super) most: Duration,
    pub(super) queue: &'static Semaphore,
}

/// Runs a command to its end.
pub(super) async fn run(job: &Job<'_>) -> Result<Printed, Problem> {
    timeout(job.most, run_in_turn(job)).await.unwrap_or_else(|_| {
        let seconds = job.most.as_secs();
        Err(Problem::input(format!(
            "this took longer than {seconds} seconds and was stopped: ask for less, or end other requests"
        )))
    })
}

async fn run_in_turn(Job { arguments, text, folder, queue, .. }: &Job<'_>) -> Result<Printed, Problem> {
    let failed = |error: std::io::Error| Problem::server(format!("`fragbuf {}`: {error}", arguments.join(" ")));
    let _permit = queue.acquire().await.map_err(|error| Problem::server(error.to_string()))?;
    let program = std::env::current_exe().map_err(failed)?;
    let mut command = Command::new(program);
    command.args(["--message-format", "json"]).args(*arguments).current_dir(folder).kill_on_drop(true);
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().map_err(failed)?;
    let stdin = child.stdin.take();
    let work = async {
        if let Some(mut stdin) = stdin {
            // A command that ends before it has read its input says why on stderr.
            stdin.write_all(text.as_bytes()).await.ok();
        }
        child.wait_with_output().await
    };
    let output = work.await.map_err(failed)?;
    Ok(Printed {
        status: output.status,
        stdout: output.stdout,
        stderr: String::from_utf8_lossy(&output.stderr).into_owned(),
    })
}

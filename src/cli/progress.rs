//! Shows a progress bar on stderr for operations longer than one second. Shows nothing if stderr is not a terminal.

use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::Duration;

use indicatif::ProgressBar;

/// A progress bar, shown from one second after its creation until it is dropped.
pub(crate) struct Progress {
    bar: ProgressBar,
    waiting: Option<(Sender<()>, JoinHandle<()>)>,
}

impl Progress {
    pub(crate) fn new() -> Self {
        let bar = ProgressBar::with_draw_target(None, indicatif::ProgressDrawTarget::hidden());
        let (sender, receiver) = channel::<()>();
        let shown = bar.clone();
        let thread = std::thread::spawn(move || {
            if receiver.recv_timeout(Duration::from_secs(1)) == Err(RecvTimeoutError::Timeout) {
                shown.set_draw_target(indicatif::ProgressDrawTarget::stderr());
                shown.enable_steady_tick(Duration::from_millis(100));
            }
        });
        Progress { bar, waiting: Some((sender, thread)) }
    }

    /// Returns a progress bar that is never shown.
    #[cfg(feature = "figures")]
    pub(crate) fn hidden() -> Self {
        Progress { bar: ProgressBar::hidden(), waiting: None }
    }

    /// Shows what is being done now.
    pub(crate) fn set_message(&self, message: impl Into<String>) {
        self.bar.set_message(message.into());
    }

    /// Shows how much of it is done, from 0 to 1. Calls `message` only if the bar is visible.
    pub(crate) fn set_fraction(&self, message: impl FnOnce() -> String, fraction: f64) {
        if self.bar.is_hidden() {
            return;
        }
        if self.bar.length().is_none() {
            self.bar.set_length(100);
            if let Ok(style) = indicatif::ProgressStyle::with_template("{spinner} {msg} {bar:24} {percent:>3} %") {
                self.bar.set_style(style);
            }
        }
        let percent = (100.0 * fraction) as u64;
        if percent != self.bar.position() {
            self.bar.set_message(message());
            self.bar.set_position(percent);
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        if let Some((sender, thread)) = self.waiting.take() {
            drop(sender);
            // A thread that failed has shown nothing, so there is nothing to clear.
            let _ = thread.join();
        }
        self.bar.finish_and_clear();
    }
}

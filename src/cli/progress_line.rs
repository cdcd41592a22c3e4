//! A line on stderr that shows what a command is doing and for how long, if stderr is a terminal. It needs no crate, so builds without
//! rendering have it, too.

use std::io::{IsTerminal, Write};
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// The time before the line appears.
const DELAY: Duration = Duration::from_secs(1);

/// The time between two updates.
const INTERVAL: Duration = Duration::from_millis(200);

/// A line that is shown from one second after its creation until it is dropped.
pub(crate) struct ProgressLine {
    message: Arc<Mutex<String>>,
    shown: Option<(Sender<()>, JoinHandle<()>)>,
}

impl ProgressLine {
    /// Creates the line on stderr.
    pub(crate) fn new(message: &str) -> Self {
        let terminal = std::io::stderr().is_terminal().then(|| Box::new(std::io::stderr()) as Box<dyn Write + Send>);
        ProgressLine::on(terminal, message, (DELAY, INTERVAL))
    }

    /// Creates the line on `out`; without it, nothing is shown.
    fn on(out: Option<Box<dyn Write + Send>>, message: &str, (delay, interval): (Duration, Duration)) -> Self {
        let message = Arc::new(Mutex::new(message.to_owned()));
        let shown = out.map(|mut out| {
            let (sender, receiver) = channel::<()>();
            let (message, since) = (message.clone(), Instant::now());
            let thread = std::thread::spawn(move || {
                let (mut wait, mut is_shown) = (delay, false);
                // The sender is dropped at the end.
                while receiver.recv_timeout(wait) == Err(RecvTimeoutError::Timeout) {
                    let text = message.lock().unwrap_or_else(PoisonError::into_inner).clone();
                    // Ignore errors: there is no other stream to report them on.
                    let _ = write!(out, "\r\x1b[K{text} ({} s)", since.elapsed().as_secs());
                    let _ = out.flush();
                    (wait, is_shown) = (interval, true);
                }
                if is_shown {
                    let _ = write!(out, "\r\x1b[K");
                    let _ = out.flush();
                }
            });
            (sender, thread)
        });
        ProgressLine { message, shown }
    }

    /// Shows what is being done now.
    pub(crate) fn show(&self, message: &str) {
        message.clone_into(&mut self.message.lock().unwrap_or_else(PoisonError::into_inner));
    }
}

impl Drop for ProgressLine {
    fn drop(&mut self) {
        if let Some((sender, thread)) = self.shown.take() {
            drop(sender);
            // A thread that failed has nothing to clear.
            let _ = thread.join();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[derive(Clone, Default)]
    struct Written(Arc<Mutex<Vec<u8>>>);

    impl Write for Written {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            self.0.lock().unwrap_or_else(PoisonError::into_inner).extend_from_slice(bytes);
            Ok(bytes.len())
        }

        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn a_long_operation_shows_its_message_and_clears_it() {
        let written = Written::default();
        let text = |written: &Written| {
            String::from_utf8_lossy(&written.0.lock().unwrap_or_else(PoisonError::into_inner)).into_owned()
        };
        let short = (Duration::from_millis(1), Duration::from_millis(1));
        let line = ProgressLine::on(Some(Box::new(written.clone())), "checking", short);
        line.show("checking main");
        while !text(&written).contains("checking main (0 s)") {
            std::thread::sleep(Duration::from_millis(1));
        }
        drop(line);
        assert!(text(&written).ends_with("\r\x1b[K"));
        let quick = Written::default();
        drop(ProgressLine::on(Some(Box::new(quick.clone())), "checking", (Duration::from_secs(60), short.1)));
        assert_eq!(text(&quick), "", "a short operation shows nothing");
    }
}

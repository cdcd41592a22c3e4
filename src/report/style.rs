//! The colours of a diagnostic on a terminal, as escape sequences (ECMA-48).

use std::io::{Result, Write};

use codespan_reporting::diagnostic::{LabelStyle, Severity};
use codespan_reporting::term::WriteStyle;

/// A text with escape sequences.
#[derive(Default)]
pub(super) struct Colored(Vec<u8>);

impl Colored {
    /// Returns the text.
    pub(super) fn text(self) -> Option<String> {
        String::from_utf8(self.0).ok()
    }

    fn set(&mut self, sequence: &str) -> Result<()> {
        self.0.write_all(format!("\x1b[{sequence}m").as_bytes())
    }
}

impl Write for Colored {
    fn write(&mut self, bytes: &[u8]) -> Result<usize> {
        self.0.write(bytes)
    }

    fn flush(&mut self) -> Result<()> {
        Ok(())
    }
}

const RESET: &str = "0";
const BOLD: &str = "1";
const BLUE: &str = "34";

fn color(severity: Severity) -> &'static str {
    match severity {
        Severity::Bug | Severity::Error => "1;31",
        Severity::Warning => "1;33",
        Severity::Note | Severity::Help => "1;36",
    }
}

impl WriteStyle for Colored {
    fn set_header(&mut self, severity: Severity) -> Result<()> {
        self.set(color(severity))
    }

    fn set_header_message(&mut self) -> Result<()> {
        self.set(BOLD)
    }

    fn set_line_number(&mut self) -> Result<()> {
        self.set(BLUE)
    }

    fn set_note_bullet(&mut self) -> Result<()> {
        self.set(BLUE)
    }

    fn set_source_border(&mut self) -> Result<()> {
        self.set(BLUE)
    }

    fn set_label(&mut self, severity: Severity, style: LabelStyle) -> Result<()> {
        match style {
            LabelStyle::Primary => self.set(color(severity)),
            LabelStyle::Secondary => self.set(BLUE),
        }
    }

    fn reset(&mut self) -> Result<()> {
        self.set(RESET)
    }
}

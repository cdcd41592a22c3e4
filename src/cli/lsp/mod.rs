//! `fragbuf lsp`: a language server for `.fragbuf` files, on stdin and stdout.
//!
//! Input: messages of the Language Server Protocol 3.17. Output: answers, and diagnostics of the open documents. The analysis is
//! [`fragbuf::analysis`]; nothing here depends on the grammar. A malformed message gets an error or ends the server. Messages are
//! answered one after the other, and a panic while one is answered is an error of that request.

mod answers;
mod documents;
mod frames;
mod lifecycle;
mod parameters;
mod server;
mod uri;

use std::io::{BufReader, Write};
use std::process::ExitCode;
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};

use super::output::Failure;
use frames::{Frame, FrameError};
use server::{Next, Server};

#[derive(clap::Args)]
pub(crate) struct Lsp {
    /// Accepted for editors that pass it: stdin and stdout are the only channel
    #[arg(long)]
    stdio: bool,
}

/// The greatest number of messages that wait for their turn.
const WAITING: usize = 64;

impl Lsp {
    pub(crate) fn run(&self) -> Result<ExitCode, Failure> {
        let _ = self.stdio;
        let (sender, receiver) = sync_channel(WAITING);
        std::thread::spawn(move || {
            let mut input = BufReader::new(std::io::stdin());
            loop {
                let frame = frames::read(&mut input);
                let is_last = matches!(frame, Ok(None) | Err(_));
                if sender.send(frame).is_err() || is_last {
                    return;
                }
            }
        });
        Ok(serve(&receiver, &mut std::io::stdout().lock()))
    }
}

/// Answers messages until `exit`, the end of the input or an error of the output.
fn serve(receiver: &Receiver<Result<Option<Frame>, FrameError>>, output: &mut dyn Write) -> ExitCode {
    let mut server = Server::new();
    loop {
        let frame = match receiver.try_recv() {
            // Diagnostics of a text that further messages change would be out of date.
            Err(TryRecvError::Empty) => {
                if send(output, server.diagnostics()).is_err() {
                    return server.exit_code();
                }
                receiver.recv().unwrap_or(Ok(None))
            }
            Err(TryRecvError::Disconnected) => Ok(None),
            Ok(frame) => frame,
        };
        let frame = match frame {
            Ok(Some(frame)) => frame,
            Ok(None) => return server.exit_code(),
            Err(error) => {
                super::output::warn(&format!("the input is no message of the protocol: {error}"));
                return ExitCode::FAILURE;
            }
        };
        let (messages, next) = server.handle(&frame);
        if send(output, messages).is_err() || next == Next::Exit {
            return server.exit_code();
        }
    }
}

fn send(output: &mut dyn Write, messages: Vec<serde_json::Value>) -> std::io::Result<()> {
    messages.iter().try_for_each(|message| frames::write(output, message))
}

//! Runs the page of the tests in headless Chromium: a server on the loopback interface, and the browser.
//!
//! Input: a folder with jobs. Output: what the page sends back. The page presents no canvas, because presenting kills the GPU process of
//! a machine without a GPU.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::{TcpListener, TcpStream};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::channel;
use std::time::{Duration, Instant};

use serde_json::Value;

/// A browser that ends with the test.
struct Browser(Child);

impl Drop for Browser {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

/// How long the page may take. A machine that runs other tests at the same time needs a multiple of the usual seconds.
const PATIENCE: Duration = Duration::from_secs(300);

const FLAGS: [&str; 9] = [
    "--headless=new",
    // Chromium has no sandbox for the user root.
    "--no-sandbox",
    "--enable-unsafe-webgpu",
    "--use-webgpu-adapter=swiftshader",
    "--enable-features=Vulkan",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
];

/// Opens the page with the jobs of `page.json` in the folder. Returns what it sends.
pub fn results(folder: &Path) -> Value {
    let listener = TcpListener::bind("127.0.0.1:0").unwrap();
    listener.set_nonblocking(true).unwrap();
    let address = format!("http://{}/tests/browser/page.html", listener.local_addr().unwrap());
    let profile = format!("--user-data-dir={}", folder.join("profile").display());
    let mut command = Command::new("chromium");
    command.args(FLAGS).args(["--disable-sync", &profile, &address]);
    let child = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
    let child =
        child.unwrap_or_else(|error| panic!("Chromium must be installed, Debian's package is `chromium`: {error}"));
    let mut browser = Browser(child);
    let (sender, receiver) = channel();
    let begin = Instant::now();
    while begin.elapsed() < PATIENCE {
        // A browser opens connections in advance that send nothing for a while.
        if let Ok((stream, _)) = listener.accept() {
            let (sender, folder) = (sender.clone(), folder.to_owned());
            std::thread::spawn(move || {
                stream.set_nonblocking(false).unwrap();
                // The receiver is gone if the test has ended.
                answer(stream, &folder).map(|results| sender.send(results).ok());
            });
        }
        if let Ok(results) = receiver.recv_timeout(Duration::from_millis(5)) {
            return results;
        }
        assert!(browser.0.try_wait().unwrap().is_none(), "Chromium ended before its page was done");
    }
    panic!("the page was not done after {PATIENCE:?}");
}

/// Answers a request. Returns what the page sends at its end.
fn answer(stream: TcpStream, folder: &Path) -> Option<Value> {
    let mut reader = BufReader::new(&stream);
    let mut line = String::new();
    reader.read_line(&mut line).ok()?;
    let request = line.clone();
    let mut length = 0;
    while reader.read_line(&mut line).is_ok_and(|bytes| bytes > 2) {
        let header = line.lines().next_back().unwrap_or("").to_ascii_lowercase();
        if let Some(bytes) = header.strip_prefix("content-length:") {
            length = bytes.trim().parse().unwrap();
        }
    }
    let mut body = vec![0; length];
    reader.read_exact(&mut body).ok()?;
    let path = request.split(' ').nth(1)?.trim_start_matches('/');
    if request.starts_with("POST") {
        respond(&stream, "200 OK", "text/plain", b"");
        return Some(serde_json::from_slice(&body).unwrap());
    }
    let file = match path.strip_prefix("jobs/") {
        Some(job) => folder.join(job),
        None => super::root().join(path),
    };
    match std::fs::read(&file) {
        Ok(bytes) => respond(&stream, "200 OK", content_type(path), &bytes),
        Err(_) => respond(&stream, "404 Not Found", "text/plain", b""),
    }
    None
}

fn content_type(path: &str) -> &'static str {
    match path.rsplit('.').next() {
        Some("html") => "text/html",
        Some("mjs") => "text/javascript",
        _ => "application/octet-stream",
    }
}

fn respond(mut stream: &TcpStream, status: &str, kind: &str, bytes: &[u8]) {
    let head = format!(
        "HTTP/1.1 {status}\r\nContent-Type: {kind}\r\nContent-Length: {}\r\nConnection: close\r\n\r\n",
        bytes.len()
    );
    // The browser may have closed a connection that it opened in advance.
    let _ = stream.write_all(head.as_bytes()).and_then(|()| stream.write_all(bytes));
}

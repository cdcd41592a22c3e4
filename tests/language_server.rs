//! Plays sessions of an editor with `fragbuf lsp`, and sends it what no editor sends.

use std::cell::RefCell;
use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use fragbuf::analysis::Document;
use fragbuf::{Registry, vocabulary::Row};
use serde_json::{Value, json};

/// A server that does not answer within this time hangs.
const PATIENCE: Duration = Duration::from_secs(120);

/// A client of a server.
struct Client {
    server: Child,
    input: Option<ChildStdin>,
    messages: Receiver<Value>,
    /// What was received.
    received: RefCell<Vec<Value>>,
    next_id: u64,
}

impl Client {
    /// Starts a server, without `initialize`.
    fn start() -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fragbuf"));
        command.args(["lsp", "--stdio"]).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut server = command.spawn().unwrap();
        let mut output = BufReader::new(server.stdout.take().unwrap());
        let (sender, messages) = channel();
        std::thread::spawn(move || {
            loop {
                let mut length = None;
                loop {
                    let mut line = String::new();
                    if output.read_line(&mut line).unwrap() == 0 {
                        return;
                    }
                    assert!(line.ends_with("\r\n"), "{line:?}");
                    match line.trim_end() {
                        "" => break,
                        header => {
                            length = header.strip_prefix("Content-Length: ").map(|length| length.parse().unwrap())
                        }
                    }
                }
                let mut text = vec![0; length.unwrap()];
                output.read_exact(&mut text).unwrap();
                let message: Value = serde_json::from_slice(&text).unwrap();
                assert_eq!(message["jsonrpc"], "2.0");
                if sender.send(message).is_err() {
                    return;
                }
            }
        });
        let input = server.stdin.take();
        Client { server, input, messages, received: RefCell::default(), next_id: 0 }
    }

    fn initialized() -> Self {
        let mut client = Self::start();
        let result = client.request("initialize", json!({ "capabilities": {} }));
        assert_eq!(result["capabilities"]["hoverProvider"], true);
        client.notify("initialized", json!({}));
        client
    }

    /// Sends bytes. A server that has ended does not take them.
    fn send_bytes(&mut self, bytes: &[u8]) {
        if let Some(input) = &mut self.input {
            let _ = input.write_all(bytes).and_then(|()| input.flush());
        }
    }

    fn send(&mut self, message: &Value) {
        let text = message.to_string();
        self.send_bytes(format!("Content-Length: {}\r\n\r\n{text}", text.len()).as_bytes());
    }

    fn notify(&mut self, method: &str, parameters: Value) {
        self.send(&json!({ "jsonrpc": "2.0", "method": method, "params": parameters }));
    }

    fn receive(&self) -> Value {
        let message = self.messages.recv_timeout(PATIENCE).expect("an answer of the server");
        self.received.borrow_mut().push(message.clone());
        message
    }

    /// Sends a request, and returns its answer. Notifications before it are skipped.
    fn answer(&mut self, method: &str, parameters: Value) -> Value {
        self.next_id += 1;
        let id = self.next_id;
        self.send(&json!({ "jsonrpc": "2.0", "id": id, "method": method, "params": parameters }));
        loop {
            let message = self.receive();
            if message["id"] == id {
                return message;
            }
        }
    }

    /// Returns the number of diagnostics that a file has after all that was sent.
    fn newest_of(&mut self, uri: &str) -> usize {
        // The diagnostics of another document come with those of what was sent before, and all of them before the next answer.
        self.open("untitled:last", "buffer Mine from kb {}\n");
        self.error("no/such/method", json!({}));
        let received = self.received.borrow();
        let mut lists = received.iter().rev().filter(|message| message["params"]["uri"] == uri);
        lists.next().and_then(|message| message["params"]["diagnostics"].as_array()).map_or(0, Vec::len)
    }

    fn request(&mut self, method: &str, parameters: Value) -> Value {
        let answer = self.answer(method, parameters);
        assert!(answer["error"].is_null(), "{method}: {answer}");
        answer["result"].clone()
    }

    fn error(&mut self, method: &str, parameters: Value) -> (i64, String) {
        let answer = self.answer(method, parameters);
        let error = &answer["error"];
        (error["code"].as_i64().expect("an error"), error["message"].as_str().unwrap().to_owned())
    }

    /// Opens a document, and returns its diagnostics.
    fn open(&mut self, uri: &str, text: &str) -> Vec<Value> {
        let document = json!({ "uri": uri, "languageId": "fragbuf", "version": 1, "text": text });
        self.notify("textDocument/didOpen", json!({ "textDocument": document }));
        self.diagnostics(uri, 1)
    }

    /// Replaces a range of a document.
    fn change(&mut self, uri: &str, version: u64, range: Value, text: &str) -> Vec<Value> {
        let change = match range.is_null() {
            true => json!({ "text": text }),
            false => json!({ "range": range, "text": text }),
        };
        let document = json!({ "uri": uri, "version": version });
        self.notify("textDocument/didChange", json!({ "textDocument": document, "contentChanges": [change] }));
        self.diagnostics(uri, version)
    }

    /// Waits for the diagnostics of a version of a document.
    fn diagnostics(&self, uri: &str, version: u64) -> Vec<Value> {
        loop {
            let message = self.receive();
            let parameters = &message["params"];
            if message["method"] == "textDocument/publishDiagnostics"
                && parameters["uri"] == uri
                && parameters["version"] == version
            {
                return parameters["diagnostics"].as_array().unwrap().clone();
            }
        }
    }

    /// Ends the input, and returns how the server ends, with its messages on stderr.
    fn end(mut self) -> (ExitStatus, String) {
        drop(self.input.take());
        let mut stderr = String::new();
        self.server.stderr.take().unwrap().read_to_string(&mut stderr).unwrap();
        (self.server.wait().unwrap(), stderr)
    }

    fn shut_down(mut self) {
        assert_eq!(self.request("shutdown", Value::Null), Value::Null);
        self.notify("exit", Value::Null);
        let (status, stderr) = self.end();
        assert!(status.success() && stderr.is_empty(), "{status}: {stderr}");
    }
}

fn at(line: u32, character: u32) -> Value {
    json!({ "line": line, "character": character })
}

fn position(uri: &str, line: u32, character: u32) -> Value {
    json!({ "textDocument": { "uri": uri }, "position": at(line, character) })
}

/// Applies the edits of an action to a text.
fn applied(text: &str, action: &Value, uri: &str) -> String {
    let registry = Registry::builtin();
    let lines = Document::new(text, "", &registry).lines();
    let offset = |position: &Value| {
        let number = |field: &str| position[field].as_u64().unwrap() as u32;
        lines.offset(fragbuf::analysis::Position { line: number("line"), character: number("character") })
    };
    let mut changed = text.to_owned();
    for edit in action["edit"]["changes"][uri].as_array().unwrap().iter().rev() {
        let range = offset(&edit["range"]["start"])..offset(&edit["range"]["end"]);
        changed.replace_range(range, edit["newText"].as_str().unwrap());
    }
    changed
}

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("language-server").join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

/// A user opens a description, makes a mistake, reads the message, applies the fix, and goes on.
#[test]
fn a_mistake_is_reported_and_fixed() {
    let mut client = Client::initialized();
    let uri = "file:///work/glass.fragbuf";
    let text = "buffer Glass from kplus_array {\n    // 𝄞\n    keep 8 least |f| f.depth;\n}\n";
    assert_eq!(client.open(uri, text), Vec::<Value>::new());
    // `depth` becomes `detph`.
    let range = json!({ "start": at(2, 23), "end": at(2, 28) });
    let found = client.change(uri, 2, range.clone(), "detph");
    let [mistake] = found.as_slice() else { panic!("{found:#?}") };
    assert_eq!((&mistake["code"], &mistake["severity"]), (&json!("unknown-field"), &json!(1)));
    assert_eq!(mistake["message"], "no attribute `detph` on a fragment\nhelp: did you mean `depth`?");
    assert_eq!(mistake["range"], range);
    let asked = json!({ "textDocument": { "uri": uri }, "range": range, "context": { "diagnostics": [mistake] } });
    let actions = client.request("textDocument/codeAction", asked);
    let action = &actions[0];
    assert_eq!((&action["kind"], &action["isPreferred"]), (&json!("quickfix"), &json!(true)));
    let fixed = applied(&text.replace("depth", "detph"), action, uri);
    assert_eq!(fixed, text);
    assert_eq!(client.change(uri, 3, Value::Null, &fixed), Vec::<Value>::new());
    // No diagnostic is there now, so there is no action.
    let asked = json!({ "textDocument": { "uri": uri }, "range": range, "context": { "diagnostics": [] } });
    assert_eq!(client.request("textDocument/codeAction", asked), json!([]));
    client.notify("textDocument/didClose", json!({ "textDocument": { "uri": uri } }));
    client.shut_down();
}

/// A list of diagnostics replaces that of the same file, also if another document has it.
#[test]
fn two_documents_have_the_errors_of_one_file() {
    let folder = folder("shared");
    std::fs::write(folder.join("x.wgsl"), "fn broken( {\n").unwrap();
    let mut client = Client::initialized();
    let uri = |name: &str| format!("file://{}", folder.join(name).display());
    let text = "buffer Mine {\n    storage: wgsl(\"x.wgsl\");\n    keep 8;\n}\n";
    client.open(&uri("a.fragbuf"), text);
    client.open(&uri("b.fragbuf"), text);
    client.notify("textDocument/didClose", json!({ "textDocument": { "uri": uri("a.fragbuf") } }));
    assert!(client.newest_of(&uri("x.wgsl")) > 0, "b is open");
    // `b` no longer names the file.
    client.change(&uri("b.fragbuf"), 2, Value::Null, "buffer Mine from kb {}\n");
    client.open(&uri("c.fragbuf"), text);
    assert!(client.newest_of(&uri("x.wgsl")) > 0, "c is open");
    client.change(&uri("c.fragbuf"), 2, Value::Null, "buffer Mine from kb {}\n");
    assert_eq!(client.newest_of(&uri("x.wgsl")), 0);
    client.shut_down();
}

#[test]
fn an_editor_shows_what_the_analysis_finds() {
    let mut client = Client::initialized();
    let uri = "untitled:Untitled-1";
    let text = "buffer Glass from kplus_array {\n    sync: ;\n    where |f| f.depth < 0.5;\n}\n";
    let found = client.open(uri, text);
    assert_eq!(found.len(), 1, "{found:#?}");
    let completion = client.request("textDocument/completion", position(uri, 1, 10));
    let items = completion["items"].as_array().unwrap();
    let registry = Registry::builtin();
    let rows: Vec<&Row> = registry.rows_of("sync").collect();
    assert_eq!(items.len(), rows.len());
    let (illegal, legal): (Vec<&Value>, Vec<&Value>) = items.iter().partition(|item| item["tags"] == json!([1]));
    assert!(!illegal.is_empty() && !legal.is_empty());
    for item in &illegal {
        assert!(item["detail"].as_str().unwrap().starts_with("illegal here: "), "{item}");
        assert!(legal.iter().all(|legal| legal["sortText"].as_str() < item["sortText"].as_str()));
    }
    let edit = &legal[0]["textEdit"];
    assert_eq!(edit["range"], json!({ "start": at(1, 10), "end": at(1, 10) }));
    let hover = client.request("textDocument/hover", position(uri, 2, 17));
    assert!(hover["contents"]["value"].as_str().unwrap().contains("depth: f32"), "{hover}");
    assert_eq!(client.request("textDocument/hover", position(uri, 2, 200)), Value::Null);
    let symbols = client.request("textDocument/documentSymbol", json!({ "textDocument": { "uri": uri } }));
    assert_eq!(symbols[0]["name"], "Glass");
    // A template is a document of its own.
    client.change(uri, 2, Value::Null, "buffer B from ab_ll {\n    sort: insertion;\n}\n");
    let definition = client.request("textDocument/definition", position(uri, 1, 12));
    let template = registry.row("sort", "insertion").unwrap().template.as_ref().unwrap();
    assert_eq!(definition["uri"], format!("fragbuf-template:/{}", template.path));
    let content = client.request("workspace/textDocumentContent", json!({ "uri": definition["uri"] }));
    assert_eq!(content["text"], *template.source);
    client.shut_down();
}

/// Errors in a user file are published for that file, and withdrawn.
#[test]
fn user_files_are_read_beside_the_description() {
    let folder = folder("files");
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("examples/user_storage");
    let shader = std::fs::read_to_string(example.join("first_k.wgsl")).unwrap();
    let text = std::fs::read_to_string(example.join("first_k.fragbuf")).unwrap();
    std::fs::write(folder.join("first_k.wgsl"), &shader).unwrap();
    let uri = |name: &str| format!("file://{}", folder.join(name).display());
    let mut client = Client::initialized();
    assert_eq!(client.open(&uri("b.fragbuf"), &text), Vec::<Value>::new());
    let line = text.lines().position(|line| line.contains("wgsl(")).unwrap();
    let column = text.lines().nth(line).unwrap().find("first_k").unwrap();
    let definition = client.request("textDocument/definition", position(&uri("b.fragbuf"), line as u32, column as u32));
    assert_eq!(definition["uri"], uri("first_k.wgsl"));
    std::fs::write(folder.join("first_k.wgsl"), shader.replace("fn ", "fn 1")).unwrap();
    client.notify("textDocument/didSave", json!({ "textDocument": { "uri": uri("b.fragbuf") } }));
    let of_file = |client: &Client| loop {
        let message = client.receive();
        if message["params"]["uri"] == uri("first_k.wgsl") {
            return message["params"]["diagnostics"].as_array().unwrap().clone();
        }
    };
    assert!(!of_file(&client).is_empty());
    std::fs::write(folder.join("first_k.wgsl"), shader).unwrap();
    client.notify("textDocument/didSave", json!({ "textDocument": { "uri": uri("b.fragbuf") } }));
    assert_eq!(of_file(&client), Vec::<Value>::new());
    client.shut_down();
}

#[test]
fn requests_that_are_wrong_have_errors() {
    let mut client = Client::start();
    let uri = "file:///a.fragbuf";
    assert_eq!(client.error("textDocument/hover", position(uri, 0, 0)).0, -32002);
    client.request("initialize", json!({}));
    assert_eq!(client.error("initialize", json!({})).0, -32600);
    assert_eq!(client.error("no/method", Value::Null).0, -32601);
    let (code, message) = client.error("textDocument/hover", position(uri, 0, 0));
    assert!(code == -32602 && message.contains("is not open"), "{message}");
    client.open(uri, "buffer B from kb {\n}");
    for (parameters, field) in [
        (Value::Null, "params.textDocument.uri"),
        (json!({ "textDocument": { "uri": 3 } }), "params.textDocument.uri"),
        (json!({ "textDocument": { "uri": uri } }), "params.position.line"),
        (json!({ "textDocument": { "uri": uri }, "position": { "line": -1, "character": 0 } }), "params.position.line"),
    ] {
        let (code, message) = client.error("textDocument/hover", parameters);
        assert!(code == -32602 && message.contains(field), "{message}");
    }
    // A position outside of the text is its end.
    client.request("textDocument/completion", position(uri, u32::MAX, u32::MAX));
    let far = json!({ "textDocument": { "uri": uri }, "position": { "line": 1u64 << 60, "character": 0 } });
    client.request("textDocument/hover", far);
    // A change of a document that is not open is logged.
    client.notify("textDocument/didChange", json!({ "textDocument": { "uri": "file:///b" }, "contentChanges": [] }));
    let logged = client.receive();
    assert!(logged["params"]["message"].as_str().unwrap().contains("is not open"), "{logged}");
    // Text that is not JSON, and JSON that is no message.
    for (text, code) in [("{", -32700), ("[]", -32600), ("3", -32600), ("{\"id\":true,\"method\":\"x\"}", -32600)] {
        client.send_bytes(format!("Content-Length: {}\r\n\r\n{text}", text.len()).as_bytes());
        assert_eq!(client.receive()["error"]["code"], code, "{text}");
    }
    client.request("shutdown", Value::Null);
    assert_eq!(client.error("textDocument/hover", position(uri, 0, 0)).0, -32600);
    client.notify("exit", Value::Null);
    assert!(client.end().0.success());
}

/// The input ends, or what follows cannot be found: the server ends, and says why.
#[test]
fn a_broken_stream_ends_the_server() {
    for (bytes, expected) in [
        (&b""[..], ""),
        (b"Content-Length: 100\r\n\r\n{}", ""),
        (b"Content-Length: 18446744073709551615\r\n\r\n{}", "it can have"),
        (b"Content-Length: 99999999999999999999999\r\n\r\n{}", "is not a header"),
        (b"GET / HTTP/1.1\r\n\r\n", "is not a header"),
        (b"\r\n\r\n", "no line `Content-Length"),
        (&[0xff; 4096], "is not a header"),
    ] {
        let mut client = Client::start();
        client.send_bytes(bytes);
        let (status, stderr) = client.end();
        assert_eq!(status.code(), Some(1), "{stderr}");
        assert!(stderr.contains(expected) && !stderr.contains("panicked"), "{stderr}");
        assert_eq!(stderr.is_empty(), expected.is_empty(), "{stderr}");
    }
    let mut client = Client::initialized();
    client.notify("exit", Value::Null);
    assert_eq!(client.end().0.code(), Some(1), "`exit` without `shutdown`");
}

/// Whole sessions with a few random bytes, and their beginnings. The server answers what it understands, and ends with its input.
#[test]
fn sessions_with_random_bytes_end() {
    let mut state = 0x9e37_79b9_u32;
    let mut random = |most: usize| {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state as usize % most
    };
    let uri = "file:///a.fragbuf";
    let opened =
        json!({ "uri": uri, "languageId": "fragbuf", "version": 1, "text": "buffer B from kb {\n    kep 3;\n}\n" });
    let place = position(uri, 1, 6);
    let messages = [
        json!({ "jsonrpc": "2.0", "id": 1, "method": "initialize", "params": { "capabilities": {} } }),
        json!({ "jsonrpc": "2.0", "method": "initialized", "params": {} }),
        json!({ "jsonrpc": "2.0", "method": "textDocument/didOpen", "params": { "textDocument": opened } }),
        json!({ "jsonrpc": "2.0", "id": 2, "method": "textDocument/completion", "params": place }),
        json!({ "jsonrpc": "2.0", "id": 3, "method": "textDocument/hover", "params": place }),
        json!({ "jsonrpc": "2.0", "id": 4, "method": "shutdown" }),
        json!({ "jsonrpc": "2.0", "method": "exit" }),
    ];
    let whole: Vec<u8> = messages
        .iter()
        .map(Value::to_string)
        .flat_map(|text| format!("Content-Length: {}\r\n\r\n{text}", text.len()).into_bytes())
        .collect();
    for number in 0..60 {
        let mut bytes = whole.clone();
        for _ in 0..number % 6 {
            let at = random(bytes.len());
            bytes[at] = random(256) as u8;
        }
        bytes.truncate(if number % 3 == 0 { random(bytes.len()) } else { bytes.len() });
        let mut client = Client::start();
        client.send_bytes(&bytes);
        let (status, stderr) = client.end();
        let is_ended = status.code().is_some_and(|code| code < 2);
        assert!(is_ended && !stderr.contains("panicked"), "{status}: {stderr}\n{}", String::from_utf8_lossy(&bytes));
    }
}

/// Random messages: well-formed frames with parts of real messages in random places. The server answers each request once.
#[test]
fn random_messages_are_answered() {
    let mut state = 0x1234_5678_u32;
    let mut random = |most: usize| {
        state ^= state << 13;
        state ^= state >> 17;
        state ^= state << 5;
        state as usize % most
    };
    let mut client = Client::initialized();
    let uri = "file:///a.fragbuf";
    let text = "buffer B from kplus_array {\n    sync: spin_lock;\n    where |f| f.depth < 0.5;\n}\n";
    client.open(uri, text);
    let methods = [
        "textDocument/hover",
        "textDocument/completion",
        "textDocument/definition",
        "textDocument/codeAction",
        "textDocument/documentSymbol",
        "workspace/textDocumentContent",
        "textDocument/didChange",
        "textDocument/didOpen",
        "initialize",
        "$/cancelRequest",
        "",
    ];
    for _ in 0..400 {
        let mut parameters = json!({
            "textDocument": { "uri": uri },
            "position": at(random(6) as u32, random(40) as u32),
            "range": { "start": at(0, 0), "end": at(random(9) as u32, random(40) as u32) },
            "context": { "diagnostics": [] },
        });
        let (field, kind) = (["textDocument", "position", "range", "context", "uri"][random(5)], random(10));
        parameters[field] = match kind {
            0 => json!(null),
            1 => json!(random(100)),
            2 => json!(-1.5e300),
            3 => json!(uri),
            4 => json!([]),
            5 => json!({ "start": at(9, 9), "end": at(0, 0) }),
            6 => json!({ "uri": [] }),
            7 => json!({ "only": ["quickfix", {}] }),
            8 => json!("fragbuf-template:/../../etc/passwd"),
            _ => at(random(6) as u32, random(40) as u32),
        };
        let method = methods[random(methods.len())];
        let answer = client.answer(method, parameters);
        assert!(answer.get("result").is_some() || answer["error"]["code"].as_i64() != Some(-32603), "{answer}");
        // A change at random places; the document stays open.
        let range =
            json!({ "start": at(random(6) as u32, random(40) as u32), "end": at(random(6) as u32, random(40) as u32) });
        let text = ["", "{", "}", "f.", "\"", "𝄞", "\n", "/*"][random(8)];
        let change = json!({ "range": range, "text": text });
        let document = json!({ "uri": uri, "version": 2 });
        client.notify("textDocument/didChange", json!({ "textDocument": document, "contentChanges": [change] }));
    }
    client.shut_down();
}

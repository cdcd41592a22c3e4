//! Tests the server of `fragbuf playground` by requests: what it answers, what it refuses, and that no request ends it.

use std::io::{BufRead as _, BufReader, Read as _, Write as _};
use std::net::TcpStream;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

use serde_json::{Value, json};

/// A server that ends with its test.
pub struct Server {
    child: Child,
    /// `127.0.0.1:PORT`
    pub address: String,
}

impl Server {
    pub fn start(arguments: &[&str]) -> Self {
        Server::start_in(Path::new("."), arguments)
    }

    /// Starts a server whose current folder is `folder`.
    fn start_in(folder: &Path, arguments: &[&str]) -> Self {
        let mut command = Command::new(env!("CARGO_BIN_EXE_fragbuf"));
        command.current_dir(folder);
        command.args(["playground", "--no-open"]).args(arguments).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut child = command.spawn().unwrap();
        let mut line = String::new();
        BufReader::new(child.stdout.as_mut().unwrap()).read_line(&mut line).unwrap();
        let address = line.trim().strip_prefix("http://").and_then(|rest| rest.strip_suffix('/')).unwrap().to_owned();
        assert!(address.starts_with("127.0.0.1:"), "{line}");
        Server { child, address }
    }

    /// Sends bytes and returns all that the server answers until it closes the connection.
    fn raw(&self, bytes: &[u8]) -> String {
        let mut stream = TcpStream::connect(&self.address).unwrap();
        stream.set_read_timeout(Some(Duration::from_secs(120))).unwrap();
        // A server that refuses a request early closes the connection.
        let _ = stream.write_all(bytes);
        let mut answer = Vec::new();
        let _ = stream.read_to_end(&mut answer);
        String::from_utf8_lossy(&answer).into_owned()
    }

    /// Sends a request with these headers. Returns the status and the body.
    fn request(&self, line: &str, headers: &[(&str, &str)], body: &str) -> (u16, String) {
        let headers: String = headers.iter().map(|(name, value)| format!("{name}: {value}\r\n")).collect();
        let length = body.len();
        let text = format!("{line} HTTP/1.1\r\n{headers}Connection: close\r\nContent-Length: {length}\r\n\r\n{body}");
        let answer = self.raw(text.as_bytes());
        let status = answer.split(' ').nth(1).and_then(|status| status.parse().ok()).unwrap_or(0);
        (status, answer.split_once("\r\n\r\n").map_or(String::new(), |(_, body)| body.to_owned()))
    }

    fn get(&self, path: &str) -> (u16, String) {
        self.request(&format!("GET {path}"), &[("Host", &self.address)], "")
    }

    fn post(&self, name: &str, body: &Value) -> (u16, Value) {
        let headers = [("Host", self.address.as_str()), ("Content-Type", "application/json")];
        let (status, text) = self.request(&format!("POST /api/{name}"), &headers, &body.to_string());
        (status, serde_json::from_str(&text).unwrap_or(Value::String(text)))
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

const KB: &str = "buffer Mine from kb {\n    keep 4;\n}\n";

fn folder(name: &str) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join("playground").join(name);
    let _ = std::fs::remove_dir_all(&path);
    std::fs::create_dir_all(&path).unwrap();
    path
}

fn picture(text: &str) -> Value {
    let camera = json!({ "azimuth": 20.0, "elevation": 10.0, "zoom": 1.0 });
    json!({ "text": text, "scene": "cubes", "size": [16, 12], "camera": camera, "device": "cpu" })
}

/// Returns the request for a picture with another value of a field.
fn picture_with(field: &str, value: Value) -> Value {
    let mut request = picture(KB);
    request[field] = value;
    request
}

#[test]
fn the_page_and_every_file_that_it_names_are_served() {
    let server = Server::start(&[]);
    let (status, page) = server.get("/");
    assert_eq!(status, 200);
    assert!(page.contains("<!doctype html>"));
    let (status, host) = server.get("/webgpu/fragbuf.mjs");
    assert_eq!(status, 200);
    // Every module that a module imports is there, too.
    let mut waiting = vec![("/webgpu/".to_owned(), host)];
    for module in ["/picture.mjs", "/camera.mjs"] {
        let (status, text) = server.get(module);
        assert_eq!(status, 200, "{module}");
        waiting.push(("/".to_owned(), text));
    }
    let mut seen = 0;
    while let Some((folder, text)) = waiting.pop() {
        for line in text.lines().filter(|line| line.starts_with("import ") || line.starts_with("export {")) {
            let Some(path) = line.split("from \"./").nth(1).and_then(|rest| rest.split('"').next()) else { continue };
            let path = format!("{folder}{path}");
            let (status, text) = server.get(&path);
            assert_eq!(status, 200, "{path}");
            seen += 1;
            assert!(seen < 200, "modules import each other in a circle");
            waiting.push((path[..=path.rfind('/').unwrap()].to_owned(), text));
        }
    }
    assert!(seen > 20, "{seen} imports");
    for file in std::fs::read_dir("src/cli/playground/page").unwrap().flatten() {
        let name = file.file_name().into_string().unwrap();
        let is_sent = [".mjs", ".css", ".html"].iter().any(|kind| name.ends_with(kind));
        assert_eq!(server.get(&format!("/{name}")).0, if is_sent { 200 } else { 404 }, "{name}");
    }
    for path in
        ["/nothing", "/../Cargo.toml", "/%2e%2e/Cargo.toml", "//etc/passwd", "/webgpu/../../Cargo.toml", "/etc/passwd"]
    {
        assert_eq!(server.get(path).0, 404, "{path}");
    }
}

#[test]
fn answers_are_those_of_the_commands() {
    let server = Server::start(&[]);
    let (status, start) = server.get("/api/start");
    assert_eq!(status, 200);
    let start: Value = serde_json::from_str(&start).unwrap();
    let techniques = start["techniques"].as_array().unwrap();
    assert_eq!(techniques.len(), fragbuf::Registry::builtin().techniques().len());
    assert!(start["devices"].as_array().unwrap().contains(&json!("cpu")));
    for preset in techniques.iter().chain(start["examples"].as_array().unwrap()) {
        let (status, answer) = server.post("analyse", &json!({ "text": preset["text"] }));
        assert_eq!(status, 200);
        assert!(answer["description"].is_object(), "{}: {}", preset["key"], answer["diagnostics"]);
    }
    let (status, answer) = server.post("analyse", &json!({ "text": "buffer Mine from kb { kep 4; }" }));
    assert_eq!((status, &answer["description"]), (200, &Value::Null));
    assert_eq!(answer["diagnostics"][0]["line"], 1);
    let (status, answer) = server.post("generate", &json!({ "text": KB, "target": "glsl", "form": "module" }));
    assert_eq!(status, 200);
    assert!(
        answer["files"]
            .as_array()
            .unwrap()
            .iter()
            .any(|file| file["text"].as_str().unwrap().contains("store_fragment"))
    );
    let (status, answer) = server.post("render", &picture(KB));
    assert_eq!(status, 200, "{answer}");
    assert!(answer["png"].as_str().unwrap().starts_with("iVBORw0KGgo"));
    assert_eq!((&answer["statistics"]["k"], &answer["statistics"]["device"]), (&json!(4), &json!("cpu")));
    let (status, answer) = server.post("predict", &picture(KB));
    assert_eq!((status, answer["histogram"].as_array().map(Vec::len)), (200, Some(1024)), "{answer}");
    let (status, answer) = server.post("check", &json!({ "text": KB, "fragments": 2, "k": 1 }));
    assert_eq!((status, &answer["holds"]), (200, &json!(false)), "{answer}");
    assert!(!answer["failure"]["steps"].as_array().unwrap().is_empty());
    let (status, answer) = server.post("download", &json!({ "text": KB }));
    assert_eq!(status, 200);
    assert!(answer.as_str().unwrap().starts_with("PK"));
}

#[test]
fn others_are_refused() {
    let server = Server::start(&[]);
    let own = server.address.as_str();
    let localhost = own.replace("127.0.0.1", "localhost");
    let kind = ("Content-Type", "application/json");
    let body = json!({ "text": KB }).to_string();
    let post = |headers: &[(&str, &str)]| server.request("POST /api/analyse", headers, &body).0;
    let origin = format!("http://{own}");
    assert_eq!(post(&[("Host", own), kind, ("Origin", &origin)]), 200);
    assert_eq!(post(&[("Host", &localhost), kind]), 200);
    // A name of somebody else that resolves to 127.0.0.1.
    assert_eq!(post(&[("Host", "evil.example"), kind]), 403);
    assert_eq!(post(&[("Host", "127.0.0.1"), kind]), 403);
    assert_eq!(server.request("GET /", &[("Host", "evil.example")], "").0, 403);
    for origin in [
        "http://evil.example",
        "null",
        "https://127.0.0.1",
        &format!("https://{own}"),
        &format!("{origin}.evil.example"),
    ] {
        assert_eq!(post(&[("Host", own), kind, ("Origin", origin)]), 403, "{origin}");
    }
    // An image of another page has no `Origin`.
    let image = |site| server.request("GET /api/start", &[("Host", own), ("Sec-Fetch-Site", site)], "").0;
    assert_eq!([image("cross-site"), image("same-site"), image("same-origin")], [403, 403, 200]);
    assert_eq!(server.request("GET /", &[("Host", own), ("Sec-Fetch-Site", "cross-site")], "").0, 200);
    // What a page sends to another origin without asking.
    for simple in ["text/plain", "application/x-www-form-urlencoded", "multipart/form-data", ""] {
        assert_eq!(post(&[("Host", own), ("Content-Type", simple)]), 415, "{simple}");
    }
    assert_eq!(server.request("OPTIONS /api/analyse", &[("Host", own), ("Origin", "http://evil.example")], "").0, 403);
}

#[test]
fn files_outside_of_the_folder_are_not_read() {
    let folder = folder("files");
    let secret = folder.join("secret.wgsl");
    let inside = folder.join("inside");
    std::fs::create_dir(&inside).unwrap();
    std::fs::write(&secret, "// not to be read: 7f3a\n").unwrap();
    std::fs::copy("examples/user_storage/first_k.wgsl", inside.join("first_k.wgsl")).unwrap();
    let naming = |path: &str| format!("buffer Mine {{\n    storage: wgsl(\"{path}\");\n    keep 8;\n}}\n");
    std::os::unix::fs::symlink(&secret, inside.join("linked.wgsl")).unwrap();
    let near = folder.join("near");
    std::fs::create_dir(&near).unwrap();
    std::fs::copy("examples/user_storage/first_k.wgsl", near.join("mine.wgsl")).unwrap();
    let without = Server::start_in(&near, &[]);
    let with = Server::start(&[inside.to_str().unwrap()]);
    let absolute = secret.display().to_string();
    for path in [absolute.as_str(), "../secret.wgsl", "linked.wgsl", "x/../../secret.wgsl", "/dev/zero", "/etc/passwd"]
    {
        for server in [&without, &with] {
            let text = naming(path);
            let (status, answer) = server.post("analyse", &json!({ "text": text }));
            let answer = answer.to_string();
            // The grammar takes no absolute path.
            let is_refused = answer.contains("is not read") || answer.contains("expected a path relative");
            assert!(status == 200 && is_refused && !answer.contains("7f3a"), "{path}: {answer}");
            for (name, body) in [
                ("render", picture(&text)),
                ("predict", picture(&text)),
                ("check", json!({ "text": text })),
                ("generate", json!({ "text": text, "target": "wgsl" })),
                ("geometry", json!({ "text": text, "scene": "cubes" })),
            ] {
                let (status, answer) = server.post(name, &body);
                assert_eq!(status, 422, "{name} {path}: {answer}");
            }
        }
    }
    // Without a folder, no message names a file of this machine.
    for (name, body) in [
        ("generate", json!({ "text": "buffer Mine { storage: mine; keep 8; }", "target": "wgsl" })),
        ("geometry", json!({ "text": "buffer Mine { storage: mine; keep 8; }", "scene": "cubes" })),
        ("render", picture("buffer Mine { storage: mine; keep 8; }")),
    ] {
        let (status, answer) = without.post(name, &body);
        assert!(status == 422 && !answer.to_string().contains("mine.wgsl"), "{name}: {answer}");
    }
    let (_, answer) = with.post("analyse", &json!({ "text": naming("first_k.wgsl") }));
    assert!(answer["description"].is_object(), "{answer}");
    let (status, answer) = with.post("render", &picture(&naming("first_k.wgsl")));
    assert_eq!(status, 200, "{answer}");
    // Scenes are generated ones, or models that a page sent.
    for scene in [
        "/etc/passwd",
        "../secret.wgsl",
        "model:../secret.wgsl",
        "model:",
        "cubes,n=1 --out /tmp/x",
        "",
        "marbles,n=99999999999",
    ] {
        let (status, answer) = with.post("render", &picture_with("scene", json!(scene)));
        assert!(status == 400 || status == 422, "{scene}: {status} {answer}");
    }
}

const MODEL: &str = "mtllib secret.mtl\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nusemtl red\nf 1 2 3\n";

impl Server {
    fn model(&self, name: &str, bytes: &str) -> (u16, Value) {
        let headers = [("Host", self.address.as_str()), ("Content-Type", "application/octet-stream")];
        let (status, text) = self.request(&format!("POST /api/model?name={name}"), &headers, bytes);
        (status, serde_json::from_str(&text).unwrap_or(Value::String(text)))
    }
}

#[test]
fn models_are_drawn_without_the_files_that_they_name() {
    let folder = folder("models");
    std::fs::write(folder.join("secret.mtl"), "newmtl red\nKd 1 0 0\n").unwrap();
    let server = Server::start(&[folder.to_str().unwrap()]);
    let secret = folder.join("secret.mtl").display().to_string();
    let model = MODEL.replace("secret.mtl", &secret);
    let (status, opened) = server.model("..%2Fone%20triangle.obj", &model);
    assert_eq!(
        (status, &opened["triangles"], &opened["name"]),
        (200, &json!(1), &json!("one_triangle.obj")),
        "{opened}"
    );
    let warning = opened["warnings"][0].as_str().unwrap();
    assert!(warning.starts_with("one_triangle.obj:1: files that the model names are not read"), "{warning}");
    let scene = opened["scene"].clone();
    assert_eq!(server.model("..%2Fone%20triangle.obj", &model).1["scene"], scene, "the same file has the same name");
    let drawn = |scene: &Value| server.post("render", &picture_with("scene", scene.clone()));
    let (status, answer) = drawn(&scene);
    assert_eq!((status, &answer["statistics"]["triangles"]), (200, &json!(1)), "{answer}");
    assert!(answer["messages"][0]["message"].as_str().unwrap().starts_with("one_triangle.obj:1: "), "{answer}");
    // The image is that of the model without its library.
    let path = folder.join("plain.obj");
    std::fs::write(&path, MODEL.replace("mtllib secret.mtl\n", "")).unwrap();
    let out = folder.join("plain.png");
    let mut command = Command::new(env!("CARGO_BIN_EXE_fragbuf"));
    command.args(["render", "kb", "--set", "k=4", "--size", "16x12", "--camera", "orbit:20,10", "--device", "cpu"]);
    command.args(["--scene", path.to_str().unwrap(), "--out", out.to_str().unwrap()]).stderr(Stdio::null());
    assert!(command.status().unwrap().success());
    use base64::Engine as _;
    let png = base64::engine::general_purpose::STANDARD.encode(std::fs::read(&out).unwrap());
    assert!(answer["png"] == json!(png), "the images differ");
    let (status, answer) = server.post("predict", &picture_with("scene", scene.clone()));
    assert_eq!((status, answer["histogram"].as_array().map(Vec::len)), (200, Some(1024)), "{answer}");
    assert_eq!(answer["scene"], scene, "the path of this machine");
    let (status, answer) = server.post("geometry", &json!({ "text": KB, "scene": scene }));
    assert!(status == 200 && answer.as_str().unwrap().contains("\"triangles\":1"), "{answer}");
    let (status, start) = server.get("/api/start");
    assert!(status == 200 && start.contains("one_triangle.obj"), "{start}");
    let (status, answer) = drawn(&json!("model:0123456789abcdef"));
    assert!(status == 422 && answer["error"].as_str().unwrap().contains("open the file again"), "{answer}");
}

#[test]
fn models_that_cannot_be_read_are_refused() {
    let server = Server::start(&[]);
    let gltf = r#"{"asset":{"version":"2.0"},"buffers":[{"uri":"/etc/passwd","byteLength":1}]}"#;
    for (name, bytes, expected) in [
        ("a.obj", "", "a.obj: the file is empty"),
        ("a.obj", "v 0 0 0\n", "a.obj: the model has no triangles"),
        ("a.stl", "solid a", "a.stl: unknown extension"),
        ("", MODEL, "model: unknown extension"),
        ("a.obj", "v 0 0 zero\n", "a.obj:1: "),
        ("a.ply", "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n", "a.ply"),
        ("a.gltf", gltf, "files that the model names are not read: `/etc/passwd`"),
        ("..", MODEL, "unknown extension"),
    ] {
        let (status, answer) = server.model(name, bytes);
        let error = answer["error"].as_str().unwrap_or_default();
        assert!(status == 422 && error.contains(expected), "{name}: {status} {answer}");
        assert!(!error.contains("/tmp"), "{error}");
    }
    let own = server.address.as_str();
    let post = |headers: &[(&str, &str)], body: &str| server.request("POST /api/model?name=a.obj", headers, body);
    let binary = ("Content-Type", "application/octet-stream");
    assert_eq!(post(&[("Host", "evil.example"), binary], MODEL).0, 403);
    assert_eq!(post(&[("Host", own), binary, ("Origin", "http://evil.example")], MODEL).0, 403);
    for kind in ["text/plain", "application/x-www-form-urlencoded", "multipart/form-data", "application/json", ""] {
        assert_eq!(post(&[("Host", own), ("Content-Type", kind)], MODEL).0, 415, "{kind}");
    }
    let (status, answer) = post(&[("Host", own), binary], &"#".repeat((64 << 20) + 1));
    assert!(status == 413 && answer.contains("use a smaller model"), "{status} {answer}");
    let unnamed = server.request("POST /api/model", &[("Host", own), binary], MODEL);
    assert!(unnamed.0 == 400 && unnamed.1.contains("name"), "{unnamed:?}");
    assert_eq!(server.get("/").0, 200);
}

#[test]
fn no_request_ends_the_server() {
    let server = Server::start(&[]);
    let own = server.address.clone();
    let headers = [("Host", own.as_str()), ("Content-Type", "application/json")];
    for name in ["analyse", "generate", "geometry", "render", "predict", "check", "download"] {
        for body in [
            "",
            "{",
            "null",
            "[]",
            "{}",
            "{\"text\": 3}",
            "{\"text\": \"\\ud800\"}",
            "{\"text\": \"buffer\", \"more\": 1}",
            "\u{0}",
        ] {
            let (status, answer) = server.request(&format!("POST /api/{name}"), &headers, body);
            assert_eq!(status, 400, "{name} {body:?}: {answer}");
            assert!(serde_json::from_str::<Value>(&answer).is_ok_and(|answer| answer["error"].is_string()), "{answer}");
        }
    }
    let nested = format!("{{\"text\": {}1{}}}", "[".repeat(100_000), "]".repeat(100_000));
    assert_eq!(server.request("POST /api/analyse", &headers, &nested).0, 400);
    let large = json!({ "text": "x".repeat(2 << 20) }).to_string();
    let (status, answer) = server.request("POST /api/analyse", &headers, &large);
    assert!(status == 413 && answer.contains("shorten the description"), "{status}: {answer}");
    let camera = json!({ "azimuth": 0.0, "elevation": 0.0, "zoom": 0.0 });
    let (status, answer) = server.post("render", &picture_with("camera", camera));
    assert!(status == 400 && answer["error"].as_str().unwrap().contains("its zoom from 0.01"), "{answer}");
    let (status, answer) = server.post("check", &json!({ "text": KB, "target": "pascal" }));
    assert!(status == 400 && answer["error"].as_str().unwrap().contains("give one of wgsl"), "{answer}");
    let (status, answer) = server.post("render", &picture_with("size", json!([4096, 4096])));
    assert_eq!(status, 400, "{answer}");
    let (status, answer) = server.post("render", &picture_with("size", json!([0, 1])));
    assert_eq!(status, 400, "{answer}");
    let (status, answer) = server.post("render", &picture_with("device", json!("no such device")));
    assert!(status == 422 && answer["error"].as_str().unwrap().contains("no such device"), "{answer}");
    for bytes in [
        &b"\x00\xff\xfe"[..],
        b"GET",
        b"GET / HTTP/1.1\r\n\r\n",
        b"GET / HTTP/9.9\r\nHost: x\r\n\r\n",
        b"POST /api/analyse HTTP/1.1\r\nContent-Length: 18446744073709551616\r\n\r\n",
        b"POST /api/analyse HTTP/1.1\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n",
    ] {
        let mut stream = TcpStream::connect(&own).unwrap();
        let _ = stream.write_all(bytes);
        drop(stream);
    }
    // Two pages at once.
    std::thread::scope(|scope| {
        let pages: Vec<_> = (0..4).map(|_| scope.spawn(|| server.post("render", &picture(KB)).0)).collect();
        assert!(pages.into_iter().all(|page| page.join().unwrap() == 200));
    });
    assert_eq!(server.get("/").0, 200);
}

/// A page that is closed cancels its check: the process that runs it ends.
#[test]
fn a_check_ends_when_its_request_is_cancelled() {
    let server = Server::start(&[]);
    // Seconds to minutes of work.
    let body = json!({ "text": "buffer Mine from kplus_heap {\n}\n", "fragments": 4, "k": 3 }).to_string();
    let mut stream = TcpStream::connect(&server.address).unwrap();
    let head = format!("POST /api/check HTTP/1.1\r\nHost: {}\r\nContent-Type: application/json\r\n", server.address);
    stream.write_all(format!("{head}Content-Length: {}\r\n\r\n{body}", body.len()).as_bytes()).unwrap();
    let id = server.child.id();
    let until = |wanted: usize| {
        for _ in 0..600 {
            if children(id) == wanted {
                return true;
            }
            std::thread::sleep(Duration::from_millis(50));
        }
        false
    };
    assert!(until(1), "the check does not run");
    drop(stream);
    assert!(until(0), "the check still runs");
}

/// Returns the number of processes whose parent is `id` and that have not ended.
fn children(id: u32) -> usize {
    let stats = std::fs::read_dir("/proc")
        .unwrap()
        .flatten()
        .filter_map(|entry| std::fs::read_to_string(entry.path().join("stat")).ok());
    let is_child = |stat: String| {
        let (_, rest) = stat.rsplit_once(") ")?;
        let mut fields = rest.split(' ');
        let state = fields.next()?;
        Some(state != "Z" && fields.next()?.parse() == Ok(id))
    };
    stats.filter_map(is_child).filter(|is_child| *is_child).count()
}

//! URIs of files and of templates.
//!
//! Input: a URI, or a path. Output: the other. A URI of another scheme has no path.

use std::fmt::Write as _;

/// The scheme of the WGSL files of fragbuf, which are in the program and not in a folder.
pub(super) const TEMPLATE: &str = "fragbuf-template";

/// Returns the path of a URI `file:///…`, or `//HOST/…` of one that names a host, as Windows has them.
pub(super) fn path(uri: &str) -> Option<String> {
    let rest = uri.strip_prefix("file://")?;
    let host = rest.split('/').next().unwrap_or_default();
    let path = match host {
        "" | "localhost" => decoded(rest.strip_prefix(host)?)?,
        _ => format!("//{}", decoded(rest)?),
    };
    // `/c:/folder` on Windows.
    let drive = path.strip_prefix('/').filter(|rest| rest.as_bytes().get(1) == Some(&b':'));
    Some(drive.map_or(path.clone(), str::to_owned))
}

/// Returns the URI of a path.
pub(super) fn of_path(path: &str) -> String {
    let path = path.replace('\\', "/");
    match path.strip_prefix("//") {
        Some(rest) => encoded("file://", rest),
        None => encoded(if path.starts_with('/') { "file://" } else { "file:///" }, &path),
    }
}

/// Returns the URI of a template.
pub(super) fn of_template(path: &str) -> String {
    encoded(&format!("{TEMPLATE}:/"), path)
}

/// Returns the path of a template.
pub(super) fn template(uri: &str) -> Option<String> {
    decoded(uri.strip_prefix(TEMPLATE)?.strip_prefix(':')?).map(|path| path.trim_start_matches('/').to_owned())
}

fn encoded(start: &str, path: &str) -> String {
    let mut uri = start.to_owned();
    for byte in path.bytes() {
        match byte {
            b'/' | b'-' | b'.' | b'_' | b'~' => uri.push(char::from(byte)),
            _ if byte.is_ascii_alphanumeric() => uri.push(char::from(byte)),
            _ => drop(write!(uri, "%{byte:02X}")),
        }
    }
    uri
}

fn decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let Some((first, after)) = rest.split_first() {
        match (first, after) {
            (b'%', [high, low, after @ ..]) => {
                let digit = |digit: &u8| char::from(*digit).to_digit(16);
                bytes.push((digit(high)? * 16 + digit(low)?) as u8);
                rest = after;
            }
            (b'%', _) => return None,
            (byte, after) => {
                bytes.push(*byte);
                rest = after;
            }
        }
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_and_uris_are_converted() {
        for (uri, expected) in [
            ("file:///a/b%20c.fragbuf", Some("/a/b c.fragbuf")),
            ("file:///c%3A/a.fragbuf", Some("c:/a.fragbuf")),
            ("file:///%C3%A9", Some("/é")),
            ("file://localhost/a", Some("/a")),
            ("file://wsl.localhost/Ubuntu/a%20b", Some("//wsl.localhost/Ubuntu/a b")),
            ("file:///%C3", None),
            ("file:///%zz", None),
            ("untitled:Untitled-1", None),
        ] {
            assert_eq!(path(uri).as_deref(), expected, "{uri}");
        }
        assert_eq!(of_path("/a/b c"), "file:///a/b%20c");
        assert_eq!(path(&of_path("c:\\ä b")).as_deref(), Some("c:/ä b"));
        assert_eq!(of_path("//wsl.localhost/Ubuntu/a b"), "file://wsl.localhost/Ubuntu/a%20b");
        assert_eq!(template(&of_template("storage/x.wgsl")).as_deref(), Some("storage/x.wgsl"));
    }
}

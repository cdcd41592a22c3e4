//! Answers the page itself, and refuses all others.
//!
//! Another page of the browser could send requests to the loopback interface, also under a name of its own that resolves to 127.0.0.1. So
//! `Host` must be this server, and so must `Origin` where a browser sends one; a request with a body must be JSON, or bytes if it is a
//! model: browsers send either to another origin only after a request that is refused here.

use std::net::SocketAddr;

use axum::extract::{Request, State};
use axum::http::header::{CONTENT_TYPE, HOST, ORIGIN};
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse as _, Response};

use super::problem::Problem;

/// The port of HTTP.
const HTTP: u16 = 80;

/// The path of models.
const MODEL: &str = "/api/model";

/// The header by which a browser says which page a request is from.
const SITE: &str = "sec-fetch-site";

/// The page may load what this server has, and nothing else. The editor sets styles of elements.
const POLICY: &str = "default-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' blob: data:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'";

/// The headers of every answer.
const HEADERS: [(HeaderName, &str); 5] = [
    (header::CONTENT_SECURITY_POLICY, POLICY),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::REFERRER_POLICY, "no-referrer"),
    (header::CACHE_CONTROL, "no-store"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
];

/// Passes a request of the page on.
pub(super) async fn check(State(address): State<SocketAddr>, request: Request, next: Next) -> Response {
    let mut response = match refusal(address, (request.method(), request.uri().path()), request.headers()) {
        Some(problem) => problem.into_response(),
        None => next.run(request).await,
    };
    for (name, value) in HEADERS {
        response.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    response
}

/// Returns why a request is refused.
fn refusal(address: SocketAddr, (method, path): (&Method, &str), headers: &HeaderMap) -> Option<Problem> {
    let mut names = vec![address.to_string(), format!("localhost:{}", address.port())];
    if address.port() == HTTP {
        // Browsers leave it out.
        names.extend([address.ip().to_string(), "localhost".to_owned()]);
    }
    let refused = |message: &str| Some(Problem { status: StatusCode::FORBIDDEN, message: message.to_owned() });
    let host = headers.get(HOST).and_then(|host| host.to_str().ok());
    if !host.is_some_and(|host| names.iter().any(|name| name == host)) {
        return refused("the header `Host` is not that of this server");
    }
    let is_own =
        |origin: &HeaderValue| names.iter().any(|name| origin.as_bytes() == format!("http://{name}").as_bytes());
    if headers.get(ORIGIN).is_some_and(|origin| !is_own(origin)) {
        return refused("the request is not from the page of this server");
    }
    // An image or a script of another page has no `Origin`.
    let site = headers.get(SITE).map(HeaderValue::as_bytes);
    if path.starts_with("/api/") && site.is_some_and(|site| site != b"same-origin" && site != b"none") {
        return refused("the request is not from the page of this server");
    }
    let kind = headers.get(CONTENT_TYPE).and_then(|kind| kind.to_str().ok()).unwrap_or_default();
    let kind = kind.split(';').next().unwrap_or_default().trim();
    let expected = if path == MODEL { "application/octet-stream" } else { "application/json" };
    if method == Method::POST && !kind.eq_ignore_ascii_case(expected) {
        let message = format!("the header `Content-Type` must be `{expected}`");
        return Some(Problem { status: StatusCode::UNSUPPORTED_MEDIA_TYPE, message });
    }
    None
}

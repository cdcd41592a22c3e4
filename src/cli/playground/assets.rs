//! The files of the page, by their paths.

/// A file of the page.
pub(in crate::cli) struct Asset {
    pub(in crate::cli) path: &'static str,
    pub(super) kind: &'static str,
    pub(in crate::cli) bytes: &'static [u8],
}

const HTML: &str = "text/html; charset=utf-8";
const SCRIPT: &str = "text/javascript; charset=utf-8";
const STYLE: &str = "text/css; charset=utf-8";

/// Files of the folder `page`.
macro_rules! page {
    ($($kind:ident $path:literal),* $(,)?) => {
        &[$(Asset { path: $path, kind: $kind, bytes: include_bytes!(concat!("page/", $path)) }),*]
    };
}

/// The WebGPU host, which the page draws with.
macro_rules! host {
    ($($path:literal),* $(,)?) => {
        &[$(Asset {
            path: concat!("webgpu/", $path),
            kind: SCRIPT,
            bytes: include_bytes!(concat!("../../../backends/run/webgpu/", $path)),
        }),*]
    };
}

const PAGE: &[Asset] = page![
    SCRIPT "api.mjs",
    SCRIPT "axes.mjs",
    STYLE "base.css",
    SCRIPT "camera.mjs",
    STYLE "check.css",
    SCRIPT "check.mjs",
    SCRIPT "code_style.mjs",
    SCRIPT "code_view.mjs",
    SCRIPT "compare.mjs",
    SCRIPT "controls.mjs",
    STYLE "costs.css",
    SCRIPT "costs.mjs",
    SCRIPT "dom.mjs",
    STYLE "editor.css",
    SCRIPT "editor.mjs",
    SCRIPT "file_tabs.mjs",
    SCRIPT "geometry.mjs",
    HTML "index.html",
    SCRIPT "language.mjs",
    SCRIPT "link.mjs",
    SCRIPT "main.mjs",
    SCRIPT "markdown.mjs",
    SCRIPT "models.mjs",
    STYLE "picture.css",
    SCRIPT "picture.mjs",
    SCRIPT "plot.mjs",
    SCRIPT "png.mjs",
    SCRIPT "problems.mjs",
    SCRIPT "scenes.mjs",
    SCRIPT "server_frames.mjs",
    SCRIPT "sliders.mjs",
    SCRIPT "state.mjs",
    SCRIPT "statistics.mjs",
    SCRIPT "status.mjs",
    STYLE "style.css",
    SCRIPT "tabs.mjs",
    SCRIPT "text.mjs",
    SCRIPT "theme.mjs",
    SCRIPT "uniforms.mjs",
    SCRIPT "vendor/codemirror.mjs",
    SCRIPT "webgpu_frames.mjs",
    STYLE "windows.css",
    SCRIPT "wrapping.mjs",
];

/// The WebGPU host, in the folder `webgpu` of the page.
pub(in crate::cli) const HOST: &[Asset] = host![
    "arguments.mjs",
    "boxes.mjs",
    "errors.mjs",
    "formula.mjs",
    "fragbuf.mjs",
    "frame.mjs",
    "host.mjs",
    "memory.mjs",
    "passes.mjs",
    "plan.mjs",
    "readback.mjs",
    "requirements.mjs",
    "times.mjs",
    "uniforms.mjs",
];

/// Returns the bytes of a file by its path in the page.
pub(in crate::cli) fn asset(path: &str) -> Option<&'static [u8]> {
    PAGE.iter().chain(HOST).find(|asset| asset.path == path).map(|asset| asset.bytes)
}

/// Returns the file of a path of the server; `/` is the page.
pub(super) fn find(path: &str) -> Option<&'static Asset> {
    let path = path.strip_prefix('/')?;
    let path = if path.is_empty() { "index.html" } else { path };
    PAGE.iter().chain(HOST).find(|asset| asset.path == path)
}

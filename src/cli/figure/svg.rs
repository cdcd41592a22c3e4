//! Writes SVG files of texts, rectangles and images. Charts with axes are in [`super::chart`].

use std::fmt::Write;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

/// A drawing.
pub(super) struct Svg {
    text: String,
}

/// Where a text is relative to its point.
#[derive(Clone, Copy)]
pub(super) enum Anchor {
    Start,
    Middle,
}

impl Svg {
    /// Returns a white drawing of a size in pixels.
    pub(super) fn new(width: u32, height: u32) -> Self {
        let mut svg = Svg { text: String::new() };
        let _ = writeln!(
            svg.text,
            r#"<svg width="{width}" height="{height}" viewBox="0 0 {width} {height}" xmlns="http://www.w3.org/2000/svg">"#
        );
        svg.rectangle([0, 0, width, height], "#ffffff");
        svg
    }

    /// Draws a text; the point is on its baseline.
    pub(super) fn text(&mut self, [x, y]: [u32; 2], (size, color, anchor): (u32, &str, Anchor), text: &str) {
        let anchor = match anchor {
            Anchor::Start => "start",
            Anchor::Middle => "middle",
        };
        let _ = writeln!(
            self.text,
            r#"<text x="{x}" y="{y}" font-family="sans-serif" font-size="{size}" fill="{color}" text-anchor="{anchor}">{}</text>"#,
            escaped(text)
        );
    }

    /// Fills a rectangle: left, top, width, height.
    pub(super) fn rectangle(&mut self, [x, y, width, height]: [u32; 4], color: &str) {
        let _ = writeln!(self.text, r#"<rect x="{x}" y="{y}" width="{width}" height="{height}" fill="{color}" />"#);
    }

    /// Draws a PNG, with sharp pixels.
    pub(super) fn image(&mut self, [x, y, width, height]: [u32; 4], png: &[u8]) {
        let _ = writeln!(
            self.text,
            r#"<image x="{x}" y="{y}" width="{width}" height="{height}" style="image-rendering:pixelated" href="data:image/png;base64,{}" />"#,
            STANDARD.encode(png)
        );
    }

    /// Returns the file.
    pub(super) fn finish(mut self) -> String {
        self.text.push_str("</svg>\n");
        self.text
    }
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

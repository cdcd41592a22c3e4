//! The frame of every page: head, bar and footer.
//!
//! Input: a title, the content of the page as HTML, and where the page is. Output: a whole page. All addresses are relative to the page.

/// A page that is not the player.
pub(super) struct Page<'a> {
    /// Text, as all of the following but `content`.
    pub(super) title: &'a str,
    /// The path from the page to the root of the site: empty, or `../`.
    pub(super) root: &'a str,
    /// The entry of the bar that is this page.
    pub(super) current: &'a str,
    /// HTML.
    pub(super) content: &'a str,
}

/// The pages that the bar leads to, by their paths from the root.
const BAR: [(&str, &str); 3] =
    [("Gallery", "index.html"), ("Techniques", "techniques/index.html"), ("Player", "play/index.html")];

impl Page<'_> {
    pub(super) fn html(&self) -> String {
        let Page { root, content, .. } = self;
        let title = escaped(self.title);
        let links: String = BAR.iter().map(|(name, path)| self.link(name, path)).collect();
        format!(
            r##"<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<meta name="generator" content="fragbuf {version}">
<title>{title}</title>
<link rel="icon" href="data:,">
<link rel="stylesheet" href="{root}play/style.css">
<link rel="stylesheet" href="{root}site.css">
<script type="module" src="{root}colours.js"></script>
</head>
<body class="site">
<a class="skip" href="#content">Skip to the content</a>
<header class="bar">
<p class="name"><a href="{root}index.html">fragbuf</a></p>
<nav aria-label="Site">{links}</nav>
<div class="actions">
<button type="button" id="theme" class="theme" aria-label="Colours" hidden>{icon}</button>
</div>
</header>
<main id="content" tabindex="-1">
{content}</main>
<footer class="foot"><p>fragbuf {version}</p></footer>
</body>
</html>
"##,
            version = env!("CARGO_PKG_VERSION"),
            icon = ICON,
        )
    }

    fn link(&self, name: &str, path: &str) -> String {
        let current = if name == self.current { " aria-current=\"page\"" } else { "" };
        format!("<a href=\"{}{path}\"{current}>{name}</a>", self.root)
    }
}

/// The icon of the button for light and dark, as in the playground.
const ICON: &str = "<svg viewBox=\"0 0 20 20\" width=\"18\" height=\"18\" aria-hidden=\"true\"><circle cx=\"10\" cy=\"10\" r=\"7\" \
                    fill=\"none\" stroke=\"currentColor\" stroke-width=\"1.6\"/><path d=\"M10 3a7 7 0 0 1 0 14z\" fill=\"currentColor\"/></svg>";

/// Returns a text for HTML, also for attributes in quotes.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

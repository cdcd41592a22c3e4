//! Markdown of this program as HTML.
//!
//! Input: a page of a technique, or a table. Output: HTML whose tables scroll in themselves. HTML in the text becomes text; links to pages
//! and pictures of the repository become those of the site.

use pulldown_cmark::{CowStr, Event, Options, Parser, Tag, TagEnd, html};

/// Returns the HTML of a text. `link` returns the address that stands in the site for one of the text.
pub(super) fn html(text: &str, link: &dyn Fn(&str) -> String) -> String {
    let parser = Parser::new_ext(text, Options::ENABLE_TABLES);
    let mut page = String::with_capacity(2 * text.len());
    html::push_html(&mut page, parser.flat_map(|event| converted(event, link)));
    page
}

/// Returns the HTML of a text that is a part of a line.
pub(super) fn inline(text: &str) -> String {
    let page = html(text, &str::to_owned);
    let page = page.trim_end();
    page.strip_prefix("<p>").and_then(|rest| rest.strip_suffix("</p>")).unwrap_or(page).to_owned()
}

/// Returns the events that stand for an event.
fn converted<'a>(event: Event<'a>, link: &dyn Fn(&str) -> String) -> Vec<Event<'a>> {
    let address = |address: CowStr<'a>| CowStr::from(link(&address));
    match event {
        Event::Html(text) | Event::InlineHtml(text) => vec![Event::Text(text)],
        Event::Start(Tag::Table(columns)) => {
            let scroll = "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Table\">";
            vec![Event::Html(scroll.into()), Event::Start(Tag::Table(columns))]
        }
        Event::End(TagEnd::Table) => vec![Event::End(TagEnd::Table), Event::Html("</div>\n".into())],
        Event::Start(Tag::Link { link_type, dest_url, title, id }) => {
            vec![Event::Start(Tag::Link { link_type, dest_url: address(dest_url), title, id })]
        }
        Event::Start(Tag::Image { link_type, dest_url, title, id }) => {
            vec![Event::Start(Tag::Image { link_type, dest_url: address(dest_url), title, id })]
        }
        other => vec![other],
    }
}

#[cfg(test)]
mod tests {
    use super::html;

    #[test]
    fn html_in_the_text_becomes_text() {
        let page = html("a <b>c</b>\n\n<script>x</script>\n\n| a |\n|---|\n| [b](b.md) |\n", &|_| "b.html".to_owned());
        assert!(page.contains("a &lt;b&gt;c&lt;/b&gt;") && page.contains("&lt;script&gt;"), "{page}");
        assert!(page.contains("<a href=\"b.html\">b</a>") && page.contains("</table>\n</div>"), "{page}");
    }
}

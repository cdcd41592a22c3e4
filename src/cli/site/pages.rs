//! The pages with text: the gallery, a page per technique, and the table of techniques.
//!
//! Input: the techniques with their facts and pages in Markdown, and the pictures with their commands. Output: HTML. Nothing is computed
//! here that `fragbuf list` and `fragbuf show --page` do not print.

use fragbuf::Registry;
use fragbuf_model::counted;

use super::gallery::{Command, picture};
use super::html::{Page, escaped};
use super::{Entry, Files, markdown};
use crate::cli::list;
use crate::cli::output::Failure;

/// What fragbuf is.
const ABOUT: &str = "A *fragment buffer* stores several fragments per pixel; order-independent transparency, depth peeling, constructive \
                     solid geometry and many other effects need one. fragbuf compiles one description of a fragment buffer to complete GPU \
                     passes in WGSL, GLSL, SPIR-V, HLSL and MSL, with a manifest that an engine can follow. It also draws with them, \
                     compares them, and checks them in every interleaving of the fragments of a pixel.";

/// What the table of techniques means; `TIERS` is what [`list::tiers`] returns.
const TABLE: &str = "# Techniques\n\n\
    A technique is a point on the axes of fragbuf, named as in its paper. *f* is the number of fragments of a pixel, *n* the greatest *f*, \
    *k* the number of fragments kept. *Tiers* name the mechanism that makes a technique sound under concurrency. TIERS. \
    *Order-independent*: the image does not depend on the order in which fragments arrive.\n\n\
    | technique | what a pixel keeps | bytes per pixel | draws | order-independent | tiers |\n|---|---|---|---|---|---|\n";

/// Adds the pages.
pub(super) fn add(
    entries: &[Entry],
    commands: &[Command],
    registry: &Registry,
    files: &mut Files,
) -> Result<(), Failure> {
    let gallery = gallery(entries, commands)?;
    let page = Page { title: "fragbuf", root: "", current: "Gallery", content: &gallery };
    files.add("index.html", page.html());
    let table: String = entries.iter().map(row).collect();
    let content = format!(
        "<article class=\"text wide\">\n{}</article>\n",
        text(&format!("{}{table}", TABLE.replace("TIERS", &list::tiers())))
    );
    let page = Page { title: "Techniques · fragbuf", root: "../", current: "Techniques", content: &content };
    files.add("techniques/index.html", page.html());
    for (number, entry) in entries.iter().enumerate() {
        let around = [number.checked_sub(1), Some(number + 1)].map(|other| other.and_then(|other| entries.get(other)));
        files.add(format!("techniques/{}.html", entry.key), technique(entry, around, registry));
    }
    Ok(())
}

/// Returns the HTML of a text in Markdown, on a page of the folder `techniques`.
fn text(text: &str) -> String {
    let link = |address: &str| match (address.strip_prefix("../gallery/"), address.strip_suffix(".md")) {
        (Some(file), _) => format!("../{}", picture(file.trim_end_matches(".png"))),
        (None, Some(page)) => format!("{page}.html"),
        (None, None) => address.to_owned(),
    };
    markdown::html(text, &link)
}

/// Returns the row of a technique in the table.
fn row(entry: &Entry) -> String {
    let field = |name: &str| entry.facts[name].as_str().map_or_else(|| entry.facts[name].to_string(), str::to_owned);
    let exact = ["deterministic", "order_independent"].iter().all(|name| entry.facts[*name] == "yes");
    let [summary, bytes, draws] = ["summary", "bytes_per_pixel", "draws"].map(field);
    let tiers = entry.facts["targets"].as_object().map(list::grouped).unwrap_or_default();
    let key = &entry.key;
    let exact = if exact { "yes" } else { "no" };
    format!("| [`{key}`]({key}.html) | {summary} | {bytes} | {draws} | {exact} | {tiers} |\n")
}

/// Returns the page of a technique, with links to the player and to the techniques before and after it.
fn technique(entry: &Entry, around: [Option<&Entry>; 2], registry: &Registry) -> String {
    let key = &entry.key;
    let (name, note) = match entry.player["unsupported"].as_str() {
        Some(reason) => ("See it in the player", format!("The player shows its picture alone: {reason}.")),
        None => ("Try it", "Draws it by WebGPU in your browser.".to_owned()),
    };
    let try_it = format!(
        "<p class=\"try\"><a class=\"button primary\" href=\"../play/index.html#technique={key}\">{name}</a> \
         <span class=\"note\">{}</span></p>\n",
        markdown::inline(&note)
    );
    let body = text(&entry.page);
    // The picture is the first paragraph with an image.
    let body = match body.split_once(".png\" alt=").and_then(|(_, rest)| rest.split_once("</p>\n")) {
        Some((_, after)) => format!("{}{try_it}{after}", &body[..body.len() - after.len()]),
        None => format!("{body}{try_it}"),
    };
    let link = |entry: Option<&Entry>, class: &str, arrow: [&str; 2]| {
        entry.map_or_else(String::new, |entry| {
            let [before, after] = arrow;
            format!("<a class=\"{class}\" href=\"{0}.html\">{before}{0}{after}</a>", entry.key)
        })
    };
    let [previous, next] = around;
    let content = format!(
        "<article class=\"text\">\n{body}<nav class=\"around\" aria-label=\"Techniques\">{}{}</nav>\n</article>\n",
        link(previous, "previous", ["← ", ""]),
        link(next, "next", ["", " →"])
    );
    let title = registry.technique(key).map_or(key.as_str(), |technique| technique.title);
    let title = if title == key { format!("{key} · fragbuf") } else { format!("{key} · {title} · fragbuf") };
    Page { title: &title, root: "../", current: "", content: &content }.html()
}

/// Returns the gallery: what fragbuf is, the larger scenes, and a picture per technique.
fn gallery(entries: &[Entry], commands: &[Command]) -> Result<String, Failure> {
    let (techniques, scenes): (Vec<&Command>, Vec<&Command>) =
        commands.iter().partition(|command| command.technique.is_some());
    let first = scenes.first().or(techniques.first());
    let first = first.map(|command| figure(command, "eager", "")).transpose()?.unwrap_or_default();
    let mut page = format!(
        "<section class=\"hero\">\n<div>\n<h1>Many fragments per pixel, from one description</h1>\n{}\
         <p class=\"try\"><a class=\"button primary\" href=\"play/index.html\">Try it in your browser</a> \
         <a class=\"button\" href=\"techniques/index.html\">{}</a></p>\n</div>\n{first}</section>\n",
        markdown::html(ABOUT, &str::to_owned),
        counted(entries.len(), "technique"),
    );
    if scenes.len() > 1 {
        page.push_str("<section aria-labelledby=\"scenes\">\n<h2 id=\"scenes\">Scenes</h2>\n<ul class=\"scenes\">\n");
        for command in scenes.iter().skip(1) {
            let caption = format!("<p>{}</p>", escaped(&command.caption));
            page.push_str(&format!("<li>{}</li>\n", figure(command, "lazy", &caption)?));
        }
        page.push_str("</ul>\n</section>\n");
    }
    page.push_str("<section aria-labelledby=\"techniques\">\n<h2 id=\"techniques\">Techniques</h2>\n");
    page.push_str(
        "<p class=\"note\">The same scene by every technique. Each page has its axes, memory, passes and tiers.</p>\n",
    );
    page.push_str("<ul class=\"techniques\">\n");
    for (command, entry) in techniques.iter().zip(entries) {
        page.push_str(&card(command, entry)?);
    }
    page.push_str("</ul>\n</section>\n");
    Ok(page)
}

/// Returns a picture with its command.
fn figure(command: &Command, loading: &str, caption: &str) -> Result<String, Failure> {
    let (image, text) = (image(command, loading)?, escaped(&command.text));
    let code = format!("<pre tabindex=\"0\"><code>{text}</code></pre>");
    Ok(format!("<figure>{image}<figcaption>{caption}{code}</figcaption></figure>\n"))
}

fn card(command: &Command, entry: &Entry) -> Result<String, Failure> {
    let summary = entry.player["summary"].as_str().unwrap_or_default();
    let (key, image) = (&entry.key, image(command, "lazy")?);
    Ok(format!(
        "<li><a href=\"techniques/{key}.html\">{image}<strong>{key}</strong></a><p>{}</p>\
         <p><a href=\"play/index.html#technique={key}\">Try it<span class=\"unseen\">: {key}</span></a></p></li>\n",
        markdown::inline(summary)
    ))
}

/// Returns the image of a command, with the size that it has, so that nothing moves while it loads.
fn image(command: &Command, loading: &str) -> Result<String, Failure> {
    let (width, height) = command.size()?;
    let alt = match &command.technique {
        Some(key) => format!("marbles, drawn by {key}"),
        None => command.caption.clone(),
    };
    let (path, alt) = (command.path(), escaped(&alt));
    Ok(format!("<img src=\"{path}\" alt=\"{alt}\" width=\"{width}\" height=\"{height}\" loading=\"{loading}\">"))
}

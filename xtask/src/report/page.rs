//! A page: one file of HTML, which loads nothing.

use maud::{DOCTYPE, Markup, PreEscaped, html};

/// How pages look, light and dark.
const STYLE: &str = include_str!("page.css");

/// A page of a title and a body. `style` is added to what all pages have.
pub fn html(title: &str, style: &str, body: &Markup) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                title { (title) }
                style { (PreEscaped(STYLE)) (PreEscaped(style)) }
            }
            body { main { (body) } }
        }
    };
    page.into_string()
}

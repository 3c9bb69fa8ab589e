//! The page that shows everything.

use maud::{DOCTYPE, PreEscaped, html};

use super::claims::{Claim, NOT_RUN};
use super::content::{ReportContext, ReportSection};

const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;color:#222}\
                     img{max-width:100%;height:auto}.pixels{image-rendering:pixelated}figure{margin:1.5rem 0}\
                     figcaption{color:#555;font-size:.9rem}table{border-collapse:collapse;margin:1rem 0}\
                     th,td{border-bottom:1px solid #ddd;padding:.3rem .6rem;text-align:left;vertical-align:top}\
                     .label{background:#fff3cd;padding:.6rem 1rem;border-left:4px solid #e0a800}\
                     .holds{color:#00734d}.not{color:#b00020}";
const TITLE: &str = "Neural Font Rendering, reproduced";

/// The whole page.
pub(super) fn page(context: &ReportContext<'_>, claims: &[Claim], sections: &[ReportSection]) -> String {
    let label = context.label();
    let fonts: Vec<&str> = context.plan.fonts.iter().map(|dataset| dataset.name.as_str()).collect();
    let class = |claim: &Claim| match claim.holds {
        Some(true) => "holds",
        Some(false) => "not",
        None => "",
    };
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width";
                title { (TITLE) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { (TITLE) }
                p.label { (label) }
                p {
                    "The models and experiments of the paper by Anderson, Shamir and Fried, and this project's grid-fit \
                     field beside them, on " (fonts.join(", ")) ". Errors are mean squared differences of coverage, 0 to \
                     1, over all pixels of the box, against the hinted bitmap."
                }
                h2 { "The paper's claims" }
                table {
                    tr {
                        th { "claim" } th { "measured" } th { "verdict" }
                        @if let Some(other) = context.beside { th colspan="2" { (other.label) } }
                    }
                    @for claim in claims {
                        tr {
                            td { (claim.statement) }
                            td { (claim.measured) }
                            td class=(class(claim)) { (claim.verdict()) }
                            @if let Some(other) = context.beside {
                                @let (measured, verdict) = other.claim(claim.statement).unwrap_or((NOT_RUN, ""));
                                td { (measured) }
                                td { (verdict) }
                            }
                        }
                    }
                }
                @for section in sections {
                    h2 { (section.title) }
                    @if section.is_empty() { p { "Not run." } }
                    (section.text)
                    @for figure in &section.figures {
                        figure {
                            img.pixels[figure.file.ends_with(".png")] src=(figure.file) alt=(figure.caption);
                            figcaption { (figure.caption) }
                        }
                    }
                }
                p.label { (label) }
            }
        }
    };
    page.into_string()
}

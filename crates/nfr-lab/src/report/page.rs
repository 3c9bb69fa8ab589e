//! The page that shows everything.

use std::fmt::Write;

use super::{Claim, Part, Section};
use nfr_convert::compare::html::escape;

const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;max-width:60rem;margin:2rem auto;padding:0 1rem;color:#222}\
                     img{max-width:100%;height:auto}.pixels{image-rendering:pixelated}figure{margin:1.5rem 0}\
                     figcaption{color:#555;font-size:.9rem}table{border-collapse:collapse;margin:1rem 0}\
                     th,td{border-bottom:1px solid #ddd;padding:.3rem .6rem;text-align:left;vertical-align:top}\
                     .label{background:#fff3cd;padding:.6rem 1rem;border-left:4px solid #e0a800}\
                     .holds{color:#00734d}.not{color:#b00020}";

/// The whole page.
pub(super) fn page(part: &Part<'_>, claims: &[Claim], sections: &[Section]) -> String {
    let label = escape(&part.label());
    let fonts: Vec<String> = part.plan.fonts.iter().map(|subject| escape(&subject.name)).collect();
    let mut html = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width\">\n<title>Neural Font Rendering, reproduced</title>\n<style>{STYLE}</style>\n\
         <h1>Neural Font Rendering, reproduced</h1>\n<p class=\"label\">{label}</p>\n<p>The models and experiments of the \
         paper by Anderson, Shamir and Fried, and this project's grid-fit field beside them, on {}. Errors are mean \
         squared differences of coverage, 0 to 1, over all pixels of the box, against the hinted bitmap.</p>\n",
        fonts.join(", ")
    );
    html += "<h2>The paper's claims</h2>\n<table>\n<tr><th>claim<th>measured<th>verdict</tr>\n";
    for claim in claims {
        let class = match claim.holds {
            Some(true) => "holds",
            Some(false) => "not",
            None => "",
        };
        // A string takes everything that is written to it, here and below.
        let _ = writeln!(
            html,
            "<tr><td>{}<td>{}<td class=\"{class}\">{}</tr>",
            escape(claim.said),
            escape(&claim.measured),
            claim.verdict()
        );
    }
    html += "</table>\n";
    for section in sections {
        let _ = writeln!(html, "<h2>{}</h2>\n{}", escape(section.title), section.text);
        for figure in &section.figures {
            let class = if figure.file.ends_with(".png") { " class=\"pixels\"" } else { "" };
            let (file, caption) = (escape(&figure.file), escape(&figure.caption));
            let _ = writeln!(
                html,
                "<figure><img{class} src=\"{file}\" alt=\"{caption}\"><figcaption>{caption}</figcaption></figure>"
            );
        }
    }
    let _ = writeln!(html, "<p class=\"label\">{label}</p>\n</html>");
    html
}

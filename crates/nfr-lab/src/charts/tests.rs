//! Properties of all charts. With `NFR_CHARTS` set to a directory, they are left there to be looked at.
#![allow(clippy::unwrap_used)]

use super::*;
use crate::statistics::Summary;

const HEADINGS: Headings<'_> = Headings {
    title: "Errors of <models> & others",
    subtitle: "Liberation Sans, a–z, s = 20–63; small scale: width 64, 2,000 epochs, one seed (the paper has width \
               1024 and 30,000 epochs, so its errors are smaller than these; see the report's notes)",
};

/// Numbers that look like chance and are the same every time, about evenly in 0..1.
fn noise(seed: usize) -> f64 {
    (seed as f64 * 12.9898).sin().mul_add(43758.5453, 0.0).rem_euclid(1.0)
}

fn errors(model: usize, count: usize) -> Vec<f64> {
    let typical = [3e-4, 1.2e-3, 6e-3, 2e-2, 4e-2][model % 5];
    (0..count).map(|i| typical * 4f64.powf(noise(i + 99 * model) + noise(7 * i + model) - 1.0)).collect()
}

fn keep(name: &str, svg: &str) {
    assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"), "{name}");
    assert!(!svg.contains("NaN") && !svg.contains("inf\""), "{name}");
    if let Some(place) = std::env::var_os("NFR_CHARTS") {
        std::fs::write(std::path::Path::new(&place).join(format!("{name}.svg")), svg).unwrap();
    }
}

const MODELS: [&str; 4] =
    ["implicit field, one glyph", "implicit field, all glyphs", "grid fitting", "resizing"];

fn samples() -> Vec<(&'static str, String)> {
    let name = |model: usize| MODELS[model].to_string();
    let series: Vec<_> = (0..4).map(|m| ErrorSeries { name: name(m), values: errors(m, 1144) }).collect();
    let at = |m, side| Summary::of(errors(m, 200).iter().map(|v| v * 20.0 / side as f64)).unwrap();
    let sizes: Vec<_> = (0..3)
        .map(|m| SizeSeries { name: name(m), sizes: (20..=63).map(|s| (s, at(m, s))).collect() })
        .collect();
    let by_glyph: Vec<_> = (0..3)
        .map(|m| GlyphSeries { name: name(m), glyphs: ('a'..='z').zip(errors(m, 26)).collect() })
        .collect();
    let history = |seed: usize, last: f64| {
        let loss = move |i: usize| {
            [i as f64, last * (1.0 + 800.0 / (i as f64 + 5.0)) * (0.8 + 0.4 * noise(i + seed))]
        };
        (0..3000).map(loss).collect()
    };
    let losses = [("training", 1, 2e-4), ("validation", 2, 3e-4)]
        .map(|(n, s, l)| Line { name: n.into(), points: history(s, l) });
    let variants = ["whole model", "without the size as an input", "ReLU instead of sine", "half the width"];
    let variants: Vec<_> = variants
        .iter()
        .enumerate()
        .map(|(m, n)| ErrorSeries { name: n.to_string(), values: errors(m, 300) })
        .collect();
    let methods: Vec<_> = (0..4)
        .map(|m| Line { name: name(m), points: (20..=63).map(|s| [s as f64, at(m, s).mean]).collect() })
        .collect();
    vec![
        ("histogram", error_histogram(&HEADINGS, &series).unwrap()),
        ("by_size", error_by_size(&HEADINGS, &sizes).unwrap()),
        ("by_glyph", error_by_glyph(&HEADINGS, &by_glyph).unwrap()),
        ("ablations", box_plot(&HEADINGS, &variants).unwrap()),
        ("loss", loss_history(&HEADINGS, &losses, &[1000.0, 2000.0]).unwrap()),
        ("lines", lines(&HEADINGS, ["size of the box s (pixels)", "mean squared error"], &methods).unwrap()),
    ]
}

#[test]
fn every_chart_is_one_document_with_its_headings_escaped() {
    for (name, svg) in samples() {
        keep(name, &svg);
        assert!(svg.contains("Errors of &lt;models&gt; &amp; others"), "{name}");
        assert!(svg.contains("small scale: width 64"), "{name}");
    }
}

#[test]
fn every_model_is_in_the_legend_and_every_glyph_under_its_column() {
    let samples = samples();
    let has = |name: &str, text: &str| {
        let (_, svg) = samples.iter().find(|(n, _)| *n == name).unwrap();
        svg.contains(&format!("\n{text}\n"))
    };
    assert!(MODELS.iter().all(|model| has("histogram", model)));
    assert!(('a'..='z').all(|glyph| has("by_glyph", &glyph.to_string())));
    assert!(has("ablations", "ReLU instead of sine"));
}

#[test]
fn charts_without_values_or_with_odd_ones_still_draw() {
    let odd = vec![0.0, f64::NAN, f64::INFINITY];
    let series = |values: &[f64]| vec![ErrorSeries { name: "odd".into(), values: values.to_vec() }];
    let line = Line { name: "odd".into(), points: vec![[0.0, 0.0], [1.0, f64::NAN]] };
    let glyphs = GlyphSeries { name: "odd".into(), glyphs: vec![('&', 0.0), ('<', f64::NAN)] };
    for svg in [
        error_histogram(&HEADINGS, &series(&odd)).unwrap(),
        error_histogram(&HEADINGS, &[]).unwrap(),
        box_plot(&HEADINGS, &series(&odd)).unwrap(),
        box_plot(&HEADINGS, &[]).unwrap(),
        error_by_size(&HEADINGS, &[]).unwrap(),
        error_by_glyph(&HEADINGS, &[glyphs]).unwrap(),
        lines(&HEADINGS, ["x", "y"], &[line]).unwrap(),
        loss_history(&HEADINGS, &[], &[]).unwrap(),
    ] {
        keep("odd", &svg);
    }
}

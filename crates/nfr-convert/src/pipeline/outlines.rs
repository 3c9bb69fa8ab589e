//! Outline models, which are found in closed form. Glyphs that cannot have one get a field, or are left out.

use std::collections::BTreeMap;
use std::sync::Arc;

use read_fonts::FontRef;
use skrifa::font::Font;

use super::glyphs::{GlyphTrainer, Measured, Stages};
use super::kept::{Kept, Messages};
use super::training;
use super::warnings::glyphs_text;
use crate::compose::Decomposition;
use crate::conversion::Stage;
use crate::error::Error;
use crate::input::open::owned;
use crate::options::{Options, Shape};
use crate::outline::{
    EncodedOutlines, FittedOutline, FontGlyph, OutlineSamples, encode, fit, stored_outline,
};
use crate::parallel;
use crate::partial::{Kind, Partial};
use crate::writer::{GlyphModel, OutlineTable, write_outlines};
use nfr::internals::model::compose::{Composed, Part, round_to_grid};
use nfr::internals::model::gridfit::Scale;
use nfr::internals::model::outline::OutlineModel;
use nfr::internals::table::Header;
use nfr::internals::table::outline::{Advances, scale_at};
use nfr::internals::{Glyph, mul_fixed};

/// A table of outline models.
pub(super) struct Learned {
    pub(super) table: Vec<u8>,
    /// The error of each glyph.
    pub(super) measured: BTreeMap<u16, Measured>,
    /// The selected glyphs that have no model.
    pub(super) left_out: Vec<u16>,
}

/// Finds the models, measures them and writes the table.
pub(super) fn learn(
    stages: Stages<'_>,
    font: &FontRef<'_>,
    partial: Option<&Partial>,
    header: &Header,
    glyphs: &Decomposition,
) -> Result<Learned, Error> {
    let copy = owned(font)?;
    let kept = Kept(partial);
    plan(&stages, kept, glyphs);
    let found = find(&stages, &copy, glyphs, kept)?;
    let mut measured = measure(&stages, &found, kept)?;
    let selected = |gid: &u16| stages.options.gids.binary_search(gid).is_ok();
    let unfit: Vec<u16> = found.unfit.into_iter().filter(selected).collect();
    let has_fields = trains_fields(stages.options);
    warn_of_unfit(&stages, &unfit, has_fields);
    let (fields, left_out) = if has_fields { (unfit, Vec::new()) } else { (Vec::new(), unfit) };
    let trained = GlyphTrainer { stages, partial }.train_all(&fields)?;
    measured.extend(trained.iter().map(|t| (t.gid, t.measured.clone())));
    let fields: Vec<GlyphModel> =
        trained.into_iter().map(|t| GlyphModel { gid: t.gid, weights: t.weights }).collect();
    let in_font = |gid: u16| FontGlyph::read(font, &copy, gid);
    let (gids, encoded, composed) = (&found.gids, &found.encoded, &found.composed);
    let table = OutlineTable { gids, encoded, composed, fields: &fields, scale: stages.scale };
    Ok(Learned { table: write_outlines(header, &table, in_font)?, measured, left_out })
}

/// The outline models of a font.
struct Found {
    /// The glyphs that have a model of their own, ascending.
    gids: Vec<u16>,
    models: BTreeMap<u16, Arc<OutlineModel>>,
    encoded: EncodedOutlines,
    composed: Vec<(Composed, Advances)>,
    /// The glyphs that cannot have an outline model, ascending: hinting changes their contours, or they are not drawn point by
    /// point.
    unfit: Vec<u16>,
}

/// Tells how much work there is.
fn plan(stages: &Stages<'_>, kept: Kept<'_>, glyphs: &Decomposition) {
    let modelled = || glyphs.modelled.iter().copied();
    let composed = || glyphs.composed.iter().map(|glyph| glyph.gid);
    stages.progress.work(&[
        (Stage::Fitting, kept.lacks(Kind::Fit, modelled())),
        (Stage::Encoding, kept.lacks(Kind::Encoding, modelled())),
        (Stage::Measuring, kept.lacks(Kind::Measurement, modelled().chain(composed()))),
    ]);
}

/// A glyph's points with its advance width, and its tracks.
type FittedGlyph = ((OutlineSamples, u16), FittedOutline);

/// A glyph's points and its tracks; none if it cannot have any. The hinted positions are left out if the glyph is encoded already.
fn fitted(stages: &Stages<'_>, font: &Font, gid: u16, kept: Kept<'_>) -> Result<Option<FittedGlyph>, Error> {
    let outline = match kept.fitted(gid) {
        Some(None) => return Ok(None),
        Some(Some(outline)) if kept.encoded(gid).is_some() => {
            let (points, advance) = stored_outline(font, gid)?;
            return Ok(Some(((OutlineSamples::of_points(points, stages.scale), advance), outline)));
        }
        Some(Some(outline)) => Some(outline),
        None => None,
    };
    let samples = outline_samples(stages, font, gid)?;
    if let Some(outline) = outline {
        return Ok(samples.map(|samples| (samples, outline)));
    }
    let units_per_em = stages.scale.units_per_em();
    let fit = samples.map(|samples| {
        let outline = fit(&samples.0, units_per_em, stages.options.fidelity, stages.options.fidelity);
        (samples, outline)
    });
    kept.keep_fitted(gid, fit.as_ref().map(|(_, outline)| outline))?;
    stages.progress.worked(Stage::Fitting);
    Ok(fit)
}

fn find(stages: &Stages<'_>, font: &Font, glyphs: &Decomposition, kept: Kept<'_>) -> Result<Found, Error> {
    let (scale, options) = (stages.scale, stages.options);
    let fitted = parallel::map(&glyphs.modelled, options.jobs, |gid| fitted(stages, font, *gid, kept))?;
    let (fit, mut unfit): (Vec<_>, Vec<_>) =
        glyphs.modelled.iter().copied().zip(fitted).partition(|(_, fitted)| fitted.is_some());
    let gids: Vec<u16> = fit.iter().map(|(gid, _)| *gid).collect();
    let (samples, mut outlines): (Vec<_>, Vec<_>) = fit.into_iter().filter_map(|(_, fitted)| fitted).unzip();
    let messages = Messages { kept, gids: &gids, progress: stages.progress };
    let encoded = encode(&samples, &mut outlines, scale, options.fidelity, options.jobs, &messages)?;
    let mut models = BTreeMap::new();
    for ((gid, (samples, _)), FittedOutline { weights, .. }) in gids.iter().zip(samples).zip(outlines) {
        models.insert(*gid, Arc::new(OutlineModel::new(samples.points, weights, scale, 0..scale.sizes())?));
    }
    let mut composed = Vec::new();
    let all_advances =
        parallel::map(&glyphs.composed, options.jobs, |glyph| advances(stages, font, glyph, &models))?;
    for (glyph, advances) in glyphs.composed.iter().zip(all_advances) {
        match advances {
            Some(advances) => composed.push((from_scaled_offsets(glyph, scale), advances)),
            None => unfit.push((glyph.gid, None)),
        }
    }
    let mut unfit: Vec<u16> = unfit.into_iter().map(|(gid, _)| gid).collect();
    unfit.sort_unstable();
    Ok(Found { gids, models, encoded, composed, unfit })
}

/// Draws all glyphs that have outline models, and compares them with the teacher.
fn measure(stages: &Stages<'_>, found: &Found, kept: Kept<'_>) -> Result<BTreeMap<u16, Measured>, Error> {
    let own = found.models.iter().map(|(gid, model)| Ok((*gid, vec![(model.clone(), Part::default())])));
    let placed = found.composed.iter().map(|(glyph, _)| {
        let parts = glyph.parts.iter().map(|part| {
            let model = found.models.get(&part.gid).ok_or(Error::MissingGlyph(part.gid))?;
            Ok((model.clone(), part.clone()))
        });
        Ok((glyph.gid, parts.collect::<Result<Vec<_>, Error>>()?))
    });
    let drawn = own.chain(placed).collect::<Result<Vec<_>, Error>>()?;
    let measured = parallel::map(&drawn, stages.options.jobs, |(gid, parts)| {
        if let Some(measured) = kept.measured(*gid) {
            stages.progress.glyph_done(*gid, measured.learnt.figures().mae);
            return Ok((*gid, measured));
        }
        let measured = stages.measure(&stages.samples(*gid)?, &Glyph::of_outlines(parts.clone()))?;
        kept.keep_measured(*gid, &measured)?;
        stages.progress.worked(Stage::Measuring);
        Ok((*gid, measured))
    })?;
    Ok(measured.into_iter().collect())
}

/// Whether glyphs that cannot have an outline model get fields.
fn trains_fields(options: &Options) -> bool {
    options.shape == Shape::Auto && training::is_possible(options)
}

/// Says which glyphs cannot have an outline model, and what they have instead.
fn warn_of_unfit(stages: &Stages<'_>, unfit: &[u16], has_fields: bool) {
    if unfit.is_empty() {
        return;
    }
    let instead = if has_fields {
        "trained fields draw them".to_owned()
    } else {
        format!("they are left without a model; {}", training::ADVICE)
    };
    stages.progress.warn(&format!(
        "hinting changes the contours of {}, not only the positions of points; {instead}",
        glyphs_text(unfit)
    ));
}

/// The hinted advance widths of a composed glyph; none if it cannot be composed of outline models.
fn advances(
    stages: &Stages<'_>,
    font: &Font,
    glyph: &Composed,
    models: &BTreeMap<u16, Arc<OutlineModel>>,
) -> Result<Option<Advances>, Error> {
    if !glyph.parts.iter().all(|part| models.contains_key(&part.gid)) {
        return Ok(None);
    }
    let Some((samples, _)) = outline_samples(stages, font, glyph.gid)? else { return Ok(None) };
    let of_first =
        glyph.parts.first().and_then(|part| models.get(&part.gid)).map(|model| &model.weights.advances);
    Ok(Some(if samples.advances.iter().all(|advance| *advance == 0) {
        Advances::Rounded
    } else if of_first == Some(&samples.advances) {
        Advances::OfFirstPart
    } else {
        Advances::Own(samples.advances)
    }))
}

/// A glyph's points with their hinted positions, and its advance width in font units; none if it cannot have an outline model.
fn outline_samples(
    stages: &Stages<'_>,
    font: &Font,
    gid: u16,
) -> Result<Option<(OutlineSamples, u16)>, Error> {
    let (points, advance) = stored_outline(font, gid)?;
    let samples = OutlineSamples::new(&stages.samples(gid)?, points, advance, stages.scale);
    Ok(samples.map(|samples| (samples, advance)))
}

/// The same parts with grid offsets that count from the offsets as FreeType scales and rounds them.
fn from_scaled_offsets(glyph: &Composed, scale: Scale) -> Composed {
    let units = scale.units_per_em();
    let mut glyph = glyph.clone();
    for part in &mut glyph.parts {
        for (offset, grid_offsets) in part.offset.iter().zip(&mut part.grid_offsets) {
            for (size, pixels) in grid_offsets.iter_mut().enumerate() {
                let scaled = mul_fixed((*offset).into(), scale_at(scale, size));
                let rounded = (scaled + 32) >> 6;
                *pixels += (round_to_grid(*offset, scale.ppem_of(size), units) - rounded) as i8;
            }
        }
    }
    glyph
}

//! Outline models, which are found in closed form.

use std::collections::BTreeMap;
use std::sync::Arc;

use read_fonts::{FontRef, TableProvider};

use super::glyphs::Stages;
use crate::compare::metrics::Sums;
use crate::compose::Decomposition;
use crate::error::Error;
use crate::input::open::owned;
use crate::outline::{FittedOutline, OutlineSamples, encode, fit};
use crate::parallel;
use crate::writer::{OutlineTable, write_outlines};
use nfr::internals::model::compose::{Composed, Part, round_to_grid};
use nfr::internals::model::gridfit::Scale;
use nfr::internals::model::outline::{OutlineModel, OutlinePoints};
use nfr::internals::table::Header;
use nfr::internals::table::outline::{Advances, scale_at};
use nfr::internals::{Glyph, components, mul_fixed};

/// A glyph's outline, and its advance width in font units.
type Known = (OutlinePoints, u16);

/// The table, and the error of each glyph.
pub(super) fn table(
    stages: &Stages<'_>,
    font: &FontRef<'_>,
    header: &Header,
    glyphs: &Decomposition,
) -> Result<(Vec<u8>, BTreeMap<u16, Sums>), Error> {
    let (scale, options) = (stages.scale, stages.options);
    let known = glyphs.modelled.iter().map(|gid| known(font, *gid)).collect::<Result<Vec<Known>, _>>()?;
    let work: Vec<(&u16, &Known)> = glyphs.modelled.iter().zip(&known).collect();
    let fitted = parallel::map(&work, options.jobs, |(gid, (points, advance))| {
        let samples = stages.samples(**gid)?;
        let samples = OutlineSamples::new(&samples, points.clone(), *advance, scale.units_per_em())?;
        let outline = fit(&samples, scale.units_per_em(), options.fidelity);
        Ok(((samples, *advance), outline))
    })?;
    let (samples, mut outlines): (Vec<_>, Vec<_>) = fitted.into_iter().unzip();
    let encoded = encode(&samples, &mut outlines, scale, options.fidelity, options.jobs)?;
    let mut models = BTreeMap::new();
    for ((gid, (points, _)), FittedOutline { weights, .. }) in glyphs.modelled.iter().zip(known).zip(outlines)
    {
        models.insert(*gid, Arc::new(OutlineModel::new(points, weights, scale, scale.sizes())?));
    }
    let composed: Vec<Composed> =
        glyphs.composed.iter().map(|glyph| from_scaled_offsets(glyph, scale)).collect();
    let own = models.iter().map(|(gid, model)| (*gid, vec![(model.clone(), Part::default())]));
    let placed = composed.iter().map(|glyph| {
        let parts = glyph.parts.iter().map(|part| {
            let model = models.get(&part.gid).ok_or(Error::MissingGlyph(part.gid))?;
            Ok((model.clone(), part.clone()))
        });
        Ok((glyph.gid, parts.collect::<Result<Vec<_>, Error>>()?))
    });
    let drawn = own.map(Ok).chain(placed).collect::<Result<Vec<_>, Error>>()?;
    let measured = parallel::map(&drawn, options.jobs, |(gid, parts)| {
        Ok((*gid, stages.measure(&stages.samples(*gid)?, &Glyph::of_outlines(parts.clone()))?))
    })?;
    let composed: Vec<(Composed, Advances)> = composed
        .into_iter()
        .map(|glyph| {
            let advances = advances(stages, font, &glyph, &models)?;
            Ok((glyph, advances))
        })
        .collect::<Result<_, Error>>()?;
    let (loca, glyf) = (font.loca(None), font.glyf());
    let known_parts = |gid: u16| components(loca.as_ref().ok()?, glyf.as_ref().ok()?, gid.into());
    let table = OutlineTable { gids: &glyphs.modelled, encoded: &encoded, composed: &composed };
    Ok((write_outlines(header, &table, known_parts)?, measured.into_iter().collect()))
}

/// The hinted advance widths of a composed glyph.
fn advances(
    stages: &Stages<'_>,
    font: &FontRef<'_>,
    glyph: &Composed,
    models: &BTreeMap<u16, Arc<OutlineModel>>,
) -> Result<Advances, Error> {
    let (points, advance) = known(font, glyph.gid)?;
    let samples =
        OutlineSamples::new(&stages.samples(glyph.gid)?, points, advance, stages.scale.units_per_em())?;
    let of_first =
        glyph.parts.first().and_then(|part| models.get(&part.gid)).map(|model| &model.weights.advances);
    Ok(if samples.advances.iter().all(|advance| *advance == 0) {
        Advances::Rounded
    } else if of_first == Some(&samples.advances) {
        Advances::OfFirstPart
    } else {
        Advances::Own(samples.advances)
    })
}

fn known(font: &FontRef<'_>, gid: u16) -> Result<Known, Error> {
    let mut points = OutlinePoints::default();
    let owned = owned(font)?;
    let outline = owned.outline_glyphs().get(gid.into());
    let unreadable = || Error::from(nfr::Error::MalformedOutline(gid.into()));
    let outline = outline.ok_or_else(unreadable)?;
    outline.draw_unscaled(skrifa::DrawMemory::Scratch, &mut points).map_err(|_| unreadable())?;
    if points.is_unfit {
        return Err(unreadable());
    }
    let advance = owned.glyph_metrics().h_advance(gid.into());
    Ok((points, advance.clamp(0.0, f32::from(u16::MAX)) as u16))
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

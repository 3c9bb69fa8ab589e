//! Which glyphs need no model of their own: accented letters and shapes that the font has twice.
//!
//! A glyph is put together from others if that is what its hints do: at every size each of its parts must be
//! another glyph's hinted outline, moved, and the parts' coverage must add up to the glyph's.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::rc::Rc;

use read_fonts::tables::glyf::{CompositeGlyphFlags, Glyph};
use read_fonts::{FontRef, TableProvider};

use super::predict::Predictor;
use super::teacher::{Teacher, TeacherAt};
use crate::compare::metrics::Sums;
use crate::error::Error;
use crate::outline::Outline;
use nfr::internals::model::compose::{Composed, Part, snapped, unsnapped};
use nfr::internals::model::gridfit::Scale;
use nfr::internals::table::{MAX_PARTS, MAX_SNAP_BYTES};
use nfr::internals::union;
use nfr::{Bitmap, Placement};

/// Hinted points may lie this far (pixels) from the part's, moved: a step of what models store.
const MAX_POINT_ERROR: f32 = 1.0 / 32.0;
/// The parts' exact bitmaps may add up to something this far from the glyph's (mae over all sizes): a fraction of
/// what models are off by themselves. Parts that overlap a lot are.
const MAX_SUM_ERROR: f64 = 0.0005;
/// So many parts of a glyph may need a model that nobody selected and no other glyph uses: a part is simpler than
/// the whole, but two are not.
const MAX_OWN_PARTS: usize = 1;
/// Components within components, at most. `maxp` allows 16; fonts have two or three.
const MAX_DEPTH: usize = 16;

/// How a selection is converted.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(super) struct Plan {
    /// The glyphs that are trained, ascending: selected ones, and parts of several selected ones.
    pub(super) models: Vec<u16>,
    /// The glyphs that are put together from those, ascending.
    pub(super) composed: Vec<Composed>,
}

impl Plan {
    /// A model for each glyph.
    pub(super) fn of_models(gids: &[u16]) -> Self {
        Self { models: gids.to_vec(), composed: Vec::new() }
    }

    /// Finds the glyphs among `gids` that others make up, and their places at the `sizes` that the teacher shows.
    ///
    /// # Errors
    ///
    /// As the teacher's.
    pub(super) fn find(
        font: &FontRef<'_>,
        teacher: &Teacher,
        sizes: &[TeacherAt],
        scale: Scale,
        gids: &[u16],
    ) -> Result<Self, Error> {
        let ppem = sizes.iter().map(|at| at.ppem().into()).collect();
        let mut fitter =
            Fitter { teacher, sizes, ppem, scale, shapes: HashMap::new(), snaps: BTreeSet::new() };
        let mut twins = Twins::default();
        let mut fitting: BTreeMap<u16, Vec<Part>> = BTreeMap::new();
        let mut composites = Vec::new();
        for &gid in gids {
            match leaves(font, gid) {
                Some(leaves) if leaves == [gid] => {
                    if let Some(part) = twins.find(gid, &mut fitter)? {
                        fitting.insert(gid, vec![part]);
                    }
                }
                Some(leaves) if !leaves.is_empty() => composites.push((gid, leaves)),
                _ => {}
            }
        }
        for (gid, leaves) in composites {
            let leaves: Vec<u16> = leaves.iter().map(|leaf| twins.original(*leaf)).collect();
            let whole = fitter.draw(gid)?;
            if let Some(parts) = fitter.fit(&whole, &leaves)? {
                fitting.insert(gid, parts);
            }
        }
        Ok(Self::of_parts(gids, fitting))
    }

    /// Gives parts that stand on whole pixels their places at all sizes of `scale`.
    pub(super) fn complete(&mut self, predictor: &Predictor, scale: Scale) {
        for part in self.composed.iter_mut().flat_map(|glyph| &mut glyph.parts) {
            for (axis, (offset, snaps)) in part.offset.iter().zip(&mut part.snaps).enumerate() {
                if !snaps.is_empty() {
                    let near = |ppem: usize| f64::from(snapped(*offset, ppem, scale.units_per_em()));
                    let known = predictor.known().iter().zip(&*snaps);
                    let places: Vec<f64> =
                        known.map(|(ppem, snap)| near((*ppem).into()) + f64::from(*snap)).collect();
                    let em = f64::from(*offset) / f64::from(scale.units_per_em());
                    let places = predictor.places(axis, em, &places);
                    // Casting clamps, and so far nothing snaps.
                    let snap = |(size, place): (usize, &f64)| (place - near(scale.ppem_of(size))) as i8;
                    *snaps = places.iter().enumerate().map(snap).collect();
                }
            }
        }
    }

    /// Leaves out what would need more models than it saves.
    fn of_parts(gids: &[u16], mut fitting: BTreeMap<u16, Vec<Part>>) -> Self {
        let selected: BTreeSet<u16> = gids.iter().copied().collect();
        let parts_of = |parts: &[Part]| parts.iter().map(|part| part.gid).collect::<BTreeSet<u16>>();
        let mut users: HashMap<u16, BTreeSet<u16>> = HashMap::new();
        for (gid, parts) in &fitting {
            for part in parts_of(parts) {
                users.entry(part).or_default().insert(*gid);
            }
        }
        // What falls away takes a user from its parts, so that the last user of one is looked at again.
        let mut open: Vec<u16> = fitting.keys().copied().collect();
        while let Some(gid) = open.pop() {
            let Some(parts) = fitting.get(&gid).map(|parts| parts_of(parts)) else { continue };
            let own = parts.iter().filter(|part| !selected.contains(part) && users[part].len() == 1);
            if own.count() <= MAX_OWN_PARTS {
                continue;
            }
            fitting.remove(&gid);
            for part in parts {
                let users = users.entry(part).or_default();
                users.remove(&gid);
                if users.len() == 1 {
                    open.extend(users.iter());
                }
            }
        }
        let parts = users.into_iter().filter(|(_, users)| !users.is_empty()).map(|(part, _)| part);
        let models: BTreeSet<u16> =
            gids.iter().copied().filter(|gid| !fitting.contains_key(gid)).chain(parts).collect();
        let composed = fitting.into_iter().map(|(gid, parts)| Composed { gid, parts });
        Self { models: models.into_iter().collect(), composed: composed.collect() }
    }
}

/// The simple glyphs that a glyph consists of, in the order of its points. None if it has too many, or scales
/// them, or cannot be read.
fn leaves(font: &FontRef<'_>, gid: u16) -> Option<Vec<u16>> {
    let mut found = Vec::new();
    collect_leaves(font, gid, MAX_DEPTH, &mut found)?;
    Some(found)
}

fn collect_leaves(font: &FontRef<'_>, gid: u16, depth: usize, found: &mut Vec<u16>) -> Option<()> {
    let scaled = CompositeGlyphFlags::WE_HAVE_A_SCALE
        | CompositeGlyphFlags::WE_HAVE_AN_X_AND_Y_SCALE
        | CompositeGlyphFlags::WE_HAVE_A_TWO_BY_TWO;
    match font.loca(None).ok()?.get_glyf(gid.into(), &font.glyf().ok()?).ok()? {
        Some(Glyph::Simple(_)) if found.len() < MAX_PARTS => found.push(gid),
        Some(Glyph::Simple(_)) => return None,
        Some(Glyph::Composite(composite)) => {
            for component in composite.components() {
                if component.flags.intersects(scaled) {
                    return None;
                }
                let gid = u16::try_from(component.glyph.to_u32()).ok()?;
                collect_leaves(font, gid, depth.checked_sub(1)?, found)?;
            }
        }
        None => {}
    }
    Some(())
}

/// Simple glyphs of the same shape.
#[derive(Default)]
struct Twins {
    by_shape: HashMap<u64, Vec<u16>>,
    originals: HashMap<u16, u16>,
}

impl Twins {
    /// The glyph before this one that it equals, as its only part.
    fn find(&mut self, gid: u16, fitter: &mut Fitter<'_>) -> Result<Option<Part>, Error> {
        let outline = fitter.teacher.unhinted_em(gid)?;
        let Some(first) = outline.points.first() else { return Ok(None) };
        let mut hasher = DefaultHasher::new();
        let units = f32::from(fitter.scale.units_per_em());
        let rounded = |point: &[f32; 2], axis: usize| ((point[axis] - first[axis]) * units).round() as i32;
        outline.points.iter().for_each(|p| [rounded(p, 0), rounded(p, 1)].hash(&mut hasher));
        let bucket = self.by_shape.entry(hasher.finish()).or_default();
        if bucket.is_empty() {
            bucket.push(gid);
            return Ok(None);
        }
        let whole = fitter.draw(gid)?;
        for original in bucket.iter() {
            if let Some(parts) = fitter.fit(&whole, &[*original])? {
                self.originals.insert(gid, *original);
                return Ok(parts.into_iter().next());
            }
        }
        bucket.push(gid);
        Ok(None)
    }

    /// The glyph whose model stands for this one's.
    fn original(&self, gid: u16) -> u16 {
        self.originals.get(&gid).copied().unwrap_or(gid)
    }
}

/// A glyph's outlines.
struct Shape {
    plain: Outline,
    hinted: Vec<Outline>,
}

/// Finds out whether glyphs are made of others.
struct Fitter<'t> {
    teacher: &'t Teacher,
    sizes: &'t [TeacherAt],
    /// Those sizes in pixels per em.
    ppem: Vec<usize>,
    /// The sizes that the table will have.
    scale: Scale,
    /// Of the glyphs that have been tried as parts.
    shapes: HashMap<u16, Rc<Shape>>,
    /// The places that parts have been found at.
    snaps: BTreeSet<Vec<i8>>,
}

impl Fitter<'_> {
    fn draw(&self, gid: u16) -> Result<Shape, Error> {
        let hinted = self.sizes.iter().map(|at| at.hinted_or_complaint(gid).map(|(outline, _)| outline));
        Ok(Shape { plain: self.teacher.unhinted_em(gid)?, hinted: hinted.collect::<Result<_, _>>()? })
    }

    fn shape(&mut self, gid: u16) -> Result<Rc<Shape>, Error> {
        if let Some(shape) = self.shapes.get(&gid) {
            return Ok(shape.clone());
        }
        let shape = Rc::new(self.draw(gid)?);
        self.shapes.insert(gid, shape.clone());
        Ok(shape)
    }

    /// The parts of a glyph that consists of `leaves`, if their models can stand for it.
    fn fit(&mut self, whole: &Shape, leaves: &[u16]) -> Result<Option<Vec<Part>>, Error> {
        let shapes = leaves.iter().map(|leaf| self.shape(*leaf)).collect::<Result<Vec<_>, _>>()?;
        let mut parts = Vec::with_capacity(leaves.len());
        let mut at = 0;
        for (leaf, shape) in leaves.iter().zip(&shapes) {
            let Some(part) = fit_part(whole, at, *leaf, shape, &self.ppem, self.scale.units_per_em()) else {
                return Ok(None);
            };
            parts.push(part);
            at += shape.plain.points.len();
        }
        if at != whole.plain.points.len() || self.sum_error(whole, &shapes, &parts)? > MAX_SUM_ERROR {
            return Ok(None);
        }
        let lists = parts.iter().flat_map(|part| &part.snaps).filter(|snaps| !snaps.is_empty());
        let new: BTreeSet<&Vec<i8>> = lists.filter(|snaps| !self.snaps.contains(*snaps)).collect();
        // What the table has no room for is trained.
        let count = self.snaps.len() + new.len();
        if count >= usize::from(u16::MAX) || count * self.scale.sizes() > MAX_SNAP_BYTES {
            return Ok(None);
        }
        self.snaps.extend(new.into_iter().cloned());
        Ok(Some(parts))
    }

    /// How far the sum of the parts' exact bitmaps is from the glyph's (mae).
    fn sum_error(&self, whole: &Shape, shapes: &[Rc<Shape>], parts: &[Part]) -> Result<f64, Error> {
        let mut sums = Sums::default();
        for (size, (hinted, ppem)) in whole.hinted.iter().zip(&self.ppem).enumerate() {
            let moved = shapes.iter().zip(parts).map(|(shape, part)| {
                let mut outline = shape.hinted[size].clone();
                outline.translate(place(part, size, *ppem, self.scale.units_per_em()));
                outline.rasterize()
            });
            sums.add(&hinted.rasterize()?, &sum(&moved.collect::<Result<Vec<Bitmap>, Error>>()?));
        }
        Ok(sums.mae())
    }
}

/// The bitmap that parts add up to.
fn sum(parts: &[Bitmap]) -> Bitmap {
    let placement = parts.iter().fold(Placement::default(), |whole, part| union(whole, part.placement));
    let mut pixels = vec![0; placement.area()];
    parts.iter().for_each(|part| add(placement, &mut pixels, part.placement, &part.pixels));
    Bitmap { placement, pixels }
}

/// Adds a part's coverage to a bitmap that has room for it. Parts that only touch cover a pixel together, and
/// where they overlap the ink is full anyway.
fn add(whole: Placement, pixels: &mut [u8], place: Placement, layer: &[u8]) {
    if place.area() == 0 {
        return;
    }
    let (row, column) = ((whole.top - place.top) as usize, (place.left - whole.left) as usize);
    let (width, stride) = (place.width as usize, whole.width as usize);
    let rows = pixels.chunks_exact_mut(stride).skip(row);
    for (pixels, layer) in rows.zip(layer.chunks_exact(width)) {
        for (pixel, more) in pixels[column..column + width].iter_mut().zip(layer) {
            *pixel = pixel.saturating_add(*more);
        }
    }
}

/// Where a part stands (pixels) at a size of which it has a snap, by its index.
fn place(part: &Part, size: usize, ppem: usize, units_per_em: u16) -> [f32; 2] {
    [0, 1].map(|axis| {
        let offset = part.offset[axis];
        match part.snaps[axis].get(size) {
            Some(snap) => (snapped(offset, ppem, units_per_em) + i32::from(*snap)) as f32,
            None => unsnapped(f32::from(offset) / f32::from(units_per_em), ppem as f32),
        }
    })
}

/// Where `shape` stands in a glyph, whose points from `at` on are to be its own. Both are hinted at the sizes `ppem`.
fn fit_part(
    whole: &Shape,
    at: usize,
    leaf: u16,
    shape: &Shape,
    ppem: &[usize],
    units_per_em: u16,
) -> Option<Part> {
    let count = shape.plain.points.len();
    let units = f32::from(units_per_em);
    let mut part = Part { gid: leaf, ..Part::default() };
    for axis in 0..2 {
        // Half the spread of the differences, and their middle.
        let difference = |whole: &Outline, shape: &Outline| {
            let pairs = whole.points.get(at..at + count)?.iter().zip(shape.points.get(..count)?);
            let (low, high) = pairs
                .map(|(whole, part)| whole[axis] - part[axis])
                .fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), d| (low.min(d), high.max(d)));
            Some((0.5 * (high - low), 0.5 * (high + low)))
        };
        let (spread, offset) = difference(&whole.plain, &shape.plain)?;
        let offset = offset * units;
        if spread * units > 0.5 || offset.abs() > f32::from(i16::MAX) {
            return None;
        }
        part.offset[axis] = offset.round() as i16;
        let mut places = Vec::with_capacity(shape.hinted.len());
        for (whole, shape) in whole.hinted.iter().zip(&shape.hinted) {
            let (spread, place) = difference(whole, shape)?;
            if spread > MAX_POINT_ERROR {
                return None;
            }
            places.push(place);
        }
        part.snaps[axis] = fit_places(&places, part.offset[axis], ppem, units_per_em)?;
    }
    Some(part)
}

/// Says how the places of a part (pixels, at the sizes `ppem`) come from its offset: by nothing, or by snapping.
fn fit_places(places: &[f32], offset: i16, ppem: &[usize], units_per_em: u16) -> Option<Vec<i8>> {
    let em = f32::from(offset) / f32::from(units_per_em);
    let mut placed = places.iter().zip(ppem);
    if placed.all(|(place, ppem)| (place - em * *ppem as f32).abs() <= MAX_POINT_ERROR) {
        return Some(Vec::new());
    }
    let snap = |(place, ppem): (&f32, &usize)| {
        let pixel = place.round();
        let near = snapped(offset, *ppem, units_per_em);
        let off = i8::try_from(pixel as i32 - near).ok()?;
        ((place - pixel).abs() <= MAX_POINT_ERROR).then_some(off)
    };
    places.iter().zip(ppem).map(snap).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plan(gids: &[u16], fitting: &[(u16, &[u16])]) -> (Vec<u16>, Vec<u16>) {
        let part = |gid: &u16| Part { gid: *gid, ..Part::default() };
        let fitting = fitting.iter().map(|(gid, parts)| (*gid, parts.iter().map(part).collect())).collect();
        let plan = Plan::of_parts(gids, fitting);
        (plan.models, plan.composed.into_iter().map(|glyph| glyph.gid).collect())
    }

    #[test]
    fn parts_that_are_selected_are_used() {
        assert_eq!(plan(&[1, 2, 5], &[(5, &[1, 2])]), (vec![1, 2], vec![5]));
    }

    #[test]
    fn a_part_that_is_not_selected_gets_a_model_if_that_saves_one() {
        // One more for one less.
        assert_eq!(plan(&[1, 5], &[(5, &[1, 2])]), (vec![1, 2], vec![5]));
        // Two more for one less.
        assert_eq!(plan(&[5], &[(5, &[1, 2])]), (vec![5], vec![]));
        // Three more for two less, but shared.
        assert_eq!(plan(&[5, 6], &[(5, &[1, 2]), (6, &[1, 3])]), (vec![1, 2, 3], vec![5, 6]));
    }

    #[test]
    fn a_part_that_is_used_twice_by_one_glyph_is_used_by_one() {
        assert_eq!(plan(&[5], &[(5, &[1, 1])]), (vec![1], vec![5]));
    }

    #[test]
    fn what_falls_away_takes_what_leans_on_it_along() {
        // 7 would need two parts of its own, and then 2 is used by 6 alone.
        let fitting: &[(u16, &[u16])] = &[(6, &[1, 2]), (7, &[2, 3, 4])];
        assert_eq!(plan(&[6, 7], fitting), (vec![6, 7], vec![]));
    }

    #[test]
    fn a_place_that_is_neither_plain_nor_a_whole_pixel_does_not_fit() {
        // Plain: 0.123 em.
        let fit = |places: &[f32]| fit_places(places, 123, &[10, 11, 12], 1000);
        assert_eq!(fit(&[1.23, 1.353, 1.476]), Some(vec![]));
        assert_eq!(fit(&[1.0, 2.0, 1.0]), Some(vec![0, 1, 0]));
        assert_eq!(fit(&[1.0, 1.5, 1.0]), None);
        assert_eq!(fit(&[1.0, 200.0, 1.0]), None);
    }

    #[test]
    fn coverage_adds_up_to_full_and_no_further() {
        let part = |left: i32, top: i32, pixels: [u8; 4]| Bitmap {
            placement: Placement { left, top, width: 2, height: 2 },
            pixels: pixels.to_vec(),
        };
        let whole = sum(&[part(-1, 2, [10, 200, 30, 40]), part(0, 3, [1, 2, 100, 3])]);
        assert_eq!(whole.placement, Placement { left: -1, top: 3, width: 3, height: 3 });
        assert_eq!(whole.pixels, [0, 1, 2, 10, 255, 3, 30, 40, 0]);
    }
}

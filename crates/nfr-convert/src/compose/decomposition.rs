//! The split of the selected glyphs into those with models and those composed of them.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use read_fonts::FontRef;

use super::components::simple_components;
use super::duplicates::Duplicates;
use super::matcher::PartMatcher;
use crate::error::Error;
use crate::predict::Predictor;
use crate::teacher::{Teacher, TeacherAt};
use nfr::internals::model::compose::{Composed, Part, round_to_grid};
use nfr::internals::model::gridfit::Scale;

/// The most parts of a composed glyph that need a model, although they are not selected and no other glyph uses them. One
/// part is simpler than the whole glyph; two are not.
const MAX_UNSHARED_PARTS: usize = 1;

/// Which glyphs have models and which are composed of them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub(crate) struct Decomposition {
    /// The glyphs with models, ascending: selected ones, and parts of several selected ones.
    pub(crate) modelled: Vec<u16>,
    /// The glyphs that are composed of those, ascending.
    pub(crate) composed: Vec<Composed>,
}

impl Decomposition {
    /// A model for each glyph.
    pub(crate) fn without_composition(gids: &[u16]) -> Self {
        Self { modelled: gids.to_vec(), composed: Vec::new() }
    }

    /// Finds the glyphs among `gids` that others compose, and the offsets of their parts at the teacher's `sizes`. With
    /// `exact`, every hinted point of a part has to be that of the whole glyph.
    pub(crate) fn find(
        font: &FontRef<'_>,
        teacher: &Teacher,
        sizes: &[TeacherAt],
        scale: Scale,
        gids: &[u16],
        exact: bool,
    ) -> Result<Self, Error> {
        let mut matcher = PartMatcher::new(teacher, sizes, scale, exact);
        let mut duplicates = Duplicates::default();
        let mut matched: BTreeMap<u16, Vec<Part>> = BTreeMap::new();
        let mut composites = Vec::new();
        for &gid in gids {
            match simple_components(font, gid) {
                Some(components) if components == [gid] => {
                    if let Some(part) = duplicates.find(gid, &mut matcher)? {
                        matched.insert(gid, vec![part]);
                    }
                }
                Some(components) if !components.is_empty() => composites.push((gid, components)),
                _ => {}
            }
        }
        for (gid, components) in composites {
            let components: Vec<u16> = components.iter().map(|gid| duplicates.original(*gid)).collect();
            let whole = matcher.draw(gid)?;
            if let Some(parts) = matcher.match_parts(&whole, &components)? {
                matched.insert(gid, parts);
            }
        }
        Ok(Self::of_parts(gids, matched))
    }

    /// Predicts the grid-fitted offsets of parts at the sizes of `scale` that the teacher does not draw.
    pub(crate) fn predict_part_offsets(&mut self, predictor: &Predictor, scale: Scale) {
        for part in self.composed.iter_mut().flat_map(|glyph| &mut glyph.parts) {
            for (axis, (offset, grid_offsets)) in part.offset.iter().zip(&mut part.grid_offsets).enumerate() {
                if !grid_offsets.is_empty() {
                    let rounded = |ppem: usize| f64::from(round_to_grid(*offset, ppem, scale.units_per_em()));
                    let known = predictor.known().iter().zip(&*grid_offsets);
                    let known: Vec<f64> =
                        known.map(|(ppem, snap)| rounded((*ppem).into()) + f64::from(*snap)).collect();
                    let em = f64::from(*offset) / f64::from(scale.units_per_em());
                    let all = predictor.part_offsets(axis, em, &known);
                    // The cast saturates, but no predicted offset is that far from the unhinted one.
                    let snap = |(size, at): (usize, &f64)| (at - rounded(scale.ppem_of(size))) as i8;
                    *grid_offsets = all.iter().enumerate().map(snap).collect();
                }
            }
        }
    }

    /// Composes those glyphs of `matched` that do not need more models for parts than they save.
    fn of_parts(gids: &[u16], mut matched: BTreeMap<u16, Vec<Part>>) -> Self {
        let selected: BTreeSet<u16> = gids.iter().copied().collect();
        let parts_of = |parts: &[Part]| parts.iter().map(|part| part.gid).collect::<BTreeSet<u16>>();
        let mut users: HashMap<u16, BTreeSet<u16>> = HashMap::new();
        for (gid, parts) in &matched {
            for part in parts_of(parts) {
                users.entry(part).or_default().insert(*gid);
            }
        }
        // A glyph that is not composed after all is no user of its parts any more, so that their last user is checked again.
        let mut open: Vec<u16> = matched.keys().copied().collect();
        while let Some(gid) = open.pop() {
            let Some(parts) = matched.get(&gid).map(|parts| parts_of(parts)) else { continue };
            let own = parts.iter().filter(|part| !selected.contains(part) && users[part].len() == 1);
            if own.count() <= MAX_UNSHARED_PARTS {
                continue;
            }
            matched.remove(&gid);
            for part in parts {
                let users = users.entry(part).or_default();
                users.remove(&gid);
                if users.len() == 1 {
                    open.extend(users.iter());
                }
            }
        }
        let parts = users.into_iter().filter(|(_, users)| !users.is_empty()).map(|(part, _)| part);
        let modelled: BTreeSet<u16> =
            gids.iter().copied().filter(|gid| !matched.contains_key(gid)).chain(parts).collect();
        let composed = matched.into_iter().map(|(gid, parts)| Composed { gid, parts });
        Self { modelled: modelled.into_iter().collect(), composed: composed.collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decompose(gids: &[u16], matched: &[(u16, &[u16])]) -> (Vec<u16>, Vec<u16>) {
        let part = |gid: &u16| Part { gid: *gid, ..Part::default() };
        let matched = matched.iter().map(|(gid, parts)| (*gid, parts.iter().map(part).collect())).collect();
        let glyphs = Decomposition::of_parts(gids, matched);
        (glyphs.modelled, glyphs.composed.into_iter().map(|glyph| glyph.gid).collect())
    }

    #[test]
    fn parts_that_are_selected_are_used() {
        assert_eq!(decompose(&[1, 2, 5], &[(5, &[1, 2])]), (vec![1, 2], vec![5]));
    }

    #[test]
    fn a_part_that_is_not_selected_gets_a_model_if_that_saves_one() {
        // One more for one less.
        assert_eq!(decompose(&[1, 5], &[(5, &[1, 2])]), (vec![1, 2], vec![5]));
        // Two more for one less.
        assert_eq!(decompose(&[5], &[(5, &[1, 2])]), (vec![5], vec![]));
        // Three more for two less, but shared.
        assert_eq!(decompose(&[5, 6], &[(5, &[1, 2]), (6, &[1, 3])]), (vec![1, 2, 3], vec![5, 6]));
    }

    #[test]
    fn a_part_that_is_used_twice_by_one_glyph_is_used_by_one() {
        assert_eq!(decompose(&[5], &[(5, &[1, 1])]), (vec![1], vec![5]));
    }

    #[test]
    fn a_glyph_that_is_not_composed_stops_sharing_its_parts() {
        // 7 would need two parts of its own, and then 2 is used by 6 alone.
        let matched: &[(u16, &[u16])] = &[(6, &[1, 2]), (7, &[2, 3, 4])];
        assert_eq!(decompose(&[6, 7], matched), (vec![6, 7], vec![]));
    }
}

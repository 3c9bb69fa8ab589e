//! What else a selection of glyphs needs: what layout makes of them, what they consist of, `.notdef` and the space. The rules are
//! pyftsubset's.

use std::collections::BTreeSet;
use std::fmt;
use std::str::FromStr;

use read_fonts::collections::IntSet;
use read_fonts::tables::glyf::{Glyf, Glyph};
use read_fonts::tables::loca::Loca;
use read_fonts::types::{GlyphId, Tag};
use read_fonts::{FontRef, ReadError, TableProvider};

use super::open::owned;
use super::select::glyph_count;
use crate::error::Error;

/// The features that pyftsubset 4.68 keeps by default: those that shapers apply without being asked, and a few more.
const DEFAULT_FEATURES: &str = "BUZZ Buzz HARF Harf abvf abvm abvs akhn blwf blwm blws calt ccmp cfar chws cjct clig cswh curs dist \
    dnom fin2 fin3 fina frac half haln halt init isol jalt kern liga ljmo locl ltra ltrm mark med2 medi mkmk mset nukt numr palt \
    pref pres pstf psts rand rclt rkrf rlig rphf rtla rtlm rvrn stch tjmo valt vatu vchw vert vhal vjmo vkrn vpal vrt2";

/// Which features of `GSUB` a selection is closed over.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum LayoutFeatures {
    /// All that the font has.
    All,
    /// Those with these tags.
    Tags(BTreeSet<Tag>),
}

impl LayoutFeatures {
    /// None.
    pub fn none() -> Self {
        Self::Tags(BTreeSet::new())
    }

    fn contains(&self, tag: Tag) -> bool {
        match self {
            Self::All => true,
            Self::Tags(tags) => tags.contains(&tag),
        }
    }
}

impl fmt::Display for LayoutFeatures {
    /// Writes what pyftsubset takes: `*`, or tags separated by commas, which are none for no features.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::All => f.write_str("*"),
            Self::Tags(tags) => {
                f.write_str(&tags.iter().map(Tag::to_string).collect::<Vec<String>>().join(","))
            }
        }
    }
}

impl Default for LayoutFeatures {
    fn default() -> Self {
        let tags =
            DEFAULT_FEATURES.split_whitespace().filter_map(|tag| Tag::new_checked(tag.as_bytes()).ok());
        Self::Tags(tags.collect())
    }
}

impl FromStr for LayoutFeatures {
    type Err = String;

    /// Reads `*` for all features, `none`, or tags separated by commas; `default` stands for those of pyftsubset.
    fn from_str(text: &str) -> Result<Self, String> {
        let mut tags = BTreeSet::new();
        for item in text.split(',').map(str::trim).filter(|item| !item.is_empty()) {
            match (item, Self::default()) {
                ("*", _) => return Ok(Self::All),
                ("none", _) => {}
                ("default", Self::Tags(defaults)) => tags.extend(defaults),
                _ => {
                    let tag = Tag::new_checked(item.as_bytes()).map_err(|_| {
                        format!("{item:?} is no feature; write tags as in default,smcp,onum, or * or none")
                    })?;
                    tags.insert(tag);
                }
            }
        }
        Ok(Self::Tags(tags))
    }
}

/// Adds to glyphs what shapers may put in their place by these features, the components of composite glyphs, `.notdef` and the
/// space. The result is ascending.
///
/// # Errors
///
/// `Malformed` if `GSUB`, `glyf` or `maxp` cannot be read.
pub fn close(font: &FontRef<'_>, gids: &[u16], features: &LayoutFeatures) -> Result<Vec<u16>, Error> {
    let count = glyph_count(font)?;
    let mut glyphs: IntSet<GlyphId> = gids.iter().map(|gid| GlyphId::from(*gid)).collect();
    glyphs.insert(GlyphId::NOTDEF);
    glyphs.extend(owned(font)?.charmap().map_unicode(' '));
    substitute(font, features, count, &mut glyphs).map_err(|e| {
        Error::Malformed(format!(
            "table 'GSUB' cannot be read ({e}); repair it, or leave layout out with --layout-features none"
        ))
    })?;
    let (loca, glyf) = (font.loca(None), font.glyf());
    if let (Ok(loca), Ok(glyf)) = (loca, glyf) {
        let mut left: Vec<GlyphId> = glyphs.iter().collect();
        while let Some(glyph) = left.pop() {
            let components = components(&loca, &glyf, glyph);
            left.extend(components.into_iter().filter(|component| glyphs.insert(*component)));
        }
    }
    Ok(glyphs.iter().map(GlyphId::to_u32).filter(|gid| *gid < count).map(|gid| gid as u16).collect())
}

fn substitute(
    font: &FontRef<'_>,
    features: &LayoutFeatures,
    count: u32,
    glyphs: &mut IntSet<GlyphId>,
) -> Result<(), ReadError> {
    let gsub = match font.gsub() {
        Ok(gsub) => gsub,
        Err(ReadError::TableIsMissing(_)) => return Ok(()),
        Err(e) => return Err(e),
    };
    let feature_list = gsub.feature_list()?;
    let records = (0..).zip(feature_list.feature_records());
    let indices: IntSet<u16> = records
        .filter(|(_, record)| features.contains(record.feature_tag()))
        .map(|(index, _)| index)
        .collect();
    let lookups = gsub.collect_lookups(&indices)?;
    gsub.closure_glyphs_with_num_glyphs(&lookups, glyphs, count)
}

/// The components of a composite glyph; none of other glyphs, and of one that cannot be read.
fn components(loca: &Loca<'_>, glyf: &Glyf<'_>, glyph: GlyphId) -> Vec<GlyphId> {
    match loca.get_glyf(glyph, glyf) {
        Ok(Some(Glyph::Composite(composite))) => {
            composite.components().map(|component| component.glyph).collect()
        }
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]

    use super::*;

    const DEJAVU: &[u8] = include_bytes!("../../fonts/DejaVuSans.ttf");

    fn closed(text: &str, features: &LayoutFeatures) -> BTreeSet<u16> {
        let font = FontRef::new(DEJAVU).unwrap();
        let charmap = owned(&font).unwrap();
        let gids: Vec<u16> = text
            .chars()
            .map(|c| charmap.charmap().map_unicode(c).unwrap().to_u32().try_into().unwrap())
            .collect();
        let closed = close(&font, &gids, features).unwrap();
        assert!(closed.is_sorted(), "{closed:?}");
        closed.into_iter().collect()
    }

    #[test]
    fn ligatures_of_the_letters_belong_to_them() {
        let font = FontRef::new(DEJAVU).unwrap();
        let ligature = owned(&font).unwrap().charmap().map_unicode('ﬁ').unwrap().to_u32() as u16;
        assert!(closed("fi", &LayoutFeatures::default()).contains(&ligature));
        assert!(!closed("fi", &LayoutFeatures::none()).contains(&ligature));
        assert!(!closed("f", &LayoutFeatures::default()).contains(&ligature));
        assert!(closed("fi", &LayoutFeatures::All).is_superset(&closed("fi", &LayoutFeatures::default())));
    }

    #[test]
    fn a_composite_glyph_brings_its_components_and_every_selection_the_blanks() {
        let (bare, accented) = (closed("e", &LayoutFeatures::none()), closed("é", &LayoutFeatures::none()));
        assert!(accented.is_superset(&bare) && accented.len() == bare.len() + 2, "{bare:?} {accented:?}");
        // .notdef, the space, and the letter.
        assert!(bare.contains(&0) && bare.contains(&3) && bare.len() == 3, "{bare:?}");
    }

    #[test]
    fn features_are_read_from_a_list() {
        let read = |text: &str| text.parse::<LayoutFeatures>();
        assert_eq!(read("*"), Ok(LayoutFeatures::All));
        assert_eq!(read("none"), Ok(LayoutFeatures::none()));
        assert_eq!(read("default"), Ok(LayoutFeatures::default()));
        let LayoutFeatures::Tags(tags) = read("default, smcp").unwrap() else { panic!("all features") };
        assert!(tags.contains(&Tag::new(b"smcp")) && tags.contains(&Tag::new(b"liga")) && tags.len() == 69);
        assert!(read("ligature").unwrap_err().contains("ligature"));
    }
}

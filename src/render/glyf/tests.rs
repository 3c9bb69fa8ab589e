use proptest::prelude::*;
use read_fonts::model::glyph::outline::UnscaledOutlineSink;
use read_fonts::tables::glyf::outline::{Buffers, OutlineContext, OutlinePlan, Unscaled};
use read_fonts::tables::glyf::{Glyf, PHANTOM_POINT_COUNT, PointFlags};
use read_fonts::tables::gvar::GlyphVariationData;
use read_fonts::tables::loca::LocaGlyph;
use read_fonts::types::{Fixed, Point};
use read_fonts::{FontData, FontRead, FontRef, TableProvider};

use super::*;

/// A font for the reader of read-fonts.
struct Twin<'a>(Glyf<'a>, Loca<'a>, Hmtx<'a>);

impl<'a> OutlineContext<'a> for Twin<'a> {
    fn glyph(&self, glyph: GlyphId) -> Option<LocaGlyph<'a>> {
        self.1.get(glyph, &self.0)
    }

    fn glyph_variation_data(&self, _: GlyphId) -> Option<GlyphVariationData<'a>> {
        None
    }

    fn has_gvar(&self) -> bool {
        false
    }

    fn phantom_point_deltas(&self, _: GlyphId) -> Option<[Point<Fixed>; PHANTOM_POINT_COUNT]> {
        None
    }

    fn units_per_em(&self) -> u16 {
        1000
    }

    fn h_metrics(&self, glyph: GlyphId) -> (i32, i32) {
        (self.2.side_bearing(glyph).unwrap_or_default().into(), 0)
    }

    fn h_line_metrics(&self) -> (i32, i32) {
        (0, 0)
    }
}

/// The points of a glyph as read-fonts reads them.
fn expected(glyf: &[u8], loca: &Loca<'_>, hmtx: &Hmtx<'_>, glyph: u32) -> Option<OutlinePoints> {
    let twin = Twin(Glyf::read(FontData::new(glyf)).ok()?, loca.clone(), hmtx.clone());
    let plan = OutlinePlan::new(&twin, GlyphId::new(glyph)).ok()?;
    let lengths = plan.buffer_lengths::<Unscaled>();
    let mut places = vec![Point::default(); lengths.points as usize];
    let mut flags = vec![PointFlags::default(); lengths.points as usize];
    let mut ends = vec![0; lengths.contours as usize];
    let buffers = Buffers {
        points: &mut places,
        flags: &mut flags,
        contours: &mut ends,
        unscaled: &mut [],
        deltas: &mut [],
        iup: &mut [],
        composite_deltas: &mut [],
    };
    let outline = plan.load(&twin, &Unscaled, buffers, None).ok()?;
    let (mut points, mut start) = (OutlinePoints::default(), 0);
    for &end in outline.contours() {
        let contour = start..usize::from(end) + 1;
        let own = outline.points().get(contour.clone())?.iter().zip(outline.flags().get(contour.clone())?);
        own.for_each(|(place, flags)| points.point(place.x, place.y, flags.without_markers()));
        points.end_contour();
        start = contour.end;
    }
    Some(points)
}

/// What both readers make of a glyph; what does not fit is as unreadable.
fn both(glyf: &[u8], loca: &Loca<'_>, hmtx: &Hmtx<'_>, glyph: u32) -> [Option<OutlinePoints>; 2] {
    let outlines = Outlines { glyf, loca: loca.clone() };
    [outlines.load(hmtx, glyph), expected(glyf, loca, hmtx, glyph)]
        .map(|points| points.filter(|points| !points.is_unfit))
}

/// Compares all glyphs of a font, and counts its composite ones.
fn compare_font(path: &std::path::Path) -> usize {
    let (name, data) = (path.display(), std::fs::read(path).unwrap());
    let font = FontRef::new(&data).unwrap();
    let (glyf, loca, hmtx) = (font.glyf().unwrap(), font.loca(None).unwrap(), font.hmtx().unwrap());
    let glyf = glyf.offset_data().as_bytes();
    let mut composites = 0;
    for glyph in 0..u32::from(font.maxp().unwrap().num_glyphs()) {
        let [own, expected] = both(glyf, &loca, &hmtx, glyph);
        assert!(own.is_some(), "glyph {glyph} of {name} cannot be read");
        assert_eq!(own, expected, "glyph {glyph} of {name}");
        let outlines = Outlines { glyf, loca: loca.clone() };
        composites += usize::from(matches!(outlines.get(glyph), Some(Outline::Composite { .. })));
    }
    composites
}

#[test]
fn all_outlines_of_the_fonts_are_those_of_read_fonts() {
    let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR"));
    let composites = ["outline", "outline-mono", "postscript", "serif"]
        .map(|name| compare_font(&root.join(format!("spec/vectors/{name}.ttf"))));
    assert!(composites.iter().sum::<usize>() > 10, "{composites:?} composite glyphs");
    // The published package has no other fonts.
    if root.join("fonts").exists() {
        let composites = ["DejaVuSans", "LiberationSerif-Regular", "Roboto_500Medium"]
            .map(|name| compare_font(&root.join(format!("fonts/{name}.ttf"))));
        assert!(composites.iter().sum::<usize>() > 1000, "{composites:?} composite glyphs");
    }
}

/// Glyphs from their bytes: `glyf` and `loca`.
fn tables(glyphs: &[Vec<u8>]) -> (Vec<u8>, Vec<u8>) {
    let (mut glyf, mut loca) = (Vec::new(), vec![0; 4]);
    for glyph in glyphs {
        glyf.extend(glyph);
        loca.extend((glyf.len() as u32).to_be_bytes());
    }
    (glyf, loca)
}

/// A glyph's header: contours, the left side of its box, and the rest of that.
fn header(contours: i16, left: i16) -> Vec<u8> {
    [contours.to_be_bytes(), left.to_be_bytes(), [0; 2], [0; 2], [0; 2]].concat()
}

/// A triangle and a line of 4 points whose flags are repeated.
fn contours() -> Vec<u8> {
    let ends = [0, 2, 0, 6];
    let instructions = [0, 1, 0x7F];
    // Long, short and missing coordinates.
    let flags = [0x01, 0x32, 0x37, 0x08 | 0x31, 3];
    let (x, y) = ([0xFF, 0x38, 50, 60], [1, 44, 20]);
    [&header(2, -200)[..], &ends, &instructions, &flags, &x, &y].concat()
}

fn hmtx(data: &[u8]) -> Hmtx<'_> {
    Hmtx::read_with_args(FontData::new(data), 1).unwrap()
}

/// The bearings of three glyphs: 10, −20 and 30.
const BEARINGS: [u8; 8] = [2, 0, 0, 10, 0xFF, 0xEC, 0, 30];

#[test]
fn repeated_flags_and_all_kinds_of_coordinates_are_read_and_placed_by_the_bearing() {
    let (glyf, loca) = tables(&[contours()]);
    let loca = Loca::read(FontData::new(&loca), true).unwrap();
    let [own, expected] = both(&glyf, &loca, &hmtx(&BEARINGS), 0);
    let own = own.unwrap();
    assert_eq!(own.ends, [3, 7]);
    // The box begins at -200, and 10 is where it belongs.
    assert_eq!(own.coordinates[0], [10, 60, 120, 120, 120, 120, 120]);
    assert_eq!(Some(own), expected);
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 2000, ..ProptestConfig::default() })]

    #[test]
    fn components_are_placed_and_scaled_as_by_read_fonts(
        components in prop::collection::vec((any::<u16>(), 0..3u16, any::<[u8; 12]>()), 1..5),
        left in -300..300i16,
    ) {
        let mut composite = header(-1, left);
        for (at, (flags, glyph, rest)) in components.iter().enumerate() {
            // Glyphs have 16 bits, offsets are small, and the last component is the last.
            let more = if at + 1 < components.len() { 0x20 } else { 0 };
            let flags = flags & !0x2020 | more;
            composite.extend([flags, glyph % 2].map(u16::to_be_bytes).concat());
            match (flags & 1 != 0, flags & 2 != 0) {
                (true, true) => composite.extend([rest[0] & 1, rest[1], rest[2] & 1, rest[3]]),
                // Anchors, some of them beyond the points.
                (true, false) => composite.extend([0, rest[1] % 8, 0, rest[3] % 8]),
                (false, true) => composite.extend(&rest[..2]),
                (false, false) => composite.extend([rest[0] % 8, rest[1] % 8]),
            }
            let count = match flags {
                _ if flags & 0x08 != 0 => 2,
                _ if flags & 0x40 != 0 => 4,
                _ if flags & 0x80 != 0 => 8,
                _ => 0,
            };
            composite.extend(&rest[4..4 + count]);
        }
        let (glyf, loca) = tables(&[contours(), Vec::new(), composite]);
        let loca = Loca::read(FontData::new(&loca), true).unwrap();
        let [own, expected] = both(&glyf, &loca, &hmtx(&BEARINGS), 2);
        // Anchors beyond all points are damage here; read-fonts takes what its buffer has there.
        if own.is_some() || components.iter().all(|(flags, ..)| flags & 2 != 0) {
            prop_assert_eq!(own, expected);
        }
    }

    #[test]
    fn damage_is_an_error_or_what_read_fonts_makes_of_it(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
        cut in 0..20usize,
    ) {
        let composite = [&header(-1, 0)[..], &[0, 2, 0, 0, 5, 6]].concat();
        let (mut glyf, loca) = tables(&[contours(), composite, Vec::new()]);
        for (at, byte) in changes {
            let at = at.index(glyf.len());
            glyf[at] = byte;
        }
        glyf.truncate(glyf.len() - cut);
        let loca = Loca::read(FontData::new(&loca), true).unwrap();
        for glyph in 0..4 {
            let [own, expected] = both(&glyf, &loca, &hmtx(&BEARINGS), glyph);
            if own.is_some() {
                prop_assert_eq!(own, expected);
            }
        }
    }
}

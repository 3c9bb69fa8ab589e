use proptest::prelude::*;

use super::*;

fn font() -> Font {
    Font::new(include_bytes!("../../../spec/vectors/outline.ttf").as_slice()).unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, cases: 32, ..ProptestConfig::default() })]

    /// The cache may hold all glyphs, some, or one.
    #[test]
    fn what_is_kept_of_a_glyph_changes_no_pixel(
        draws in prop::collection::vec((any::<prop::sample::Index>(), 0..4usize, 0..4u8, any::<bool>()), 1..40),
        cache in prop_oneof![Just(0), 2000..20_000usize, Just(DEFAULT_CACHE)],
    ) {
        let font = font();
        let glyphs: Vec<u32> = font.modelled_glyphs().collect();
        let mut rasterizer = Rasterizer::new(&font).with_cache(cache);
        for (glyph, size, quarters, hinting) in draws {
            let mut options = DrawOptions::new([9.0, 16.0, 16.5, 300.0][size]).with_hinting(hinting);
            options.offset = [f32::from(quarters) / 4.0, 0.0];
            let glyph = *glyph.get(&glyphs);
            let drawn = rasterizer.render(glyph, options).unwrap();
            let fresh = Rasterizer::new(&font).render(glyph, options).unwrap();
            prop_assert_eq!(drawn, fresh);
            let entries = rasterizer.cache.entries.iter();
            prop_assert_eq!(rasterizer.cache.bytes, entries.map(Entry::memory).sum::<usize>());
            prop_assert!(rasterizer.cache.bytes <= cache || rasterizer.cache.entries.len() == 1);
        }
    }
}

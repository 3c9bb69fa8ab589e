//! The functions, called as C calls them.

#![allow(clippy::unwrap_used)]
#![allow(unsafe_code, reason = "calls of a C interface")]

#[path = "../examples/fixtures/fonts.rs"]
#[allow(dead_code, reason = "the programs in C use all of it")]
mod fonts;

use std::ffi::{CStr, c_void};
use std::ptr::{null, null_mut};
use std::sync::LazyLock;
use std::sync::atomic::{AtomicUsize, Ordering};

use nfr::{DrawOptions, Font, Rasterizer, Target};
use nfr_capi::nfr_status::*;
use nfr_capi::*;

static SANS: LazyLock<Vec<u8>> = LazyLock::new(|| fonts::converted("agR ", Target::Smooth));

/// Frees both when it is dropped.
struct Handles(*mut nfr_font, *mut nfr_rasterizer);

impl Drop for Handles {
    fn drop(&mut self) {
        // SAFETY: NULL, or made by the functions below and freed here alone.
        unsafe {
            nfr_font_free(self.0);
            nfr_rasterizer_free(self.1);
        }
    }
}

fn open(data: &[u8]) -> Result<Handles, nfr_status> {
    let mut handles = Handles(null_mut(), null_mut());
    // SAFETY: pointers to values of this function.
    unsafe {
        match nfr_font_new(data.as_ptr(), data.len(), 0, &raw mut handles.0) {
            NFR_OK => assert_eq!(nfr_rasterizer_new(handles.0, &raw mut handles.1), NFR_OK),
            status => {
                assert!(handles.0.is_null());
                return Err(status);
            }
        }
    }
    Ok(handles)
}

fn last() -> String {
    // SAFETY: the message ends with a NUL and is copied before another call.
    unsafe { CStr::from_ptr(nfr_last_error()) }.to_str().unwrap().to_owned()
}

#[test]
fn pixels_and_metrics_are_those_of_the_library() {
    let (handles, font) = (open(&SANS).unwrap(), Font::new(SANS.clone()).unwrap());
    let mut rasterizer = Rasterizer::new(&font);
    for character in "agR ".chars() {
        let glyph = font.glyph_for_char(character).unwrap();
        for (ppem, offset) in [(9.0, [0.0, 0.0]), (12.5, [0.25, 0.5]), (40.0, [0.0, 0.0])] {
            let options = DrawOptions::new(ppem).with_offset(offset);
            let expected = rasterizer.render(glyph, options).unwrap();
            let (mut placement, mut lent, mut advance) = (nfr_placement::default(), null(), 0.0);
            let (mut pixels, stride) = (vec![7; 64 * 64], 64);
            // SAFETY: handles that are open, and pointers to values of this function.
            unsafe {
                assert_eq!(nfr_font_glyph_for_char(handles.0, character.into()), glyph);
                assert!(nfr_font_has_model(handles.0, glyph));
                assert_eq!(nfr_font_advance(handles.0, glyph, ppem), font.advance(glyph, ppem));
                let [x, y] = offset;
                let status =
                    nfr_rasterizer_draw(handles.1, glyph, ppem, x, y, &raw mut lent, &raw mut placement);
                assert_eq!((status, placement), (NFR_OK, expected.placement.into()));
                assert_eq!(std::slice::from_raw_parts(lent, expected.pixels.len()), expected.pixels);
                let mono = rasterizer.render_mono(glyph, options).unwrap();
                let status =
                    nfr_rasterizer_draw_mono(handles.1, glyph, ppem, x, y, &raw mut lent, &raw mut placement);
                assert_eq!((status, placement), (NFR_OK, mono.placement.into()));
                assert_eq!(std::slice::from_raw_parts(lent, mono.bits.len()), mono.bits);
                let (start, len) = (pixels.as_mut_ptr(), pixels.len());
                let status = nfr_rasterizer_render_into(
                    handles.1,
                    glyph,
                    ppem,
                    x,
                    y,
                    start,
                    len,
                    stride,
                    &raw mut placement,
                );
                assert_eq!((status, placement), (NFR_OK, expected.placement.into()));
                assert_eq!(nfr_rasterizer_hinted_advance(handles.1, glyph, ppem, &raw mut advance), NFR_OK);
            }
            assert_eq!(advance, rasterizer.hinted_advance(glyph, ppem).unwrap());
            for (row, line) in pixels.chunks(stride).enumerate() {
                let inside = expected.rows().nth(row).unwrap_or(&[]);
                assert_eq!(line[..inside.len()], *inside);
                assert!(line[inside.len()..].iter().all(|level| *level == 7), "beside the bitmap");
            }
        }
    }
}

#[test]
fn each_cause_has_its_status_and_message() {
    let fonts: [(&[u8], nfr_status, &str); 4] = [
        (b"no font", NFR_NOT_A_FONT, "OpenType"),
        (&fonts::plain(), NFR_NO_MODELS, "'Nfrt'"),
        (&SANS[..SANS.len() / 2], NFR_DAMAGED_FONT, "table"),
        (&[], NFR_NOT_A_FONT, "OpenType"),
    ];
    for (data, status, text) in fonts {
        assert_eq!(open(data).err(), Some(status), "{text}");
        assert!(last().contains(text), "{}", last());
    }
    let handles = open(&SANS).unwrap();
    let draw = |glyph, ppem, x, len, stride| {
        let (mut pixels, mut placement) = (vec![0; 4096], nfr_placement::default());
        // SAFETY: a rasterizer that is open, and pointers to values of this function.
        let status = unsafe {
            let start = pixels.as_mut_ptr();
            nfr_rasterizer_render_into(handles.1, glyph, ppem, x, 0.0, start, len, stride, &raw mut placement)
        };
        (status, placement)
    };
    // SAFETY: a font that is open.
    let [a, q] = ['a', 'Q'].map(|c| unsafe { nfr_font_glyph_for_char(handles.0, c.into()) });
    let (status, box_of_a) = draw(a, 16.0, 0.0, 4096, 64);
    assert_eq!(status, NFR_OK);
    let (width, height) = (box_of_a.width as usize, box_of_a.height as usize);
    for (len, stride) in [(width * height - 1, width), (4096, width - 1), (0, width), (4096, usize::MAX)] {
        assert_eq!(draw(a, 16.0, 0.0, len, stride), (NFR_BUFFER_TOO_SMALL, box_of_a));
    }
    assert_eq!(draw(a, 16.0, 0.0, width * height, width).0, NFR_OK);
    assert_eq!(draw(q, 16.0, 0.0, 4096, 64).0, NFR_MISSING_MODEL);
    assert_eq!(draw(70_000, 16.0, 0.0, 4096, 64).0, NFR_NO_SUCH_GLYPH);
    for ppem in [0.0, -1.0, f32::NAN, f32::INFINITY, 2049.0] {
        assert_eq!(draw(a, ppem, 0.0, 4096, 64).0, NFR_INVALID_SIZE);
    }
    assert_eq!(draw(a, 16.0, f32::NAN, 4096, 64).0, NFR_INVALID_OFFSET);
    let stale = open(&fonts::stale(SANS.clone(), 'a')).unwrap();
    let damaged = open(&fonts::damaged(&SANS, 'a', "g")).unwrap();
    for (handles, status) in [(stale, NFR_STALE), (damaged, NFR_DAMAGED_GLYPH)] {
        let mut placement = nfr_placement::default();
        // SAFETY: a rasterizer that is open, and a pointer to a value of this function.
        let found = [16.0, 64.0].map(|ppem| unsafe {
            nfr_rasterizer_placement(handles.1, a, ppem, 0.0, 0.0, &raw mut placement)
        });
        assert!(found.contains(&status), "{found:?}");
        assert!(last().contains(&format!("glyph {a}")), "{}", last());
    }
}

#[test]
fn settings_change_what_is_drawn() {
    let handles = open(&SANS).unwrap();
    let mut limits = nfr_limits { bitmap_side: 0, decoded_bytes: 0, work: 0 };
    let place = |glyph| {
        let mut placement = nfr_placement::default();
        // SAFETY: a rasterizer that is open, and a pointer to a value of this function.
        (unsafe { nfr_rasterizer_placement(handles.1, glyph, 16.0, 0.0, 0.0, &raw mut placement) }, placement)
    };
    // SAFETY: handles that are open, and pointers to values of this function.
    unsafe {
        let q = nfr_font_glyph_for_char(handles.0, 'Q'.into());
        assert_eq!(nfr_rasterizer_set_missing_model(handles.1, 1), NFR_OK);
        assert_eq!(place(q), (NFR_OK, nfr_placement::default()));
        assert_eq!(nfr_rasterizer_set_missing_model(handles.1, 2), NFR_OK);
        assert!(place(q).1.width > 5);
        assert_eq!(nfr_rasterizer_set_missing_model(handles.1, 3), NFR_INVALID_ARGUMENT);
        assert_eq!(nfr_rasterizer_set_cache(handles.1, 0), NFR_OK);
        assert_eq!(nfr_limits_default(&raw mut limits), NFR_OK);
        limits.bitmap_side = 4;
        assert_eq!(nfr_rasterizer_set_limits(handles.1, &raw const limits), NFR_OK);
        assert_eq!(place(q).0, NFR_LIMIT);
    }
}

#[test]
fn borrowed_bytes_are_released_once_after_the_last_use_and_on_failure() {
    static RELEASED: AtomicUsize = AtomicUsize::new(0);
    unsafe extern "C" fn release(user: *mut c_void) {
        // SAFETY: the number that the test gave.
        RELEASED.fetch_add(unsafe { *user.cast::<usize>() }, Ordering::SeqCst);
    }
    let released = || RELEASED.load(Ordering::SeqCst);
    let mut count = 1usize;
    let one = (&raw mut count).cast::<c_void>();
    let (mut font, mut rasterizer) = (null_mut(), null_mut());
    // SAFETY: bytes that outlive all of it, handles that are open, and pointers to values of this function.
    unsafe {
        let (data, len) = (SANS.as_ptr(), SANS.len());
        assert_eq!(nfr_font_new_borrowed(data, len, 0, Some(release), one, &raw mut font), NFR_OK);
        assert_eq!(nfr_rasterizer_new(font, &raw mut rasterizer), NFR_OK);
        nfr_font_free(font);
        assert_eq!(released(), 0);
        nfr_rasterizer_free(rasterizer);
        assert_eq!(released(), 1);
        assert_eq!(nfr_font_new_borrowed(data, 9, 0, Some(release), one, &raw mut font), NFR_NOT_A_FONT);
        assert_eq!(released(), 2);
        assert_eq!(nfr_font_new_borrowed(data, len, 0, Some(release), one, null_mut()), NFR_NULL_POINTER);
        assert_eq!(
            nfr_font_new_borrowed(null(), len, 0, Some(release), one, &raw mut font),
            NFR_NULL_POINTER
        );
        assert_eq!(released(), 4);
        assert_eq!(nfr_font_new_borrowed(data, len, 1, None, null_mut(), &raw mut font), NFR_NO_SUCH_FONT);
        assert!(font.is_null());
    }
}

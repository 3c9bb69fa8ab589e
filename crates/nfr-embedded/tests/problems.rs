//! What cannot be drawn.

use embedded_graphics::geometry::Point;
use embedded_graphics::mock_display::MockDisplay;
use embedded_graphics::pixelcolor::{Gray8, GrayColor};
use embedded_graphics::text::Baseline;
use embedded_graphics::text::renderer::TextRenderer;
use nfr::{Error, Font, Limits, Rasterizer};
use nfr_embedded::{Face, Missing, Problem, Reason};

static FONT: &[u8] = include_bytes!("../fonts/ascii.nfr.ttf");

/// Whether anything was drawn, how wide the text is, and what went wrong.
fn drawn(face: &Face, text: &str, ppem: f32) -> (bool, i32, Option<Problem>) {
    face.forget_problem();
    let mut display = MockDisplay::<Gray8>::new();
    display.set_allow_overdraw(true);
    let style = face.style(ppem, Gray8::WHITE, Gray8::BLACK);
    let next = style
        .draw_string(text, Point::new(4, 30), Baseline::Alphabetic, &mut display)
        .expect("a display without errors");
    let width = style.measure_string(text, Point::zero(), Baseline::Top).next_position.x;
    assert_eq!(next.x - 4, width);
    let area = display.affected_area();
    (!area.is_zero_sized(), width, face.problem())
}

/// A B a b, of which A and B have no models: `nfr-convert fonts/LiberationSans-Regular.ttf PART --unicodes U+61-62 --ppem 10-24`, then
/// `nfr subset PART partial.nfr.ttf --unicodes U+41-42,U+61-62`.
static PARTIAL: &[u8] = include_bytes!("samples/partial.nfr.ttf");

#[test]
fn a_size_out_of_range_draws_nothing_and_is_told() {
    let face = Face::new(&Font::new(FONT).expect("a converted font"));
    for ppem in [0.0, -3.0, f32::NAN, f32::INFINITY, 1e9] {
        let (ink, width, problem) = drawn(&face, "ab", ppem);
        assert_eq!((ink, width), (false, 0), "{ppem} ppem");
        let Some(Problem { character: 'a', reason: Reason::Glyph(Error::InvalidSize(_)), .. }) = problem
        else {
            panic!("{problem:?} at {ppem} ppem");
        };
        assert_eq!(face.style(ppem, Gray8::WHITE, Gray8::BLACK).line_height(), 0);
    }
    let (ink, width, problem) = drawn(&face, "ab", 12.0);
    assert!(ink && width > 0 && problem.is_none());
}

#[test]
fn a_character_that_the_font_lacks_is_a_box_or_nothing_and_is_told() {
    let font = Font::new(FONT).expect("a converted font");
    for (missing, ink, width) in
        [(Missing::Notdef, true, 12), (Missing::Outline, true, 12), (Missing::Skip, false, 0)]
    {
        let face = Face::new(&font).with_missing(missing);
        let (found, _, problem) = drawn(&face, "Ж", 16.0);
        assert_eq!(found, ink, "{missing:?}");
        assert_eq!(
            problem.map(|problem| (problem.character, problem.reason)),
            Some(('Ж', Reason::NotInFont))
        );
        assert_eq!(drawn(&face, "Ж", 16.0).1, width, "{missing:?}");
        assert!(problem.is_some_and(|problem| problem.to_string().contains("U+0416")));
    }
}

#[test]
fn a_glyph_without_a_model_is_a_box_or_nothing_or_its_outline() {
    let font = Font::new(PARTIAL).expect("a converted font");
    let own_width = font.advance(font.glyph_for_char('A').expect("a glyph"), 16.0).round() as i32;
    let expected = [
        (Missing::Notdef, true, 12, true),
        (Missing::Skip, false, own_width, true),
        (Missing::Outline, true, own_width, false),
    ];
    for (missing, ink, width, told) in expected {
        let face = Face::new(&font).with_missing(missing);
        let (found, found_width, problem) = drawn(&face, "A", 16.0);
        assert_eq!((found, found_width, problem.is_some()), (ink, width, told), "{missing:?}");
        if let Some(problem) = problem {
            assert!(matches!(problem.reason, Reason::Glyph(Error::MissingModel(_))), "{problem:?}");
        }
    }
}

#[test]
fn a_glyph_that_cannot_be_drawn_is_skipped_and_the_first_is_told() {
    let font = Font::new(FONT).expect("a converted font");
    let mut limits = Limits::default();
    limits.bitmap_side = 12;
    let face = Face::from_rasterizer(Rasterizer::new(&font).with_limits(limits));
    let (ink, width, problem) = drawn(&face, "iWM", 16.0);
    let Some(Problem { character: 'W', reason: Reason::Glyph(Error::BitmapTooLarge { .. }), .. }) = problem
    else {
        panic!("{problem:?}");
    };
    assert!(ink);
    assert_eq!(width, drawn(&Face::new(&font), "iWM", 16.0).1);
}

use super::*;
use crate::model::outline::AxisHints;

/// The example of the specification: a glyph at three sizes, with three tracks along y.
fn example() -> (OutlinePoints, OutlineWeights, Sources) {
    let points = OutlinePoints {
        coordinates: [vec![50, 50, 150, 150, 400, 400], vec![0, 700, 700, 350, 350, 0]],
        on_curve: vec![true, true, true, false, true, true],
        ends: vec![6],
        is_unfit: false,
    };
    let y = AxisHints {
        is_hinted: true,
        levels: vec![0, 350, 700],
        track_of: vec![0, 2, 2, 1, 1, 0],
        moves: vec![0, 13, 26, 0, -10, -19, 0, 32, 0],
        corrections: vec![Correction { size: 2, point: 3, by: -5 }],
    };
    let weights = OutlineWeights { axes: [AxisHints::default(), y], advances: vec![0, 1, 0] };
    (points, weights, [Vec::new(), vec![Source::Own; 3]])
}

fn known(points: &OutlinePoints) -> Known<'_> {
    let shared = Shared { levels: [&[], &[]], moves: &|_, _, _| Ok(Vec::new()) };
    Known { points, advance: 450, scale: Scale::new(1000, 8, 10).expect("a scale"), shared }
}

#[test]
fn the_example_of_the_specification_is_coded_as_it_says() {
    let (points, mut weights, sources) = example();
    let expected = weights.clone();
    let known = known(&points);
    let message =
        encode(&known, &mut weights, &sources, &mut |question| question.wanted.into()).expect("a message");
    let page = include_str!("../../../../spec/nfrt.md");
    assert!(page.contains(&format!("Its hash is {:04X}.", points.hash())), "{:04X}", points.hash());
    let hex: String = message.iter().map(|byte| format!("{byte:02x}")).collect();
    assert!(page.contains(&format!("    {hex}\n")), "spec/nfrt.md does not have {hex}");
    assert_eq!(decode(&message, &known, 3), Ok((expected, sources)));
}

#[test]
fn a_track_that_stays_takes_no_bits_and_keeps_its_place() {
    let (points, mut weights, mut sources) = example();
    weights.axes[1].corrections.clear();
    for size in 0..3 {
        weights.axes[1].moves[3 * size] = 0;
    }
    sources[1][0] = Source::Still;
    let expected = weights.clone();
    let known = known(&points);
    let mut asked = Vec::new();
    let message = encode(&known, &mut weights, &sources, &mut |question| {
        asked.push(question.track);
        question.wanted.into()
    });
    assert!(!asked.contains(&0), "a track that stays was coded");
    assert_eq!(decode(&message.expect("a message"), &known, 3), Ok((expected, sources)));
}

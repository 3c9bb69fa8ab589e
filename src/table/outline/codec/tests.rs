use super::*;
use crate::model::outline::{AxisHints, Correction};
use crate::model::sizes::Origin;
use crate::table::outline::sizes_for;

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
        first_size: 0,
        moves: vec![0, 13, 26, 0, -10, -19, 0, 32, 0],
        corrections: vec![Correction { size: 2, point: 3, by: -5 }],
        ..AxisHints::default()
    };
    let weights = OutlineWeights { axes: [AxisHints::default(), y], advances: vec![0, 1, 0] };
    (points, weights, [Vec::new(), vec![Source::Own; 3]])
}

fn known(points: &OutlinePoints) -> Known<'_> {
    let shared = Shared { levels: [&[], &[]], moves: &|_, _, _, _| Ok(Vec::new()) };
    Known { points, advance: 450, scale: Scale::new(1000, 8, 10).expect("a scale"), shared }
}

#[test]
fn the_example_of_the_specification_is_coded_as_it_says() {
    let (points, mut weights, sources) = example();
    let expected = weights.clone();
    let known = known(&points);
    let message =
        encode(&known, &mut weights, &sources, &mut |question| question.wanted.into()).expect("a message");
    let (page, hash) = (include_str!("../../../../spec/nfrt.md"), points.hash(known.advance));
    assert!(page.contains(&format!("Its hash is {:04X}.", hash)), "{hash:04X}");
    let hex: String = message.iter().map(|byte| format!("{byte:02x}")).collect();
    assert!(page.contains(&format!("    {hex}\n")), "spec/nfrt.md does not have {hex}");
    assert_eq!(decode(&message, &known, 0..3, &mut Vec::new()), Ok((expected, sources)));
}

#[test]
fn tracks_of_postscript_outlines_are_read_as_they_were_written_local_or_not() {
    let (points, mut weights, sources) = example();
    let y = &mut weights.axes[1];
    y.is_local = vec![false, true, false];
    let expected = weights.clone();
    let mut known = known(&points);
    known.scale = known.scale.with_origin(Origin::PostScript);
    let message =
        encode(&known, &mut weights, &sources, &mut |question| question.wanted.into()).expect("a message");
    let read = decode(&message, &known, 0..3, &mut Vec::new());
    assert_eq!(read, Ok((expected.clone(), sources.clone())));
    // Each track says whether it is local, even if none is.
    weights.axes[1].is_local.clear();
    let message =
        encode(&known, &mut weights, &sources, &mut |question| question.wanted.into()).expect("a message");
    let (read, _) = decode(&message, &known, 0..3, &mut Vec::new()).expect("hints");
    assert_eq!(read.axes[1].is_local, [false; 3]);
    assert_eq!(read.axes[1].moves, expected.axes[1].moves);
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
    assert_eq!(decode(&message.expect("a message"), &known, 0..3, &mut Vec::new()), Ok((expected, sources)));
}

/// The example's outline at 70 sizes, which make three sections, with moves that nothing predicts well.
fn sections() -> (OutlinePoints, OutlineWeights, Sources, Scale) {
    let (points, mut weights, sources) = example();
    let count = 70;
    let mixed = |at: usize| (at * at * 7 + at * 13) % 41;
    weights.axes[1].moves = (0..3 * count).map(|at| mixed(at) as i16 - 20).collect();
    weights.axes[1].corrections = (0..count as u16)
        .step_by(5)
        .map(|size| Correction { size, point: size % 6, by: mixed(size.into()) as i16 + 1 })
        .collect();
    weights.advances = (0..count).map(|size| (mixed(size) % 3) as i8 - 1).collect();
    (points, weights, sources, Scale::new(1000, 8, 77).expect("a scale"))
}

#[test]
fn the_sizes_of_a_section_are_read_without_those_before() {
    let (points, mut weights, sources, scale) = sections();
    let whole = weights.clone();
    let known = Known { scale, ..known(&points) };
    let message =
        encode(&known, &mut weights, &sources, &mut |question| question.wanted.into()).expect("a message");
    assert_eq!(decode(&message, &known, 0..70, &mut Vec::new()), Ok((whole.clone(), sources)));
    for size in 0..70 {
        let sizes = sizes_for(size);
        assert!(sizes.end == size + 1 && sizes.len() <= 29, "{sizes:?} are read for {size}");
        let (found, _) = decode(&message, &known, sizes.clone(), &mut Vec::new()).expect("some sizes");
        for size in sizes.clone() {
            let [found, whole] = [&found, &whole].map(|weights| {
                let y = &weights.axes[1];
                (y.moves_at(size), y.corrections_at(size), weights.advances[size])
            });
            assert_eq!(found, whole, "of the size {size} in {sizes:?}");
        }
        assert_eq!(found.axes[1].moves.len(), 3 * sizes.len());
    }
}

#[test]
fn a_section_ends_where_its_bytes_do() {
    let (points, mut weights, sources, scale) = sections();
    let known = Known { scale, ..known(&points) };
    let message =
        encode(&known, &mut weights, &sources, &mut |question| question.wanted.into()).expect("a message");
    let longer = [&message[..], &[0]].concat();
    let shorter = &message[..message.len() - 1];
    for (bytes, sizes) in [(&longer[..], 58..70), (shorter, 58..70), (&longer, 0..70), (shorter, 0..70)] {
        assert!(
            decode(bytes, &known, sizes.clone(), &mut Vec::new()).is_err(),
            "{} bytes, {sizes:?}",
            bytes.len()
        );
    }
}

#[test]
fn a_shared_track_is_read_section_by_section() {
    let (_, weights, _, scale) = sections();
    let moves = &weights.axes[1].moves[..70];
    let message = encode_shared(350, moves, scale).expect("a message");
    assert_eq!(decode_shared(&message, 350, scale, 0..70, &mut Vec::new()).as_deref(), Ok(moves));
    for size in 0..70 {
        let sizes = sizes_for(size);
        assert_eq!(
            decode_shared(&message, 350, scale, sizes.clone(), &mut Vec::new()).as_deref(),
            Ok(&moves[sizes])
        );
    }
    let longer = [&message[..], &[0]].concat();
    assert!(decode_shared(&longer, 350, scale, 58..70, &mut Vec::new()).is_err());
}

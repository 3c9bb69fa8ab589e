//! The worked example of `spec/nfrt.md`.

use nfr::internals::model::gridfit::{AxisWarp, Scale, Weights};
use nfr::internals::table::codec::{decode, encode};

#[test]
fn the_example_of_the_specification_is_packed_as_it_says() {
    let scale = Scale::new(1000, 8, 10).unwrap();
    let weights = Weights {
        bounds: [0, -20, 300, 700],
        cells: [10, 10],
        field: (0..144).map(|i| (50 - i) as i8).collect(),
        warp_y: AxisWarp { knots: vec![-20, 700], hinted: vec![-1, 180, 0, 202, -32, 224] },
        rank: 1,
        patterns: (0..64).map(|i| i % 5 - 2).collect(),
        embedding: vec![3, 3, -4],
        ..Weights::default()
    };
    let bytes = encode(&weights, scale).unwrap();
    let hex: Vec<String> =
        bytes.chunks(32).map(|line| line.iter().map(|byte| format!("{byte:02x}")).collect()).collect();
    let listing = hex.iter().map(|line| format!("    {line}\n")).collect::<String>();
    assert!(include_str!("../spec/nfrt.md").contains(&listing), "the message is\n{listing}");
    assert_eq!(decode(&bytes, scale), Ok(weights));
}

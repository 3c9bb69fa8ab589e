use super::super::rules::{BEFORE, LOWER, ROOM, lanes};
use super::*;

fn rules(positions: &[i32], valid: usize) -> Rules<3> {
    let mut room = [0; ROOM];
    room[..positions.len()].copy_from_slice(positions);
    Rules { lanes: lanes(&room), valid }
}

#[test]
fn the_first_rule_is_the_reference_until_one_is_nearer() {
    let mut shifts = Shifts::new();
    let rules = rules(&[64, 70, 50], BEFORE);
    let reference = shifts.reference(&rules);
    assert_eq!((reference.position, reference.context), (64, 5));
    // The second rule is off by 1, the others by 7 and by 21.
    shifts.update(&rules, 71);
    let reference = shifts.reference(&rules);
    // (1 − 20) · 4 / 4 = −19; half of 1, rounded down, is 0.
    assert_eq!((reference.position, reference.context), (70, 5));
    assert_eq!(shifts.mean[1], 80 - 19);
}

#[test]
fn a_rule_that_is_always_off_by_as_much_becomes_exact() {
    let mut shifts = Shifts::new();
    for size in 0..20 {
        let rules = rules(&[1000, 100 * size], 0);
        shifts.update(&rules, 100 * size - 16);
    }
    let reference = shifts.reference(&rules(&[1000, 500], 0));
    assert_eq!((reference.position, reference.context), (500 - 16, 0));
}

#[test]
fn a_jump_by_a_pixel_is_not_followed() {
    let mut shifts = Shifts::new();
    shifts.update(&rules(&[0, 64], 0), 0);
    assert_eq!([shifts.by[1], shifts.by[0]], [0, 0]);
    // It counts as 48 of 1/64 pixel.
    assert_eq!(shifts.mean[1], 80 + (4 * 48 - 80) / 4);
}

#[test]
fn rules_that_lack_something_learn_nothing_and_are_no_reference() {
    let mut shifts = Shifts::new();
    let rules = rules(&[500, 500, 7, 500, 10], LOWER);
    shifts.update(&rules, 7);
    assert_eq!((shifts.by[2], shifts.mean[2]), (0, 80));
    assert_eq!(shifts.reference(&rules).position, 10 + (-3 >> 1));
}

#[test]
fn positions_of_damaged_bytes_are_taken() {
    let mut shifts = Shifts::new();
    for position in [i32::MIN, i32::MAX, 0] {
        shifts.update(&rules(&[i32::MAX, i32::MIN, 0], BEFORE), position);
    }
    assert!(shifts.by.iter().all(|by| i32::from(*by).abs() <= 3 * FOLLOWED));
}

#[test]
fn a_shift_stays_in_8_bits() {
    let mut shifts = Shifts::new();
    for size in 0..40 {
        shifts.update(&rules(&[0], 0), 12 * size);
    }
    assert_eq!(shifts.by[0], i8::MAX);
}

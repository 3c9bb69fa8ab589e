//! Coding of tracks' hinted positions, size by size, so that a reader can stop at the size that it draws.

use alloc::vec;
use alloc::vec::Vec;

use super::rules::{Neighbours, Ranked, Scores, View, coding_order, to_grid};
use crate::model::outline::scale_of;
use crate::number::mul_fixed;
use crate::table::context_model::{ContextModel, class};
use crate::table::elements::{HIT, MISS_FRACTION, MISS_PIXELS};
use crate::table::range::Coder;

/// Gives the probabilities of the bits of a move to its second argument.
pub type Price<'q> = dyn Fn(i32, &mut dyn FnMut(u32)) + 'q;

/// The shared track that a track refers to.
#[derive(Default)]
pub(super) struct Referred {
    /// Its moves; none for a track of its own.
    pub(super) moves: Option<Vec<i16>>,
    /// Whether they are the track's own moves.
    pub(super) is_same: bool,
}

/// A hinted position that is to be written.
pub struct Question<'q> {
    /// 0 for x, 1 for y.
    pub axis: usize,
    /// The track.
    pub track: usize,
    /// The index of the size.
    pub size: usize,
    /// The track's move as it was given, in 1/64 pixel.
    pub wanted: i16,
    /// The moves that take few bits.
    pub candidates: &'q [i32],
    /// Calls its second argument with the probability, in 1/4096, of each bin that a move takes.
    pub price: &'q Price<'q>,
}

/// Chooses the moves that are written. A reader never asks.
pub type Choose<'c> = &'c mut dyn FnMut(&Question<'_>) -> i32;

/// The tracks of an axis while their positions are coded.
pub(super) struct Axis<'a> {
    axis: usize,
    levels: &'a [i16],
    order: Vec<(usize, Neighbours)>,
    tracks: Vec<Track>,
    plain: Vec<i32>,
    hinted: Vec<i32>,
    before: Vec<i32>,
}

/// What is known of a track from smaller sizes.
struct Track {
    scores: Scores,
    /// Whether the first candidate was wrong at each of the last sizes, the last one lowest.
    misses: u8,
    shared: Referred,
}

impl<'a> Axis<'a> {
    /// Tracks at the first size, with the shared track that each refers to.
    pub(super) fn new(axis: usize, levels: &'a [i16], shared: Vec<Referred>) -> Self {
        let order = coding_order(levels.len());
        let mut kinds = vec![0; levels.len()];
        for (track, neighbours) in &order {
            kinds[*track] = neighbours.kind();
        }
        let track = |(shared, kind)| Track { scores: Scores::new(kind), misses: 0, shared };
        Self {
            axis,
            levels,
            order,
            tracks: shared.into_iter().zip(kinds).map(track).collect(),
            plain: vec![0; levels.len()],
            hinted: vec![0; levels.len()],
            before: Vec::new(),
        }
    }

    /// Codes the moves of all tracks at a size.
    pub(super) fn code<C: Coder>(
        &mut self,
        model: &mut ContextModel<'_, C>,
        size: usize,
        scale: i32,
        moves: &mut [i16],
        choose: Choose<'_>,
    ) {
        for (plain, level) in self.plain.iter_mut().zip(self.levels) {
            *plain = mul_fixed((*level).into(), scale);
        }
        let mut missed = 0;
        for at in 0..self.order.len() {
            let (track, neighbours) = self.order[at];
            let Track { scores, misses, shared: Referred { moves: shared, is_same } } =
                &mut self.tracks[track];
            let plain = self.plain[track];
            let shared = shared.as_ref().and_then(|moves| moves.get(size)).copied();
            if *is_same {
                let moved = shared.unwrap_or(0);
                moves[track] = moved;
                self.hinted[track] = plain.wrapping_add(moved.into());
                continue;
            }
            let before = (!self.before.is_empty()).then_some(&*self.before);
            let view = View { levels: self.levels, plain: &self.plain, hinted: &self.hinted, before, shared };
            let rules = view.rules(track, neighbours);
            let ranked = scores.rank(&rules);
            let state = State { misses: usize::from(*misses & 3), missed, kind: neighbours.kind() };
            if C::WRITES {
                moves[track] =
                    asked(model, &ranked, state, choose, (self.axis, track, size), plain, moves[track]);
            }
            let wanted = plain.wrapping_add(moves[track].into());
            let (position, is_first) = code_position(model, &ranked, state, wanted);
            *misses = *misses << 1 | u8::from(!is_first);
            missed += usize::from(!is_first);
            // Damaged bytes may give any position.
            moves[track] = position.wrapping_sub(plain) as i16;
            self.hinted[track] = plain.wrapping_add(moves[track].into());
            scores.update(&rules, self.hinted[track]);
        }
        self.before.clone_from(&self.hinted);
    }
}

/// What the contexts of a position are made of, beside its candidates.
#[derive(Clone, Copy)]
struct State {
    /// Whether the first candidate was wrong at the last two sizes.
    misses: usize,
    /// How many tracks were missed at this size.
    missed: usize,
    /// The kind of neighbours.
    kind: usize,
}

fn asked<C: Coder>(
    model: &ContextModel<'_, C>,
    ranked: &Ranked,
    state: State,
    choose: Choose<'_>,
    (axis, track, size): (usize, usize, usize),
    plain: i32,
    wanted: i16,
) -> i16 {
    let candidates: Vec<i32> = ranked.candidates().iter().map(|c| c.position.wrapping_sub(plain)).collect();
    let price = |moved: i32, visit: &mut dyn FnMut(u32)| {
        price(model, ranked, state, plain.wrapping_add(moved), visit);
    };
    let chosen = choose(&Question { axis, track, size, wanted, candidates: &candidates, price: &price });
    chosen.clamp(i16::MIN.into(), i16::MAX.into()) as i16
}

/// The contexts of the bin that says whether a candidate is right.
fn hit_contexts(ranked: &Ranked, rank: usize, left: u32, state: State) -> [usize; 3] {
    let candidate = &ranked.candidates()[rank];
    let share = (candidate.weight * 32 / left.max(1)) as i32;
    [
        rank * 8 + class(share, [6, 10, 14, 18, 22, 26, 30]),
        candidate.rule * 4 + class(i32::from(candidate.score >> 8), [100, 180, 235]),
        rank.min(3) * 12 + state.misses * 3 + state.missed.min(2),
    ]
}

fn miss_pixels_context(state: State) -> [usize; 3] {
    [state.kind * 3 + state.missed.min(2), 0, 0]
}

fn miss_fraction_context(first: i32, pixels: i32, state: State) -> [usize; 3] {
    [state.kind * 4 + usize::from(to_grid(first) == first) * 2 + usize::from(pixels != 0), 0, 0]
}

/// The distance from the first candidate in whole pixels, and the rest.
fn split(position: i32, first: i32) -> (i32, i32) {
    let pixels = to_grid(position.wrapping_sub(first)) >> 6;
    (pixels, position.wrapping_sub(first).wrapping_sub(pixels << 6))
}

/// Codes a position; also says whether it is the first candidate's.
fn code_position<C: Coder>(
    model: &mut ContextModel<'_, C>,
    ranked: &Ranked,
    state: State,
    position: i32,
) -> (i32, bool) {
    let mut left = ranked.total;
    for (rank, candidate) in ranked.candidates().iter().enumerate() {
        if model.flag(HIT, hit_contexts(ranked, rank, left, state), candidate.position == position) {
            return (candidate.position, rank == 0);
        }
        left -= candidate.weight;
    }
    let first = ranked.candidates()[0].position;
    let (pixels, fraction) = split(position, first);
    let pixels = model.signed(MISS_PIXELS, miss_pixels_context(state), pixels);
    let fraction = model.signed(MISS_FRACTION, miss_fraction_context(first, pixels, state), fraction);
    (first.wrapping_add(pixels.wrapping_shl(6)).wrapping_add(fraction), false)
}

/// Gives the probabilities of the bins of a position.
fn price<C: Coder>(
    model: &ContextModel<'_, C>,
    ranked: &Ranked,
    state: State,
    position: i32,
    visit: &mut dyn FnMut(u32),
) {
    let mut left = ranked.total;
    for (rank, candidate) in ranked.candidates().iter().enumerate() {
        let probability = model.probability(HIT, hit_contexts(ranked, rank, left, state), 0);
        if candidate.position == position {
            visit(probability);
            return;
        }
        visit((1 << 12) - probability);
        left -= candidate.weight;
    }
    let first = ranked.candidates()[0].position;
    let (pixels, fraction) = split(position, first);
    model.visit_signed(MISS_PIXELS, miss_pixels_context(state), pixels, visit);
    model.visit_signed(MISS_FRACTION, miss_fraction_context(first, pixels, state), fraction, visit);
}

/// Codes the moves of a shared track, which has no neighbours.
pub(super) fn code_shared<C: Coder>(
    model: &mut ContextModel<'_, C>,
    level: i16,
    scales: impl Iterator<Item = i32>,
    moves: &mut Vec<i16>,
) {
    let levels = [level];
    let mut axis = Axis::new(0, &levels, vec![Referred::default()]);
    for (size, scale) in scales.enumerate() {
        let mut moved = [moves.get(size).copied().unwrap_or(0)];
        axis.code(model, size, scale, &mut moved, &mut |question| question.wanted.into());
        if !C::WRITES {
            moves.push(moved[0]);
        }
    }
}

/// The scale of each trained size.
pub(super) fn scales(scale: crate::model::sizes::Scale) -> impl Iterator<Item = i32> {
    (0..scale.sizes()).map(move |size| scale_of(scale.ppem_of(size) as f32, scale.units_per_em()))
}

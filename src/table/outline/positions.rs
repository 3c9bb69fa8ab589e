//! Coding of tracks' hinted positions, size by size, so that a reader can stop at the size that it draws.

use alloc::vec;
use alloc::vec::Vec;

use super::rules::{Neighbours, Scaling, View, coding_order, to_grid};
use super::scores::Scores;
use super::shared::Source;
use super::shifts::{Reference, Shifts};
use super::votes::{CANDIDATES, Candidate, Votes};
use crate::number::mul_fixed;
use crate::table::context_model::{ContextModel, class};
use crate::table::elements::{HIT, MISS_FRACTION, MISS_PIXELS};
use crate::table::range::Coder;

/// Gives the probabilities of the bits of a move to its second argument.
pub type Price<'q> = dyn Fn(i32, &mut dyn FnMut(u32)) + 'q;

/// What tracks refer to.
pub(super) struct Referred<'s> {
    pub(super) sources: &'s [Source],
    /// For a writer: at each size the move of each track's shared track; 0 for one that refers to none. A reader finds them where it
    /// puts the tracks' moves.
    pub(super) moves: Vec<i16>,
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
pub(super) struct Axis<'r> {
    axis: usize,
    /// Those that are coded, in their order.
    tracks: Vec<Track>,
    /// Plain positions of all tracks, then the hinted ones at even sizes of the section, and those at odd ones.
    positions: Vec<i32>,
    /// The sizes of the section that are coded.
    coded: usize,
    /// What each track refers to.
    referred: &'r Referred<'r>,
}

/// A track, and what is known of it from smaller sizes.
struct Track {
    number: u8,
    neighbours: Neighbours,
    /// Whether a shared track predicts it.
    is_near: bool,
    /// Whether the first candidate was wrong at each of the last sizes, the last one lowest.
    misses: u8,
    scores: Scores,
    shifts: Shifts,
}

impl Track {
    fn new(number: u8, neighbours: Neighbours, is_near: bool) -> Self {
        let scores = Scores::new(neighbours.kind());
        Self { number, neighbours, is_near, misses: 0, scores, shifts: Shifts::new() }
    }
}

impl<'r> Axis<'r> {
    /// Tracks at the first size of a section, with what each refers to.
    pub(super) fn new(axis: usize, referred: &'r Referred<'r>) -> Self {
        let sources = referred.sources;
        let coded = sources.iter().filter(|source| source.is_coded()).count();
        let mut tracks = Vec::with_capacity(coded);
        if coded > 0 {
            // There are MAX_TRACKS at most.
            for (number, neighbours) in coding_order(sources.len() as u8) {
                let source = sources[usize::from(number)];
                if source.is_coded() {
                    tracks.push(Track::new(number, neighbours, matches!(source, Source::Near(_))));
                }
            }
        }
        Self { axis, referred, tracks, positions: vec![0; 3 * sources.len()], coded: 0 }
    }

    /// Codes the moves of all tracks at a size. A reader's are those of the tracks that they refer to, before.
    pub(super) fn code<C: Coder>(
        &mut self,
        model: &mut ContextModel<'_, C>,
        size: usize,
        scaling: Scaling,
        levels: &[i16],
        moves: &mut [i16],
        choose: Choose<'_>,
    ) {
        let count = self.positions.len() / 3;
        let shared = if C::WRITES { &self.referred.moves[size * count..][..count] } else { &[] };
        for ((moved, shared), source) in moves.iter_mut().zip(shared).zip(self.referred.sources) {
            *moved = if source.is_coded() { *moved } else { *shared };
        }
        if self.tracks.is_empty() {
            return;
        }
        let (plain, rest) = self.positions.split_at_mut(count);
        let (even, odd) = rest.split_at_mut(count);
        let (hinted, before) = if self.coded.is_multiple_of(2) { (even, odd) } else { (odd, even) };
        for ((plain, hinted), (level, moved)) in
            plain.iter_mut().zip(&mut *hinted).zip(levels.iter().zip(&*moves))
        {
            *plain = mul_fixed((*level).into(), scaling.factor);
            *hinted = plain.wrapping_add((*moved).into());
        }
        let plain = &*plain;
        let before = (self.coded > 0).then_some(&*before);
        let mut missed = 0;
        for track in &mut self.tracks {
            let number = usize::from(track.number);
            let shared = track.is_near.then(|| if C::WRITES { shared[number] } else { moves[number] });
            let view = View { levels, plain, hinted, before, scaling };
            let at = At { axis: self.axis, size, missed, shared };
            let (moved, is_first) = track.code(model, &view, at, moves[number], choose);
            moves[number] = moved;
            missed += usize::from(!is_first);
            hinted[number] = plain[number].wrapping_add(moved.into());
        }
        self.coded += 1;
    }
}

/// The size at which a track's position is coded.
#[derive(Clone, Copy)]
struct At {
    axis: usize,
    /// The index of the size.
    size: usize,
    /// How many tracks were missed at this size.
    missed: usize,
    /// The move of the shared track that this one refers to.
    shared: Option<i16>,
}

impl Track {
    /// Codes the move at a size; also says whether the position is the first candidate's.
    fn code<C: Coder>(
        &mut self,
        model: &mut ContextModel<'_, C>,
        view: &View<'_>,
        at: At,
        moved: i16,
        choose: Choose<'_>,
    ) -> (i16, bool) {
        // The lowest and the highest track have few rules.
        match self.neighbours.kind() {
            _ if cfg!(feature = "small") => self.code_by::<C, 3>(model, view, at, moved, choose),
            0 => self.code_by::<C, 1>(model, view, at, moved, choose),
            1 => self.code_by::<C, 2>(model, view, at, moved, choose),
            _ => self.code_by::<C, 3>(model, view, at, moved, choose),
        }
    }

    /// The same with the rules of the first `N` groups of four.
    fn code_by<C: Coder, const N: usize>(
        &mut self,
        model: &mut ContextModel<'_, C>,
        view: &View<'_>,
        at: At,
        moved: i16,
        choose: Choose<'_>,
    ) -> (i16, bool) {
        let number = usize::from(self.number);
        let plain = view.plain[number];
        let rules = view.rules::<N>(number, self.neighbours, at.shared);
        let votes = Votes::new(&rules, &self.scores);
        let state = State { misses: usize::from(self.misses & 3), missed: at.missed };
        let reference = || self.shifts.reference(&rules);
        let moved = if C::WRITES {
            asked(model, (&votes, reference()), state, choose, (at.axis, number, at.size), plain, moved)
        } else {
            moved
        };
        let wanted = plain.wrapping_add(moved.into());
        let (position, is_first) = code_position(model, votes, reference, state, wanted);
        self.misses = self.misses << 1 | u8::from(!is_first);
        // Damaged bytes may give any position.
        let moved = position.wrapping_sub(plain) as i16;
        let position = plain.wrapping_add(moved.into());
        self.scores.update(&rules, position);
        if !is_first {
            self.shifts.update(&rules, position);
        }
        (moved, is_first)
    }
}

/// What the contexts of a position are made of, beside its candidates.
#[derive(Clone, Copy)]
struct State {
    /// Whether the first candidate was wrong at the last two sizes.
    misses: usize,
    /// How many tracks were missed at this size.
    missed: usize,
}

fn asked<C: Coder, const N: usize>(
    model: &ContextModel<'_, C>,
    (votes, reference): (&Votes<N>, Reference),
    state: State,
    choose: Choose<'_>,
    (axis, track, size): (usize, usize, usize),
    plain: i32,
    wanted: i16,
) -> i16 {
    let candidates: Vec<Candidate> = votes.all().collect();
    let tried = candidates.iter().map(|c| c.position).chain([reference.position]);
    let moves: Vec<i32> = tried.map(|position| position.wrapping_sub(plain)).collect();
    let price = |moved: i32, visit: &mut dyn FnMut(u32)| {
        price(model, (&candidates, reference), votes.left, state, plain.wrapping_add(moved), visit);
    };
    let chosen = choose(&Question { axis, track, size, wanted, candidates: &moves, price: &price });
    chosen.clamp(i16::MIN.into(), i16::MAX.into()) as i16
}

/// The contexts of the bin that says whether a candidate is right. `left` is the weight of all that are not tried before it.
#[inline(always)]
fn hit_contexts(candidate: &Candidate, rank: usize, left: u32, state: State) -> [usize; 3] {
    // The share of the weight reaches 6, 10, 14 … 30 of 32 parts.
    let (mut share, mut limit) = (0, 6 * left);
    for _ in 0..7 {
        share += usize::from(candidate.weight * 32 >= limit);
        limit += 4 * left;
    }
    [
        rank * 8 + share,
        candidate.rule * 4 + class(i32::from(candidate.score >> 8), [100, 180, 235]),
        rank * 12 + state.misses * 3 + state.missed.min(2),
    ]
}

fn miss_pixels_context(reference: Reference, state: State) -> [usize; 3] {
    [reference.context * 3 + state.missed.min(2), 0, 0]
}

fn miss_fraction_context(reference: Reference, pixels: i32) -> [usize; 3] {
    let is_whole = to_grid(reference.position) == reference.position;
    [reference.context * 4 + usize::from(is_whole) * 2 + usize::from(pixels != 0), 0, 0]
}

/// The distance from the reference in whole pixels, and the rest.
fn split(position: i32, reference: Reference) -> (i32, i32) {
    let apart = position.wrapping_sub(reference.position);
    let pixels = to_grid(apart) >> 6;
    (pixels, apart.wrapping_sub(pixels << 6))
}

/// Codes a position; also says whether it is the first candidate's.
#[inline(always)]
fn code_position<C: Coder, const N: usize>(
    model: &mut ContextModel<'_, C>,
    mut votes: Votes<N>,
    reference: impl Fn() -> Reference,
    state: State,
    position: i32,
) -> (i32, bool) {
    for rank in 0..CANDIDATES {
        let Some(candidate) = votes.take() else { break };
        let contexts = hit_contexts(&candidate, rank, votes.left, state);
        if model.flag(HIT, contexts, candidate.position == position) {
            return (candidate.position, rank == 0);
        }
        votes.left -= candidate.weight;
    }
    let reference = reference();
    let (pixels, fraction) = split(position, reference);
    let pixels = model.signed(MISS_PIXELS, miss_pixels_context(reference, state), pixels);
    let fraction = model.signed(MISS_FRACTION, miss_fraction_context(reference, pixels), fraction);
    (reference.position.wrapping_add(pixels.wrapping_shl(6)).wrapping_add(fraction), false)
}

/// Gives the probabilities of the bins of a position.
fn price<C: Coder>(
    model: &ContextModel<'_, C>,
    (candidates, reference): (&[Candidate], Reference),
    total: u32,
    state: State,
    position: i32,
    visit: &mut dyn FnMut(u32),
) {
    let mut left = total;
    for (rank, candidate) in candidates.iter().enumerate() {
        let probability = model.probability(HIT, hit_contexts(candidate, rank, left, state), 0);
        if candidate.position == position {
            visit(probability);
            return;
        }
        visit((1 << 12) - probability);
        left -= candidate.weight;
    }
    let (pixels, fraction) = split(position, reference);
    model.visit_signed(MISS_PIXELS, miss_pixels_context(reference, state), pixels, visit);
    model.visit_signed(MISS_FRACTION, miss_fraction_context(reference, pixels), fraction, visit);
}

/// Codes the moves of a shared track, which has no neighbours, at the sizes of a section, each with its number and its scale.
pub(super) fn code_shared<C: Coder>(
    model: &mut ContextModel<'_, C>,
    level: i16,
    sizes: impl Iterator<Item = (usize, Scaling)>,
    moves: &mut Vec<i16>,
) {
    let mut track = Track::new(0, Neighbours::default(), false);
    let mut before = None;
    for (size, scaling) in sizes {
        let plain = [mul_fixed(level.into(), scaling.factor)];
        let view = View {
            levels: &[level],
            plain: &plain,
            hinted: &[0],
            before: before.as_ref().map(<[i32; 1]>::as_slice),
            scaling,
        };
        let at = At { axis: 0, size, missed: 0, shared: None };
        let wanted = moves.get(size).copied().unwrap_or(0);
        let (moved, _) = track.code(model, &view, at, wanted, &mut |question| question.wanted.into());
        before = Some([plain[0].wrapping_add(moved.into())]);
        if !C::WRITES {
            moves.push(moved);
        }
    }
}

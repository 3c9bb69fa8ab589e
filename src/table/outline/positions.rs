//! Coding of tracks' hinted positions, size by size, so that a reader can stop at the size that it draws.

use alloc::vec;
use alloc::vec::Vec;
use core::ops::Range;

use super::rules::{Neighbours, ROOM, Scaling, View, coding_order, to_grid};
use super::scores::{Candidate, Ranked, Scores};
use super::shared::Source;
use super::shifts::{Reference, Shifts};
use crate::number::mul_fixed;
use crate::table::context_model::{ContextModel, class};
use crate::table::elements::{HIT, MISS_FRACTION, MISS_PIXELS};
use crate::table::range::Coder;

/// Gives the probabilities of the bits of a move to its second argument.
pub type Price<'q> = dyn Fn(i32, &mut dyn FnMut(u32)) + 'q;

/// What tracks refer to.
pub(super) struct Referred<'s> {
    pub(super) sources: &'s [Source],
    /// For each track, the moves of the shared track at the sizes that are coded; zeros for one that refers to none.
    pub(super) moves: Vec<i16>,
    pub(super) sizes: Range<usize>,
}

impl Referred<'_> {
    /// The move of the shared track at a size. None if the track refers to none.
    fn moved(&self, track: usize, size: usize) -> Option<i16> {
        if !matches!(self.sources[track], Source::Same(_) | Source::Near(_)) {
            return None;
        }
        let at = track * self.sizes.len() + size.checked_sub(self.sizes.start)?;
        self.moves.get(at).copied()
    }
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
    /// All tracks with their neighbours, in the order in which their positions become known.
    order: Vec<(u8, Neighbours)>,
    /// In the same order, those whose moves are coded. Most of the tracks of many glyphs stay, or are shared.
    tracks: Vec<Track>,
    /// Plain positions of all tracks, then the hinted ones at even sizes of the section, and those at odd ones.
    positions: Vec<i32>,
    /// The sizes of the section that are coded.
    coded: usize,
    /// What each track refers to.
    referred: &'r Referred<'r>,
    /// Working memory.
    ranked: Ranked,
}

/// A track, and what is known of it from smaller sizes.
struct Track {
    scores: Scores,
    shifts: Shifts,
    /// Whether the first candidate was wrong at each of the last sizes, the last one lowest.
    misses: u8,
}

impl<'r> Axis<'r> {
    /// Tracks at the first size of a section, with what each refers to.
    pub(super) fn new(axis: usize, referred: &'r Referred<'r>) -> Self {
        // There are MAX_TRACKS at most.
        let count = referred.sources.len() as u8;
        let coded = referred.sources.iter().filter(|source| source.is_coded()).count();
        // Where nothing is coded, nothing is predicted.
        let count = if coded > 0 { count } else { 0 };
        let order = coding_order(count);
        let mut tracks = Vec::with_capacity(coded);
        tracks.extend(
            order
                .iter()
                .filter(|(number, _)| referred.sources[usize::from(*number)].is_coded())
                .map(|(_, neighbours)| Track::new(*neighbours)),
        );
        Self {
            axis,
            referred,
            order,
            tracks,
            positions: vec![0; 3 * usize::from(count)],
            coded: 0,
            ranked: Ranked::default(),
        }
    }

    /// Codes the moves of all tracks at a size.
    pub(super) fn code<C: Coder>(
        &mut self,
        model: &mut ContextModel<'_, C>,
        size: usize,
        scaling: Scaling,
        levels: &[i16],
        moves: &mut [i16],
        choose: Choose<'_>,
    ) {
        if self.tracks.is_empty() {
            for (number, moved) in moves.iter_mut().enumerate() {
                *moved = self.referred.moved(number, size).unwrap_or(0);
            }
            return;
        }
        let count = self.positions.len() / 3;
        let (plain, rest) = self.positions.split_at_mut(count);
        let (even, odd) = rest.split_at_mut(count);
        let (hinted, before) = if self.coded.is_multiple_of(2) { (even, odd) } else { (odd, even) };
        for (plain, level) in plain.iter_mut().zip(levels) {
            *plain = mul_fixed((*level).into(), scaling.factor);
        }
        let plain = &*plain;
        let before = (self.coded > 0).then_some(&*before);
        let mut missed = 0;
        let mut tracks = self.tracks.iter_mut();
        for (number, neighbours) in &self.order {
            let number = usize::from(*number);
            let shared = self.referred.moved(number, size);
            let coded = if self.referred.sources[number].is_coded() { tracks.next() } else { None };
            if let Some(track) = coded {
                let view = View { levels, plain, hinted, before, scaling };
                let at = At { axis: self.axis, number, neighbours: *neighbours, size, missed, shared };
                let (moved, is_first) = track.code(model, &view, at, &mut self.ranked, moves[number], choose);
                moves[number] = moved;
                missed += usize::from(!is_first);
            } else {
                moves[number] = shared.unwrap_or(0);
            }
            hinted[number] = plain[number].wrapping_add(moves[number].into());
        }
        self.coded += 1;
    }
}

/// Which track's position is coded, and at which size.
#[derive(Clone, Copy)]
struct At {
    axis: usize,
    number: usize,
    neighbours: Neighbours,
    /// The index of the size.
    size: usize,
    /// How many tracks were missed at this size.
    missed: usize,
    /// The move of the shared track that this one refers to.
    shared: Option<i16>,
}

impl Track {
    fn new(neighbours: Neighbours) -> Self {
        Self { scores: Scores::new(neighbours.kind()), shifts: Shifts::new(), misses: 0 }
    }

    /// Codes the move at a size; also says whether the position is the first candidate's.
    fn code<C: Coder>(
        &mut self,
        model: &mut ContextModel<'_, C>,
        view: &View<'_>,
        at: At,
        ranked: &mut Ranked,
        moved: i16,
        choose: Choose<'_>,
    ) -> (i16, bool) {
        // The lowest and the highest track have few rules.
        match at.neighbours.kind() {
            _ if cfg!(feature = "small") => self.code_by::<C, 3>(model, view, at, ranked, moved, choose),
            0 => self.code_by::<C, 1>(model, view, at, ranked, moved, choose),
            1 => self.code_by::<C, 2>(model, view, at, ranked, moved, choose),
            _ => self.code_by::<C, 3>(model, view, at, ranked, moved, choose),
        }
    }

    /// The same with the rules of the first `N` groups of four.
    fn code_by<C: Coder, const N: usize>(
        &mut self,
        model: &mut ContextModel<'_, C>,
        view: &View<'_>,
        at: At,
        ranked: &mut Ranked,
        moved: i16,
        choose: Choose<'_>,
    ) -> (i16, bool) {
        let number = at.number;
        let plain = view.plain[number];
        let rules = view.rules::<N>(number, at.neighbours, at.shared);
        self.scores.rank(&rules, ranked);
        let mut candidates = Candidates {
            ranked,
            scores: &self.scores,
            shifts: &self.shifts,
            positions: &rules.positions,
            valid: rules.valid,
        };
        let state = State { misses: usize::from(self.misses & 3), missed: at.missed };
        let moved = if C::WRITES {
            asked(model, &mut candidates, state, choose, (at.axis, number, at.size), plain, moved)
        } else {
            moved
        };
        let wanted = plain.wrapping_add(moved.into());
        let (position, is_first) = code_position(model, &mut candidates, state, wanted);
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

/// The candidates for a position.
struct Candidates<'s> {
    ranked: &'s mut Ranked,
    scores: &'s Scores,
    shifts: &'s Shifts,
    /// What the rules give, and which have what they need.
    positions: &'s [i32; ROOM],
    valid: usize,
}

impl Candidates<'_> {
    #[inline(always)]
    fn get(&mut self, rank: usize) -> Option<Candidate> {
        self.ranked.candidate(rank, self.scores)
    }

    /// What a position that none of them is counts from.
    fn reference(&self) -> Reference {
        self.shifts.reference(self.positions, self.valid)
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

fn asked<C: Coder>(
    model: &ContextModel<'_, C>,
    candidates: &mut Candidates<'_>,
    state: State,
    choose: Choose<'_>,
    (axis, track, size): (usize, usize, usize),
    plain: i32,
    wanted: i16,
) -> i16 {
    let (total, reference) = (candidates.ranked.total, candidates.reference());
    let candidates = candidates.ranked.all(candidates.scores);
    let tried = candidates.iter().map(|c| c.position).chain([reference.position]);
    let moves: Vec<i32> = tried.map(|position| position.wrapping_sub(plain)).collect();
    let price = |moved: i32, visit: &mut dyn FnMut(u32)| {
        price(model, (candidates, reference), total, state, plain.wrapping_add(moved), visit);
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
fn code_position<C: Coder>(
    model: &mut ContextModel<'_, C>,
    candidates: &mut Candidates<'_>,
    state: State,
    position: i32,
) -> (i32, bool) {
    let (mut left, mut rank) = (candidates.ranked.total, 0);
    while let Some(candidate) = candidates.get(rank) {
        if model.flag(HIT, hit_contexts(&candidate, rank, left, state), candidate.position == position) {
            return (candidate.position, rank == 0);
        }
        left -= candidate.weight;
        rank += 1;
    }
    let reference = candidates.reference();
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
    let mut track = Track::new(Neighbours::default());
    let (mut before, mut ranked) = (None, Ranked::default());
    for (size, scaling) in sizes {
        let plain = [mul_fixed(level.into(), scaling.factor)];
        let view = View {
            levels: &[level],
            plain: &plain,
            hinted: &[0],
            before: before.as_ref().map(<[i32; 1]>::as_slice),
            scaling,
        };
        let at = At { axis: 0, number: 0, neighbours: Neighbours::default(), size, missed: 0, shared: None };
        let wanted = moves.get(size).copied().unwrap_or(0);
        let (moved, _) =
            track.code(model, &view, at, &mut ranked, wanted, &mut |question| question.wanted.into());
        before = Some([plain[0].wrapping_add(moved.into())]);
        if !C::WRITES {
            moves.push(moved);
        }
    }
}

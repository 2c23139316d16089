//! An axis of half-open bins, lo ≤ x < hi, in which x is compared with exactly the edges that were given.

use super::cells::Cells;
use super::whole::ROUND;
use crate::Error;
use crate::memory::copied;
use crate::simd::Pack;
use pulp::Simd;

/// Largest deviation of an edge from uniform spacing, in bin widths, for bins that count as uniform.
const UNIFORM: f64 = 1e-7;
/// Within this distance of an edge, in bin widths, the edge itself decides; it must exceed [`UNIFORM`] and rounding.
const NEAR: f64 = 1e-6;

/// Bins between edges, with one more below and one more above.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    edges: Vec<f64>,
    /// The lowest edge and the number of edges, as the inner loop needs them; 0 where the edges are not uniform.
    low: f64,
    last: f64,
    /// The number of an additional bin, which counts undefined values.
    pub(super) beyond: f64,
    /// Difference of the numbers of a site in neighbouring rows of a grid: the number of bins plus one.
    pub(super) stride: f64,
    /// Bins per unit; 0 where the edges are not uniform.
    density: f64,
    /// The table that finds the bin where the edges are not uniform.
    cells: Option<Cells>,
}

impl Axis {
    /// The axis with these edges; `name` is for the error.
    ///
    /// # Errors
    /// [`Error::Parameter`] unless there are at least two edges, finite and increasing, and [`Error::Memory`].
    pub fn new(name: &'static str, edges: &[f64]) -> Result<Self, Error> {
        let bins = edges.len().saturating_sub(1);
        Error::unless(bins > 0, name, edges.len(), "at least two edges")?;
        Error::unless(bins <= 1 << 24, name, edges.len(), "at most 2^24 bins")?;
        let (low, high) = (edges[0], edges[bins]);
        let width = (high - low) / bins as f64;
        let density = 1.0 / width;
        Error::unless(
            width > 0.0 && width.is_finite() && density.is_finite(),
            name,
            width,
            "increasing edges, whose mean distance has a finite reciprocal",
        )?;
        for pair in edges.windows(2) {
            let increasing = pair[0] < pair[1] && pair[0].is_finite() && pair[1].is_finite();
            Error::unless(increasing, name, pair[1], "finite, increasing edges")?;
        }
        let off = |(i, &edge): (usize, &f64)| (edge - (low + i as f64 * width)).abs() * density;
        let uniform = edges.iter().enumerate().map(off).all(|off| off <= UNIFORM);
        let count = edges.len() as f64;
        Ok(Self {
            edges: copied(name, edges)?,
            low: if uniform { low } else { 0.0 },
            last: if uniform { count } else { 0.0 },
            beyond: count + 1.0,
            stride: count + 2.0,
            density: if uniform { density } else { 0.0 },
            cells: if uniform {
                None
            } else {
                Some(Cells::new(name, edges)?)
            },
        })
    }

    /// Number of bins, including those below and above.
    pub(super) fn bins(&self) -> usize {
        self.edges.len() + 1
    }

    /// Returns whether all bins have the same width.
    pub(super) fn is_even(&self) -> bool {
        self.cells.is_none()
    }

    /// Numbers of the bins of up to three quantities on an axis each, plus [`ROUND`]: 0 below, 1 to n inside, n + 1 above; any for
    /// NaN. EVEN: all bins of every axis have the same width. The search among other bins uses registers of the bounce loop even
    /// where it is skipped, so that the loop is compiled with and without it.
    #[inline(always)]
    pub(super) fn locate<S: Simd, const N: usize, const EVEN: bool>(
        axes: [&Self; N],
        x: [Pack<S>; N],
    ) -> [Pack<S>; N] {
        if EVEN {
            return Self::locate_even(axes, x);
        }
        let mut bins = x;
        // Not a loop, which would keep its packs in memory.
        bins[0] = axes[0].locate_one(x[0]);
        if N > 1 {
            bins[1] = axes[1].locate_one(x[1]);
        }
        if N > 2 {
            bins[2] = axes[2].locate_one(x[2]);
        }
        bins
    }

    #[inline(always)]
    fn locate_one<S: Simd>(&self, x: Pack<S>) -> Pack<S> {
        match &self.cells {
            Some(cells) => cells.locate(x),
            None => Self::locate_even([self], [x])[0],
        }
    }

    /// The same for bins of equal width: a single test for all axes decides whether any number is near an edge.
    #[inline(always)]
    fn locate_even<S: Simd, const N: usize>(axes: [&Self; N], x: [Pack<S>; N]) -> [Pack<S>; N] {
        let mut places = x;
        let mut bins = x;
        let mut most = Pack::splat(x[0].simd(), 0.0);
        for i in 0..N {
            places[i] = axes[i].place(x[i]);
            bins[i] = places[i] + ROUND;
            most = most.max(off(places[i], bins[i]));
        }
        if !most.lt(0.5 - NEAR).all() {
            for i in 0..N {
                bins[i] = axes[i].decided(x[i], places[i], bins[i]);
            }
        }
        bins
    }

    /// Position of `x` in bin widths; integers are the centres of the bins.
    #[inline(always)]
    fn place<S: Simd>(&self, x: Pack<S>) -> Pack<S> {
        (x - self.low)
            .mul_add(self.density, 0.5)
            .max(0.0)
            .min(self.last)
    }

    /// The bins, with the lanes that are near an edge decided by comparison with the edge.
    #[inline(always)]
    fn decided<S: Simd>(&self, x: Pack<S>, place: Pack<S>, bin: Pack<S>) -> Pack<S> {
        // Lanes are accessed one by one only here, which is rarely reached.
        let far = off(place, bin).lt(0.5 - NEAR);
        let (x, place) = (far.select(0.0, x), far.select(0.0, place));
        let mut decided = place;
        for (lane, bin) in decided.as_mut_slice().iter_mut().enumerate() {
            *bin = ROUND + self.compare(x.as_slice()[lane], *bin);
        }
        far.select(bin, decided)
    }

    /// The bin of a number that is near an edge.
    #[cold]
    #[inline(never)]
    fn compare(&self, x: f64, place: f64) -> f64 {
        let edge = (place as usize).min(self.edges.len() - 1);
        if x < self.edges[edge] {
            edge as f64
        } else {
            edge as f64 + 1.0
        }
    }
}

/// Distance of a position from the centre of its bin.
#[inline(always)]
fn off<S: Simd>(place: Pack<S>, bin: Pack<S>) -> Pack<S> {
    (place - (bin - ROUND)).abs()
}

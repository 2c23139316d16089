//! A uniform axis of half-open bins, lo ≤ x < hi, compared with the very edges that were given.

use crate::Error;
use crate::lanes::Pack;
use pulp::Simd;

/// Largest departure of an edge from uniform spacing, in bin widths.
const UNIFORM: f64 = 1e-7;
/// Within this distance of an edge, in bin widths, the edge itself decides; it must exceed [`UNIFORM`] and rounding.
const NEAR: f64 = 1e-6;
/// 1.5 · 2⁵²: adding it to |x| < 2⁵¹ rounds to the nearest integer, which then stands in the low bits.
pub(super) const ROUND: f64 = 6_755_399_441_055_744.0;

/// Bins between uniform edges, with one for what is below and one for what is above.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    edges: Vec<f64>,
    /// The lowest edge and the number of edges, at hand in the hot loop.
    low: f64,
    last: f64,
    /// What the number of a site grows by from row to row of a grid: the bins and one more.
    pub(super) stride: f64,
    /// Bins per unit.
    density: f64,
}

impl Axis {
    /// Checks that there are at least two edges, finite, increasing and uniform; `name` is for the error.
    pub fn new(name: &'static str, edges: &[f64]) -> Result<Self, Error> {
        let bins = edges.len().saturating_sub(1);
        Error::unless(bins > 0, name, edges.len() as f64, "at least two edges")?;
        Error::unless(
            bins <= 1 << 24,
            name,
            edges.len() as f64,
            "at most 2^24 bins",
        )?;
        let (low, high) = (edges[0], edges[bins]);
        let width = (high - low) / bins as f64;
        let density = 1.0 / width;
        Error::unless(
            width > 0.0 && width.is_finite() && density.is_finite(),
            name,
            width,
            "increasing edges",
        )?;
        for (i, &edge) in edges.iter().enumerate() {
            let off = (edge - (low + i as f64 * width)).abs() * density;
            Error::unless(off <= UNIFORM, name, edge, "finite, uniform edges")?;
        }
        Ok(Self {
            edges: edges.to_vec(),
            low,
            last: edges.len() as f64,
            stride: edges.len() as f64 + 2.0,
            density,
        })
    }

    /// Number of bins, those below and above included.
    pub(super) fn bins(&self) -> usize {
        self.edges.len() + 1
    }

    /// The bin after the last, where what has no bin is counted.
    #[inline(always)]
    pub(super) fn beyond(&self) -> f64 {
        self.last + 1.0
    }

    /// Numbers of the bins of N quantities on an axis each, plus [`ROUND`]: 0 below, 1 to n inside, n + 1 above. NaN may be
    /// anywhere.
    #[inline(always)]
    pub(super) fn locate<S: Simd, const K: usize, const N: usize>(
        axes: [&Self; N],
        x: [Pack<S, K>; N],
    ) -> [Pack<S, K>; N] {
        let mut places = x;
        let mut bins = x;
        let mut most = Pack::splat(x[0].simd(), 0.0);
        for i in 0..N {
            places[i] = axes[i].place(x[i]);
            bins[i] = places[i] + ROUND;
            most = most.max(off(places[i], bins[i]));
        }
        if most.lt(0.5 - NEAR).all() {
            return bins;
        }
        let mut exact = bins;
        for i in 0..N {
            exact[i] = axes[i].decided(x[i], places[i], bins[i]);
        }
        exact
    }

    /// Where `x` is, in bin widths: whole numbers are in the middle of the bins.
    #[inline(always)]
    fn place<S: Simd, const K: usize>(&self, x: Pack<S, K>) -> Pack<S, K> {
        (x - self.low)
            .mul_add(self.density, 0.5)
            .max(0.0)
            .min(self.last)
    }

    /// The bins where the edges decide in the lanes that are near one.
    #[inline(always)]
    fn decided<S: Simd, const K: usize>(
        &self,
        x: Pack<S, K>,
        place: Pack<S, K>,
        bin: Pack<S, K>,
    ) -> Pack<S, K> {
        // Lanes are in memory here only, where hardly anything ever comes.
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

/// How far a place is from the middle of its bin.
#[inline(always)]
fn off<S: Simd, const K: usize>(place: Pack<S, K>, bin: Pack<S, K>) -> Pack<S, K> {
    (place - (bin - ROUND)).abs()
}

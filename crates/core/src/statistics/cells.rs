//! Bins of arbitrary widths: a table of narrow cells gives the few edges next to a number, and comparison with them decides.
//!
//! The cell of x is computed by a formula that is monotonic in x in spite of rounding. Edges in an earlier cell are therefore below
//! x and edges in a later cell above it; only edges in the same cell have to be compared.

use super::whole::{ROUND, whole};
use crate::Error;
use crate::memory::{collected, empty, zeros};
use crate::simd::{Pack, one};
use pulp::Simd;

/// Largest number of cells, unless there are more edges: the table then fits into a cache.
const MOST: usize = 1 << 14;

/// Cells over the edges of an axis.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Cells {
    scale: Scale,
    cells: Vec<Cell>,
    /// Number of the last cell.
    last: f64,
    /// If some cell has several edges: all edges and an infinite one.
    crowded: Option<Vec<f64>>,
}

/// A cell of the table.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Cell {
    /// The lowest edge that is not in an earlier cell.
    edge: f64,
    /// Number of edges in earlier cells, plus [`ROUND`]; with a minus sign where several edges are in this one.
    number: f64,
}

/// The division of the real line into cells.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Scale {
    /// Equal intervals from the lowest to the highest edge.
    Linear { low: f64, density: f64 },
    /// On either side of a centre, fractions of octaves of the distance from it, which suit logarithmic bins and bins that are dense
    /// in one place. The cell follows from the bits of distance + `least`, which increase with the distance. Cell number `middle`
    /// begins at the centre.
    Octaves {
        centre: f64,
        least: f64,
        shift: u32,
        middle: i64,
    },
}

impl Scale {
    /// The cells of numbers, from 0 to `last`; any for NaN.
    #[inline(always)]
    fn cells<S: Simd>(self, x: Pack<S>, last: f64) -> Pack<S> {
        match self {
            Self::Linear { low, density } => ((x - low) * density).max(0.0).min(last) + ROUND,
            Self::Octaves {
                centre,
                least,
                shift,
                middle,
            } => {
                let from_centre = x - centre;
                let (mut cells, last) = (from_centre.abs() + least, last as i64);
                let from_centre = from_centre.as_slice();
                for (cell, from_centre) in cells.as_mut_slice().iter_mut().zip(from_centre) {
                    let away = ((cell.to_bits() - least.to_bits()) >> shift) as i64;
                    let cells = if *from_centre < 0.0 { !away } else { away };
                    *cell = f64::from_bits((middle + cells).clamp(0, last) as u64);
                }
                cells
            }
        }
    }

    /// At most `cells` cells in octaves about the narrowest bin.
    fn octaves(edges: &[f64], cells: usize) -> Self {
        let width = |i: &usize| edges[i + 1] - edges[*i];
        let bins = 0..edges.len() - 1;
        let densest = bins.min_by(|i, k| width(i).total_cmp(&width(k)));
        let densest = densest.expect("there are two edges");
        let (centre, least) = (edges[densest], width(&densest));
        let away = |edge: f64| ((edge - centre).abs() + least).to_bits() - least.to_bits();
        // Below the second edge there is a single bin, and no cells are needed: logarithmic bins may begin at 0.
        let below = (densest > 1).then(|| away(edges[1]));
        let above = away(edges[edges.len() - 1]);
        let middle = |shift| 1 + below.map_or(0, |below| 1 + (below >> shift));
        let fits = |shift: &u32| middle(*shift) + (above >> *shift) < cells as u64;
        let shift = (0..u64::BITS).find(fits).expect("one octave for all");
        Self::Octaves {
            centre,
            least,
            shift,
            middle: middle(shift) as i64,
        }
    }

    /// The cell of a number.
    fn cell(self, x: f64, cells: usize) -> usize {
        index(self.cells(one(x), (cells - 1) as f64).as_slice()[0], cells)
    }

    /// Number of edges in all cells before each of the `cells` cells; `name` is for the error.
    fn before(self, name: &'static str, edges: &[f64], cells: usize) -> Result<Vec<u32>, Error> {
        let mut before = zeros(name, cells + 1)?;
        for &edge in edges {
            before[self.cell(edge, cells) + 1] += 1;
        }
        for cell in 0..cells {
            before[cell + 1] += before[cell];
        }
        Ok(before)
    }
}

/// The number of a cell as an index, clamped to the table.
#[inline(always)]
fn index(cell: f64, cells: usize) -> usize {
    whole(cell).min(cells - 1)
}

/// Largest number of edges in a cell.
fn crowd(before: &[u32]) -> u32 {
    let each = before.windows(2).map(|pair| pair[1] - pair[0]);
    each.max().unwrap_or(0)
}

impl Cells {
    /// The table for increasing, finite edges: with as few cells as put every edge into a cell of its own, if that is possible.
    ///
    /// # Errors
    /// [`Error::Memory`] with `name`.
    pub fn new(name: &'static str, edges: &[f64]) -> Result<Self, Error> {
        let (low, high) = (edges[0], edges[edges.len() - 1]);
        let mut count = edges.len().next_power_of_two();
        let most = MOST.max(count);
        loop {
            let density = count as f64 / (high - low);
            let found = |scale: Scale| {
                let before = scale.before(name, edges, count)?;
                Ok((crowd(&before), scale, before))
            };
            let equal = found(Scale::Linear { low, density })?;
            let logarithmic = found(Scale::octaves(edges, count))?;
            let (crowd, scale, before) = if logarithmic.0 < equal.0 {
                logarithmic
            } else {
                equal
            };
            if crowd <= 1 || count >= most {
                let mut padded = empty(name, edges.len() + 1)?;
                padded.extend_from_slice(edges);
                padded.push(f64::INFINITY);
                let of = |pair: &[u32]| {
                    let number = f64::from(pair[0]) + ROUND;
                    let several = pair[1] - pair[0] > 1;
                    Cell {
                        edge: padded[pair[0] as usize],
                        number: if several { -number } else { number },
                    }
                };
                return Ok(Self {
                    scale,
                    cells: collected(name, before.windows(2).map(of))?,
                    last: (count - 1) as f64,
                    crowded: (crowd > 1).then_some(padded),
                });
            }
            count *= 2;
        }
    }

    /// Numbers of the bins, plus [`ROUND`]: 0 below, 1 to n inside, n + 1 above; any for NaN.
    #[inline(always)]
    pub fn locate<S: Simd>(&self, x: Pack<S>) -> Pack<S> {
        let Self {
            scale,
            cells,
            last,
            crowded,
        } = self;
        // Infinity must be above the last edge, but below the infinite one.
        let x = x.min(f64::MAX);
        let places = scale.cells(x, *last);
        let (mut edge, mut number) = (x, x);
        for lane in 0..Pack::<S>::WIDTH {
            let cell = cells[index(places.as_slice()[lane], cells.len())];
            edge.as_mut_slice()[lane] = cell.edge;
            number.as_mut_slice()[lane] = cell.number;
        }
        let several = number;
        let number = several.abs();
        let mut bins = edge.le(x).select(number + 1.0, number);
        if let Some(edges) = crowded
            && several.lt(0.0).any()
        {
            Self::compare(edges, x.as_slice(), bins.as_mut_slice());
        }
        bins
    }

    /// The bins of numbers in cells that may have several edges.
    #[cold]
    #[inline(never)]
    fn compare(edges: &[f64], x: &[f64], bins: &mut [f64]) {
        for (bin, &x) in bins.iter_mut().zip(x) {
            let more = edges[whole(*bin)..].iter().take_while(|&&edge| edge <= x);
            *bin += more.count() as f64;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn agrees(edges: &[f64], x: f64) {
        let cells = Cells::new("edges", edges).unwrap();
        let bin = cells.locate(one(x));
        let expected = edges.partition_point(|&edge| edge <= x);
        assert_eq!(whole(bin.as_slice()[0]), expected, "{x} in {edges:?}");
    }

    proptest! {
        /// As by binary search: at every edge, one bit beside it, and anywhere.
        #[test]
        fn the_edges_decide(
            mut edges in prop::collection::vec(prop_oneof![-1e3..1e3_f64, -1e-9..1e-9_f64, any::<f64>()], 2..40),
            x in prop_oneof![-1e3..1e3_f64, any::<f64>()],
        ) {
            edges.retain(|edge| edge.abs() < 1e100);
            edges.push(-2e100);
            edges.push(2e100);
            edges.sort_by(f64::total_cmp);
            edges.dedup();
            for &edge in &edges {
                for near in [edge.next_down(), edge, edge.next_up()] {
                    agrees(&edges, near);
                }
            }
            for x in [x, 0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY, f64::MAX] {
                if !x.is_nan() {
                    agrees(&edges, x);
                }
            }
        }
    }

    /// Bins of equal width, on either side of 0: no cell has several edges.
    #[test]
    fn even_bins_are_found_at_once() {
        for low in [-1.0, 0.0, 0.5] {
            let edges: Vec<_> = (0..401).map(|i| low + 0.01 * f64::from(i)).collect();
            assert_eq!(Cells::new("edges", &edges).unwrap().crowded, None);
        }
    }

    /// Bins that are dense in the midst of others, as ε is about ε_n: no cell has several edges.
    #[test]
    fn dense_bins_are_found_at_once() {
        for power in [3, 5] {
            let edges: Vec<_> = (0..121)
                .map(|i| 0.98 + (f64::from(i) / 60.0 - 1.0).powi(power))
                .collect();
            assert_eq!(Cells::new("edges", &edges).unwrap().crowded, None);
        }
    }

    /// Logarithmic bins over six decades, and with a bin from 0 before them: no cell has several edges.
    #[test]
    fn logarithmic_bins_are_found_at_once() {
        let mut edges: Vec<_> = (0..601)
            .map(|i| 10.0_f64.powf(f64::from(i) / 100.0 - 6.0))
            .collect();
        for _ in 0..2 {
            let cells = Cells::new("edges", &edges).unwrap();
            assert_eq!(cells.crowded, None);
            edges.insert(0, 0.0);
        }
    }
}

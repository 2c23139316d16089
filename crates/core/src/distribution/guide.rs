//! A guide to a list of increasing numbers: nearly all searches in it end after one or two comparisons.

use crate::Error;
use crate::memory::zeros;

/// The number of entries in the cells before each of equally wide cells, which span the middle of the list.
#[derive(Debug)]
pub(super) struct Guide {
    low: f64,
    /// Cells per unit.
    scale: f64,
    before: Vec<u32>,
}

impl Guide {
    /// A guide to points, of which there are fewer than 2³².
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn new(points: &[f64]) -> Result<Self, Error> {
        let cells = points.len().next_power_of_two();
        // The outermost points of a distribution are far apart: cells that span them all would hold most points in a few.
        let margin = points.len() / 8;
        let (low, high) = (points[margin], points[points.len() - 1 - margin]);
        let scale = cells as f64 / (high - low);
        let mut guide = Self {
            low,
            scale: if scale.is_finite() { scale } else { 0.0 },
            before: zeros("guide to a table", cells + 1)?,
        };
        for &point in points {
            let cell = guide.cell(point);
            guide.before[cell + 1] += 1;
        }
        for cell in 0..cells {
            guide.before[cell + 1] += guide.before[cell];
        }
        Ok(guide)
    }

    /// Rounded operations do not change the order of two numbers: a point in an earlier cell than x is below x, and one in a later
    /// cell above it. What lies beyond the cells belongs to the first or to the last.
    #[inline]
    fn cell(&self, x: f64) -> usize {
        (((x - self.low) * self.scale) as usize).min(self.before.len() - 2)
    }

    /// Number of the points that are not above x.
    #[inline]
    pub fn reached(&self, points: &[f64], x: f64) -> usize {
        let cell = self.cell(x);
        let (start, end) = (self.before[cell] as usize, self.before[cell + 1] as usize);
        start + points[start..end].partition_point(|&point| point <= x)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Points at equal distances, of which there are no more than cells: those of the middle three quarters lie in cells of two at most, the
    /// others in the outermost cells.
    #[test]
    fn no_cell_in_the_middle_has_many_points() {
        for number in [2_usize, 7, 8, 64, 100, 1000, 4097] {
            for (first, step) in [(0.0, 1.0), (-3.0, 0.1), (7.0, 1e-3)] {
                let points: Vec<_> = (0..number).map(|i| first + step * i as f64).collect();
                let guide = Guide::new(&points).unwrap();
                let widths = guide.before.windows(2).map(|two| two[1] - two[0]);
                let cells: Vec<_> = widths.map(|points| points as usize).collect();
                assert_eq!(cells.iter().sum::<usize>(), number);
                let last = cells.len() - 1;
                assert!(cells[1..last].iter().all(|&points| points <= 2));
                assert!(cells[0].max(cells[last]) <= number / 8 + 2);
            }
        }
    }

    /// As many as a count of all points has, at the points, between them and beyond them.
    #[test]
    fn every_point_that_is_reached_is_counted() {
        for points in [
            vec![0.3],
            vec![-1.0, 5.0],
            (0..50).map(|i| f64::from(i).powi(3)).collect(),
        ] {
            let between = points.windows(2).map(|two| 0.5 * (two[0] + two[1]));
            let beyond = [f64::NEG_INFINITY, points[0] - 1.0, 1e9, f64::INFINITY];
            for x in between.chain(beyond).chain(points.iter().copied()) {
                let reached = points.iter().filter(|&&point| point <= x).count();
                assert_eq!(
                    Guide::new(&points).unwrap().reached(&points, x),
                    reached,
                    "{x}"
                );
            }
        }
    }
}

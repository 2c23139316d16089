//! A guide to a list of increasing numbers: nearly all searches in it end after one or two comparisons.

/// How many of the numbers lie in the cells before each of equally wide cells, which span the middle of the list.
#[derive(Debug)]
pub(super) struct Guide {
    low: f64,
    /// Cells per unit.
    scale: f64,
    before: Vec<u32>,
}

impl Guide {
    /// A guide to points, of which there are fewer than 2³².
    pub fn new(points: &[f64]) -> Self {
        let cells = points.len().next_power_of_two();
        // The outermost points of a distribution are far apart: cells that span them all would hold most points in a few.
        let margin = points.len() / 8;
        let (low, high) = (points[margin], points[points.len() - 1 - margin]);
        let scale = cells as f64 / (high - low);
        let mut guide = Self {
            low,
            scale: if scale.is_finite() { scale } else { 0.0 },
            before: vec![0; cells + 1],
        };
        for &point in points {
            let cell = guide.cell(point);
            guide.before[cell + 1] += 1;
        }
        for cell in 0..cells {
            guide.before[cell + 1] += guide.before[cell];
        }
        guide
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

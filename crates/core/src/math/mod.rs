//! Vectors, of one particle or of one in each lane, symmetric matrices, rotations, zeros of polynomials, the normal distribution, and
//! functions by their values at the nodes of a quadrature.

pub(crate) mod flat;
pub(crate) mod gaussian;
pub(crate) mod nodal;
pub(crate) mod quaternion;
pub(crate) mod roots;
mod symmetric;
mod vector;

pub use quaternion::Quaternion;
pub(crate) use quaternion::{Quaternions, sum};
pub use symmetric::Symmetric;
pub(crate) use symmetric::UNITS;
pub(crate) use vector::Vectors;
pub use vector::{Part, Vector};

/// Nodes of Gauss's quadrature with 16 points, and their weights; each stands for its mirror image as well.
const GAUSS: [[f64; 2]; 8] = [
    [0.989_400_934_991_649_9, 0.027_152_459_411_754_096],
    [0.944_575_023_073_232_6, 0.062_253_523_938_647_894],
    [0.865_631_202_387_831_8, 0.095_158_511_682_492_79],
    [0.755_404_408_355_003, 0.124_628_971_255_533_88],
    [0.617_876_244_402_643_8, 0.149_595_988_816_576_74],
    [0.458_016_777_657_227_37, 0.169_156_519_395_002_54],
    [0.281_603_550_779_258_9, 0.182_603_415_044_923_58],
    [0.095_012_509_837_637_44, 0.189_450_610_455_068_5],
];

/// Nodes of Gauss's quadrature from −1 to 1 with 16 points, and their weights.
pub(crate) fn gauss() -> impl Iterator<Item = (f64, f64)> {
    let both = |[node, weight]: [f64; 2]| [(-node, weight), (node, weight)];
    GAUSS.into_iter().flat_map(both)
}

/// Adds a value to each sum.
#[inline(always)]
pub(crate) fn add_to<const N: usize>(sums: &mut [f64; N], values: [f64; N]) {
    for (sum, value) in sums.iter_mut().zip(values) {
        *sum += value;
    }
}

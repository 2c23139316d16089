//! Operations of the laws on the matrix K (10), so that each formula stands once, for every K.

use super::Components;
use crate::simd::Pack;
use pulp::Simd;

/// The matrix K of the contact in each lane: that of a body of revolution, or of any body.
pub(super) trait Compliant<S: Simd> {
    /// K_nn.
    fn nn(&self) -> Pack<S, 1>;

    /// The components of the contact velocity along **u** and **w** after an impulse along **n**.
    fn pushed(&self, normal: Pack<S, 1>, velocity: &Components<Pack<S, 1>>) -> [Pack<S, 1>; 2];

    /// The impulse that changes the contact velocity by `change`: K P = Δ**v**_c (10). Without `SPACE` nothing happens along **w**.
    fn impulse<const SPACE: bool>(&self, change: Components<Pack<S, 1>>) -> Components<Pack<S, 1>>;
}

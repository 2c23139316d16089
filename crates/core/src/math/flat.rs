//! Vectors in a plane.

/// a × b.
#[inline]
pub(crate) fn cross(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

/// a·b.
#[inline]
pub(crate) fn scalar(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// |a|. That of the platform's library has another last bit on another platform.
#[inline]
pub(crate) fn norm(a: [f64; 2]) -> f64 {
    scalar(a, a).sqrt()
}

/// The components of v in axes of which the first is turned to this direction.
#[inline]
pub(crate) fn rotate(axis: [f64; 2], v: [f64; 2]) -> [f64; 2] {
    [scalar(axis, v), cross(axis, v)]
}

/// The vector that has these components there.
#[inline]
pub(crate) fn rotate_back(axis: [f64; 2], v: [f64; 2]) -> [f64; 2] {
    rotate([axis[0], -axis[1]], v)
}

/// cot(δ/2), δ the angle from one direction to another, in turns to this side between 0 and 1.
#[inline]
pub(crate) fn half_cotangent(from: [f64; 2], to: [f64; 2], side: f64) -> f64 {
    let (sine, cosine) = (side * cross(from, to), scalar(from, to));
    if cosine >= 0.0 {
        (1.0 + cosine) / sine
    } else {
        sine / (1.0 - cosine)
    }
}

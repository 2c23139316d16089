//! The parts with which a body touches another body: on a plane only its convex hull can.
//!
//! Each is convex, and the Minkowski sum of a polyhedron (a point, a segment, or one with faces) and of a superellipsoid, or an ellipsoid whose support function is
//! √(**u**·B**u**): a ball has B = ρ²I, a disc, which makes a cylinder of a segment, B = ρ²(I − **aa**), and a polyhedron by itself B = 0.

use super::hull::triangles;
use super::surface::Superellipsoid;
use crate::math::{Quaternion, Symmetric, UNITS, Vector};
use crate::simd::Level;
use pulp::{Simd, WithSimd};

/// A part of a body, in m and the principal axes, from the centre of mass.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Piece {
    pub kind: PieceKind,
    /// The corners of the polyhedron; of a ball its centre.
    pub corners: Vec<Vector>,
    pub features: Vec<Feature>,
    pub round: Round,
    /// The radius of a ball whose sum with something convex it is, as large as this can be.
    pub ball: f64,
    /// The largest distance of a point of that from the centre of mass.
    pub reach: f64,
    /// Of what is symmetric about a principal axis: the largest height of a corner on it, and the semi-axes of an ellipsoid along and across with which
    /// the rest without the ball fits.
    pub extents: [f64; 3],
}

/// The round portion of a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Round {
    /// B.
    Ellipsoid(Symmetric),
    /// With its axes.
    Superellipsoid(Superellipsoid, [Vector; 3]),
}

/// The kind of a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum PieceKind {
    /// A ball with this centre and this radius.
    Ball(Vector, f64),
    Convex,
    /// Fixed in space, with the normal z.
    Plane,
}

/// A corner, an edge or a face of a part: a corner of it, and the directions to which the normal is perpendicular where it touches.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Feature {
    pub corner: Vector,
    pub ties: Vec<Vector>,
    /// The outward normal of a face.
    pub normal: Option<Vector>,
}

impl Feature {
    fn new(corner: Vector, ties: &[Vector]) -> Self {
        let normal = match ties {
            [a, b] => {
                let across = a.cross(*b);
                Some(across / across.norm())
            }
            _ => None,
        };
        Self {
            corner,
            ties: ties.to_vec(),
            normal,
        }
    }
}

/// The matter between the parts that touch a plane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Extent {
    /// The body is made of balls.
    Balls,
    /// It is its convex hull.
    Hull,
    /// Neither.
    Other,
}

impl Round {
    /// True for nothing, the rest of a polyhedron.
    #[inline(always)]
    pub fn is_point(&self) -> bool {
        *self == Self::Ellipsoid(Symmetric::default())
    }

    /// h(**u**), the support, and h times its gradient, the place that touches.
    #[inline(always)]
    pub fn support(&self, u: Vector) -> (Vector, f64) {
        match self {
            Self::Ellipsoid(round) => {
                let pushed = *round * u;
                (pushed, u.dot(pushed).max(0.0).sqrt())
            }
            Self::Superellipsoid(surface, axes) => {
                let support = FarthestPlace(surface, axes, u);
                Level::run_scalar(support)
            }
        }
    }

    /// The second derivatives **a**·h″**a**, **a**·h″**b** and **b**·h″**b** at **u**, given h times the gradient, and h > 0.
    #[inline(always)]
    pub fn bends(&self, u: Vector, [a, b]: [Vector; 2], (pushed, size): (Vector, f64)) -> [f64; 3] {
        match self {
            Self::Ellipsoid(round) => {
                let part = 1.0 / size;
                let [p, q] = [a.dot(pushed) * part, b.dot(pushed) * part];
                let [along, across] = [*round * a, *round * b];
                [
                    (a.dot(along) - p * p) * part,
                    (b.dot(along) - p * q) * part,
                    (b.dot(across) - q * q) * part,
                ]
            }
            Self::Superellipsoid(surface, axes) => {
                let bends = RadiiOfCurvature(surface, axes, [u, a, b]);
                Level::run_scalar(bends)
            }
        }
    }
}

/// [`Round::support`] of a superellipsoid: a function of its own, since what stands in its place in the search of other bodies makes that slower by half.
struct FarthestPlace<'a>(&'a Superellipsoid, &'a [Vector; 3], Vector);

impl WithSimd for FarthestPlace<'_> {
    type Output = (Vector, f64);

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let Self(surface, [x, y, z], u) = self;
        let own = Vector::new(x.dot(u), y.dot(u), z.dot(u));
        let (size, place) = surface.farthest(own);
        let place = z.mul_add(place.z, y.mul_add(place.y, *x * place.x));
        (place * size, size)
    }
}

/// [`Round::bends`] of one.
struct RadiiOfCurvature<'a>(&'a Superellipsoid, &'a [Vector; 3], [Vector; 3]);

impl WithSimd for RadiiOfCurvature<'_> {
    type Output = [f64; 3];

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Self::Output {
        let Self(surface, [x, y, z], given) = self;
        let [u, a, b] = given.map(|v| Vector::new(x.dot(v), y.dot(v), z.dot(v)));
        surface.bends(u, [a, b])
    }
}

impl Piece {
    /// The plane.
    pub(crate) fn plane() -> Self {
        Self {
            kind: PieceKind::Plane,
            ..Self::convex(vec![Vector::default()], vec![], Symmetric::default())
        }
    }

    pub(super) fn ball(centre: Vector, radius: f64) -> Self {
        Self {
            kind: PieceKind::Ball(centre, radius),
            ball: radius,
            reach: centre.norm(),
            ..Self::ellipsoid([radius; 3], Quaternion::IDENTITY, centre)
        }
    }

    fn convex(corners: Vec<Vector>, features: Vec<Feature>, round: Symmetric) -> Self {
        let distances = corners.iter().map(|corner| corner.norm());
        let (squares, _) = round.principal();
        let [a, b, c] = squares.map(|square| square.max(0.0).sqrt());
        let (least, most) = (a.min(b).min(c), a.max(b).max(c));
        // The least radius of curvature of an ellipsoid, where it is most pointed.
        let ball = if most > 0.0 {
            least * least / most
        } else {
            0.0
        };
        Self {
            kind: PieceKind::Convex,
            reach: distances.fold(0.0, f64::max) + (most - ball),
            corners,
            features,
            round: Round::Ellipsoid(round),
            ball,
            extents: [0.0; 3],
        }
    }

    /// An ellipsoid whose axes and centre are these in those of the body.
    pub(super) fn ellipsoid(semi_axes: [f64; 3], axes: Quaternion, centre: Vector) -> Self {
        let round = Symmetric::turned(semi_axes.map(|axis| axis * axis), axes);
        Self::convex(vec![centre], vec![Feature::new(centre, &[])], round)
    }

    /// A superellipsoid with these axes and this centre, and the largest distance of a point from the centre of mass.
    pub(super) fn superellipsoid(
        surface: Superellipsoid,
        axes: Quaternion,
        centre: Vector,
        reach: f64,
    ) -> Self {
        let round = Round::Superellipsoid(surface, UNITS.map(|unit| axes.rotate(unit)));
        let corner = Feature::new(centre, &[]);
        Self {
            round,
            reach,
            ..Self::convex(vec![centre], vec![corner], Symmetric::default())
        }
    }

    /// A segment rounded by a ball, or by a disc across it, whose flat sides are faces.
    pub(super) fn rod(ends: [Vector; 2], radius: f64, flat: bool) -> Self {
        let along = ends[1] - ends[0];
        let axis = along / along.norm();
        let mut features = vec![Feature::new(ends[0], &[along])];
        features.extend(ends.map(|end| Feature::new(end, &[])));
        let square = radius * radius;
        let mut round = Symmetric::diagonal([square; 3]);
        if flat {
            round = round + Symmetric::square(axis, -square);
            let across = axis.across();
            let [x, y] = [across, axis.cross(across)];
            features.push(Feature::new(ends[1], &[x, y]));
            features.push(Feature::new(ends[0], &[y, x]));
        }
        Self::convex(ends.to_vec(), features, round)
    }

    pub(super) fn polyhedron(corners: Vec<Vector>) -> Option<Self> {
        let triangles = triangles(&corners)?;
        let mut features: Vec<Feature> = corners.iter().map(|&at| Feature::new(at, &[])).collect();
        let mut edges: Vec<([usize; 2], Vector)> = Vec::new();
        for triangle in triangles {
            let [a, b, c] = triangle.map(|i| corners[i]);
            let (e, f) = (b - a, c - a);
            // The centre of mass is inside.
            let outward = e.cross(f).dot(a) > 0.0;
            let face = Feature::new(a, &if outward { [e, f] } else { [f, e] });
            let normal = face.normal?;
            let is_new = |other: &Feature| other.normal.is_none_or(|n| n.dot(normal) < 1.0 - 1e-12);
            if features.iter().all(is_new) {
                features.push(face);
            }
            // The numbers of a triangle ascend.
            for [i, j] in [[0, 1], [1, 2], [0, 2]] {
                let ends = [triangle[i], triangle[j]];
                let Some(place) = edges.iter().position(|edge| edge.0 == ends) else {
                    edges.push((ends, normal));
                    continue;
                };
                // An edge between two triangles of one face is none.
                if edges.swap_remove(place).1.dot(normal) < 1.0 - 1e-12 {
                    let [from, to] = ends.map(|end| corners[end]);
                    features.push(Feature::new(from, &[to - from]));
                }
            }
        }
        Some(Self::convex(corners, features, Symmetric::default()))
    }

    /// True of a body of revolution about the principal axis of this number.
    pub(crate) fn is_round_about(&self, axis: usize) -> bool {
        let Round::Ellipsoid(round) = self.round else {
            return false;
        };
        let [_, f, g] = around(axis);
        let on = |v: &Vector| v.dot(f) == 0.0 && v.dot(g) == 0.0;
        let sides = self.features.iter().all(|feature| match feature.normal {
            Some(normal) => on(&normal),
            None => feature.ties.iter().all(on),
        });
        let [one, two] = [f, g].map(|u| round * u);
        self.corners.iter().all(on) && sides && one == f * one.dot(f) && two == g * one.dot(f)
    }

    /// With [`Self::extents`] about a principal axis.
    pub(crate) fn about(mut self, axis: usize) -> Self {
        let [e, f, _] = around(axis);
        let height = self.corners.iter().map(|corner| corner.dot(e).abs());
        let [along, across] = [e, f].map(|u| (self.round.support(u).1 - self.ball).max(0.0));
        self.extents = [height.fold(0.0, f64::max), along, across];
        self
    }

    /// The largest distance of its points, without its ball, from an axis through the centre of mass; sine and cosine of the angle between that axis and its
    /// own. It is the largest support across that axis, and √(**u**·B**u**) − ϱ at most that of an ellipsoid whose axes are shorter by ϱ.
    #[inline(always)]
    pub(crate) fn swing(&self, sine: f64, cosine: f64) -> f64 {
        let [height, along, across] = self.extents;
        let [x, y] = [along * sine, across * cosine];
        height.mul_add(sine, x.mul_add(x, y * y).sqrt().max(across))
    }

    /// The support in a direction of any length, and the place of the point that lies farthest; of several corners that which moves farthest as the
    /// direction changes by `turning`.
    #[inline(always)]
    pub(crate) fn support(&self, u: Vector, turning: Vector) -> (f64, Vector) {
        let mut best = (f64::NEG_INFINITY, self.corners[0]);
        let tie = 1e-12 * self.reach * u.norm();
        for &corner in &self.corners {
            let height = u.dot(corner);
            if height > best.0 + tie
                || height > best.0 - tie && turning.dot(corner) > turning.dot(best.1)
            {
                best = (height.max(best.0), corner);
            }
        }
        let (pushed, size) = self.round.support(u);
        if size > 0.0 {
            (best.0 + size, best.1 + pushed / size)
        } else {
            best
        }
    }
}

/// A principal axis and the next two.
fn around(axis: usize) -> [Vector; 3] {
    [0, 1, 2].map(|i| UNITS[(axis + i) % 3])
}

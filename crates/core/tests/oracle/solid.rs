//! Bodies of revolution: mass and inertia by quadrature over slices, and what of them touches the plane.

use super::algebra::{Matrix, NORMAL, Vector, apply, plus, times};
use restitution_core::{Dumbbell, LoadedSphere, Solid, Spherocylinder, Spheroid};
use std::f64::consts::PI;

/// A shape by its parameters, in SI units.
#[derive(Debug, Clone, Copy)]
pub enum Shape {
    Dumbbell {
        radius: [f64; 2],
        separation: f64,
        density: [f64; 2],
    },
    LoadedSphere {
        radius: f64,
        density: f64,
        load: f64,
        offset: f64,
    },
    Spherocylinder {
        radius: f64,
        separation: f64,
        density: f64,
    },
    Spheroid {
        equatorial: f64,
        polar: f64,
        density: f64,
    },
}

/// What of a body can touch the plane, measured from the centre of mass.
#[derive(Debug, Clone)]
pub enum Hull {
    /// Spheres on the axis, by name.
    Balls(Vec<Ball>),
    /// A spheroid with these semi-axes across and along its axis.
    Spheroid { equatorial: f64, polar: f64 },
}

#[derive(Debug, Clone, Copy)]
pub struct Ball {
    pub name: i8,
    pub place: f64,
    pub radius: f64,
}

/// A rigid body.
#[derive(Debug, Clone)]
pub struct Body {
    pub mass: f64,
    pub transverse: f64,
    pub axial: f64,
    /// Along the axis, from the middle of the shape.
    pub centre: f64,
    pub hull: Hull,
}

/// Mass, first moment, and inertia about the axis and across it, all about the origin.
#[derive(Default)]
struct Sums {
    mass: f64,
    first: f64,
    across: f64,
    axial: f64,
}

impl Sums {
    /// Adds the slices of a body whose squared radius at z is a polynomial of second degree. Five nodes after Gauss and
    /// Legendre are exact up to the ninth degree, and the integrands have the fourth.
    fn slices(&mut self, from: f64, to: f64, density: f64, square: impl Fn(f64) -> f64) {
        let root = |sign: f64| (5.0 + sign * 2.0 * (10.0_f64 / 7.0).sqrt()).sqrt() / 3.0;
        let weight = |sign: f64| (322.0 + sign * 13.0 * 70.0_f64.sqrt()) / 900.0;
        let nodes = [
            (0.0, 128.0 / 225.0),
            (root(-1.0), weight(1.0)),
            (-root(-1.0), weight(1.0)),
            (root(1.0), weight(-1.0)),
            (-root(1.0), weight(-1.0)),
        ];
        for (x, weight) in nodes {
            let z = 0.5 * (from + to) + 0.5 * (to - from) * x;
            let square = square(z);
            let mass = density * PI * square * weight * 0.5 * (to - from);
            self.mass += mass;
            self.first += mass * z;
            self.across += mass * (0.25 * square + z * z);
            self.axial += mass * 0.5 * square;
        }
    }

    fn ball(&mut self, centre: f64, radius: f64, density: f64) {
        self.segment(centre, radius, density, [centre - radius, centre + radius]);
    }

    fn segment(&mut self, centre: f64, radius: f64, density: f64, [from, to]: [f64; 2]) {
        self.slices(from, to, density, |z| {
            (radius - (z - centre)) * (radius + (z - centre))
        });
    }

    fn body(self, hull: impl FnOnce(f64) -> Hull) -> Body {
        let centre = self.first / self.mass;
        Body {
            mass: self.mass,
            transverse: self.across - self.first * centre,
            axial: self.axial,
            centre,
            hull: hull(centre),
        }
    }
}

impl Shape {
    /// The body that the engine is given.
    pub fn solid(&self) -> Solid {
        match *self {
            Self::Dumbbell {
                radius,
                separation,
                density,
            } => Dumbbell::unequal(radius, separation, density)
                .unwrap()
                .into(),
            Self::LoadedSphere {
                radius,
                density,
                load,
                offset,
            } => LoadedSphere::new(radius, density, load, offset)
                .unwrap()
                .into(),
            Self::Spherocylinder {
                radius,
                separation,
                density,
            } => Spherocylinder::new(radius, separation, density)
                .unwrap()
                .into(),
            Self::Spheroid {
                equatorial,
                polar,
                density,
            } => Spheroid::new(equatorial, polar, density).unwrap().into(),
        }
    }

    /// The longest radius.
    pub fn size(&self) -> f64 {
        match *self {
            Self::Dumbbell { radius, .. } => radius[0].max(radius[1]),
            Self::LoadedSphere { radius, .. } | Self::Spherocylinder { radius, .. } => radius,
            Self::Spheroid {
                equatorial, polar, ..
            } => equatorial.max(polar),
        }
    }

    /// The body that the oracle works out itself.
    pub fn body(&self) -> Body {
        let mut sums = Sums::default();
        match *self {
            Self::Dumbbell {
                radius,
                separation,
                density,
            } => dumbbell(radius, separation, density),
            Self::LoadedSphere {
                radius,
                density,
                load,
                offset,
            } => {
                sums.ball(0.0, radius, density);
                sums.mass += load;
                sums.first += load * offset;
                sums.across += load * offset * offset;
                sums.body(|centre| balls(&[(1, -centre, radius)]))
            }
            Self::Spherocylinder {
                radius,
                separation,
                density,
            } => {
                let end = 0.5 * separation;
                sums.segment(end, radius, density, [end, end + radius]);
                sums.slices(-end, end, density, |_| radius * radius);
                sums.segment(-end, radius, density, [-end - radius, -end]);
                sums.body(|_| balls(&[(1, end, radius), (2, -end, radius)]))
            }
            Self::Spheroid {
                equatorial,
                polar,
                density,
            } => {
                let slender = equatorial / polar;
                sums.slices(-polar, polar, density, |z| {
                    slender * slender * (polar - z) * (polar + z)
                });
                sums.body(|_| Hull::Spheroid { equatorial, polar })
            }
        }
    }
}

fn balls(list: &[(i8, f64, f64)]) -> Hull {
    let ball = |&(name, place, radius): &(i8, f64, f64)| Ball {
        name,
        place,
        radius,
    };
    Hull::Balls(list.iter().map(ball).collect())
}

/// Two spheres, cut where they meet; each side has its density.
fn dumbbell(radius: [f64; 2], separation: f64, density: [f64; 2]) -> Body {
    let (one, two) = (0.5 * separation, -0.5 * separation);
    let mut sums = Sums::default();
    for (i, name) in [(0, 1), (1, 2)] {
        let engulfs = radius[i] - radius[1 - i] >= separation && radius[i] > radius[1 - i];
        if engulfs {
            let place = [one, two][i];
            sums.ball(place, radius[i], density[i]);
            return sums.body(|centre| balls(&[(name, place - centre, radius[i])]));
        }
    }
    if separation >= radius[0] + radius[1] {
        sums.ball(one, radius[0], density[0]);
        sums.ball(two, radius[1], density[1]);
    } else {
        let cut = if radius[0] == radius[1] {
            0.0
        } else {
            (radius[1] - radius[0]) * (radius[1] + radius[0]) / (2.0 * separation)
        };
        sums.segment(one, radius[0], density[0], [cut, one + radius[0]]);
        sums.segment(two, radius[1], density[1], [two - radius[1], cut]);
    }
    sums.body(|centre| balls(&[(1, one - centre, radius[0]), (2, two - centre, radius[1])]))
}

impl Body {
    /// The body with all its numbers off by what `factor` says of each: lengths by as much as its size is.
    pub fn blurred(&self, mut factor: impl FnMut() -> f64) -> Self {
        let hull = match &self.hull {
            Hull::Balls(balls) => Hull::Balls(
                balls
                    .iter()
                    .map(|ball| Ball {
                        place: ball.place + ball.radius * (factor() - 1.0),
                        radius: ball.radius * factor(),
                        ..*ball
                    })
                    .collect(),
            ),
            Hull::Spheroid { equatorial, polar } => Hull::Spheroid {
                equatorial: equatorial * factor(),
                polar: polar * factor(),
            },
        };
        Self {
            mass: self.mass * factor(),
            transverse: self.transverse * factor(),
            axial: self.axial * factor(),
            centre: self.centre,
            hull,
        }
    }

    /// The inertia tensor about the centre of mass.
    pub fn inertia(&self, axis: Vector) -> Matrix {
        self.spread(self.transverse, self.axial, axis)
    }

    /// `across` times the unit matrix, and `along` in the direction of the axis.
    fn spread(&self, across: f64, along: f64, axis: Vector) -> Matrix {
        let mut matrix = [[0.0; 3]; 3];
        for i in 0..3 {
            for j in 0..3 {
                let unit = if i == j { across } else { 0.0 };
                matrix[i][j] = unit + (along - across) * axis[i] * axis[j];
            }
        }
        matrix
    }

    /// True if all that can touch is spheres in one place, of which it does not matter which one does.
    pub fn is_ball(&self) -> bool {
        match &self.hull {
            Hull::Balls(balls) => balls.iter().all(|ball| ball.place == balls[0].place),
            Hull::Spheroid { .. } => false,
        }
    }

    /// The parts that can touch.
    pub fn parts(&self) -> usize {
        match &self.hull {
            Hull::Balls(balls) => balls.len(),
            Hull::Spheroid { .. } => 1,
        }
    }

    /// From the centre of mass to the lowest point of a part: −∂h/∂**n** of its support function h.
    pub fn lowest_point(&self, part: usize, axis: Vector) -> Vector {
        match &self.hull {
            Hull::Balls(balls) => plus(
                times(balls[part].place, axis),
                times(-balls[part].radius, NORMAL),
            ),
            Hull::Spheroid { equatorial, polar } => {
                let (a2, c2) = (equatorial * equatorial, polar * polar);
                let below = apply(&self.spread(a2, c2, axis), NORMAL);
                times(-1.0 / below[2].sqrt(), below)
            }
        }
    }

    /// The number under which the contact of a part is recorded.
    pub fn name(&self, part: usize, axis: Vector) -> i8 {
        match &self.hull {
            Hull::Balls(balls) => balls[part].name,
            Hull::Spheroid { .. } if axis[2] < 0.0 => 1,
            Hull::Spheroid { .. } => 2,
        }
    }

    /// A bound on d²h/dt² while e_z = c + A cos Ωt, over Ω²; h is the height of the centre of mass above the lowest point.
    ///
    /// Of a ball h = ϱ − s e_z. Of a spheroid h² = a² + De_z², D = c² − a², hence
    /// d²h/dt² = D e_z e_z″/h + D a² e_z′²/h³ with |e_z| ≤ |c| + A, |e_z″| ≤ AΩ² and |e_z′| ≤ AΩ; the second term is
    /// negative where D is, and otherwise h ≥ a.
    pub fn bend(&self, amplitude: f64, reach: f64) -> f64 {
        match &self.hull {
            Hull::Balls(balls) => {
                let longest = balls.iter().map(|ball| ball.place.abs());
                amplitude * longest.fold(0.0, f64::max)
            }
            Hull::Spheroid { equatorial, polar } => {
                let excess = polar * polar - equatorial * equatorial;
                let first = excess.abs() * reach * amplitude / equatorial.min(*polar);
                first + excess.max(0.0) * amplitude * amplitude / equatorial
            }
        }
    }
}

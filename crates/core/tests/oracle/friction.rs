//! Coulomb friction along the path of an impact, integrated in the normal impulse p.
//!
//! While the contact slips, d**P**_t/dp = −μ**s**/|**s**|; everything else follows from d**v**_c = K d**P**. The equation is solved by
//! Gauss's collocation of the sixteenth order in steps that are a part of |**s**|/|d**s**/dp|, so that the slip may turn
//! as quickly as it likes; after enough of them nothing is left of a slip that stops.

use super::impact::{Answer, Contact};
use restitution_core::Hypothesis;
use std::sync::LazyLock;

/// Slip, normal velocity, friction impulse, and the work of the normal force so far, ∫v_n dp.
const SIZE: usize = 6;
type Path = [f64; SIZE];
const NORMAL_VELOCITY: usize = 2;
const WORK: usize = 5;

/// A step turns or brakes the slip by no more than this part of it.
const STEP: f64 = 0.25;
/// Slip that, until it stopped, would turn aside by no more than this part of the impulse so far goes straight on; so does slip that
/// gets faster, if its rate is no more than this aside of it.
const STRAIGHT: f64 = 0.25 * f64::EPSILON;
const STAGES: usize = 8;
const MOST_ITERATIONS: usize = 40;

struct Motion<'a> {
    contact: &'a Contact,
    friction: f64,
    /// The most that |d**s**/dp| can be.
    stiffness: f64,
}

/// When the impact is over.
#[derive(Clone, Copy)]
enum End {
    Compressed,
    /// The contact approaches again.
    Pressed,
    Speed(f64),
    Impulse(f64),
    Work(f64),
}

impl End {
    /// The further normal impulse that it takes where dv_n/dp is `stiffness`.
    fn length(&self, p: f64, path: &Path, stiffness: f64) -> f64 {
        let speed = path[NORMAL_VELOCITY];
        match self {
            Self::Impulse(impulse) => impulse - p,
            Self::Pressed if stiffness < 0.0 => -speed / stiffness,
            _ if stiffness <= 0.0 => f64::INFINITY, // the contact jams
            Self::Pressed => f64::INFINITY,
            Self::Compressed => -speed / stiffness,
            Self::Speed(wanted) => (wanted - speed) / stiffness,
            Self::Work(work) => {
                let left = work - path[WORK];
                2.0 * left / (speed + (speed * speed + 2.0 * stiffness * left).sqrt())
            }
        }
    }

    /// Negative until this end is reached.
    fn lack(&self, p: f64, path: &Path) -> f64 {
        match self {
            Self::Compressed => path[NORMAL_VELOCITY],
            Self::Pressed => -path[NORMAL_VELOCITY],
            Self::Speed(speed) => path[NORMAL_VELOCITY] - speed,
            Self::Impulse(impulse) => p - impulse,
            Self::Work(work) => path[WORK] - work,
        }
    }
}

impl Motion<'_> {
    /// dy/dp, with friction `pull` per unit of normal impulse.
    fn pulled(&self, pull: [f64; 2], path: &Path) -> Path {
        let k = &self.contact.response;
        let row = |i: usize| k[i][2] + k[i][0] * pull[0] + k[i][1] * pull[1];
        [
            row(0),
            row(1),
            row(2),
            pull[0],
            pull[1],
            path[NORMAL_VELOCITY],
        ]
    }

    /// dy/dp while the contact slips.
    fn slipping(&self, path: &Path) -> Path {
        let size = path[0].hypot(path[1]);
        let pull = [0, 1].map(|i| -self.friction * path[i] / size);
        self.pulled(pull, path)
    }

    /// The friction that goes with a contact at rest along the plane: what keeps it there, or, where the cone is too narrow, that of
    /// the one direction into which it can start to slip.
    fn resting(&self) -> [f64; 2] {
        let k = &self.contact.response;
        let determinant = k[0][0] * k[1][1] - k[0][1] * k[1][0];
        let hold = [
            -(k[1][1] * k[0][2] - k[0][1] * k[1][2]) / determinant,
            -(k[0][0] * k[1][2] - k[1][0] * k[0][2]) / determinant,
        ];
        if hold[0].hypot(hold[1]) <= self.friction {
            return hold;
        }
        // The slip starts towards **d** if d**s**/dp is along **d**: the product of both vanishes there.
        let along = |angle: f64| {
            let d = [angle.cos(), angle.sin()];
            let rate = self.pulled(d.map(|x| -self.friction * x), &[0.0; SIZE]);
            (
                d[0] * rate[1] - d[1] * rate[0],
                d[0] * rate[0] + d[1] * rate[1],
                d,
            )
        };
        let start = k[1][2].atan2(k[0][2]) - 0.5; // it starts close to where K_tn pushes
        const PARTS: usize = 720;
        let angle = |i: usize| start + std::f64::consts::TAU * i as f64 / PARTS as f64;
        for i in 0..PARTS {
            let (mut low, mut high) = (angle(i), angle(i + 1));
            if along(low).0 * along(high).0 > 0.0 {
                continue;
            }
            for _ in 0..100 {
                let middle = 0.5 * (low + high);
                if along(low).0 * along(middle).0 > 0.0 {
                    low = middle;
                } else {
                    high = middle;
                }
            }
            let (_, growth, direction) = along(high);
            if growth > 0.0 {
                return direction.map(|x| -self.friction * x);
            }
        }
        panic!("no direction to slip in: {k:?}")
    }

    /// y after a step of `length` while the contact slips: Gauss's collocation, its stages by iteration.
    fn advanced(&self, path: &Path, length: f64) -> Path {
        let Gauss { weights, stages } = &*GAUSS;
        let mut rates = [self.slipping(path); STAGES];
        let mut places = [*path; STAGES];
        for _ in 0..MOST_ITERATIONS {
            let before = places;
            for (place, stage) in places.iter_mut().zip(stages) {
                for i in 0..2 {
                    let change: f64 = stage.iter().zip(&rates).map(|(a, rate)| a * rate[i]).sum();
                    place[i] = path[i] + length * change;
                }
            }
            for (rate, place) in rates.iter_mut().zip(&places) {
                *rate = self.slipping(place);
            }
            let change = |(a, b): (&Path, &Path)| (a[0] - b[0]).abs() + (a[1] - b[1]).abs();
            let most = places.iter().zip(&before).map(change).fold(0.0, f64::max);
            if most <= 0.25 * f64::EPSILON * path[0].hypot(path[1]) {
                break;
            }
        }
        // The work follows from the normal velocity at the stages.
        let speeds = stages.map(|stage| {
            let gained = stage
                .iter()
                .zip(&rates)
                .map(|(a, rate)| a * rate[NORMAL_VELOCITY]);
            path[NORMAL_VELOCITY] + length * gained.sum::<f64>()
        });
        for (rate, speed) in rates.iter_mut().zip(speeds) {
            rate[WORK] = speed;
        }
        let weighted = weights.iter().zip(&rates);
        let mean = weighted.fold([0.0; SIZE], |sum, (&weight, rate)| plus(&sum, weight, rate));
        plus(path, length, &mean)
    }

    /// y after a step of `length` with the same friction all the way.
    fn straight(&self, pull: [f64; 2], path: &Path, length: f64) -> Path {
        let rate = self.pulled(pull, path);
        let mut after = plus(path, length, &rate);
        after[WORK] += 0.5 * rate[NORMAL_VELOCITY] * length * length;
        after
    }

    /// The next piece of the path: at most up to `end`, and whether it is reached.
    fn piece(&self, p: f64, path: &Path, end: End) -> (f64, Path, bool) {
        let slip = path[0].hypot(path[1]);
        let (pull, most) = if self.friction == 0.0 {
            ([0.0; 2], f64::INFINITY)
        } else if slip == 0.0 {
            (self.resting(), f64::INFINITY)
        } else {
            let rate = self.slipping(path);
            let size = rate[0].hypot(rate[1]);
            let reach = slip / size;
            let aside = (path[0] * rate[1] - path[1] * rate[0]).abs();
            let braked = path[0] * rate[0] + path[1] * rate[1] < 0.0;
            // Slip that gets faster keeps the direction that it is given here to the end.
            let straight = if braked {
                aside <= STRAIGHT * p * size * size
            } else {
                aside <= STRAIGHT * slip * size
            };
            if !straight {
                let step = STEP * slip / self.stiffness;
                let after = self.advanced(path, step);
                return if end.lack(p + step, &after) < 0.0 {
                    (p + step, after, false)
                } else {
                    let length = self.root(p, path, step, end);
                    (p + length, self.advanced(path, length), true)
                };
            }
            let most = if braked { reach } else { f64::INFINITY };
            ([0, 1].map(|i| -self.friction * path[i] / slip), most)
        };
        let length = end.length(p, path, self.pulled(pull, path)[NORMAL_VELOCITY]);
        let mut after = self.straight(pull, path, length.min(most));
        if length > most {
            after[..2].fill(0.0);
        }
        (p + length.min(most), after, length <= most)
    }

    /// Where within a step the end is reached, by Newton's method within a bracket.
    fn root(&self, p: f64, path: &Path, longest: f64, end: End) -> f64 {
        let (mut low, mut high) = (0.0, longest);
        let mut length = longest;
        for _ in 0..200 {
            let there = self.advanced(path, length);
            let lack = end.lack(p + length, &there);
            if lack < 0.0 {
                low = length
            } else {
                high = length
            }
            let slope = match end {
                End::Compressed | End::Speed(_) => self.slipping(&there)[NORMAL_VELOCITY],
                End::Pressed => -self.slipping(&there)[NORMAL_VELOCITY],
                End::Impulse(_) => 1.0,
                End::Work(_) => there[NORMAL_VELOCITY],
            };
            let newton = length - lack / slope;
            if (newton - length).abs() <= f64::EPSILON * length {
                return length;
            }
            length = if low < newton && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
            if high - low <= f64::EPSILON * high {
                return length;
            }
        }
        length
    }
}

/// Gauss's method with [`STAGES`] stages, of twice that order: what each stage and the end take of the rates.
struct Gauss {
    weights: [f64; STAGES],
    stages: [[f64; STAGES]; STAGES],
}

static GAUSS: LazyLock<Gauss> = LazyLock::new(|| {
    // Zeros of Legendre's polynomial on [−1, 1] by Newton's method, and P′ there.
    let zero = |i: usize| {
        let mut x = -(std::f64::consts::PI * (i as f64 + 0.75) / (STAGES as f64 + 0.5)).cos();
        let mut slope = 0.0;
        for _ in 0..50 {
            let (mut last, mut now) = (1.0, x);
            for n in 2..=STAGES {
                let n = n as f64;
                (last, now) = (now, ((2.0 * n - 1.0) * x * now - (n - 1.0) * last) / n);
            }
            slope = STAGES as f64 * (x * now - last) / (x * x - 1.0);
            x -= now / slope;
        }
        (x, slope)
    };
    let zeros: [(f64, f64); STAGES] = std::array::from_fn(zero);
    let nodes = zeros.map(|(x, _)| 0.5 + 0.5 * x);
    let weights = zeros.map(|(x, slope)| 1.0 / ((1.0 - x * x) * slope * slope));
    // The integral of Lagrange's polynomial of node j from 0 to node i, by the same quadrature.
    let lagrange = |j: usize, x: f64| -> f64 {
        let others = (0..STAGES).filter(|&k| k != j);
        others
            .map(|k| (x - nodes[k]) / (nodes[j] - nodes[k]))
            .product()
    };
    let stage = |i: usize| {
        std::array::from_fn(|j| {
            let part = |k: usize| nodes[i] * weights[k] * lagrange(j, nodes[i] * nodes[k]);
            (0..STAGES).map(part).sum()
        })
    };
    Gauss {
        weights,
        stages: std::array::from_fn(stage),
    }
});

fn plus(a: &Path, factor: f64, b: &Path) -> Path {
    std::array::from_fn(|i| a[i] + factor * b[i])
}

/// The impulse of a contact that is followed to its end.
pub fn follow(
    contact: &Contact,
    restitution: f64,
    friction: f64,
    hypothesis: Hypothesis,
) -> Answer {
    let k = &contact.response;
    let stiffest = (k[0][0] + k[1][1]).max(f64::MIN_POSITIVE); // no less than either eigenvalue
    let motion = Motion {
        contact,
        friction,
        stiffness: k[0][2].hypot(k[1][2]) + friction * stiffest,
    };
    let [x, y, _] = contact.velocity;
    let approach = contact.approach();
    let mut path = [x, y, -approach, 0.0, 0.0, 0.0];
    let mut p = 0.0;
    let answer = |p: f64, path: &Path, separation: f64| Answer {
        impulse: [path[3], path[4], p],
        separation,
    };
    if approach == 0.0 {
        let pull = if friction == 0.0 {
            [0.0; 2]
        } else if x == 0.0 && y == 0.0 {
            motion.resting()
        } else {
            [0, 1].map(|i| -friction * path[i] / x.hypot(y))
        };
        if motion.pulled(pull, &path)[NORMAL_VELOCITY] > 0.0 {
            return answer(p, &path, 0.0);
        }
    }
    let jams = friction * k[0][2].hypot(k[1][2]) > k[2][2];
    // Goes on to this end, or to where the contact is pressed together again: whether that comes first.
    let run = |p: &mut f64, path: &mut Path, end: End| {
        let watch = jams && matches!(end, End::Impulse(_) | End::Work(_));
        for _ in 0..100_000 {
            let (there, after, over) = motion.piece(*p, path, end);
            if watch {
                let (back, turned, pressed) = motion.piece(*p, path, End::Pressed);
                if pressed && back <= there {
                    (*p, *path) = (back, turned);
                    return true;
                }
            }
            (*p, *path) = (there, after);
            if over {
                return false;
            }
        }
        panic!("the impact did not end: {contact:?}, {friction}");
    };
    // Work so far, and the most that was taken.
    let (mut balance, mut taken): (f64, f64) = (0.0, 0.0);
    loop {
        run(&mut p, &mut path, End::Compressed);
        balance += path[WORK];
        taken = taken.max(-balance);
        path[NORMAL_VELOCITY] = 0.0;
        path[WORK] = 0.0;
        let due = restitution * restitution * taken - (taken + balance);
        if restitution == 0.0 || hypothesis == Hypothesis::Stronge && due <= 0.0 {
            return answer(p, &path, 0.0);
        }
        let end = match hypothesis {
            Hypothesis::Newton => End::Speed(restitution * approach),
            Hypothesis::Poisson => End::Impulse(p + restitution * p),
            Hypothesis::Stronge => End::Work(due),
        };
        if !run(&mut p, &mut path, end) {
            return answer(p, &path, path[NORMAL_VELOCITY]);
        }
        balance += path[WORK];
        path[NORMAL_VELOCITY] = 0.0;
        path[WORK] = 0.0;
    }
}

//! Coulomb friction where the slip turns: the contact slips across the plane of the axis, too.
//!
//! In the normal impulse p the slip **s** obeys d**s**/dp = K_nu **u** − μ K_t **s**/|**s**|, which is singular where it
//! vanishes. In τ with dp = |**s**| dτ it is smooth and homogeneous,
//!
//! d**s**/dτ = |**s**| K_nu **u** − μ K_t **s**,
//!
//! so that one step size serves slips of every magnitude. It is integrated by its Taylor series of order 24 in steps whose
//! last two terms are below 2⁻⁵⁴ of |**s**|. Each piece is a polynomial, on which the events (end of the compression, of the
//! restitution) are found by the rule of false position. Slip in a direction that does not turn is a straight line in p,
//! also where it vanishes, and needs no steps; every other direction turns towards such a one. General integrators would
//! need a power function to choose their steps, interpolate the events, and stop short of the singularity.

use super::series::{ORDER, Series, crossing, integral, line, step_of, value};
use super::{Components, Contact, Coulomb, Hypothesis, Response, length};
use std::array::from_fn;

/// Slip at which it counts as vanished, relative to the contact velocity.
const VANISHED: f64 = 1.0 / 1_152_921_504_606_846_976.0; // 2⁻⁶⁰
/// Longest step, over the fastest rate: the terms of an exponential function are then small enough.
const LONGEST: f64 = 4.0;
/// Rate of turning that counts as none, relative to the largest that there may be.
const STRAIGHT: f64 = 16.0 * f64::EPSILON;
/// Pieces after which the slip is taken to have vanished. Of 400 000 random contacts none needed more than 86.
const MOST_PIECES: usize = 1000;

impl Coulomb<'_> {
    /// The response to a contact that slips in any direction.
    pub(super) fn in_space(&self, contact: &Contact) -> Response {
        let mut impact = Impact::new(self, contact);
        for number in 0..=MOST_PIECES {
            let piece = impact.next_piece(number == MOST_PIECES);
            let event = impact.event(&piece);
            impact.state = piece.at(event.map_or(piece.length, |(t, _)| t));
            match event {
                Some((_, Event::Over)) => break,
                Some((_, event)) => impact.pass(event),
                None if piece.stops => impact.state.slip = [0.0; 2],
                None => {}
            }
        }
        let state = impact.state;
        Response {
            impulse: Components {
                normal: state.impulse,
                along: state.friction[0],
                across: state.friction[1],
            },
            separation_speed: state.normal.max(0.0),
        }
    }
}

/// Where the impact has come to.
#[derive(Clone, Copy)]
struct State {
    /// Contact velocity along **n**, and along **u** and **w**.
    normal: f64,
    slip: [f64; 2],
    /// Normal and tangential impulse so far.
    impulse: f64,
    friction: [f64; 2],
    /// Work of the normal force since the beginning or the last end of a compression.
    work: f64,
}

/// An impact under way.
struct Impact {
    friction: f64,
    hypothesis: Hypothesis,
    restitution: f64,
    /// −v_c^n before the impact.
    speed: f64,
    /// K_nn, K_nu and {K_uu, K_ww}.
    normal: f64,
    coupling: f64,
    tangential: [f64; 2],
    /// Contact velocity before the impact.
    scale: f64,
    state: State,
    /// Before the end of the compression, which in a jam may come more than once.
    compressing: bool,
    /// Impulse at its last end, and work of the normal force until then.
    compression: f64,
    balance: f64,
    /// The most work that was taken so far, and what of it had been returned by then.
    taken: f64,
    returned: f64,
}

/// A part of the way on which every quantity is a polynomial.
struct Piece {
    length: f64,
    normal: Series,
    slip: [Series; 2],
    impulse: Series,
    friction: [Series; 2],
    work: Series,
    /// Of the sign of dv_c^n/dp.
    slope: Series,
    /// Whether the slip vanishes at its end.
    stops: bool,
}

impl Piece {
    fn at(&self, t: f64) -> State {
        State {
            normal: value(&self.normal, t),
            slip: [value(&self.slip[0], t), value(&self.slip[1], t)],
            impulse: value(&self.impulse, t),
            friction: [value(&self.friction[0], t), value(&self.friction[1], t)],
            work: value(&self.work, t),
        }
    }
}

impl Impact {
    fn new(law: &Coulomb<'_>, contact: &Contact) -> Self {
        let plane = contact.plane();
        let speed = contact.slip.normal.abs();
        let slip = [contact.slip.along, contact.slip.across];
        Self {
            friction: law.friction,
            hypothesis: law.hypothesis,
            restitution: law.normal.at(speed),
            speed,
            normal: plane.normal_response().as_slice()[0],
            coupling: plane.coupling().as_slice()[0],
            tangential: [plane.along_response().as_slice()[0], contact.across],
            scale: speed + length(slip[0], slip[1]),
            state: State {
                normal: -speed,
                slip,
                impulse: 0.0,
                friction: [0.0; 2],
                work: 0.0,
            },
            compressing: true,
            compression: 0.0,
            balance: 0.0,
            taken: 0.0,
            returned: 0.0,
        }
    }

    /// The piece that begins at the present state; the `last` one takes the slip as vanished.
    fn next_piece(&self, last: bool) -> Piece {
        let [u, w] = self.state.slip;
        let size = length(u, w);
        let (mu, nu, [uu, ww]) = (self.friction, self.coupling, self.tangential);
        if last || size <= self.scale * VANISHED {
            let along = (-nu / uu).clamp(-mu, mu);
            let sticks = nu.abs() <= mu * uu;
            let slip = if sticks { 0.0 } else { along.mul_add(uu, nu) };
            return self.line([along, 0.0], [slip, 0.0]);
        }
        let (c, s) = (u / size, w / size);
        let drive = [(-mu * uu).mul_add(c, nu), -mu * ww * s]; // d**s**/dp
        let turning = c.mul_add(drive[1], -(s * drive[0]));
        let fastest = mu.mul_add(uu.max(ww), nu.abs());
        let growth = c.mul_add(drive[0], s * drive[1]);
        // A slip about to vanish may turn by so much more as it is smaller; one that grows must have the right direction.
        let weight = if growth < 0.0 { size / self.scale } else { 1.0 };
        if turning.abs() * weight <= STRAIGHT * fastest {
            self.line([-mu * c, -mu * s], [growth * c, growth * s])
        } else {
            self.curve(size, [c, s], fastest)
        }
    }

    /// A piece with constant friction and constant rate of the slip, in p: up to where the slip vanishes or beyond the end.
    fn line(&self, friction: [f64; 2], rate: [f64; 2]) -> Piece {
        let state = &self.state;
        let slope = self.coupling.mul_add(friction[0], self.normal);
        let size = length(state.slip[0], state.slip[1]);
        let braking = -(state.slip[0] * rate[0] + state.slip[1] * rate[1]);
        let stops = size > self.scale * VANISHED && braking > 0.0;
        let length = if stops {
            size * size / braking
        } else {
            // What is missing of the compression, and the most that any hypothesis wants for the restitution.
            let missing = -state.normal.min(0.0) / slope;
            let work = missing.mul_add(
                -state.normal.min(0.0),
                2.0 * (self.taken - state.work.min(0.0)),
            );
            let newton = self.speed / slope;
            let poisson = self.compression.max(state.impulse + missing);
            2.0 * (missing + newton + poisson + (work / slope).sqrt())
        };
        Piece {
            length,
            normal: line(state.normal, slope),
            slip: [line(state.slip[0], rate[0]), line(state.slip[1], rate[1])],
            impulse: line(state.impulse, 1.0),
            friction: [
                line(state.friction[0], friction[0]),
                line(state.friction[1], friction[1]),
            ],
            work: integral(state.work, &line(state.normal, slope), 1.0),
            slope: line(slope, 0.0),
            stops,
        }
    }

    /// A piece on which the slip of this size and direction turns, in τ times `fastest`.
    fn curve(&self, size: f64, direction: [f64; 2], fastest: f64) -> Piece {
        let scaled = |rate: f64| rate / fastest;
        let (mu, nu) = (self.friction, scaled(self.coupling));
        let [uu, ww] = self.tangential.map(|rate| scaled(mu * rate));
        let (mut u, mut w, mut magnitude) = (
            line(direction[0], 0.0),
            line(direction[1], 0.0),
            line(1.0, 0.0),
        );
        for n in 0..ORDER {
            let order = (n + 1) as f64;
            u[n + 1] = nu.mul_add(magnitude[n], -uu * u[n]) / order;
            w[n + 1] = -ww * w[n] / order;
            // |s|² = s·s, order by order.
            let mut sum = 0.0;
            for i in 0..=n + 1 {
                sum += u[i] * u[n + 1 - i] + w[i] * w[n + 1 - i];
            }
            for i in 1..=n {
                sum -= magnitude[i] * magnitude[n + 1 - i];
            }
            magnitude[n + 1] = 0.5 * sum;
        }
        let step = step_of(&magnitude, LONGEST);

        let state = &self.state;
        let pace = size / fastest; // dp/dτ over |s|
        let jam = -(mu * self.coupling);
        let slope: Series = from_fn(|n| self.normal.mul_add(magnitude[n], jam * u[n]));
        let normal = integral(state.normal, &slope, pace);
        let power: Series = from_fn(|n| (0..=n).map(|i| magnitude[i] * normal[n - i]).sum());
        Piece {
            length: step,
            normal,
            slip: [u.map(|x| size * x), w.map(|x| size * x)],
            impulse: integral(state.impulse, &magnitude, pace),
            friction: [
                integral(state.friction[0], &u, -mu * pace),
                integral(state.friction[1], &w, -mu * pace),
            ],
            work: integral(state.work, &power, pace),
            slope,
            stops: false,
        }
    }

    /// The first event on the piece, and where it is.
    fn event(&self, piece: &Piece) -> Option<(f64, Event)> {
        // While the slip turns, dv_c^n/dp changes monotonically: on either side of its zero v_c^n is monotonic.
        let (before, after) = (piece.slope[0], value(&piece.slope, piece.length));
        let crest = if before * after < 0.0 {
            crossing(0.0, piece.length, |t| -before * value(&piece.slope, t))
        } else {
            piece.length
        };
        self.event_between(piece, 0.0, crest)
            .or_else(|| self.event_between(piece, crest, piece.length))
    }

    /// The same between two points, between which v_c^n is monotonic.
    fn event_between(&self, piece: &Piece, low: f64, high: f64) -> Option<(f64, Event)> {
        let normal = |t| value(&piece.normal, t);
        if self.compressing {
            let rises = normal(high) >= 0.0;
            return rises.then(|| (crossing(low, high, normal), Event::Compressed));
        }
        let falls = normal(high) < 0.0;
        let high = if falls {
            crossing(low, high, |t| -normal(t))
        } else {
            high
        };
        let surplus = |t| self.surplus(piece, t);
        if surplus(high) >= 0.0 {
            return Some((crossing(low, high, surplus), Event::Over));
        }
        falls.then_some((high, Event::CompressedAgain))
    }

    /// What the restitution has reached, less what it shall: ≥ 0 when it is over.
    fn surplus(&self, piece: &Piece, t: f64) -> f64 {
        let e = self.restitution;
        match self.hypothesis {
            Hypothesis::Newton => value(&piece.normal, t) - e * self.speed,
            Hypothesis::Poisson => {
                value(&piece.impulse, t) - e.mul_add(self.compression, self.compression)
            }
            Hypothesis::Stronge => {
                value(&piece.work, t) - (e * e).mul_add(self.taken, -self.returned)
            }
        }
    }

    /// Goes on from an event.
    fn pass(&mut self, event: Event) {
        self.state.normal = 0.0;
        self.compressing = event == Event::CompressedAgain;
        if event == Event::Compressed {
            // The balance begins anew, so that a little restitution is not lost in a large compression.
            self.balance += self.state.work;
            self.state.work = 0.0;
            self.taken = self.taken.max(-self.balance);
            self.returned = self.taken + self.balance;
            self.compression = self.state.impulse;
        }
    }
}

/// What can happen on a piece.
#[derive(Clone, Copy, PartialEq)]
enum Event {
    /// The compression ends.
    Compressed,
    /// In a jam the normal velocity turns before the restitution is over.
    CompressedAgain,
    /// The impact is over.
    Over,
}

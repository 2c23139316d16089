//! The laws where they are known on paper: limits in which they coincide, spheres, published closed forms in the plane, and
//! grazing contacts.

use crate::contacts::*;
use restitution_core::describe::{Allowed, Argument, Parameter};
use restitution_core::law::{AxialCompliance, Compliance, Contact, Creation, Response};
use restitution_core::{Hypothesis, LAWS, Law, Rule, Symmetric, TangentialRestitution, Vector};

const CONTACTS: usize = 20_000;

/// Planar contacts and others, alternately.
fn each_contact(seed: u64, mut check: impl FnMut(&mut Random, &Contact)) {
    let mut random = Random::new(seed);
    for number in 0..CONTACTS {
        let contact = if number % 2 == 0 {
            random.planar()
        } else {
            random.spatial()
        };
        check(&mut random, &contact);
    }
}

/// Every law of this file with random coefficients.
fn laws(random: &mut Random) -> Vec<Law<'static>> {
    let (normal, friction) = (random.coefficient(), random.friction());
    let tangential = random.between(-1.0, 1.0);
    let mut laws = vec![
        frictionless(normal),
        chatterjee_ruina(normal, tangential, friction),
        Law::new(normal, TangentialRestitution::new(tangential).unwrap()).unwrap(),
    ];
    laws.extend(HYPOTHESES.map(|hypothesis| coulomb(normal, friction, hypothesis)));
    laws
}

/// What the table says of every law holds, with parameters drawn from it: energy is created only where it can be, a law with a coefficient
/// of friction stays within the cone, and the answer for the full matrix is the same where the contact does not jam.
#[test]
fn every_law_of_the_table_keeps_what_it_says() {
    each_contact(8, |random, contact| {
        for entry in LAWS {
            let draw = |about: &Parameter| match about.allowed {
                Allowed::Number(range) => {
                    Argument::Number(random.between(range.low.max(-2.0), range.high.min(2.0)))
                }
                Allowed::Name(names) => {
                    Argument::Name(names[(random.uniform() * names.len() as f64) as usize])
                }
                _ => about.example,
            };
            let arguments: Vec<_> = entry.kind.parameters.iter().map(draw).collect();
            let value = |name: &str| {
                let place = entry.kind.parameters.iter().position(|p| p.name == name);
                place.map(|place| arguments[place])
            };
            let rule = (entry.kind.make)(&arguments).unwrap();
            let law = Law::new(random.coefficient(), rule).unwrap();
            let response = law.respond(contact);
            let allowed = 64.0 * rounding(contact, &response);
            let creates = match entry.creates_energy {
                Creation::Never => false,
                Creation::Possible => true,
                Creation::Where(name, with) => value(name) == Some(Argument::Name(with)),
            };
            let what = || format!("{law:?} {contact:?} {response:?}");
            let scale = response.impulse.norm();
            assert!(
                creates || gain(contact, &response) <= allowed * scale,
                "{}",
                what()
            );

            let AxialCompliance {
                inertia,
                arm_normal: n,
                arm_along: u,
                ww,
            } = contact.compliance;
            let k = Symmetric {
                xx: 1.0 + n * n / inertia,
                yy: ww,
                zz: 1.0 + u * u / inertia,
                xy: 0.0,
                xz: -n * u / inertia,
                yz: 0.0,
            };
            if let Some(Argument::Number(friction)) = value("friction") {
                let (pull, limit) = (tangential(response.impulse), friction * response.impulse.z);
                assert!(pull <= limit + (1.0 + friction) * allowed, "{}", what());
                if friction * k.xz.abs() > k.zz {
                    continue;
                }
            }
            let k = Compliance::new(k).unwrap();
            let found = law.answer(&k, contact.velocity).unwrap();
            assert!(
                agree(contact, &found, &response, 64.0),
                "{} {found:?}",
                what()
            );
        }
    });
}

/// K turns the impulse that was solved for a change of the contact velocity into that change (10), in every direction.
#[test]
fn an_impulse_makes_the_change_that_it_is_for() {
    each_contact(6, |random, contact| {
        let mut part = || random.between(-2.0, 2.0);
        let wanted = Vector::new(part(), part(), part());
        let impulse = contact.compliance.impulse(wanted);
        let made = contact.compliance.change(impulse);
        let response = Response {
            impulse,
            separation_speed: 0.0,
        };
        let off = made - wanted;
        assert!(
            off.norm() <= 32.0 * rounding(contact, &response),
            "{contact:?} {impulse:?} {off:?}"
        );
    });
}

/// Nothing breaks, the plane pushes, and the separation speed is the normal velocity that the impulse leaves behind.
#[test]
fn every_response_is_that_of_an_impact() {
    each_contact(1, |random, contact| {
        for law in laws(random) {
            let response = law.respond(contact);
            let left = after(contact, &response).z;
            let allowed = 32.0 * rounding(contact, &response);
            assert!(
                (response.separation_speed - left).abs() <= allowed,
                "{law:?} {contact:?} {response:?} {left}"
            );
            assert!(response.separation_speed >= 0.0);
            let pushes =
                matches!(law.rule, Rule::TangentialRestitution(_)) || response.impulse.z >= 0.0;
            assert!(pushes, "{law:?} {contact:?} {response:?}");
        }
    });
}

/// Newton's coefficient is kept where the law says so, and by all hypotheses where the slip does not change.
#[test]
fn the_normal_velocity_obeys_newton() {
    each_contact(2, |random, contact| {
        let (e, mu) = (random.coefficient(), random.friction());
        let t = random.between(-1.0, 1.0);
        for law in [
            frictionless(e),
            chatterjee_ruina(e, t, mu),
            coulomb(e, mu, Hypothesis::Newton),
        ] {
            let response = law.respond(contact);
            let left = after(contact, &response).z;
            let allowed = 32.0 * rounding(contact, &response);
            assert!(
                (left + e * contact.velocity.z).abs() <= allowed,
                "{law:?} {contact:?}"
            );
        }
    });
}

/// A plastic contact has no speed of separation at all: the smallest one would be the start of a flight.
#[test]
fn a_plastic_contact_is_not_left() {
    each_contact(3, |random, contact| {
        let (t, mu) = (random.between(-1.0, 1.0), random.friction());
        let mut laws = vec![frictionless(0.0), chatterjee_ruina(0.0, t, mu)];
        laws.extend(HYPOTHESES.map(|hypothesis| coulomb(0.0, mu, hypothesis)));
        for law in laws {
            let left = law.respond(contact).separation_speed;
            assert_eq!(left, 0.0, "{law:?} {contact:?}");
        }
    });
}

/// Without friction every law that knows of friction is frictionless; e_t = −1 is another name for it.
#[test]
fn without_friction_there_is_one_law() {
    each_contact(3, |random, contact| {
        let (e, t) = (random.coefficient(), random.between(-1.0, 1.0));
        let expected = frictionless(e).respond(contact);
        assert_eq!(tangential(expected.impulse), 0.0);
        let mut laws = HYPOTHESES
            .map(|hypothesis| coulomb(e, 0.0, hypothesis))
            .to_vec();
        laws.push(chatterjee_ruina(e, t, 0.0));
        laws.push(chatterjee_ruina(e, -1.0, random.friction()));
        for law in laws {
            let found = law.respond(contact);
            assert!(
                agree(contact, &expected, &found, 16.0),
                "{law:?} {contact:?} {found:?} {expected:?}"
            );
        }
    });
}

/// A sphere of J = 2/5, K_nn = 1 and K_tt = 7/2: it slides through the impact if 7/2 μ(1 + e)v < |s| and else ends without
/// slip. All hypotheses, and Chatterjee–Ruina with e_t = 0, are this textbook law, in every direction of the slip.
#[test]
fn spheres_slide_or_stick_as_in_the_textbook() {
    each_contact(4, |random, contact| {
        let sphere = Contact {
            compliance: AxialCompliance {
                inertia: 0.4,
                arm_normal: -1.0,
                arm_along: 0.0,
                ww: 3.5,
            },
            ..*contact
        };
        let (e, mu) = (random.coefficient(), random.friction());
        let normal = -(1.0 + e) * sphere.velocity.z;
        let slip = tangential(sphere.velocity);
        let share = if 3.5 * mu * normal < slip {
            mu * normal / slip
        } else {
            1.0 / 3.5
        };
        let expected = Response {
            impulse: Vector::new(
                -share * sphere.velocity.x,
                -share * sphere.velocity.y,
                normal,
            ),
            separation_speed: -e * sphere.velocity.z,
        };
        let mut laws = HYPOTHESES
            .map(|hypothesis| coulomb(e, mu, hypothesis))
            .to_vec();
        laws.push(chatterjee_ruina(e, 0.0, mu));
        for law in laws {
            let found = law.respond(&sphere);
            assert!(
                agree(&sphere, &expected, &found, 16.0),
                "{law:?} {sphere:?} {found:?} {expected:?}"
            );
        }
    });
}

/// What never slips sticks: for a contact through whose normal the centre of mass lies, Poisson's hypothesis with μ → ∞ is
/// Chatterjee–Ruina with e_t = 0, for every e. For others the two agree in a plastic impact only, where both are P_II, for
/// Poisson's restitution goes on sticking while Chatterjee and Ruina's is frictionless.
#[test]
fn endless_friction_sticks() {
    let never_slips = 1e12;
    each_contact(5, |random, contact| {
        let e = random.coefficient();
        let mut central = *contact;
        central.compliance.arm_along = 0.0;
        let reference = chatterjee_ruina(e, 0.0, never_slips).respond(&central);
        for hypothesis in HYPOTHESES {
            let found = coulomb(e, never_slips, hypothesis).respond(&central);
            if central.velocity.z < -1e-6 {
                assert!(
                    agree(&central, &found, &reference, 1e6),
                    "{central:?} {found:?} {reference:?}"
                );
            }
        }
        // P_II pulls where stopping the slip alone would already lift the contact.
        let sticking = contact.compliance.impulse(contact.velocity * -1.0);
        if sticking.z > 1e-3 * sticking.norm() {
            let reference = chatterjee_ruina(0.0, 0.0, never_slips).respond(contact);
            let found = coulomb(0.0, never_slips, Hypothesis::Poisson).respond(contact);
            assert!(
                agree(contact, &found, &reference, 1e6),
                "{contact:?} {found:?} {reference:?}"
            );
            let poisson = coulomb(e, never_slips, Hypothesis::Poisson).respond(contact);
            let slip = tangential(after(contact, &poisson));
            assert!(
                slip <= 1e6 * rounding(contact, &poisson),
                "{contact:?} {slip}"
            );
        }
    });
}

/// Poisson's hypothesis in the closed form of Y. Wang and M. T. Mason, J. Appl. Mech. 59, 635 (1992), Table 1, in their
/// notation: five modes of contact.
fn wang_and_mason(contact: &Contact, e: f64, mu: f64) -> (usize, f64, f64) {
    let (n, u, j) = (
        contact.compliance.arm_normal,
        contact.compliance.arm_along,
        contact.compliance.inertia,
    );
    let (b1, b2, b3) = (1.0 + n * n / j, 1.0 + u * u / j, n * u / j);
    let (s0, c0) = (contact.velocity.x, contact.velocity.z);
    let s = if s0 < 0.0 { -1.0 } else { 1.0 };
    let pd = (b2 + s * mu * b3) * s * s0;
    let pq = (mu * b1 + s * b3) * -c0;
    let slides = -(1.0 + e) * c0 / (b2 + s * mu * b3);
    let sticks = mu > (b3 / b1).abs();
    if pd > (1.0 + e) * pq {
        return (0, slides, -s * mu * slides);
    }
    match (pd < pq, sticks) {
        (true, true) => {
            let py = -(1.0 + e) * (b1 * c0 + b3 * s0) / (b1 * b2 - b3 * b3);
            (1, py, (b3 * py - s0) / b1)
        }
        (false, true) => (2, slides, (b3 * slides - s0) / b1),
        (true, false) => {
            let py = -(1.0 + e) / (b2 - s * mu * b3)
                * (c0 + 2.0 * s * mu * b3 * s0 / (b3 + s * mu * b1));
            (3, py, s * mu * (py - 2.0 * s0 / (b3 + s * mu * b1)))
        }
        (false, false) => (4, slides, s * mu * (slides - 2.0 * s0 / (b3 + s * mu * b1))),
    }
}

#[test]
fn poisson_is_the_closed_form_of_wang_and_mason() {
    let mut random = Random::new(6);
    let mut modes = [0; 5];
    for _ in 0..CONTACTS {
        let mut contact = random.planar();
        contact.velocity.z = -random.between(0.01, 2.0);
        contact.velocity.x = random.between(-2.0, 2.0);
        let (e, mu) = (random.coefficient(), random.between(0.0, 1.5));
        let (mode, normal, along) = wang_and_mason(&contact, e, mu);
        let found = coulomb(e, mu, Hypothesis::Poisson).respond(&contact);
        let allowed = 1e4 * rounding(&contact, &found);
        assert!(
            (found.impulse.z - normal).abs() <= allowed
                && (found.impulse.x - along).abs() <= allowed,
            "mode {mode}: {contact:?} {e} {mu} {found:?} {normal} {along}"
        );
        modes[mode] += 1;
    }
    assert!(modes.iter().all(|&count| count > 100), "{modes:?}");
}

/// What is not slipping at all, not approaching, or neither, has an answer, and it is small.
#[test]
fn grazing_contacts_have_an_answer() {
    each_contact(7, |random, contact| {
        for law in laws(random) {
            for (normal, slips) in [(0.0, 1.0), (-0.0, 1.0), (1.0, 0.0), (0.0, 0.0)] {
                let Vector { x, y, z } = contact.velocity;
                let velocity = Vector::new(x * slips, y * slips, z * normal);
                let grazing = Contact {
                    velocity,
                    ..*contact
                };
                let response = law.respond(&grazing);
                assert!(
                    response.impulse.norm().is_finite(),
                    "{law:?} {grazing:?} {response:?}"
                );
                assert!(response.separation_speed >= 0.0, "{law:?} {grazing:?}");
                if velocity.norm() == 0.0 {
                    assert_eq!(response.impulse.norm(), 0.0, "{law:?} {grazing:?}");
                }
            }
        }
    });
}

/// The slip across the plane made smaller and smaller, the law in space becomes the closed form in the plane. Where the slip
/// along comes to rest the little that is across turns the whole direction, for as long as it is the larger: an impulse of
/// its own size.
#[test]
fn the_law_in_space_tends_to_that_in_the_plane() {
    let mut random = Random::new(8);
    for _ in 0..CONTACTS / 10 {
        let mut contact = random.planar();
        contact.velocity.z = -random.between(0.01, 2.0);
        let (e, mu) = (random.coefficient(), random.between(0.0, 2.0));
        for hypothesis in HYPOTHESES {
            let law = coulomb(e, mu, hypothesis);
            let flat = law.respond(&contact);
            for across in [1e-4, 1e-7, 1e-10, 1e-13, 1e-16, 1e-30, 1e-300] {
                let mut tilted = contact;
                tilted.velocity.y = across;
                let found = law.respond(&tilted);
                let off = (found.impulse.z - flat.impulse.z).abs()
                    + (found.impulse.x - flat.impulse.x).abs();
                let scale = contact.velocity.norm() + flat.impulse.norm();
                assert!(
                    off <= 1e3 * across + 1e-14 * scale,
                    "{law:?} {contact:?} across {across}: {found:?} {flat:?}"
                );
            }
        }
    }
}

/// The response in space knows no right and left: mirrored contacts have mirrored impulses, to the bit.
#[test]
fn mirrored_contacts_have_mirrored_impulses() {
    each_contact(9, |random, contact| {
        for law in laws(random) {
            let response = law.respond(contact);
            let mut mirrored = *contact;
            mirrored.velocity.y = -contact.velocity.y;
            let mut expected = response;
            expected.impulse.y = -response.impulse.y;
            assert_eq!(law.respond(&mirrored), expected, "{law:?} {contact:?}");
            mirrored.velocity.x = -contact.velocity.x;
            mirrored.compliance.arm_along = -contact.compliance.arm_along;
            expected.impulse.x = -response.impulse.x;
            assert_eq!(law.respond(&mirrored), expected, "{law:?} {contact:?}");
        }
    });
}

//! Which laws can make energy: ten million random impacts of each.

use crate::contacts::*;
use restitution_core::law::Contact;
use restitution_core::{Hypothesis, Law, TangentialRestitution};

const IMPACTS: u64 = 10_000_000;

/// Impacts in which energy grows beyond rounding, of those in the plane and of a hundredth as many in space; and the
/// greatest growth, as a share of what the impulse moves.
fn growing(seed: u64, mut law: impl FnMut(&mut Random) -> Law<'static>) -> (u64, f64) {
    let mut random = Random::new(seed);
    let mut count = 0;
    let mut most: f64 = 0.0;
    let mut look = |law: Law<'_>, contact: &Contact| {
        let response = law.respond(contact);
        let (gain, scale) = (gain(contact, &response), response.impulse.norm());
        let allowed = 64.0 * rounding(contact, &response) * scale;
        assert!(gain.is_finite(), "{law:?} {contact:?} {response:?}");
        if gain > allowed {
            count += 1;
            most = most.max(gain / (scale * contact.velocity.norm()));
        }
    };
    for number in 0..IMPACTS {
        look(law(&mut random), &random.planar());
        if number % 100 == 0 {
            look(law(&mut random), &random.spatial());
        }
    }
    (count, most)
}

#[test]
fn without_friction_energy_never_grows() {
    assert_eq!(growing(1, |random| frictionless(random.coefficient())).0, 0);
}

#[test]
fn with_stronges_hypothesis_energy_never_grows() {
    let law =
        |random: &mut Random| coulomb(random.coefficient(), random.friction(), Hypothesis::Stronge);
    assert_eq!(growing(2, law).0, 0);
}

#[test]
fn with_chatterjee_and_ruina_energy_never_grows() {
    let law = |random: &mut Random| {
        let tangential = random.between(-1.0, 1.0);
        chatterjee_ruina(random.coefficient(), tangential, random.friction())
    };
    assert_eq!(growing(3, law).0, 0);
}

/// Poisson's hypothesis has been suspected, but the slope q of dT/dp, T the kinetic energy and p the normal impulse, never
/// grows along the path, and dT/dp ≤ 0 at the end of the compression: what restitution adds is less than what compression
/// took.
#[test]
fn with_poissons_hypothesis_energy_never_grows() {
    let law =
        |random: &mut Random| coulomb(random.coefficient(), random.friction(), Hypothesis::Poisson);
    assert_eq!(growing(4, law).0, 0);
}

/// The other laws do make energy, and the documentation says so.
#[test]
fn the_other_laws_can_make_energy() {
    let newton = growing(5, |random| {
        coulomb(random.coefficient(), random.friction(), Hypothesis::Newton)
    });
    let papers = growing(6, |random| {
        let tangential = random.between(-1.0, 1.0);
        let rule = TangentialRestitution::new(tangential).unwrap();
        Law::new(random.coefficient(), rule).unwrap()
    });
    println!("Newton {newton:?}, paper {papers:?}");
    assert!(newton.0 > 0 && papers.0 > 0);
}

/// |P_t| ≤ μ P_n, to the roundings of the sums that the two are, of which that of P_n counts μ times.
#[test]
fn the_friction_cone_is_respected() {
    let mut random = Random::new(7);
    for number in 0..IMPACTS {
        let space = number % 100 == 0;
        let contact = if space {
            random.spatial()
        } else {
            random.planar()
        };
        let (e, mu) = (random.coefficient(), random.friction());
        let tangential_coefficient = random.between(-1.0, 1.0);
        for law in [
            coulomb(e, mu, Hypothesis::Stronge),
            coulomb(e, mu, Hypothesis::Poisson),
            coulomb(e, mu, Hypothesis::Newton),
            chatterjee_ruina(e, tangential_coefficient, mu),
        ] {
            let response = law.respond(&contact);
            let (friction, limit) = (tangential(response.impulse), mu * response.impulse.z);
            let allowed = 64.0 * (1.0 + mu) * rounding(&contact, &response);
            assert!(
                friction <= limit + allowed,
                "{law:?} {contact:?} {response:?}"
            );
        }
    }
}

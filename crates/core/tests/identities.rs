//! What every impact must obey, whatever the state: the balances of momentum, of angular momentum and of energy, and the
//! law itself.

use crate::common::*;
use crate::scalar::*;
use proptest::prelude::*;
use restitution_core::collide;

proptest! {
    #![proptest_config(cases(4000))]

    /// (11): the impulse P = m Δv changes the angular momentum by **r**_c × P, component by component.
    #[test]
    fn momentum_and_angular_momentum_balance((body, law, before, sphere) in approach()) {
        let (after, _) = collide(&body, &law, &before, sphere);
        let impulse = after.velocity - before.velocity;
        let arm = arm(&before, &body, sphere);
        let gained = (after.precession - before.precession) * body.transverse;
        // Δv and ΔΛ are differences of numbers of this size.
        let scale = before.velocity.norm() + impulse.norm()
            + body.transverse * (before.precession.norm() + after.precession.norm());
        let error = (gained - arm.cross(impulse)).norm();
        prop_assert!(error <= 16.0 * f64::EPSILON * scale, "{error:e} of {scale:e}");
    }

    /// (9): both components of the contact velocity change by their factors, and nothing else of the state changes.
    #[test]
    fn the_contact_velocity_obeys_the_law((body, (normal, tangential), (_, _, before, sphere)) in
        approach().prop_flat_map(|a| (Just(a.0), coefficients(), Just(a)))
    ) {
        let law = law(normal, tangential);
        let (after, speed) = collide(&body, &law, &before, sphere);
        let (v, w) = (contact_velocity(&before, &body, sphere), contact_velocity(&after, &body, sphere));
        // The spin about the axis is found from Λ by a division by J_zz: what Λ is rounded by counts J_xx/J_zz times.
        let spin = before.spin(&body).norm() + after.spin(&body).norm();
        let scale = before.velocity.norm() + after.velocity.norm()
            + (1.0 + body.half_separation) * spin * body.transverse / body.axial;
        let allowed = 16.0 * f64::EPSILON * scale;
        prop_assert!((w.z + normal * v.z).abs() <= allowed, "{:e} of {scale:e}", w.z + normal * v.z);
        prop_assert!((w.x - tangential * v.x).abs() <= allowed);
        prop_assert!((w.y - tangential * v.y).abs() <= allowed);
        prop_assert!((speed + normal * v.z).abs() <= allowed && speed >= 0.0);
        prop_assert_eq!(after.axis, before.axis);
        prop_assert_eq!(lift(&after), lift(&before));
    }

    /// The work theorem: ΔE = P·(v_c + v_c′)/2.
    #[test]
    fn the_impulse_does_the_work((body, law, before, sphere) in approach()) {
        let (after, _) = collide(&body, &law, &before, sphere);
        let impulse = after.velocity - before.velocity;
        let (v, w) = (contact_velocity(&before, &body, sphere), contact_velocity(&after, &body, sphere));
        let work = 0.5 * impulse.dot(v + w);
        let (e, f) = (before.kinetic_energy(&body), after.kinetic_energy(&body));
        let error = (f - e - work).abs();
        // The energies, and the slip that J_xx/J_zz makes less certain, as above.
        let scale = (e + f) * (1.0 + body.transverse / body.axial);
        prop_assert!(error <= 16.0 * f64::EPSILON * scale, "{error:e} of {scale:e}");
    }

    /// Energy cannot grow where v′ᵀK⁻¹v′ ≤ vᵀK⁻¹v for every v: with ε_t = −ε_n, when all of v_c is scaled; for a sphere,
    /// whose K is diagonal; and otherwise as long as κ² ≤ (1 − ε_n²)(1 − ε_t²)/(1 + ε_n ε_t)², κ² = K_nu²/(K_nn K_uu).
    #[test]
    fn energy_does_not_grow_where_the_law_cannot_do_work(
        (body, _, before, sphere) in approach(), (normal, tangential) in coefficients(), antiparallel in any::<bool>(),
    ) {
        let tangential = if antiparallel { -normal } else { tangential };
        let arm = arm(&before, &body, sphere);
        let (n, u, j) = (arm.z, arm.horizontal(), body.transverse);
        let coupling = (n * u).powi(2) / ((j + u * u) * (j + n * n));
        let allowed = (1.0 - normal * normal) * (1.0 - tangential * tangential)
            / (1.0 + normal * tangential).powi(2);
        let safe = antiparallel || u == 0.0 || coupling < allowed * (1.0 - 1e-12);
        prop_assume!(safe);
        let (after, _) = collide(&body, &law(normal, tangential), &before, sphere);
        let (e, f) = (before.kinetic_energy(&body), after.kinetic_energy(&body));
        prop_assert!(f <= e * (1.0 + 16.0 * f64::EPSILON * (1.0 + body.transverse / body.axial)), "{:e}", f / e - 1.0);
    }
}

/// The criterion is sharp: just beyond it there is a contact velocity, the eigenvector of v′ᵀK⁻¹v′ − vᵀK⁻¹v, for which energy
/// grows. With ε_t = 1 that is so for every body that is not a sphere: the paper's law is not a frictionless one.
#[test]
fn energy_grows_just_beyond_that_criterion() {
    use restitution_core::{State, Vector};
    let body = dumbbell(1.0);
    let normal = 0.9;
    let axis = Vector::new(0.8, 0.0, -0.6);
    let release = State::with_spin(&body, 1.0, Vector::default(), axis, Vector::default());
    let on_plane = at_height(&release, 1.0 + 0.6 * body.half_separation);
    let arm = arm(&on_plane, &body, restitution_core::Sphere::One);
    let (n, u, j) = (arm.z, arm.x, body.transverse);
    // K⁻¹ up to a factor, in the frame (n, u).
    let (a, b, c) = (j + n * n, n * u, j + u * u);
    let gain = |tangential: f64, slope: f64| {
        let velocity = Vector::new(slope, 0.0, -1.0);
        let before = State {
            velocity,
            ..on_plane
        };
        let (after, _) = collide(
            &body,
            &law(normal, tangential),
            &before,
            restitution_core::Sphere::One,
        );
        after.kinetic_energy(&body) / before.kinetic_energy(&body) - 1.0
    };
    let best = |t: f64| {
        // Stationary point of (ε_n² − 1)a v_n² − 2(1 + ε_n t)b v_n v_u + (t² − 1)c v_u² over v_u, at v_n = −1.
        (1.0 + normal * t) * b / ((1.0 - t * t) * c)
    };
    // κ² = b²/(ac) = (1 − ε_n²)(1 − t²)/(1 + ε_n t)², solved for t by bisection between 0 and 1.
    let beyond = |t: f64| {
        b * b / (a * c) > (1.0 - normal * normal) * (1.0 - t * t) / (1.0 + normal * t).powi(2)
    };
    let (mut low, mut high) = (-normal, 1.0);
    while high - low > 1e-15 {
        let middle = 0.5 * (low + high);
        if beyond(middle) {
            high = middle
        } else {
            low = middle
        }
    }
    assert!(gain(low - 1e-6, best(low - 1e-6)) < 0.0);
    assert!(gain(high + 1e-6, best(high + 1e-6)) > 0.0);
    assert!(gain(1.0, 100.0) > 0.0 || gain(1.0, -100.0) > 0.0);
}

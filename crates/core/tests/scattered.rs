//! A coefficient that scatters: the same bits whatever the schedule, and no trace where it does not scatter.

use crate::common::*;
use restitution_core::{
    Columns, Coulomb, Frictionless, Hypothesis, Law, Level, Material, Monitor, Plastic, Resources,
    Rule, Run, Scattered, Spin, TangentialRestitution, Vector, simulate_series,
};

fn material(deviation: f64) -> Material {
    let around = Plastic::new(0.05).unwrap();
    Material::Scattered(Scattered::new(around.into(), deviation).unwrap())
}

fn rules() -> [Rule; 3] {
    [
        TangentialRestitution::new(0.6).unwrap().into(),
        Frictionless.into(),
        Coulomb::new(0.2, Hypothesis::Stronge).unwrap().into(),
    ]
}

/// From rest, and spinning, so that lanes wait for each other; trajectories end at different times.
fn runs(material: &Material) -> Vec<Run<'_>> {
    let spins = [Spin::NONE, Spin::Fixed(Vector::new(20.0, 5.0, 40.0))];
    rules()
        .iter()
        .flat_map(|&rule| {
            spins.map(|spin| Run {
                particles: 100,
                impacts: 40,
                spin,
                minimum_speed: 0.2,
                settled: 0.0,
                ..paper(0.4, Law::of(material, rule))
            })
        })
        .collect()
}

fn on(run: &Run<'_>, threads: usize, level: Level) -> impl PartialEq + use<> {
    let resources = Resources { threads, level };
    let records = run.simulate(resources, &Monitor::default()).unwrap();
    all_bits(&records.into())
}

#[test]
fn threads_and_levels_do_not_matter() {
    for run in runs(&material(0.02)) {
        let one = on(&run, 1, Level::Scalar);
        for level in Level::available() {
            for threads in [1, 2, 3] {
                assert!(
                    on(&run, threads, level) == one,
                    "{level:?}, {threads} threads, {:?}",
                    run.law
                );
            }
        }
    }
}

/// Parts of runs of two seeds side by side, and one particle followed by itself.
#[test]
fn a_particle_is_the_same_by_itself() {
    for run in runs(&material(0.02)) {
        let other = Run { seed: 77, ..run };
        let all = [&run, &other].map(|run| simulate(run));
        let resources = Resources {
            threads: 2,
            level: Level::best(),
        };
        let series = [(run, 30..40), (other, 0..20)];
        let (columns, monitor) = (
            Columns::usual(run.body, &run.law, false),
            Monitor::default(),
        );
        let found = Records::from(simulate_series(&series, &columns, resources, &monitor).unwrap());
        let expected = [&all[0].time[30 * 40..40 * 40], &all[1].time[..20 * 40]].concat();
        let bits = |times: &[f64]| times.iter().map(|t| t.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&found.time), bits(&expected));
        let alone = Records::from(
            run.simulate_columns(33..34, &columns, resources, &monitor)
                .unwrap(),
        );
        assert_eq!(bits(&alone.time), bits(&all[0].time[33 * 40..34 * 40]));
    }
}

#[test]
fn no_deviation_is_no_scatter() {
    let (still, plain) = (material(0.0), Material::from(Plastic::new(0.05).unwrap()));
    for (a, b) in runs(&still).iter().zip(&runs(&plain)) {
        assert!(on(a, 1, Level::best()) == on(b, 1, Level::best()));
    }
}

/// Each seed, particle and impact has its own.
#[test]
fn every_impact_is_drawn_anew() {
    let law = Material::Scattered(Scattered::new(0.9.into(), 0.01).unwrap());
    let run = |seed| Run {
        particles: 50,
        impacts: 20,
        seed,
        ..paper(0.0, Law::of(&law, Frictionless.into()))
    };
    let mut drawn: Vec<u64> = [1, 2]
        .iter()
        .flat_map(|&seed| simulate(&run(seed)).restitution)
        .map(f64::to_bits)
        .collect();
    drawn.sort_unstable();
    drawn.dedup();
    assert_eq!(drawn.len(), 2 * 50 * 20);
}

#[test]
fn what_scatters_cannot_scatter_again() {
    assert!(Scattered::new(material(0.1), 0.1).is_err());
    assert!(Scattered::new(0.9.into(), 1.1).is_err());
}

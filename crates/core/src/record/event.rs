//! Events as a run reports them, the trait of their receivers, and how their variables are tabulated.

use super::Variable;
use super::column::Slices;
use crate::Error;
use crate::simd::Level;
use crate::simd::{Mask, Pack};
use crate::threads::Monitor;
use pulp::Simd;
use std::ops::Range;

/// A process that runs are of: in each row a sequence of events, such as the impacts of a particle on the plane.
pub(crate) trait Process: Sized + 'static {
    /// A run that has been checked.
    type Plan<'a>: Sync;
    /// The state of a row before its first event.
    type Row: Described<Of = Self>;
    /// Why the events of a row end.
    type Reason: Copy;
    /// The variables of an event.
    const EVENTS: &'static [Variable];
    /// The variables of a row, of which the first is the number of its events, and the second the number of the reason of their end.
    const ROWS: &'static [Variable];

    /// The names of the reasons, in the order of their numbers.
    const REASONS: &'static [&'static str];
    /// The reason where the run was cancelled.
    const INTERRUPTED: Self::Reason;

    /// The number of a reason.
    fn number(reason: Self::Reason) -> usize;
    /// Largest number of events in a row.
    fn most(plan: &Self::Plan<'_>) -> usize;
    /// Returns whether a variable of the rows is recorded.
    fn has(plan: &Self::Plan<'_>, about: &Variable) -> bool;
    /// The unit of velocities, in m/s, and the origin about which moments of the coefficient of restitution are summed.
    fn units(plan: &Self::Plan<'_>) -> (f64, f64);
    /// The row of this number.
    fn row(number: usize) -> Self::Row;
    /// Simulates some rows and hands their events to `sink`.
    fn simulate(
        source: &impl Source<Of = Self>,
        rows: Range<usize>,
        level: Level,
        monitor: &Monitor,
        sink: &mut impl Sink<Self>,
    ) -> Result<(), Error>;
}

/// The rows of one run, or of several.
pub(crate) trait Source: Sync {
    type Of: Process;

    /// The part that is the same for all rows.
    fn plan(&self) -> &<Self::Of as Process>::Plan<'_>;

    /// The run of a row, and its number there.
    fn origin(&self, row: usize) -> (&<Self::Of as Process>::Plan<'_>, usize);
}

/// Of which variables are recorded: an event, or a row.
pub(crate) trait Described {
    type Of: Process;

    /// Writes the chosen variables into cells, pairs of a lane and a cell.
    fn write(
        &self,
        plan: &<Self::Of as Process>::Plan<'_>,
        columns: &mut [Option<Slices<'_>>],
        cells: &[(usize, usize)],
    );
}

/// An event in each active lane.
pub(crate) trait Event<S: Simd, const K: usize>: Described {
    /// Number of the row, and of the event in it, counted from 0.
    fn place(&self) -> (Pack<S, K>, Pack<S, K>);
    /// The lanes that have an event.
    fn active(&self) -> Mask<S, K>;
    /// Normal velocity before the event, positive towards each other, in the unit of [`Process::units`].
    fn velocity(&self) -> Pack<S, K>;
    /// Coefficient of restitution.
    fn restitution(&self) -> Pack<S, K>;
    /// E_rot/E_tot before the event.
    fn rotational_fraction(&self) -> Pack<S, K>;
    /// Total kinetic energies before and after the event.
    fn energies(&self) -> [Pack<S, K>; 2];

    /// Time, the part that touched, and the states before and after the impact, of a body of revolution.
    #[cfg(feature = "one-lane")]
    #[allow(clippy::type_complexity)]
    fn states(
        &self,
    ) -> Option<(
        Pack<S, K>,
        Pack<S, K>,
        [&crate::motion::SpatialState<S, K>; 2],
    )>;

    /// Total kinetic energy after the event divided by that before.
    #[inline(always)]
    fn energy_ratio(&self) -> Pack<S, K> {
        let [before, after] = self.energies();
        after / before
    }
}

/// Work on events that wait in a queue.
pub(crate) trait Meanwhile {
    /// True if the paper's runs have a bounce loop of their own for this work.
    const INTERLEAVED: bool;

    /// Works up the event at a place.
    fn meanwhile(&mut self, place: usize);

    /// Works up the events at these places.
    #[inline(always)]
    fn settle(&mut self, places: Range<usize>) {
        for place in places {
            self.meanwhile(place);
        }
    }
}

/// A receiver of events, which records or counts them.
pub(crate) trait Sink<P: Process>: Meanwhile {
    /// Announces a release: at no place is there an event to be worked up.
    fn begin(&mut self);
    /// Receives an event in each active lane of a group. What is left to be done with it is done before the next one of this group:
    /// meanwhile, or by [`Meanwhile::settle`].
    fn event<S: Simd, E: Event<S, K, Of = P>, const K: usize>(&mut self, group: usize, event: &E);
    /// Receives the end of a row after so many events.
    fn end(&mut self, row: usize, events: usize, reason: P::Reason);
}

/// Tabulates the variables of an event or a row. A line is `name: type { metadata } = |it, plan| value`; choice, storage, blanks, the
/// binding and the Dataset follow from it.
macro_rules! variables {
    (
        $(#[$doc:meta])* $all:ident: $of:ty, [$($generic:tt)*] $event:ty;
        $($name:ident: $kind:ty { $($about:tt)* } = |$it:pat_param, $plan:pat_param| $value:expr;)*
    ) => {
        $(#[$doc])*
        pub const $all: &[$crate::record::Variable] = &[$(
            $crate::record::Variable {
                key: stringify!($name),
                components: <$kind as $crate::record::Stored>::COMPONENTS,
                kind: <$kind as $crate::record::Stored>::KIND,
                ..variables!(@named $name $($about)*)
            }
        ),*];

        impl<$($generic)*> $crate::record::Described for $event {
            type Of = $of;

            #[inline(always)]
            fn write(
                &self,
                plan: &<$of as $crate::record::Process>::Plan<'_>,
                columns: &mut [Option<$crate::record::Slices<'_>>],
                cells: &[(usize, usize)],
            ) {
                let mut columns = columns.iter_mut();
                $(if let Some(Some(column)) = columns.next() {
                    let ($it, $plan) = (self, plan);
                    let values = $value;
                    <$kind as $crate::record::Stored>::put(column, cells, |lane| {
                        $crate::record::InLanes::<$kind>::lane(&values, lane)
                    });
                })*
            }
        }
    };
    (@named $name:ident name: $given:expr, $($about:tt)*) => {
        $crate::record::Variable { name: $given, $($about)*, ..$crate::record::Variable::PLAIN }
    };
    (@named $name:ident $($about:tt)*) => {
        $crate::record::Variable { name: stringify!($name), $($about)*, ..$crate::record::Variable::PLAIN }
    };
}
pub(crate) use variables;

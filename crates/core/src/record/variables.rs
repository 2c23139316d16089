//! The macro that makes a variable of a line.

/// Tabulates the variables of something that is recorded in a run. A line is `name: type { metadata } = |it, plan| value`; choice, storage, blanks, the
/// binding and the Dataset follow from it.
macro_rules! variables {
    (
        $(#[$doc:meta])* $all:ident: [$($generic:tt)*] $described:ty, $run:ty;
        $($name:ident: $kind:ty { $($about:tt)* } = |$it:pat_param, $plan:pat_param| $value:expr;)*
    ) => {
        $(#[$doc])*
        pub const $all: &[$crate::record::Variable] = &[$(
            $crate::record::Variable {
                key: stringify!($name),
                components: <$kind as $crate::record::Stored>::COMPONENTS,
                each: <$kind as $crate::record::Stored>::EACH,
                kind: <$kind as $crate::record::Stored>::KIND,
                ..variables!(@named $name $($about)*)
            }
        ),*];

        impl<$($generic)*> $described {
            /// Writes the chosen variables into cells, pairs of a lane and a cell.
            #[inline(always)]
            pub(super) fn write(
                &self,
                plan: &$run,
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

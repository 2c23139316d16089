"""A distribution as a C99 and C++ header that needs nothing else."""

import xarray as xr

from restitution.distribution import _store
from restitution.distribution._table import Floats, Ints, Table
from restitution.distribution._text import about, checked_name, chunks, gaps

_FUNCTIONS = """
/* The last of n increasing points that is <= x, but not the last of all. */
static inline int NAME_below(const double *points, int n, double x)
{
    int low = 0, high = n - 1;
    while (high - low > 1) {
        const int middle = low + (high - low) / 2;
        if (points[middle] <= x) {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

/* Chooses one of two neighbours among n points by how near x is; *u is uniform again afterwards. */
static inline int NAME_choose(const double *points, int n, double x, double *u)
{
    int left;
    double weight;
    if (n == 1) {
        return 0;
    }
    left = NAME_below(points, n, x);
    weight = (x - points[left]) / (points[left + 1] - points[left]);
    weight = weight < 0.0 ? 0.0 : weight > 1.0 ? 1.0 : weight;
    if (*u < weight) {
        *u /= weight;
        return left + 1;
    }
    *u = (*u - weight) / (1.0 - weight);
    return left;
}

/* The quantile of u in a histogram of n edges. */
static inline double NAME_quantile(const double *edge, const double *below, int n, double u)
{
    const int bin = NAME_below(below, n, u);
    return edge[bin] + (u - below[bin]) * ((edge[bin + 1] - edge[bin]) / (below[bin + 1] - below[bin]));
}

/* A restitution at impact velocity v. */
static inline double NAME_sample(double v, double u1, double u2)
{
    int node;
RANGE
    node = NAME_choose(NAME_velocity, NAME_nodes, v, &u1);
    return NAME_quantile(NAME_edge + NAME_start[node], NAME_probability_below + NAME_start[node],
                         NAME_start[node + 1] - NAME_start[node], u2);
}
"""

_GIVEN = """
/* A restitution at impact velocity v under condition z. */
static inline double NAME_sample_given(double v, double z, double u1, double u2)
{
    int node, first, component;
RANGE
SEEN
    node = NAME_choose(NAME_velocity, NAME_nodes, v, &u1);
    first = NAME_given_first[node];
    component = first + NAME_choose(NAME_given + first, NAME_given_first[node + 1] - first, z, &u1);
    return NAME_quantile(NAME_given_edge + NAME_given_start[component],
                         NAME_given_probability_below + NAME_given_start[component],
                         NAME_given_start[component + 1] - NAME_given_start[component], u2);
}
"""

_RANGE = """    if (!(v >= NAME_velocity[0] && v <= NAME_velocity[NAME_nodes - 1])) {
        return (double)NAN;
    }"""

_GAP = """
    for (node = 0; node < GAPS; node++) {
        if (v >= NAME_gap_lowest[node] && v < NAME_gap_highest[node]) {
            return (double)NAN;
        }
    }"""

_SEEN = """    node = NAME_below(NAME_velocity, NAME_nodes, v);
    if (!((z >= NAME_given_lowest[node] || z >= NAME_given_lowest[node + 1])
          && (z <= NAME_given_highest[node] || z <= NAME_given_highest[node + 1]))) {
        return (double)NAN;
    }"""


def header(data: xr.Dataset, name: str) -> str:
    """Write the header; see `FluctuatingRestitution.to_c`."""
    guard = f"{checked_name(name).upper()}_H"
    table = _store.table(data)
    lines = ["/*", *(f" * {line}".rstrip() for line in about(data)), " *"]
    lines += [f" *     double eps = {name}_sample(v, u1, u2);"]
    if "given" in data.attrs:
        lines += [f" *     double eps = {name}_sample_given(v, z, u1, u2);"]
    lines += [" */", f"#ifndef {guard}", f"#define {guard}", ""]
    checked = data.attrs["beyond"] != "clamp"
    lines += ["#include <math.h>", ""] if checked else []
    lines += [f"enum {{ {name}_nodes = {table.speeds.size} }};"]
    lines += _arrays(name, "", table)
    functions = _FUNCTIONS
    if "given" in data.attrs:
        lines += _arrays(name, "given_", _store.table(data, "given_"))
        functions += _GIVEN
        if checked:
            for key in ("given_lowest", "given_highest"):
                lines += [_array(f"{name}_{key}", data[key].to_numpy())]
    range_ = _RANGE if checked else ""
    if checked and len(gaps(data)):
        for key, ends in zip(("gap_lowest", "gap_highest"), gaps(data).T, strict=True):
            lines += [_array(f"{name}_{key}", ends)]
        range_ += _GAP.replace("GAPS", str(len(gaps(data))))
    functions = functions.replace("RANGE\n", f"{range_}\n" if checked else "")
    functions = functions.replace("SEEN\n", f"{_SEEN}\n" if checked else "").replace("NAME", name)
    return "\n".join(lines) + "\n" + functions + f"\n#endif /* {guard} */\n"


def _arrays(name: str, prefix: str, table: Table) -> list[str]:
    arrays: dict[str, Floats | Ints] = {"start": table.start}
    if prefix:
        arrays |= {"first": table.first}
    else:
        arrays |= {"velocity": table.speeds}
    arrays |= {"edge": table.edges, "probability_below": table.cumulative}
    lines = [_array(f"{name}_{prefix}{key}", values) for key, values in arrays.items()]
    return [*lines, _array(f"{name}_given", table.conditions)] if prefix else lines


def _array(name: str, values: Floats | Ints) -> str:
    kind = "int" if values.dtype.kind == "i" else "double"
    rows = (", ".join(repr(value) for value in chunk.tolist()) for chunk in chunks(values, 5))
    return f"static const {kind} {name}[{values.size}] = {{\n    " + ",\n    ".join(rows) + "\n};"

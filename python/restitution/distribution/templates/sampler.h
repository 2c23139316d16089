/*
@about
 *
 *     double eps = NAME_sample(v, u1, u2);
@if given
 *     double eps = NAME_sample_given(v, z, u1, u2);
@end
 */
#ifndef GUARD
#define GUARD

@if checked
#include <math.h>

@end
enum { NAME_nodes = NODES };
@arrays

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
@if checked
    if (!(v >= NAME_velocity[0] && v <= NAME_velocity[NAME_nodes - 1])) {
        return (double)NAN;
    }
@end
@if gaps
    for (node = 0; node < GAPS; node++) {
        if (v >= NAME_gap_lowest[node] && v < NAME_gap_highest[node]) {
            return (double)NAN;
        }
    }
@end
    node = NAME_choose(NAME_velocity, NAME_nodes, v, &u1);
    return NAME_quantile(NAME_edge + NAME_start[node], NAME_probability_below + NAME_start[node],
                         NAME_start[node + 1] - NAME_start[node], u2);
}
@if given

/* A restitution at impact velocity v under condition z. */
static inline double NAME_sample_given(double v, double z, double u1, double u2)
{
    int node, first, component;
@if checked
    if (!(v >= NAME_velocity[0] && v <= NAME_velocity[NAME_nodes - 1])) {
        return (double)NAN;
    }
@end
@if gaps
    for (node = 0; node < GAPS; node++) {
        if (v >= NAME_gap_lowest[node] && v < NAME_gap_highest[node]) {
            return (double)NAN;
        }
    }
@end
@if checked
    node = NAME_below(NAME_velocity, NAME_nodes, v);
    if (!((z >= NAME_given_lowest[node] || z >= NAME_given_lowest[node + 1])
          && (z <= NAME_given_highest[node] || z <= NAME_given_highest[node + 1]))) {
        return (double)NAN;
    }
@end
    node = NAME_choose(NAME_velocity, NAME_nodes, v, &u1);
    first = NAME_given_first[node];
    component = first + NAME_choose(NAME_given + first, NAME_given_first[node + 1] - first, z, &u1);
    return NAME_quantile(NAME_given_edge + NAME_given_start[component],
                         NAME_given_probability_below + NAME_given_start[component],
                         NAME_given_start[component + 1] - NAME_given_start[component], u2);
}
@end

#endif /* GUARD */

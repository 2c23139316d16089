/*
 * Coefficient of restitution at random, p(eps | v): restitution 0.1.0.
 *
 *   body = Dumbbell
 *   radius = 0.003
 *   separation = 0.003
 *   density = 2500.0
 *   law = TangentialRestitution
 *   normal = 0.9
 *   tangential = 1.0
 *   particles = 1000
 *   impacts = 20
 *   release_height = 0.06
 *   gravity = 9.81
 *   orientation = uniform-angle
 *   spin = (0.0, 0.0, 0.0)
 *   release_velocity = (0.0, 0.0, 0.0)
 *   incline = 0.0
 *   minimum_speed = 0.0
 *   seed = 1
 *   all_impacts = 20000
 *   energy_created_impacts = 2370
 *   energy_created_share = 0.1185
 *   largest_energy_ratio = 1.8618219008095425
 *   standard_errors = none: counts do not say which particle an impact belongs to
 *
 * v is the normal impact velocity in m/s, from 0.75 to 0.8500000000000001; others give NaN.
 * u1 and u2 are independent uniform random numbers in [0, 1) of yours.
 *
 *     double eps = dist_sample(v, u1, u2);
 */
#ifndef DIST_H
#define DIST_H

#include <math.h>

enum { dist_nodes = 2 };
static const int dist_start[3] = {
    0, 23, 42
};
static const double dist_velocity[2] = {
    0.75, 0.8500000000000001
};
static const double dist_edge[42] = {
    0.15989517370381648, 0.15999999999999992, 0.19999999999999996, 0.28, 0.3600000000000001,
    0.40000000000000013, 0.48, 0.56, 0.6400000000000001, 0.6799999999999999,
    0.72, 0.76, 0.8, 0.8400000000000001, 0.8800000000000001,
    0.9199999999999999, 0.96, 1.0, 1.04, 1.08,
    1.1600000000000001, 1.2400000000000002, 1.2571582961641352, 0.26899911109249086, 0.28,
    0.32000000000000006, 0.3600000000000001, 0.40000000000000013, 0.48, 0.56,
    0.6400000000000001, 0.6799999999999999, 0.72, 0.76, 0.8,
    0.8400000000000001, 0.8800000000000001, 0.9199999999999999, 0.96, 1.0,
    1.04, 1.057547930583252
};
static const double dist_probability_below[42] = {
    0.0, 0.0007331378299120235, 0.006598240469208211, 0.013196480938416423, 0.03519061583577713,
    0.05498533724340176, 0.09530791788856305, 0.13929618768328444, 0.19794721407624633, 0.23826979472140764,
    0.28005865102639294, 0.3277126099706745, 0.3651026392961877, 0.43255131964809385, 0.5117302052785924,
    0.6275659824046921, 0.7155425219941349, 0.7778592375366569, 0.8189149560117303, 0.8695014662756598,
    0.9318181818181818, 0.966275659824047, 1.0, 0.0, 0.002366863905325444,
    0.0035502958579881655, 0.008284023668639054, 0.014201183431952662, 0.05680473372781065, 0.11597633136094675,
    0.19289940828402366, 0.2485207100591716, 0.30532544378698223, 0.3668639053254438, 0.42485207100591715,
    0.5076923076923077, 0.5928994082840237, 0.7562130177514793, 0.8615384615384616, 0.9467455621301775,
    0.9751479289940829, 1.0
};

/* The last of n increasing points that is <= x, but not the last of all. */
static inline int dist_below(const double *points, int n, double x)
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
static inline int dist_choose(const double *points, int n, double x, double *u)
{
    int left;
    double weight;
    if (n == 1) {
        return 0;
    }
    left = dist_below(points, n, x);
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
static inline double dist_quantile(const double *edge, const double *below, int n, double u)
{
    const int bin = dist_below(below, n, u);
    return edge[bin] + (u - below[bin]) * ((edge[bin + 1] - edge[bin]) / (below[bin + 1] - below[bin]));
}

/* A restitution at impact velocity v. */
static inline double dist_sample(double v, double u1, double u2)
{
    int node;
    if (!(v >= dist_velocity[0] && v <= dist_velocity[dist_nodes - 1])) {
        return (double)NAN;
    }
    node = dist_choose(dist_velocity, dist_nodes, v, &u1);
    return dist_quantile(dist_edge + dist_start[node], dist_probability_below + dist_start[node],
                         dist_start[node + 1] - dist_start[node], u2);
}

#endif /* DIST_H */

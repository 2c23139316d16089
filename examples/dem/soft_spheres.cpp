// A gas of soft spheres whose ε is drawn from p(ε | v) at the onset of each contact and kept until it ends.
// g++ -O3 -o soft_spheres soft_spheres.cpp; ./soft_spheres drawn | clipped | CONSTANT, speed in m/s, time in s, seed
#include "grain.h"  // written by soft_spheres.py: double grain_sample(v, u1, u2)
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <utility>
#include <vector>

int main(int, char **argv)
{
    const int N = 125, STEPS = 40;                          // spheres; steps in a contact
    const double D = 6e-3, CONTACT = 3e-4, PI = std::acos(-1.0);  // diameter in m, time of an elastic contact in s
    const double BOX = std::cbrt(N * PI * D * D * D / 6.0 / 0.1);  // a tenth is full
    const double K = 0.5 * PI * PI / (CONTACT * CONTACT), DT = CONTACT / STEPS;  // of spheres of mass 1: m* = 1/2
    const std::string mode = argv[1];
    const double speed = std::atof(argv[2]), until = std::atof(argv[3]);
    std::mt19937_64 random(std::atoi(argv[4]));
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> uniform;
    std::vector<std::array<double, 3>> x(N), v(N), f(N);
    std::vector<double> kept(N * N, NAN);  // the state of a contact: its damping; NaN where there is none
    for (int i = 0; i < N; i++)
        for (int k = 0; k < 3; k++) {
            x[i][k] = BOX / 5.0 * (i / (k == 0 ? 1 : k == 1 ? 5 : 25) % 5);
            v[i][k] = speed * normal(random);
        }
    const auto apart = [&](int i, int j, double *n) {  // from j to the nearest image of i; returns the square
        double r2 = 0.0;
        for (int k = 0; k < 3; k++) {
            n[k] = x[i][k] - x[j][k];
            n[k] -= BOX * std::round(n[k] / BOX);
            r2 += n[k] * n[k];
        }
        return r2;
    };
    double n[3], contacts = 0.0, floored = 0.0, moved = D;
    std::vector<std::pair<int, int>> near;  // those that may touch before a sphere has moved by D / 4
    for (long step = 0; step * DT <= until; step++) {
        if (moved > D / 4.0) {
            near.clear(), moved = 0.0;
            for (int i = 0; i < N; i++)
                for (int j = 0; j < i; j++)
                    if (apart(i, j, n) < 2.25 * D * D) near.emplace_back(i, j);
        }
        for (auto &one : f) one = {0.0, 0.0, 0.0};
        for (const auto &[i, j] : near) {
            double rate = 0.0;
            const double r2 = apart(i, j, n);
            double &damping = kept[i * N + j];
            if (r2 >= D * D) { damping = NAN; continue; }  // over: the next contact draws anew
            const double r = std::sqrt(r2);
            for (int k = 0; k < 3; k++) rate += (v[j][k] - v[i][k]) * (n[k] /= r);  // of the overlap
            if (std::isnan(damping)) {
                const double met = std::clamp(rate, 0.05, 0.8);  // the range that was learned
                double e = mode[0] == 'd' || mode[0] == 'c' ? grain_sample(met, uniform(random), uniform(random))
                                                            : std::atof(mode.c_str());
                contacts++, floored += e < 0.05;
                e = std::clamp(e, 0.05, mode[0] == 'c' ? 1.0 : 100.0);
                damping = -std::log(e) / std::hypot(PI, std::log(e)) * std::sqrt(2.0 * K);  // 2 ζ √(k m*), m* = 1/2
            }
            const double push = K * (D - r) + damping * rate;
            for (int k = 0; k < 3; k++) f[i][k] += push * n[k], f[j][k] -= push * n[k];
        }
        double energy = 0.0, fastest = 0.0;
        for (int i = 0; i < N; i++) {
            for (int k = 0; k < 3; k++) energy += v[i][k] * v[i][k] / (3.0 * N), x[i][k] += DT * (v[i][k] += DT * f[i][k]);
            fastest = std::max(fastest, std::hypot(v[i][0], v[i][1], v[i][2]));
        }
        moved += fastest * DT;
        if (step % std::lround(until / DT / 10) == 0)
            std::printf("%.3f %.5f %.1f %.4f\n", step * DT, std::sqrt(energy), 2.0 * contacts / N, floored / contacts);
    }
}

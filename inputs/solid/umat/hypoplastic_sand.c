/* Hypoplastic sand: rate equation of stress and void ratio with the critical surface of Matsuoka and Nakai.
 *
 * Source: von Wolffersdorff (1996), Mech. Cohes.-Frict. Mater. 1, 251-271; pressure-dependent void ratios by Bauer
 * (1996), Soils Found. 36(1). Integration: Runge-Kutta of order 4 in steps of 1e-4 strain at most.
 * PROPS: 1 critical friction angle [deg], 2 granulate hardness h_s [Pa], 3 n, 4 e_d0, 5 e_c0, 6 e_i0, 7 alpha, 8 beta,
 * 9 pressure [Pa] added to the stress, which keeps the law defined at a free surface.
 * STATEV: 1 void ratio. DDSDDE stays 0: the program takes differences. PNEWDT is 0.5 beyond the range of the law. */
#include "umat.h"
#include <math.h>

#define STEP 1e-4
#define MOST_STEPS 20000
#define STATE 7

UMAT_COUNTS(9, 1);

static double trace(const double *t) { return t[0] + t[1] + t[2]; }

/* T : S of tensors, shear components once. */
static double product(const double *t, const double *s) {
    double sum = 0.0;
    for (int i = 0; i < 6; i++) sum += (i < 3 ? 1.0 : 2.0) * t[i] * s[i];
    return sum;
}

static double determinant(const double *t) {
    return t[0] * t[1] * t[2] + 2.0 * t[3] * t[4] * t[5] - t[0] * t[5] * t[5] - t[1] * t[4] * t[4] -
           t[2] * t[3] * t[3];
}

/* F: 1 in compression, Lode angle by cos(3 theta) = -sqrt(6) tr(T*^3) / (tr(T*^2))^(3/2). */
static double lode_factor(const double *deviator) {
    const double square = product(deviator, deviator);
    if (square <= 1e-30) return 1.0;
    double cosine = -3.0 * sqrt(6.0) * determinant(deviator) / (square * sqrt(square));
    cosine = fmin(1.0, fmax(-1.0, cosine));
    const double tangent = sqrt(3.0 * square);
    const double inner =
        tangent * tangent / 8.0 + (2.0 - tangent * tangent) / (2.0 + sqrt(2.0) * tangent * cosine);
    return sqrt(fmax(inner, 0.0)) - tangent / (2.0 * sqrt(2.0));
}

/* Rates of stress (six) and void ratio by a strain path of unit length; returns 0 outside the range of the law. */
static int rates(const double *state, const double *strain, const double *props, double *rate) {
    const double pi = 3.14159265358979323846;
    const double sine = sin(props[0] * pi / 180.0), hardness = props[1], n = props[2];
    const double ed0 = props[3], ec0 = props[4], ei0 = props[5], alpha = props[6], beta = props[7];
    const double e = state[6];
    double t[6], d[6], hat[6], star[6];
    for (int i = 0; i < 6; i++) {
        t[i] = state[i] - (i < 3 ? props[8] : 0.0);
        d[i] = i < 3 ? strain[i] : 0.5 * strain[i];
    }
    const double sum = -trace(t);
    if (!(sum > 1e-12 * hardness) || !(e > 0.0)) return 0;
    for (int i = 0; i < 6; i++) {
        hat[i] = -t[i] / sum;
        star[i] = hat[i] - (i < 3 ? 1.0 / 3.0 : 0.0);
    }
    const double a = sqrt(3.0) * (3.0 - sine) / (2.0 * sqrt(2.0) * sine), f = lode_factor(star);
    const double bauer = exp(-pow(sum / hardness, n));
    const double ed = ed0 * bauer, ec = ec0 * bauer, ei = ei0 * bauer;
    const double fd = e > ed ? pow((e - ed) / (ec - ed), alpha) : 0.0, fe = pow(ec / e, beta);
    const double isotropic = 3.0 + a * a - sqrt(3.0) * a * pow((ei0 - ed0) / (ec0 - ed0), alpha);
    const double fb = hardness / n * pow(ei0 / ec0, beta) * (1.0 + ei) / ei * pow(sum / hardness, 1.0 - n) / isotropic;
    const double scale = fb * fe / product(hat, hat), along = product(hat, d), size = sqrt(product(d, d));
    for (int i = 0; i < 6; i++)
        rate[i] = scale * (f * f * d[i] + a * a * along * hat[i] + fd * a * f * (hat[i] + star[i]) * size);
    rate[6] = (1.0 + e) * trace(d);
    return 1;
}

/* One step of Runge-Kutta. */
static int advance(double *state, const double *strain, const double *props) {
    static const double at[4] = {0.0, 0.5, 0.5, 1.0}, weight[4] = {1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0};
    double rate[STATE] = {0.0}, sum[STATE] = {0.0}, trial[STATE];
    for (int k = 0; k < 4; k++) {
        for (int i = 0; i < STATE; i++) trial[i] = state[i] + at[k] * rate[i];
        if (!rates(trial, strain, props, rate)) return 0;
        for (int i = 0; i < STATE; i++) sum[i] += weight[k] * rate[i];
    }
    for (int i = 0; i < STATE; i++) state[i] += sum[i];
    return 1;
}

UMAT_DEFINITION {
    double state[STATE], part[6], length = 0.0;
    for (int i = 0; i < 6; i++) {
        state[i] = stress[i];
        length += (i < 3 ? 1.0 : 0.5) * dstran[i] * dstran[i];
    }
    state[6] = statev[0];
    const double steps = ceil(fmax(1.0, sqrt(length) / STEP));
    if (!(steps <= MOST_STEPS)) {
        *pnewdt = 0.5;
        return;
    }
    for (int i = 0; i < 6; i++) part[i] = dstran[i] / steps;
    for (int k = 0; k < (int)steps; k++) {
        if (!advance(state, part, props)) {
            *pnewdt = 0.5;
            return;
        }
    }
    for (int i = 0; i < 6; i++) stress[i] = state[i];
    statev[0] = state[6];
}

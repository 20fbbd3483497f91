/* Drucker-Prager plasticity: linear elasticity, exact return to cone and apex, consistent tangent.
 *
 * sqrt(J2) + eta p - k <= 0 with p = tr(sigma)/3; flow by sqrt(J2) + eta_bar p. Source: de Souza Neto, Peric and
 * Owen (2008), section 8.3.
 * PROPS: 1 Young's modulus [Pa], 2 Poisson's ratio, 3 eta, 4 k [Pa], 5 eta_bar.
 * STATEV: 1 equivalent plastic strain. SSE and SPD are set. */
#include "umat.h"
#include <math.h>

UMAT_COUNTS(5, 1);

static double energy(const double *s, double young, double poisson) {
    double square = 0.0;
    for (int i = 0; i < 6; i++) square += (i < 3 ? 1.0 : 2.0) * s[i] * s[i];
    const double trace = s[0] + s[1] + s[2];
    return 0.5 * ((1.0 + poisson) * square - poisson * trace * trace) / young;
}

/* d p = a[0] d p_trial + a[1] d q_trial, d q = a[2] d p_trial + a[3] d q_trial; n: deviator over q; ratio: q over q_trial. */
static void tangent(double *ddsdde, const double *n, const double *a, double ratio, double bulk, double shear) {
    for (int i = 0; i < 6; i++) {
        const double one_i = i < 3 ? 1.0 : 0.0;
        const double by_p = (one_i * a[0] + n[i] * a[2]) * bulk;
        const double by_q = (one_i * a[1] + n[i] * (a[3] - ratio)) * shear;
        for (int j = 0; j < 6; j++) {
            const double one_j = j < 3 ? 1.0 : 0.0;
            const double unit = i != j ? 0.0 : i < 3 ? 1.0 : 0.5;
            ddsdde[i + 6 * j] =
                by_p * one_j + by_q * n[j] + 2.0 * shear * ratio * (unit - one_i * one_j / 3.0);
        }
    }
}

UMAT_DEFINITION {
    const double young = props[0], poisson = props[1], eta = props[2], strength = props[3], flow = props[4];
    const double shear = 0.5 * young / (1.0 + poisson), bulk = young / (3.0 * (1.0 - 2.0 * poisson));
    const double lambda = bulk - 2.0 / 3.0 * shear, volume = dstran[0] + dstran[1] + dstran[2];
    const double before = energy(stress, young, poisson);
    double trial[6], work = 0.0;
    for (int i = 0; i < 6; i++)
        trial[i] = stress[i] + (i < 3 ? lambda * volume + 2.0 * shear * dstran[i] : shear * dstran[i]);
    const double p = (trial[0] + trial[1] + trial[2]) / 3.0;
    double n[6], j2 = 0.0;
    for (int i = 0; i < 6; i++) {
        n[i] = trial[i] - (i < 3 ? p : 0.0);
        j2 += (i < 3 ? 0.5 : 1.0) * n[i] * n[i];
    }
    const double q = sqrt(j2);
    for (int i = 0; i < 6; i++) n[i] = q > 0.0 ? n[i] / q : 0.0;
    double end_p = p, end_q = q;
    double a[4] = {1.0, 0.0, 0.0, 1.0};
    const double excess = q + eta * p - strength;
    if (excess > 1e-12 * (fabs(p) + q)) {
        const double stiffness = shear + bulk * eta * flow;
        end_p = p - bulk * flow * excess / stiffness;
        end_q = q - shear * excess / stiffness;
        a[0] = 1.0 - bulk * flow * eta / stiffness;
        a[1] = -bulk * flow / stiffness;
        a[2] = -shear * eta / stiffness;
        a[3] = 1.0 - shear / stiffness;
        if (end_q < 0.0) {
            end_p = strength / eta;
            end_q = a[0] = a[1] = a[2] = a[3] = 0.0;
        }
    }
    for (int i = 0; i < 6; i++) {
        const double end = end_q * n[i] + (i < 3 ? end_p : 0.0);
        work += 0.5 * (stress[i] + end) * dstran[i];
        stress[i] = end;
    }
    tangent(ddsdde, n, a, q > 0.0 ? end_q / q : 1.0, bulk, shear);
    const double plastic_volume = (p - end_p) / bulk, plastic_shear = (q - end_q) / shear;
    statev[0] += sqrt(plastic_shear * plastic_shear / 3.0 + 2.0 / 9.0 * plastic_volume * plastic_volume);
    const double stored = energy(stress, young, poisson) - before;
    *sse += stored;
    *spd += work - stored;
}

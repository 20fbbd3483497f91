/* Isotropic elasticity with stored energy.
 *
 * PROPS: 1 Young's modulus [Pa], 2 Poisson's ratio. No state variables. */
#include "umat.h"

UMAT_COUNTS(2, 0);

UMAT_DEFINITION {
    const double young = props[0], poisson = props[1];
    const double mu = 0.5 * young / (1.0 + poisson);
    const double lambda = 2.0 * mu * poisson / (1.0 - 2.0 * poisson);
    const double volume = dstran[0] + dstran[1] + dstran[2];
    double work = 0.0;
    for (int i = 0; i < 6; i++) {
        const double old = stress[i];
        stress[i] += i < 3 ? lambda * volume + 2.0 * mu * dstran[i] : mu * dstran[i];
        work += 0.5 * (old + stress[i]) * dstran[i];
        for (int j = 0; j < 6; j++) {
            const int normal = i < 3 && j < 3;
            const double diagonal = i != j ? 0.0 : normal ? 2.0 * mu : mu;
            ddsdde[i + 6 * j] = diagonal + (normal ? lambda : 0.0);
        }
    }
    *sse += work;
}

/* Routine that shows its arguments: stress by an unsymmetric matrix of distinct entries.
 *
 * PROPS: 1 mode: 0 matrix, 1 PNEWDT, 2 stress, 3 state, 4 tangent not finite, 5 STATEV overrun, 6 no tangent;
 * 2 largest strain increment without PNEWDT.
 * STATEV: arguments as set below, 7 to 12 STRAN at the start. */
#include "../../../../inputs/solid/umat/umat.h"
#include <math.h>
#include <string.h>

UMAT_COUNTS(2, 20);

UMAT_DEFINITION {
    const int mode = (int)props[0];
    for (int i = 0; i < 6; i++) {
        for (int j = 0; j < 6; j++) {
            const double entry = 1e6 * (10 * (i + 1) + (j + 1)) + (i == j ? 1e8 : 0.0);
            stress[i] += entry * dstran[j];
            if (mode != 6) ddsdde[i + 6 * j] = entry;
            if (fabs(dstran[j]) > props[1]) *pnewdt = 0.25;
        }
    }
    const double unit = drot[0] + 10.0 * drot[4] + 100.0 * drot[8] + drot[1] + dfgrd0[0] + dfgrd1[4];
    const int blanks = cmname[4] == ' ' && cmname[79] == ' ' && cmname_length == 80;
    const double shown[] = {time[0], time[1], *dtime, *noel, *npt, *kinc};
    memcpy(statev, shown, sizeof shown);
    memcpy(statev + 6, stran, 6 * sizeof *stran);
    statev[12] = 100 * *ndi + 10 * *nshr + *ntens;
    statev[13] = 100 * *nstatv + *nprops;
    statev[14] = unit;
    statev[15] = 1000 * (cmname[0] == 'S') + 100 * (cmname[3] == 'L') + blanks;
    statev[16] = 1000 * jstep[0] + 100 * *layer + 10 * *kspt + *celent;
    *sse += 2.0;
    *spd += 3.0;
    *scd += 4.0;
    if (mode == 1) *pnewdt = 0.5;
    if (mode == 2) stress[1] = NAN;
    if (mode == 3) statev[19] = INFINITY;
    if (mode == 4) ddsdde[7] = NAN;
    if (mode == 5) statev[20] = 1.0;
}

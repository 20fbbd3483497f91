/* Interface UMAT of Abaqus for routines in C; see docs/scene.md, [[solid.material]].
 *
 * Order 11, 22, 33, 12, 13, 23; engineering shear; tension positive; matrices by columns: DDSDDE[row + 6 * column].
 * Constants and state variables of a library are declared, if it exports them, by the integers umat_nprops and
 * umat_nstatv. */
#ifndef UMAT_H
#define UMAT_H

#include <stddef.h>

#if defined(_WIN32)
#define UMAT_EXPORT __declspec(dllexport)
#else
#define UMAT_EXPORT __attribute__((visibility("default")))
#endif

#define UMAT_COUNTS(constants, states)                                                                                 \
    UMAT_EXPORT const int umat_nprops = (constants);                                                                   \
    UMAT_EXPORT const int umat_nstatv = (states)

UMAT_EXPORT void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd,
                       double *rpl, double *ddsddt, double *drplde, double *drpldt, const double *stran,
                       const double *dstran, const double *time, const double *dtime, const double *temp,
                       const double *dtemp, const double *predef, const double *dpred, const char *cmname,
                       const int *ndi, const int *nshr, const int *ntens, const int *nstatv, const double *props,
                       const int *nprops, const double *coords, const double *drot, double *pnewdt,
                       const double *celent, const double *dfgrd0, const double *dfgrd1, const int *noel,
                       const int *npt, const int *layer, const int *kspt, const int *jstep, const int *kinc,
                       size_t cmname_length);

/* Heading of a definition of umat_ with the names above. */
#define UMAT_DEFINITION                                                                                                \
    void umat_(double *stress, double *statev, double *ddsdde, double *sse, double *spd, double *scd, double *rpl,     \
               double *ddsddt, double *drplde, double *drpldt, const double *stran, const double *dstran,             \
               const double *time, const double *dtime, const double *temp, const double *dtemp,                      \
               const double *predef, const double *dpred, const char *cmname, const int *ndi, const int *nshr,         \
               const int *ntens, const int *nstatv, const double *props, const int *nprops, const double *coords,      \
               const double *drot, double *pnewdt, const double *celent, const double *dfgrd0,                         \
               const double *dfgrd1, const int *noel, const int *npt, const int *layer, const int *kspt,               \
               const int *jstep, const int *kinc, size_t cmname_length)

#endif

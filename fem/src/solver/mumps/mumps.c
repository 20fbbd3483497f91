/* C interface to MUMPS: the layout of its structure depends on the version, so only its own header can define it. */

#include <stdlib.h>
#include <string.h>

#include <dmumps_c.h>

_Static_assert(sizeof(MUMPS_INT) == sizeof(int), "a MUMPS with integers of 32 bits is needed");

/* MPI_COMM_WORLD for every version of MUMPS. */
enum { WORLD = -987654 };

/* Returns a silent instance for symmetric matrices, or null if out of memory. SYM = 2 (indefinite) is needed for the
   detection of null pivots. */
DMUMPS_STRUC_C *trackbed_mumps_start(void) {
    DMUMPS_STRUC_C *id = calloc(1, sizeof *id);
    if (!id) {
        return NULL;
    }
    id->par = 1;
    id->sym = 2;
    id->comm_fortran = WORLD;
    id->job = -1;
    dmumps_c(id);
    if (id->infog[0] < 0) {
        free(id);
        return NULL;
    }
    for (int i = 0; i < 3; i++) {
        id->icntl[i] = -1;
    }
    id->icntl[3] = 0;
    return id;
}

/* Ends an instance and removes its files. */
void trackbed_mumps_end(DMUMPS_STRUC_C *id) {
    id->job = -2;
    dmumps_c(id);
    free(id);
}

/* Sets ICNTL(index). */
void trackbed_mumps_set(DMUMPS_STRUC_C *id, int index, int value) {
    id->icntl[index - 1] = value;
}

/* Sets CNTL(index). */
void trackbed_mumps_set_real(DMUMPS_STRUC_C *id, int index, double value) {
    id->cntl[index - 1] = value;
}

/* Sets the directory of out-of-core files; returns 0 if the name is too long. */
int trackbed_mumps_folder(DMUMPS_STRUC_C *id, const char *folder) {
    if (strlen(folder) >= sizeof id->ooc_tmpdir) {
        return 0;
    }
    strcpy(id->ooc_tmpdir, folder);
    return 1;
}

/* Sets one triangle by coordinates and the elimination position of each equation, all from 1. */
void trackbed_mumps_matrix(DMUMPS_STRUC_C *id, int n, long long nnz, int *row, int *column, double *value, int *place) {
    id->n = n;
    id->nnz = nnz;
    id->irn = row;
    id->jcn = column;
    id->a = value;
    id->perm_in = place;
}

/* Sets the right-hand side, overwritten by the solution. */
void trackbed_mumps_side(DMUMPS_STRUC_C *id, double *x) {
    id->rhs = x;
    id->nrhs = 1;
    id->lrhs = id->n;
}

/* Runs a job and returns INFOG(1). */
int trackbed_mumps_run(DMUMPS_STRUC_C *id, int job) {
    id->job = job;
    dmumps_c(id);
    return id->infog[0];
}

/* INFOG(index). */
int trackbed_mumps_info(const DMUMPS_STRUC_C *id, int index) {
    return id->infog[index - 1];
}

/* Returns the first equation with a null pivot, from 1; valid if INFOG(28) > 0. */
int trackbed_mumps_null_pivot(const DMUMPS_STRUC_C *id) {
    return id->pivnul_list ? id->pivnul_list[0] : 0;
}

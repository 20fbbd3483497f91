// Motion of the bodies.

/// Moves a body that is free, as all of its group of four are.
DEVICE void advance_free(const four x, const four v, const four w, const sums s, const four g, const real kick, const real dt,
                         const real damping, four *nx, four *nv, four *nw, real *speed2, real *held) {
//@FREE
}

/// Moves a body by itself; `fixed`: bits of the motions that do not change.
DEVICE void advance_single(const four x, const four v, const four w, const sums s, const four g, const real kick, const real dt,
                           const real damping, const two constants, const unsigned fixed, four *nx, four *nv, four *nw, real *speed2,
                           real *held) {
//@SINGLE
}

/// Moves body `i`.
DEVICE void advance(ARGUMENTS p, const unsigned i, const four x, const four v, const four w, const sums s) {
    const four g = {GRAVITY_X, GRAVITY_Y, GRAVITY_Z, 0.0};
    four nx = x, nv = v, nw = w;
    real speed2;
#if HELD
    real *held = HELD_BY + HELD_WIDTH * i;
#else
    real *held = 0;
#endif
#if CLUMPS
    four nq;
    if (!turn(p, i, x, v, w, s, g, &nx, &nv, &nw, &nq, &speed2, held))
#endif
    {
        if (BY_FOUR(i)) {
            advance_free(x, v, w, s, g, STEP, WAY, DAMPING, &nx, &nv, &nw, &speed2, held);
        } else {
            advance_single(x, v, w, s, g, STEP, WAY, DAMPING, CONSTANTS[i], FIXED(i), &nx, &nv, &nw, &speed2, held);
        }
    }
#if CLUMPS
    place(p, i, nx, nq);
#endif
    NEW_X[i] = nx;
    NEW_V[i] = nv;
    NEW_W[i] = nw;
    SPEED2[i] = speed2;
    if (!(speed2 <= BOUND * BOUND)) FLAGS[0] = 1;
}

/// Component `d` of the sum of mass times position of a block's bodies.
DEVICE real moment(ARGUMENTS p, const unsigned first, const unsigned last, const unsigned d) {
    real lane[4] = {0.0, 0.0, 0.0, 0.0}, single = 0.0;
    for (unsigned i = first; i < last; ++i) {
        const real x = ((const real *)(OLD_X + i))[d];
        if (BY_FOUR(i)) {
            lane[(i - first) & 3] += x * (1.0 / OLD_V[i].w);
        } else {
            single += x * CONSTANTS[i].x;
        }
    }
    return single + ((lane[0] + lane[1]) + (lane[2] + lane[3]));
}

DEVICE real fastest2(ARGUMENTS p, const unsigned first, const unsigned last) {
    real most = 0.0;
    for (unsigned i = first; i < last; ++i) most = SPEED2[i] > most ? SPEED2[i] : most;
    return most;
}

DEVICE real motion_books(ARGUMENTS p, const unsigned *from, const unsigned *to, const unsigned q) {
    return q < 3 ? moment(p, from[0], to[0], q) : fastest2(p, from[0], to[0]);
}

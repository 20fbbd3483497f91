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

/// Component `d` of the sum of mass times position of the bodies that move four at a time, of them every fourth.
DEVICE real moment_lane(ARGUMENTS p, const unsigned first, const unsigned last, const unsigned d, const unsigned lane) {
    real sum = 0.0;
    for (unsigned i = first + lane; i < last; i += 2 * BATCH) {
        real x[BATCH / 2], mass[BATCH / 2];
        unsigned how[BATCH / 2];
        UNROLL for (unsigned m = 0; m < BATCH / 2; ++m) {
            const unsigned k = AT_MOST(i + 4 * m, last - 1);
            x[m] = ((const real *)(OLD_X + k))[d];
            mass[m] = MASS[k];
            how[m] = BY_FOUR(k);
        }
        UNROLL for (unsigned m = 0; m < BATCH / 2; ++m) sum += i + 4 * m < last && how[m] ? x[m] * mass[m] : 0.0;
    }
    return sum;
}

/// The first body of a block that moves by itself, or one past the last.
DEVICE unsigned first_single(ARGUMENTS p, const unsigned *from) {
    return FIRST_SINGLE[(unsigned)(from - RANGES) / LISTS];
}

/// Component `d` of the sum of mass times position of a block's bodies.
DEVICE real moment(ARGUMENTS p, const unsigned *from, const unsigned *to, const unsigned d) {
    real single = 0.0;
    for (unsigned i = first_single(p, from); i < to[0]; ++i) {
        if (!(BY_FOUR(i))) single += ((const real *)(OLD_X + i))[d] * MASS[i];
    }
    return single + LANES(moment_lane, p, from[0], to[0], d);
}

/// The largest square of a speed of every fourth body.
DEVICE real fastest_lane(ARGUMENTS p, const unsigned first, const unsigned last, const unsigned lane) {
    real most = 0.0;
    for (unsigned i = first + lane; i < last; i += 4 * BATCH) {
        real x[BATCH];
        UNROLL for (unsigned m = 0; m < BATCH; ++m) x[m] = SPEED2[AT_MOST(i + 4 * m, last - 1)];
        UNROLL for (unsigned m = 0; m < BATCH; ++m) most = x[m] > most ? x[m] : most;
    }
    return most;
}

DEVICE real motion_books(ARGUMENTS p, const unsigned *from, const unsigned *to, const unsigned q) {
    return q < 3 ? moment(p, from, to, q) : LARGEST(fastest_lane, p, from[0], to[0]);
}

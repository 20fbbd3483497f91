// Clumps: their turns, and where these take their spheres.

/// Tangent of half the angle by which a free body turns in a step, about the axis of the turn, in its own frame.
DEVICE four half_turn(const four q, const four l, const four moments, const real dt) {
    four start, half, c = none(), next = none();
    int more;
//@MIDPOINT
    for (unsigned n = 0; n < ITERATIONS; ++n) {
//@ITERATE
        c = next;
        if (!more) break;
    }
    return c;
}

/// Moves a free body of a group of four in which a clump is.
DEVICE void advance_among(const four x, const four v, const four w, const four q, const four l, const four moments, const sums s, const four g,
                          const real kick, const real dt, const real damping, four *nx, four *nv, four *nw, four *nq, four *nl, real *speed2,
                          real *held) {
//@AMONG_KICK
    const four c = half_turn(q, *nl, moments, dt);
//@AMONG
}

/// Moves a clump by itself; `target`: the spin that it has where its rotation is fixed.
DEVICE void advance_alone(const four x, const four v, const four w, const four q, const four l, const four moments, const sums s, const four g,
                          const real kick, const real dt, const real damping, const two constants, const unsigned fixed, const four target,
                          four *nx, four *nv, four *nw, four *nq, four *nl, real *speed2, real *held) {
    if (fixed >> 3) {
//@ALONE_HELD
        return;
    }
//@ALONE_KICK
    const four c = half_turn(q, *nl, moments, dt);
//@ALONE
}

/// Moves a body that turns, and puts its orientation and its momentum down; whether it does.
DEVICE int turn(ARGUMENTS p, const unsigned i, const four x, const four v, const four w, const sums s, const four g, four *nx, four *nv,
                four *nw, four *nq, real *speed2, real *held) {
    const four q = OLD_ORIENTATION[i], l = OLD_MOMENTUM[i], moments = MOMENTS[i];
    four nl = l;
    *nq = q;
    if (TURNS(i)) {
        if (BY_FOUR(i)) {
            advance_among(x, v, w, q, l, moments, s, g, STEP, WAY, DAMPING, nx, nv, nw, nq, &nl, speed2, held);
        } else {
            advance_alone(x, v, w, q, l, moments, s, g, STEP, WAY, DAMPING, CONSTANTS[i], FIXED(i), TARGET[i], nx, nv, nw, nq, &nl, speed2,
                          held);
        }
    }
    NEW_ORIENTATION[i] = *nq;
    NEW_MOMENTUM[i] = nl;
    return TURNS(i);
}

/// Puts the spheres of a body where its centre and orientation say.
DEVICE void place(ARGUMENTS p, const unsigned i, const four x, const four q) {
    for (unsigned k = FIRST_SPHERE[i]; k < FIRST_SPHERE[i + 1]; ++k) {
        const four local = LOCAL[k];
        four sphere = local;
        if (ORIENTED(i)) {
//@PLACE
        } else {
            sphere = x;
        }
        NEW_SPHERES[k] = sphere;
    }
}

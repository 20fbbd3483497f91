// What the processor has worked out of a step, and what it needs to know for the next.

/// Adds forces one by one, as the engine does.
DEVICE void handed_over(ARGUMENTS p, const unsigned c, const unsigned there, const int second, const four x, const four v, const four w,
                        sums *s) {
    for (unsigned k = HANDED_START[c]; k < HANDED_START[c + 1]; ++k) {
        add(&s->force, HANDED[2 * k]);
        add(&s->torque, HANDED[2 * k + 1]);
    }
}

/// Motion of the bodies that the processor needs to know.
KERNEL(pick) {
    THREAD(t, WATCHED_COUNT)
    const unsigned i = WATCHED[t];
    four *picked = PICKED + PICKED_WIDTH * t;
    picked[0] = OLD_X[i];
    picked[1] = OLD_V[i];
    picked[2] = OLD_W[i];
#if CLUMPS
    picked[3] = OLD_ORIENTATION[i];
#endif
}
RUN(pick)

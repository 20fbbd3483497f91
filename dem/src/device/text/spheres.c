// Contacts of single spheres.

DEVICE int spheres_touch(const four xa, const four xb) {
    int on;
//@SPHERES_TOUCH
    return on;
}

DEVICE void spheres(const four xa, const four va, const four wa, const four xb, const four vb, const four wb, const real *k, const four m,
                    const four r, const real step, outcome *o) {
//@SPHERES
}

/// A contact of two spheres, seen from one of them.
DEVICE void sphere_contact(ARGUMENTS p, const unsigned c, const unsigned there, const int second, const four x, const four v, const four w, sums *s) {
    const four x_there = OLD_X[there];
    const four xa = second ? x_there : x, xb = second ? x : x_there;
    const int on = spheres_touch(xa, xb);
    if (!on && second) return;
    const four m = OLD_MEMORY[c], w_there = OLD_W[there];
    const four wa = second ? w_there : w, wb = second ? w : w_there;
    const real *k = law_of(p, wa, wb);
    const four r = old_turn(p, c);
    if (!on) {
        end(p, c, k, m, r);
        return;
    }
    const four v_there = OLD_V[there];
    outcome o;
    spheres(xa, second ? v_there : v, wa, xb, second ? v : v_there, wb, k, m, r, STEP, &o);
    hand_out(p, c, second, o, s);
}

DEVICE real spheres_books(ARGUMENTS p, const unsigned *from, const unsigned *to, const unsigned q) {
    const unsigned list = 1 + q / 2;
    real sum = in_lanes((const real *)(SPENT + from[list]) + (q & 1), to[list] - from[list], 2);
#if PERIODIC
    // Contacts across borders come after those across blocks, one by one.
    for (unsigned c = from[IMAGES_LIST]; c < to[IMAGES_LIST] && q < 2; ++c) sum += q == 0 ? SPENT[c].x : SPENT[c].y;
#endif
    return sum;
}

// Contacts across periodic borders.

DEVICE int images_touch(const four xa, const four xb, const four way) {
    int on;
//@IMAGES_TOUCH
    return on;
}

/// `couple`: the angular impulse about the origin that a step of it gives.
DEVICE void images(const four xa, const four va, const four wa, const four ca, const four xb, const four vb, const four wb, const four cb,
                   const four way, const real *k, const four m, const four r, const real step, outcome *o, four *couple) {
//@IMAGES
}

/// A contact with the image of a sphere, seen from one of the bodies.
DEVICE void image_contact(ARGUMENTS p, const unsigned c, const unsigned there, const int second, const four x, const four v, const four w, sums *s) {
    const unsigned here = second ? ENDS[c].second : ENDS[c].first;
    const four own = SPHERE(here), other = SPHERE(there), way = WAYS[c - FIRST_IMAGE];
    const four xa = second ? other : own, xb = second ? own : other;
    const int on = images_touch(xa, xb, way);
    if (!second) COUPLES[c - FIRST_IMAGE] = none();
    if (!on && second) return;
    const unsigned body = BODY(there);
    const four m = OLD_MEMORY[c], r = old_turn(p, c), w_there = OLD_W[body];
    const four wa = second ? w_there : w, wb = second ? w : w_there;
    const real *k = law_of(p, wa, wb);
    if (!on) {
        end(p, c, k, m, r);
        return;
    }
    const four x_there = OLD_X[body], v_there = OLD_V[body];
    outcome o;
    four couple = none();
    images(xa, second ? v_there : v, wa, second ? x_there : x, xb, second ? v : v_there, wb, second ? x : x_there, way, k, m, r, STEP, &o,
           &couple);
    hand_out(p, c, second, o, s);
    if (!second) COUPLES[c - FIRST_IMAGE] = couple;
}

/// What they do about the origin; what they took joins that of the other contacts across blocks.
DEVICE real images_books(ARGUMENTS p, const unsigned *from, const unsigned *to, const unsigned q) {
    return in_turn((const real *)(COUPLES + (from[IMAGES_LIST] - FIRST_IMAGE)) + q, to[IMAGES_LIST] - from[IMAGES_LIST], 4);
}

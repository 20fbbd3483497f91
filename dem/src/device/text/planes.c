// Contacts of single spheres with planes.

DEVICE int plane_touches(const four x, const four face) {
    int on;
//@PLANE_TOUCHES
    return on;
}

DEVICE void plane(const four x, const four v, const four w, const four face, const four motion, const real *k, const four m, const four r,
                  const real step, outcome *o, four *wall) {
//@PLANE
}

/// A contact of a sphere with a plane.
DEVICE void plane_contact(ARGUMENTS p, const unsigned c, const unsigned there, const int second, const four x, const four v, const four w, sums *s) {
    const four face = PLANES[2 * there], motion = PLANES[2 * there + 1], m = OLD_MEMORY[c];
    const real *k = law_of(p, w, motion);
    four *wall = WALLS + 2 * (c - FIRST_PLANE);
    const four r = old_turn(p, c);
    if (!plane_touches(x, face)) {
        end(p, c, k, m, r);
        wall[0] = none();
        wall[1] = none();
        return;
    }
    outcome o;
    plane(x, v, w, face, motion, k, m, r, STEP, &o, wall);
    add(&s->force, o.force);
    add(&s->torque, o.torque_a);
    keep(p, c, o);
}

DEVICE real planes_books(ARGUMENTS p, const unsigned *from, const unsigned *to, const unsigned q) {
    if (q < 2) return in_lanes((const real *)(SPENT + from[3]) + q, to[3] - from[3], 2);
    return in_lanes((const real *)(WALLS + 2 * (from[3] - FIRST_PLANE)) + (q - 2), to[3] - from[3], 8);
}

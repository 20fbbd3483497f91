// Contacts of spheres that may be members of clumps.

DEVICE void members(const four xa, const four va, const four wa, const four ca, const four xb, const four vb, const four wb, const four cb,
                    const real *k, const four m, const four r, const real step, outcome *o) {
//@MEMBERS
}

DEVICE void member_plane(const four x, const four v, const four w, const four centre, const four face, const four motion, const real *k,
                         const four m, const four r, const real step, outcome *o, four *wall) {
//@MEMBER_PLANE
}

/// A contact of two spheres that may be members of clumps, seen from one of their bodies.
DEVICE void member_contact(ARGUMENTS p, const unsigned c, const unsigned there, const int second, const four x, const four v, const four w, sums *s) {
    const unsigned here = second ? ENDS[c].second : ENDS[c].first;
    const four own = OLD_SPHERES[here], other = OLD_SPHERES[there];
    const four xa = second ? other : own, xb = second ? own : other;
    const int on = spheres_touch(xa, xb);
    if (!on && second) return;
    const unsigned body = OWNER[there];
    const four m = OLD_MEMORY[c], r = old_turn(p, c), w_there = OLD_W[body];
    const four wa = second ? w_there : w, wb = second ? w : w_there;
    const real *k = law_of(p, wa, wb);
    if (!on) {
        end(p, c, k, m, r);
        return;
    }
    const four x_there = OLD_X[body], v_there = OLD_V[body];
    outcome o;
    members(xa, second ? v_there : v, wa, second ? x_there : x, xb, second ? v : v_there, wb, second ? x : x_there, k, m, r, STEP, &o);
    hand_out(p, c, second, o, s);
}

/// A contact of such a sphere with a plane.
DEVICE void member_plane_contact(ARGUMENTS p, const unsigned c, const unsigned there, const int second, const four x, const four v, const four w, sums *s) {
    const four face = PLANES[2 * there], motion = PLANES[2 * there + 1], m = OLD_MEMORY[c], r = old_turn(p, c);
    const four own = OLD_SPHERES[ENDS[c].first];
    const real *k = law_of(p, w, motion);
    four *wall = WALLS + 2 * (c - FIRST_PLANE);
    if (!plane_touches(own, face)) {
        end(p, c, k, m, r);
        wall[0] = none();
        wall[1] = none();
        return;
    }
    outcome o;
    member_plane(own, v, w, x, face, motion, k, m, r, STEP, &o, wall);
    add(&s->force, o.force);
    add(&s->torque, o.torque_a);
    keep(p, c, o);
}

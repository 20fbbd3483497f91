// Bonds, and the contacts of pairs that were bonded.

/// Carries a bond on and returns whether it holds; `n`: its memory after that.
DEVICE int bond_holds(const four xa, const four va, const four wa, const four xb, const four vb, const four wb, const real *k, const four shear,
                      const four turn, const real dt, outcome *o, four *n) {
    int holds;
//@BOND
    return holds;
}

/// The contact of two spheres that were bonded, of which `reference` does not count.
DEVICE int debonded_touch(const four xa, const four xb, const real reference) {
    int on;
//@DEBONDED_TOUCH
    return on;
}

DEVICE void debonded(const four xa, const four va, const four wa, const four xb, const four vb, const four wb, const real *k, const four m,
                     const four r, const real reference, const real step, outcome *o) {
//@DEBONDED
}
/// A bond, seen from one of its bodies.
DEVICE void bond(ARGUMENTS p, const unsigned c, const unsigned there, const int second, const four x, const four v, const four w, sums *s) {
    const four x_there = OLD_X[there], v_there = OLD_V[there], w_there = OLD_W[there];
    outcome o;
    four n[2];
    const int holds = bond_holds(second ? x_there : x, second ? v_there : v, second ? w_there : w, second ? x : x_there,
                                 second ? v : v_there, second ? w : w_there, BOND_CONSTANTS + BOND_WIDTH * c,
                                 OLD_BONDS[2 * c], OLD_BONDS[2 * c + 1], SINCE, &o, n);
    if (second) {
        subtract(&s->force, o.force);
        add(&s->torque, o.torque_b);
        return;
    }
    add(&s->force, o.force);
    add(&s->torque, o.torque_a);
    NEW_BONDS[2 * c] = n[0];
    NEW_BONDS[2 * c + 1] = n[1];
    POWER[c] = o.dashpot;
    if (!holds) FLAGS[0] = 1;
}

/// The contact of a pair that was bonded, seen from one of its bodies.
DEVICE void debonded_contact(ARGUMENTS p, const unsigned c, const unsigned there, const int second, const four x, const four v, const four w, sums *s) {
    const four x_there = OLD_X[there], v_there = OLD_V[there], w_there = OLD_W[there], m = OLD_MEMORY[c];
    const four xa = second ? x_there : x, wa = second ? w_there : w, xb = second ? x : x_there, wb = second ? w : w_there;
    const real reference = REFERENCE[c - FIRST_DEBONDED], *k = law_of(p, wa, wb);
    const four r = old_turn(p, c);
    if (!debonded_touch(xa, xb, reference)) {
        if (!second) end(p, c, k, m, r);
        return;
    }
    outcome o;
    debonded(xa, second ? v_there : v, wa, xb, second ? v : v_there, wb, k, m, r, reference, LAST, &o);
    hand_out(p, c, second, o, s);
}

DEVICE real bonds_books(ARGUMENTS p, const unsigned *from, const unsigned *to, const unsigned q) {
    if (q < 2) return in_lanes(POWER + from[6 + q], to[6 + q] - from[6 + q], 1);
    const unsigned list = 4 + (q - 2) / 2;
    return in_turn((const real *)(SPENT + from[list]) + (q & 1), to[list] - from[list], 2);
}

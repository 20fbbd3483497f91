// The step of the grains, one body a thread, as C and as CUDA: the same text for both, and the same bits as the engine's where products
// are not contracted with sums (cc -ffp-contract=off, NVRTC --fmad=false). Each body gathers what acts on it from the arrays of the last
// step and writes itself into those of this one; a contact is evaluated from both its sides, and the first keeps its memory.
// Lines that begin with //@ are replaced by the formulas of the engine, recorded (`tape.rs`), and by the names of arrays and numbers.

#ifdef __CUDACC__
#define DEVICE __device__ static __forceinline__
#define ALIGNED __align__(16)
#define ARGUMENTS const arguments &
#define OF(member) p.member
#define KERNEL(name) extern "C" __global__ void __launch_bounds__(128) name(const arguments p)
#define THREAD(i, count)                                     \
    const unsigned i = blockIdx.x * blockDim.x + threadIdx.x; \
    if (i >= (count)) return;
#define ENDLESS __longlong_as_double(0x7ff0000000000000LL)
#else
#include <math.h>
#define DEVICE static inline
#define ALIGNED
#define ARGUMENTS const arguments *
#define OF(member) p->member
#define KERNEL(name) static inline void name##_of(const arguments *p, unsigned thread_number)
#define THREAD(i, count)              \
    const unsigned i = thread_number; \
    if (i >= (count)) return;
#define ENDLESS ((real)INFINITY)
#endif

typedef double real;
typedef struct ALIGNED { real x, y, z, w; } four;
typedef struct ALIGNED { real x, y; } two;
typedef struct { unsigned first, second; } ends;
//@LAYOUT

/// What a contact does to its partners, and what it keeps.
typedef struct {
    four force, torque_a, torque_b, memory, turn;
    real dashpot, friction;
    int deep;
} outcome;

/// Force and torque on a body so far.
typedef struct { four force, torque; } sums;

DEVICE four none(void) {
    four zero = {0.0, 0.0, 0.0, 0.0};
    return zero;
}

DEVICE int spheres_touch(const four xa, const four xb) {
    int on;
//@SPHERES_TOUCH
    return on;
}

DEVICE void spheres(const four xa, const four va, const four wa, const four xb, const four vb, const four wb, const real *k, const four m,
                    const four r, const real step, outcome *o) {
//@SPHERES
}

DEVICE real left_in_springs(const real *k, const four m, const four r) {
    real left;
//@LEFT
    return left;
}

DEVICE int plane_touches(const four x, const four face) {
    int on;
//@PLANE_TOUCHES
    return on;
}

DEVICE void plane(const four x, const four v, const four w, const four face, const four motion, const real *k, const four m, const four r,
                  const real step, outcome *o, four *wall) {
//@PLANE
}

#if BONDS
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
#endif

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

DEVICE void add(four *sum, const four a) {
    sum->x += a.x;
    sum->y += a.y;
    sum->z += a.z;
}

DEVICE void subtract(four *sum, const four a) {
    sum->x -= a.x;
    sum->y -= a.y;
    sum->z -= a.z;
}

DEVICE const real *law_of(ARGUMENTS p, const four wa, const four wb) {
    return LAW + ((unsigned)wa.w * MATERIALS + (unsigned)wb.w) * LAW_WIDTH;
}

DEVICE void keep(ARGUMENTS p, const unsigned c, const outcome o) {
    two spent = {o.dashpot, o.friction};
    NEW_MEMORY[c] = o.memory;
#if ROLL
    NEW_TURN[c] = o.turn;
#endif
    SPENT[c] = spent;
    if (o.deep) FLAGS[0] = 1;
}

/// A contact that does not touch: what it had in its springs is lost.
DEVICE void end(ARGUMENTS p, const unsigned c, const real *k, const four m, const four r) {
    outcome o = {none(), none(), none(), {0.0, 0.0, 0.0, FRESH}, none(), 0.0, 0.0, 0};
    if (m.w < FRESH) o.friction = left_in_springs(k, m, r);
    keep(p, c, o);
}

/// A contact of two spheres, seen from one of them.
DEVICE void sphere_contact(ARGUMENTS p, const unsigned c, const int second, const four x, const four v, const four w, sums *s) {
    const unsigned other = second ? ENDS[c].first : ENDS[c].second;
    const four x_there = OLD_X[other];
    const four xa = second ? x_there : x, xb = second ? x : x_there;
    const int on = spheres_touch(xa, xb);
    if (!on && second) return;
    const four m = OLD_MEMORY[c], w_there = OLD_W[other];
    const four wa = second ? w_there : w, wb = second ? w : w_there;
    const real *k = law_of(p, wa, wb);
#if ROLL
    const four r = OLD_TURN[c];
#else
    const four r = none();
#endif
    if (!on) {
        end(p, c, k, m, r);
        return;
    }
    const four v_there = OLD_V[other];
    outcome o;
    spheres(xa, second ? v_there : v, wa, xb, second ? v : v_there, wb, k, m, r, STEP, &o);
    if (second) {
        subtract(&s->force, o.force);
        add(&s->torque, o.torque_b);
    } else {
        add(&s->force, o.force);
        add(&s->torque, o.torque_a);
        keep(p, c, o);
    }
}

/// A contact of a sphere with a plane.
DEVICE void plane_contact(ARGUMENTS p, const unsigned c, const four x, const four v, const four w, sums *s) {
    const four face = PLANES[2 * ENDS[c].second], motion = PLANES[2 * ENDS[c].second + 1], m = OLD_MEMORY[c];
    const real *k = law_of(p, w, motion);
    four *wall = WALLS + 2 * (c - FIRST_PLANE);
#if ROLL
    const four r = OLD_TURN[c];
#else
    const four r = none();
#endif
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

#if BONDS
/// A bond, seen from one of its bodies.
DEVICE void bond(ARGUMENTS p, const unsigned c, const int second, const four x, const four v, const four w, sums *s) {
    const unsigned other = second ? BOND_ENDS[c].first : BOND_ENDS[c].second;
    const four x_there = OLD_X[other], v_there = OLD_V[other], w_there = OLD_W[other];
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
DEVICE void debonded_contact(ARGUMENTS p, const unsigned c, const int second, const four x, const four v, const four w, sums *s) {
    const unsigned other = second ? ENDS[c].first : ENDS[c].second;
    const four x_there = OLD_X[other], v_there = OLD_V[other], w_there = OLD_W[other], m = OLD_MEMORY[c];
    const four xa = second ? x_there : x, wa = second ? w_there : w, xb = second ? x : x_there, wb = second ? w : w_there;
    const real reference = REFERENCE[c - FIRST_DEBONDED], *k = law_of(p, wa, wb);
#if ROLL
    const four r = OLD_TURN[c];
#else
    const four r = none();
#endif
    if (!debonded_touch(xa, xb, reference)) {
        if (!second) end(p, c, k, m, r);
        return;
    }
    outcome o;
    debonded(xa, second ? v_there : v, wa, xb, second ? v : v_there, wb, k, m, r, reference, LAST, &o);
    if (second) {
        subtract(&s->force, o.force);
        add(&s->torque, o.torque_b);
    } else {
        add(&s->force, o.force);
        add(&s->torque, o.torque_a);
        keep(p, c, o);
    }
}
#endif

KERNEL(bodies) {
    THREAD(i, BODIES)
    const four x = OLD_X[i], v = OLD_V[i], w = OLD_W[i], g = {GRAVITY_X, GRAVITY_Y, GRAVITY_Z, 0.0};
    sums s = {none(), none()};
    for (unsigned e = START[i]; e < START[i + 1]; ++e) {
        const unsigned c = ENTRIES[e] >> 3, what = ENTRIES[e] >> 1 & 3;
        const int second = (int)(ENTRIES[e] & 1);
        if (what == 0) {
            sphere_contact(p, c, second, x, v, w, &s);
        } else if (what == 1) {
            plane_contact(p, c, x, v, w, &s);
        }
#if BONDS
        else if (what == 2) {
            bond(p, c, second, x, v, w, &s);
        } else {
            debonded_contact(p, c, second, x, v, w, &s);
        }
#endif
    }
    four nx = x, nv = v, nw = w;
    real speed2;
#if HELD
    real *held = HELD_BY + HELD_WIDTH * i;
#else
    real *held = 0;
#endif
    if (SINGLE[i] == 0) {
        advance_free(x, v, w, s, g, STEP, WAY, DAMPING, &nx, &nv, &nw, &speed2, held);
    } else {
        advance_single(x, v, w, s, g, STEP, WAY, DAMPING, CONSTANTS[i], SINGLE[i] >> 1, &nx, &nv, &nw, &speed2, held);
    }
    NEW_X[i] = nx;
    NEW_V[i] = nv;
    NEW_W[i] = nw;
    SPEED2[i] = speed2;
    if (!(speed2 <= BOUND * BOUND)) FLAGS[0] = 1;
}

/// Sum of every `stride`-th number of a list as lanes of four add them up.
DEVICE real in_lanes(const real *list, const unsigned count, const unsigned stride) {
    real lane[4] = {0.0, 0.0, 0.0, 0.0};
    for (unsigned k = 0; k < count; ++k) lane[k & 3] += list[k * stride];
    return (lane[0] + lane[1]) + (lane[2] + lane[3]);
}

/// The same one by one.
DEVICE real in_turn(const real *list, const unsigned count, const unsigned stride) {
    real sum = 0.0;
    for (unsigned k = 0; k < count; ++k) sum += list[k * stride];
    return sum;
}

/// Component `d` of the sum of mass times position of a block's bodies.
DEVICE real moment(ARGUMENTS p, const unsigned first, const unsigned last, const unsigned d) {
    real lane[4] = {0.0, 0.0, 0.0, 0.0}, single = 0.0;
    for (unsigned i = first; i < last; ++i) {
        const real x = ((const real *)(OLD_X + i))[d];
        if (SINGLE[i] == 0) {
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

#if HELD
/// Sums over the bodies of a block that move by themselves, of one number or of two in turn.
DEVICE real of_singles(ARGUMENTS p, const unsigned first, const unsigned last, const unsigned one, const unsigned two) {
    real sum = 0.0;
    for (unsigned i = first; i < last; ++i) {
        if (SINGLE[i] == 0) continue;
        sum += HELD_BY[HELD_WIDTH * i + one];
        if (two != one) sum += HELD_BY[HELD_WIDTH * i + two];
    }
    return sum;
}

/// Sums over those that move four at a time: first one number of each of the four, then the other.
DEVICE real of_fours(ARGUMENTS p, const unsigned first, const unsigned last, const unsigned one, const unsigned two) {
    real sum = 0.0;
    for (unsigned g = first; g + 4 <= last; g += 4) {
        if (SINGLE[g] != 0) continue;
        for (unsigned i = g; i < g + 4; ++i) sum += HELD_BY[HELD_WIDTH * i + one];
        if (two == one) continue;
        for (unsigned i = g; i < g + 4; ++i) sum += HELD_BY[HELD_WIDTH * i + two];
    }
    return sum;
}

/// The same in lanes.
DEVICE real of_lanes(ARGUMENTS p, const unsigned first, const unsigned last, const unsigned one) {
    real lane[4] = {0.0, 0.0, 0.0, 0.0};
    for (unsigned i = first; i < last; ++i) {
        if (SINGLE[i] == 0) lane[(i - first) & 3] += HELD_BY[HELD_WIDTH * i + one];
    }
    return (lane[0] + lane[1]) + (lane[2] + lane[3]);
}

/// What local damping and fixed motions are booked with.
DEVICE real held_books(ARGUMENTS p, const unsigned first, const unsigned last, const unsigned q) {
    switch (q) {
    case 0:
        return (of_fours(p, first, last, 0, 3) + of_fours(p, first, last, 1, 4)) + of_fours(p, first, last, 2, 5);
    case 1: case 2: case 3:
        return of_fours(p, first, last, 5 + q, 5 + q);
    case 4: case 5: case 6:
        return of_lanes(p, first, last, 8 + q) + of_fours(p, first, last, 5 + q, 5 + q);
    case 7:
        return of_singles(p, first, last, 0, 7);
    case 8: case 9: case 10:
        return of_singles(p, first, last, q - 7, q - 7);
    case 11: case 12: case 13:
        return of_singles(p, first, last, q - 7, q - 3);
    case 14:
        return of_singles(p, first, last, 11, 11);
    case 15: case 16: case 17:
        return of_singles(p, first, last, q - 3, q - 3);
    default:
        return of_singles(p, first, last, q - 3, q);
    }
}
#endif

/// What the blocks book, one number of one block a thread.
KERNEL(books) {
    THREAD(t, BLOCKS * QUANTITIES)
    const unsigned q = t % QUANTITIES, *from = RANGES + t / QUANTITIES * LISTS, *to = from + LISTS;
    real x;
    if (q < 6) {
        const unsigned list = 1 + q / 2;
        x = in_lanes((const real *)(SPENT + from[list]) + (q & 1), to[list] - from[list], 2);
    } else if (q < 13) {
        x = in_lanes((const real *)(WALLS + 2 * (from[3] - FIRST_PLANE)) + (q - 6), to[3] - from[3], 8);
    } else if (q < 16) {
        x = moment(p, from[0], to[0], q - 13);
    } else if (q == 16) {
        x = fastest2(p, from[0], to[0]);
    }
#if BONDS
    else if (q < BONDS_BOOKED + 2) {
        const unsigned list = 6 + q - BONDS_BOOKED;
        x = in_lanes(POWER + from[list], to[list] - from[list], 1);
    } else if (q < BONDS_BOOKED + 6) {
        const unsigned list = 4 + (q - BONDS_BOOKED - 2) / 2;
        x = in_turn((const real *)(SPENT + from[list]) + ((q - BONDS_BOOKED) & 1), to[list] - from[list], 2);
    }
#endif
#if HELD
    else if (q >= HELD_BOOKED) {
        x = held_books(p, from[0], to[0], q - HELD_BOOKED);
    }
#endif
    else {
        x = 0.0;
    }
    BOOKS[t] = x;
}

#ifndef __CUDACC__
/// Runs a kernel with so many threads one after another, from the first or from the last.
#define RUN(name)                                                                        \
    void name(const arguments *p, unsigned threads, int backwards) {                     \
        for (unsigned t = 0; t < threads; ++t) name##_of(p, backwards ? threads - 1 - t : t); \
    }
RUN(bodies)
RUN(books)
#endif

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
#define RUN(name)
#define TAKE(count) atomicAdd(&(count), 1u)
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
/// Runs a kernel with so many threads one after another, from the first or from the last.
#define RUN(name)                                                                        \
    void name(const arguments *p, unsigned threads, int backwards) {                     \
        for (unsigned t = 0; t < threads; ++t) name##_of(p, backwards ? threads - 1 - t : t); \
    }
/// What a count is before one is added to it; on a device as one operation.
#define TAKE(count) ((count)++)
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

#if CLUMPS
#define SPHERE(k) OLD_SPHERES[k]
#define BODY(k) OWNER[k]
#else
#define SPHERE(k) OLD_X[k]
#define BODY(k) (k)
#endif

DEVICE four none(void) {
    four zero = {0.0, 0.0, 0.0, 0.0};
    return zero;
}

DEVICE real left_in_springs(const real *k, const four m, const four r) {
    real left;
//@LEFT
    return left;
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

DEVICE four old_turn(ARGUMENTS p, const unsigned c) {
#if ROLL
    return OLD_TURN[c];
#else
    return none();
#endif
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

/// What a contact does to the body that it is seen from; the first of the two keeps what it remembers.
DEVICE void hand_out(ARGUMENTS p, const unsigned c, const int second, const outcome o, sums *s) {
    if (second) {
        subtract(&s->force, o.force);
        add(&s->torque, o.torque_b);
    } else {
        add(&s->force, o.force);
        add(&s->torque, o.torque_a);
        keep(p, c, o);
    }
}

/// A contact that does not touch: what it had in its springs is lost.
DEVICE void end(ARGUMENTS p, const unsigned c, const real *k, const four m, const four r) {
    outcome o = {none(), none(), none(), {0.0, 0.0, 0.0, FRESH}, none(), 0.0, 0.0, 0};
    if (m.w < FRESH) o.friction = left_in_springs(k, m, r);
    keep(p, c, o);
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

//@PARTS
KERNEL(bodies) {
    THREAD(i, BODIES)
    const four x = OLD_X[i], v = OLD_V[i], w = OLD_W[i];
    sums s = {none(), none()};
    for (unsigned e = START[i]; e < START[i + 1]; ++e) {
        const unsigned c = ENTRIES[e] >> 4, what = ENTRIES[e] >> 1 & 7;
        const int second = (int)(ENTRIES[e] & 1);
//@ENTRIES
    }
    advance(p, i, x, v, w, s);
}
RUN(bodies)

/// What the blocks book, one number of one block a thread.
KERNEL(books) {
    THREAD(t, BLOCKS * QUANTITIES)
    const unsigned q = t % QUANTITIES, *from = RANGES + t / QUANTITIES * LISTS, *to = from + LISTS;
    real x = 0.0;
//@BOOKS
    BOOKS[t] = x;
}
RUN(books)

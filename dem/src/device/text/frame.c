// The step of the grains, one body a thread, as C and as CUDA: the same text for both, and the same bits as the engine's where products
// are not contracted with sums (cc -ffp-contract=off, NVRTC --fmad=false). Each body gathers what acts on it from the arrays of the last
// step and writes itself into those of this one; a contact is evaluated from both its sides, and the first keeps its memory.
// Lines that begin with //@ are replaced by the formulas of the engine, recorded (`tape.rs`), and by the names of arrays and numbers.

#ifdef __CUDACC__
#define DEVICE __device__ static __forceinline__
#define ALIGNED __align__(16)
#define ARGUMENTS const arguments &
#define OF(member) p.member
#define KERNEL(name) extern "C" __global__ void __launch_bounds__(128, BLOCKS_AT_ONCE) name(const arguments p)
#define THREAD(i, count)                                     \
    const unsigned i = blockIdx.x * blockDim.x + threadIdx.x; \
    if (i >= (count)) return;
#define RUN(name)
#define TAKE(count) atomicAdd(&(count), 1u)
#define ENDLESS __longlong_as_double(0x7ff0000000000000LL)
#define UNROLL _Pragma("unroll")
#define SHARED_BY_FOUR(i)
#define LANES(f, ...) over_lanes(f(__VA_ARGS__, threadIdx.x & 3u))
#define LARGEST(f, ...) largest_of_lanes(f(__VA_ARGS__, threadIdx.x & 3u))
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
#define UNROLL
/// Threads that sum up together, a lane each, on a device; here the first does it all.
#define SHARED_BY_FOUR(i) \
    if ((i) & 3u) return;
/// The sum of what a function has for each of four lanes, as lanes of four add up; and the largest.
#define LANES(f, ...) ((f(__VA_ARGS__, 0u) + f(__VA_ARGS__, 1u)) + (f(__VA_ARGS__, 2u) + f(__VA_ARGS__, 3u)))
#define LARGER(a, b) ((a) > (b) ? (a) : (b))
#define LARGEST(f, ...) LARGER(LARGER(f(__VA_ARGS__, 0u), f(__VA_ARGS__, 1u)), LARGER(f(__VA_ARGS__, 2u), f(__VA_ARGS__, 3u)))
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

/// Where the lists of a block begin.
#define LISTS_OF(block) (RANGES + (block) * LISTS)

#define AT_MOST(a, b) ((a) < (b) ? (a) : (b))

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

#ifdef __CUDACC__
/// What four threads have together: either order of two terms has the same sum.
DEVICE real over_lanes(real sum) {
    const unsigned four_threads = 0xfu << (threadIdx.x & 28u);
    sum += __shfl_xor_sync(four_threads, sum, 1);
    return sum + __shfl_xor_sync(four_threads, sum, 2);
}

DEVICE real largest_of_lanes(const real own) {
    const unsigned four_threads = 0xfu << (threadIdx.x & 28u);
    const real beside = __shfl_xor_sync(four_threads, own, 1), larger = own > beside ? own : beside;
    const real others = __shfl_xor_sync(four_threads, larger, 2);
    return larger > others ? larger : others;
}
#endif

/// Numbers that are fetched before any of them is added, so that they do not wait for each other. Past the end of a list the last is
/// fetched once more, and a zero added, which changes no sum.
#define BATCH 32u

/// Sum of every `stride`-th number of a list, of them every fourth.
DEVICE real lane_sum(const real *list, const unsigned count, const unsigned stride, const unsigned lane) {
    real sum = 0.0;
    for (unsigned k = lane; k < count; k += 4 * BATCH) {
        real x[BATCH];
        UNROLL for (unsigned m = 0; m < BATCH; ++m) x[m] = list[AT_MOST(k + 4 * m, count - 1) * stride];
        UNROLL for (unsigned m = 0; m < BATCH; ++m) sum += k + 4 * m < count ? x[m] : 0.0;
    }
    return sum;
}

/// Sum of every `stride`-th number of a list as lanes of four add them up.
DEVICE real in_lanes(const real *list, const unsigned count, const unsigned stride) {
    return LANES(lane_sum, list, count, stride);
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
#if BESIDE
    if (SINGLE[i] & ELSEWHERE) return;
#endif
    const four x = OLD_X[i], v = OLD_V[i], w = OLD_W[i];
    sums s = {none(), none()};
    for (unsigned e = START[i]; e < START[i + 1]; ++e) {
        const ends entry = ENTRIES[e];
        const unsigned c = entry.first >> ENTRY_SHIFT, what = entry.first >> 1 & 15, there = entry.second;
        const int second = (int)(entry.first & 1);
//@ENTRIES
    }
    advance(p, i, x, v, w, s);
}
RUN(bodies)

/// What the blocks book, one number of one block four threads, part by part, so that threads side by side do the same; one more thread
/// puts behind it whether the step has failed.
KERNEL(books) {
    THREAD(t, 4 * BLOCKS * QUANTITIES + 1)
    if (t == 4 * BLOCKS * QUANTITIES) BOOKS[BLOCKS * QUANTITIES] = FLAGS[0];
    SHARED_BY_FOUR(t)
    unsigned number = t / 4;
//@BOOKS
}
RUN(books)

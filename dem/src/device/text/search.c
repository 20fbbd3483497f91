// Search for neighbours: the near lists of spheres with each other and with planes, as the engine makes them (`engine/neighbours.rs`), and
// what each body gathers, from these and from what the processor lists.
// Spheres lie in buckets by a hash of their cell, in each in any order: rows of partners are sorted, so that nothing hangs on it. Each
// class of size has cells of its own, so that small spheres between large ones do not crowd.

#if CLUMPS
#define FIRST_OF(i) FIRST_SPHERE[i]
#else
#define FIRST_OF(i) (i)
#endif
/// What a body calls its spheres within its block.
#define NAME(k) (ORIENTED(BODY(k)) ? (k) : BODY(k))
/// First contact of a sphere with other blocks, within its own, with planes; its first partner of all.
#define CROSS_OF(k) OFFSETS[k]
#define OWN_OF(k) OFFSETS[SPHERE_COUNT + (k)]
#define PLANES_OF(k) OFFSETS[2 * SPHERE_COUNT + (k)]
#define ROW_OF(k) (OFFSETS[3 * SPHERE_COUNT + (k)] - OFFSETS[3 * SPHERE_COUNT])

DEVICE int spheres_near(const four xa, const four xb, const real near) {
    int on;
//@SPHERES_NEAR
    return on;
}

DEVICE int plane_near(const four x, const four point, const four offset, const four normal, const real near) {
    int on;
//@PLANE_NEAR
    return on;
}

/// Coordinate of a cell; what is very far away shares the last.
DEVICE long long cell_of(const real x, const real inverse) {
    const real c = floor(x * inverse);
    return c > 1e15 ? 1000000000000000LL : c > -1e15 ? (long long)c : -1000000000000000LL;
}

/// Class of size of a sphere.
DEVICE unsigned size_of(ARGUMENTS p, const real radius) {
    unsigned k = 0;
    while (k + 1 < CLASSES && radius <= GRIDS[2 * k + 3]) ++k;
    return k;
}

/// Cells in a row along x have buckets in a row.
DEVICE unsigned bucket_of(ARGUMENTS p, const unsigned size, const long long x, const long long y, const long long z) {
    unsigned h = (unsigned)y * 73856093u ^ (unsigned)z * 19349663u ^ size * 83492791u;
    h ^= h >> 15;
    return ((unsigned)x + h * 2654435761u) & (BUCKETS - 1);
}

/// Whether a sphere lies in one of the cells of a row along x.
DEVICE int in_row(ARGUMENTS p, const four x, const unsigned size, const real inverse, const long long from_x, const long long to_x,
                  const long long cy, const long long cz) {
    const long long cx = cell_of(x.x, inverse);
    return size_of(p, x.w) == size && cx >= from_x && cx <= to_x && cell_of(x.y, inverse) == cy && cell_of(x.z, inverse) == cz;
}

/// Puts a number into an ascending list of `count`.
DEVICE void insert(unsigned *list, unsigned count, const unsigned x) {
    for (; count > 0 && list[count - 1] > x; --count) list[count] = list[count - 1];
    list[count] = x;
}

#if BESIDE && !CLUMPS
/// Whether a body that the processor moves, which has no spheres, stands in their list.
#define NO_SPHERE(s) (SINGLE[s] & ELSEWHERE)
#else
#define NO_SPHERE(s) 0
#endif

/// Whether two bodies never have a contact, since a bond has it.
DEVICE int held_apart(ARGUMENTS p, const unsigned body, const unsigned other) {
#if BONDS
    for (unsigned k = HELD_START[body]; k < HELD_START[body + 1]; ++k)
        if (HELD_WITH[k] == other) return 1;
#endif
    return 0;
}

/// Spheres near one that may touch it: how many; how many of the later ones are of other blocks and of its own; in `row`, if there is
/// one, ascending.
DEVICE unsigned partners(ARGUMENTS p, const unsigned s, unsigned *later, unsigned *row) {
    const four x = SPHERE(s);
    const unsigned body = BODY(s);
    const int still = OLD_V[body].w == 0.0;
    unsigned n = 0;
    if (NO_SPHERE(s)) return 0;
    for (unsigned size = 0; size < CLASSES; ++size) {
        const real inverse = GRIDS[2 * size], way = 1.000001 * (x.w + GRIDS[2 * size + 1] + REACH);
        // The cells of all centres within that way, roundings allowed for.
        const real wx = way + 1e-15 * fabs(x.x), wy = way + 1e-15 * fabs(x.y), wz = way + 1e-15 * fabs(x.z);
        const long long from_x = cell_of(x.x - wx, inverse), to_x = cell_of(x.x + wx, inverse);
        const long long to_y = cell_of(x.y + wy, inverse), to_z = cell_of(x.z + wz, inverse);
        // No bucket twice.
        const unsigned cells = to_x - from_x < (long long)BUCKETS ? (unsigned)(to_x - from_x) + 1 : BUCKETS;
        for (long long cz = cell_of(x.z - wz, inverse); cz <= to_z; ++cz)
        for (long long cy = cell_of(x.y - wy, inverse); cy <= to_y; ++cy) {
            unsigned bucket = bucket_of(p, size, from_x, cy, cz);
            // The last bucket is followed by the first.
            for (unsigned left = cells, run; left > 0; left -= run, bucket = 0) {
                run = AT_MOST(left, BUCKETS - bucket);
                const unsigned end = CELLS[bucket + run];
                for (unsigned m = CELLS[bucket]; m < end; ++m) {
                    const unsigned other = ITEMS[m], there = BODY(other);
                    const four y = SPHERE(other);
                    if (there == body || !spheres_near(x, y, REACH)) continue;
                    if (still && OLD_V[there].w == 0.0) continue;
                    if (NO_SPHERE(other) || held_apart(p, body, there)) continue;
                    // Other cells share the buckets.
                    if (!in_row(p, y, size, inverse, from_x, to_x, cy, cz)) continue;
                    if (row) {
                        insert(row, n, other);
                    } else if (other > s) {
                        ++later[BLOCK[there] == BLOCK[body]];
                    }
                    ++n;
                }
            }
        }
    }
    return n;
}

/// Planes near a sphere: how many; contacts with them from `c` on, if they are to be listed.
DEVICE unsigned planes_near(ARGUMENTS p, const unsigned s, const int list, const unsigned c) {
    unsigned n = 0;
    if (OLD_V[BODY(s)].w == 0.0 || NO_SPHERE(s)) return 0;
    for (unsigned k = 0; k < PLANE_COUNT; ++k) {
        const four point = PLANES_SEARCHED[3 * k];
        if (point.w != 0.0 || !plane_near(SPHERE(s), point, PLANES_SEARCHED[3 * k + 1], PLANES_SEARCHED[3 * k + 2], REACH)) continue;
        if (list) {
            ENDS[c + n].first = NAME(s);
            ENDS[c + n].second = k;
        }
        ++n;
    }
    return n;
}

KERNEL(clear_cells) {
    THREAD(i, BUCKETS + 1)
    CELLS[i] = 0;
}
RUN(clear_cells)

KERNEL(count_cells) {
    THREAD(s, SPHERE_COUNT)
    const four x = SPHERE(s);
    const unsigned size = size_of(p, x.w);
    const real inverse = GRIDS[2 * size];
    const unsigned bucket = bucket_of(p, size, cell_of(x.x, inverse), cell_of(x.y, inverse), cell_of(x.z, inverse));
    BUCKET[s] = bucket;
    PLACE[s] = TAKE(CELLS[bucket]);
}
RUN(count_cells)

/// After the counts have become sums.
KERNEL(fill_cells) {
    THREAD(s, SPHERE_COUNT)
    ITEMS[CELLS[BUCKET[s]] + PLACE[s]] = s;
}
RUN(fill_cells)

KERNEL(count_partners) {
    THREAD(s, SPHERE_COUNT + 1)
    unsigned later[2] = {0, 0};
    const int there = s < SPHERE_COUNT;
    // One past the last there is none.
    const unsigned count = there ? partners(p, s, later, 0) : 0;
    OFFSETS[3 * SPHERE_COUNT + s] = count;
    if (!there) return;
    CROSS_OF(s) = later[0];
    OWN_OF(s) = later[1];
    PLANES_OF(s) = planes_near(p, s, 0, 0);
}
RUN(count_partners)

/// What the lists take, after the counts have become sums: contacts of spheres, all contacts, partners.
KERNEL(totals) {
    THREAD(i, 1)
    TOTALS[i] = PLANES_OF(0);
    TOTALS[i + 1] = PLANES_OF(SPHERE_COUNT);
    TOTALS[i + 2] = ROW_OF(SPHERE_COUNT);
}
RUN(totals)

/// Gives contacts of a sphere what they remember if they were in its list before; both lists ascend.
DEVICE void carry(ARGUMENTS p, const unsigned from, const unsigned to, unsigned old, const unsigned end) {
    for (unsigned c = from; c < to; ++c) {
        while (old < end && OLD_ENDS[old].second < ENDS[c].second) ++old;
        const int known = old < end && OLD_ENDS[old].second == ENDS[c].second;
        const four fresh = {0.0, 0.0, 0.0, FRESH};
        NEW_MEMORY[c] = known ? OLD_MEMORY[old] : fresh;
#if ROLL
        NEW_TURN[c] = known ? OLD_TURN[old] : none();
#endif
    }
}

KERNEL(list_partners) {
    THREAD(s, SPHERE_COUNT)
    unsigned *row = ROWS + ROW_OF(s), cross = CROSS_OF(s), own = OWN_OF(s);
    const unsigned count = partners(p, s, 0, row);
    for (unsigned m = 0; m < count; ++m) {
        const unsigned other = row[m];
        if (other < s) continue;
        if (BLOCK[BODY(other)] == BLOCK[BODY(s)]) {
            ENDS[own].first = NAME(s);
            ENDS[own++].second = NAME(other);
        } else {
            ENDS[cross].first = s;
            ENDS[cross++].second = other;
        }
    }
    planes_near(p, s, 1, PLANES_OF(s));
    for (unsigned list = 0; list < 3; ++list) {
        const unsigned k = list * SPHERE_COUNT + s;
        carry(p, OFFSETS[k], OFFSETS[k + 1], OLD_OFFSETS[k], OLD_OFFSETS[k + 1]);
    }
}
RUN(list_partners)

/// The contact in which a sphere, by its name in that list, is the second.
DEVICE unsigned contact_of(ARGUMENTS p, unsigned c, const unsigned name) {
    while (ENDS[c].second != name) ++c;
    return c;
}

/// Puts an entry into an ascending list of `count`.
DEVICE void enter(ends *list, unsigned count, const unsigned what, const unsigned with) {
    for (; count > 0 && list[count - 1].first > what; --count) list[count] = list[count - 1];
    list[count].first = what;
    list[count].second = with;
}

#if LISTED_THERE
/// Puts entries of the processor between those of contacts across blocks, of which there are `count` behind room for them: after those of
/// the same block. `rest`: the first of those that are left; what comes after them is left of what comes last.
DEVICE unsigned merge(ARGUMENTS p, ends *entry, const ends *across, const unsigned count, unsigned *rest, const unsigned end) {
    unsigned n = 0, m = 0;
    for (;;) {
        const int more = *rest < end && REST_FROM[*rest] <= BLOCKS;
        if (m < count && !(more && REST_FROM[*rest] < BLOCK[BODY(ENDS[across[m].first >> ENTRY_SHIFT].first)])) entry[n++] = across[m++];
        else if (more) entry[n++] = REST[(*rest)++];
        else return n;
    }
}
#endif

/// Contacts that a body gathers, in the order of the engine's sums: across blocks, within, with planes; in the order of the lists in each.
KERNEL(enter_partners) {
    THREAD(i, BODIES + 1)
    const unsigned first = FIRST_OF(i);
    ends *entry = ENTRIES + (ROW_OF(first) + PLANES_OF(first) - PLANES_OF(0));
    unsigned n = 0;
#if LISTED_THERE
    unsigned rest = REST_START[i];
    entry += rest;
#endif
    START[i] = (unsigned)(entry - ENTRIES);
    if (i == BODIES) return;
    for (unsigned own = 0; own < 2; ++own) {
        const unsigned what = own == 0 ? ACROSS : ORIENTED(i) ? WITHIN_TURNED : WITHIN;
        unsigned count = 0;
#if LISTED_THERE
        // Room in front of contacts across blocks for what comes between them.
        ends *const to = entry + n + (own ? 0 : REST_START[i + 1] - rest);
#else
        ends *const to = entry + n;
#endif
        for (unsigned s = first; s < FIRST_OF(i + 1); ++s) {
            unsigned c = OFFSETS[own * SPHERE_COUNT + s];
            for (unsigned m = ROW_OF(s); m < ROW_OF(s + 1); ++m) {
                const unsigned other = ROWS[m], second = other < s;
                if ((BLOCK[BODY(other)] == BLOCK[i]) != own) continue;
                const unsigned of = second ? contact_of(p, OFFSETS[own * SPHERE_COUNT + other], own ? NAME(s) : s) : c++;
                enter(to, count++, of << ENTRY_SHIFT | what << 1 | second, own ? NAME(other) : other);
            }
        }
#if LISTED_THERE
        if (own == 0) count = merge(p, entry, to, count, &rest, REST_START[i + 1]);
#endif
        n += count;
    }
    for (unsigned c = PLANES_OF(first); c < PLANES_OF(FIRST_OF(i + 1)); ++c) {
        const ends with = {c << ENTRY_SHIFT | (ORIENTED(i) ? PLANE_TURNED : PLANE) << 1, ENDS[c].second};
        entry[n++] = with;
    }
#if LISTED_THERE
    for (; rest < REST_START[i + 1]; ++rest) entry[n++] = REST[rest];
#endif
}
RUN(enter_partners)

/// Where the lists of each block begin that are listed here.
KERNEL(ranges) {
    THREAD(b, BLOCKS + 1)
    unsigned *of = RANGES + b * LISTS;
    const unsigned first = FIRST_OF(of[0]);
    of[1] = CROSS_OF(first);
    of[2] = OWN_OF(first);
    of[3] = PLANES_OF(first);
#if !LISTED_THERE
    for (unsigned list = 4; list < LISTS; ++list) of[list] = PLANES_OF(SPHERE_COUNT);
#endif
}
RUN(ranges)

/// Sums of stretches of a list: those of all of these are summed likewise, until there is one.
KERNEL(sum_up) {
    THREAD(t, (SUM_COUNT + STRETCH - 1) / STRETCH)
    unsigned sum = 0;
    for (unsigned k = t * STRETCH; k < SUM_COUNT && k < (t + 1) * STRETCH; ++k) sum += SUMMED[SUM_FROM + k];
    SUMS[SUM_TO + t] = sum;
}
RUN(sum_up)

/// Each number of a stretch becomes the sum of all before it, given that of all before the stretch.
KERNEL(sum_down) {
    THREAD(t, (SUM_COUNT + STRETCH - 1) / STRETCH)
    unsigned sum = SUM_COUNT > STRETCH ? SUMS[SUM_TO + t] : 0;
    for (unsigned k = t * STRETCH; k < SUM_COUNT && k < (t + 1) * STRETCH; ++k) {
        const unsigned own = SUMMED[SUM_FROM + k];
        SUMMED[SUM_FROM + k] = sum;
        sum += own;
    }
}
RUN(sum_down)

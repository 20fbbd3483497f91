// Contacts with walls of triangles: which of the triangles near a sphere count, as `contact/patches.rs` decides it, and their forces.
// What a contact remembers lies with its pair of sphere and triangle.

/// Touches of a sphere in one step; where there are more, the processor makes the step.
#define MOST 12u

/// A triangle against the sphere at hand.
typedef struct {
    /// Closest point and overlap, normal of the contact, normal of the triangle, velocity of the wall there.
    four point, normal, outward, velocity;
    unsigned pair;
    /// 0 inside, 1 on an edge, 2 in a corner.
    unsigned rank;
    int counts;
} touch;

/// What a contact with a triangle keeps.
typedef struct {
    four point, normal, velocity, memory, turn;
    int alive;
} kept;

/// Numbers of a triangle, and of the wall that it belongs to.
DEVICE const real *shape_of(ARGUMENTS p, const unsigned patch) {
    return SHAPES + SHAPE_WIDTH * patch;
}

DEVICE const real *wall_of(ARGUMENTS p, const unsigned patch) {
    return WALL_NOW + WALL_WIDTH * PATCHES[PATCH_WIDTH * patch];
}

DEVICE four to_local(const real *u, const four x) {
    four y = x;
//@TO_LOCAL
    return y;
}

/// A lower bound of the distance of a point in the frame of the wall.
DEVICE real clearance_of(const real *f, const four y) {
    real clear;
//@CLEARANCE
    return clear;
}

/// Whether a point in the frame of the wall stands above the inside, and where.
DEVICE int foot(const real *f, const four y, four *on) {
    int inside;
//@FOOT
    return inside;
}

/// Part of the triangle that is closest: 0 the inside, 1 to 3 corners, 4 to 6 edges.
DEVICE unsigned region_of(const real *f, const four y) {
    real code;
//@REGION
    return (unsigned)code;
}

/// The point of the edge from `a` to `b` that is closest to `y`.
DEVICE four on_edge(const real *a, const real *b, const four y) {
    four on = y;
//@ON_EDGE
    return on;
}

/// A point and a direction of the wall's frame in the world, and the velocity there.
DEVICE void to_world(const real *u, const real *f, const four on, four *point, four *outward, four *velocity) {
//@TO_WORLD
}

/// The point of a triangle that is closest to `x`; its rank.
DEVICE unsigned closest(ARGUMENTS p, const unsigned patch, const four x, four *point, four *outward, four *velocity) {
    const real *f = shape_of(p, patch), *u = wall_of(p, patch), *corners = f + 16;
    const unsigned *numbers = PATCHES + PATCH_WIDTH * patch + 2;
    const four y = to_local(u, x);
    four on = none();
    unsigned rank = 0;
    if (!foot(f, y, &on)) {
        const unsigned region = region_of(f, y);
        if (region > 3) {
            // From the lower corner, so that both triangles of an edge find the same bits.
            const unsigned a = region - 4, b = (a + 1) % 3, turned = numbers[a] > numbers[b];
            on = on_edge(corners + 3 * (turned ? b : a), corners + 3 * (turned ? a : b), y);
            rank = 1;
        } else if (region > 0) {
            const real *corner = corners + 3 * (region - 1);
            on.x = corner[0];
            on.y = corner[1];
            on.z = corner[2];
            rank = 2;
        }
    }
    to_world(u, f, on, point, outward, velocity);
    return rank;
}

/// Distance of a sphere's centre from its closest point; the normal and the overlap of the contact.
DEVICE int meets(const four x, const four point, const four outward, const int straight, four *normal, real *overlap) {
    int near;
//@MEETS
    return near;
}

/// A contact that stays inside a triangle, where nothing else can count; whether it does.
DEVICE int rests(const four x, const four point, const four outward, four *normal, real *overlap, real *side) {
    int stays;
//@RESTS
    return stays;
}

DEVICE int one_point(const four a, const four b, const real radius) {
    int same;
//@ONE_POINT
    return same;
}

DEVICE int within(const real clear, const real radius) {
    int near;
//@WITHIN
    return near;
}

DEVICE int alike(const four a, const four b) {
    int same;
//@ALIKE
    return same;
}

/// Whether a contact that begins may go on from one that ends, and how far that is away.
DEVICE int may_follow(const four normal, const four point, const four old_normal, const four old_point, const real radius, real *away) {
    int may;
//@MAY_FOLLOW
    return may;
}

/// The side of a contact on its triangle, and whether it is too deep; `fresh`: it has no force before.
DEVICE real side_of(const touch t, const four old_normal, const real old_side, const int fresh, const real radius, int *deep) {
    real side;
//@SIDE
    return side;
}

/// The force of a contact, and its moment about the centre of the wall.
DEVICE void patch_force(const four x, const four v, const four w, const real *u, const four point, const real radius, const four normal,
                        const four velocity, const real *k, const four m, const four r, const real step, outcome *o, four *moment) {
//@PATCH_FORCE
}

/// Decides which of several touches count.
DEVICE void count_once(ARGUMENTS p, const real radius, touch *found, const unsigned n) {
    for (unsigned k = 0; k < n; ++k) {
        int counts = 1;
        for (unsigned m = 0; m < n; ++m) {
            if (m == k) continue;
            if (one_point(found[m].point, found[k].point, radius)) {
                counts &= found[k].rank < found[m].rank || (found[k].rank == found[m].rank && k < m);
            } else if (found[k].rank > 0) {
                const unsigned other = PATCH_PAIRS[found[m].pair].second;
                const real clear = clearance_of(shape_of(p, other), to_local(wall_of(p, other), found[k].point));
                if (!within(clear, radius)) continue;
                four point = none(), outward = none(), velocity = none();
                closest(p, other, found[k].point, &point, &outward, &velocity);
                counts &= !one_point(point, found[k].point, radius);
            }
        }
        found[k].counts = counts;
    }
}

/// Whether a touch comes after another in falling order of overlap.
DEVICE int comes_after(const touch *found, const unsigned k, const unsigned last, const real overlap) {
    return last == MOST || found[k].point.w < overlap || (found[k].point.w == overlap && k > last);
}

/// Of contacts whose normals differ little keeps the deepest, the first of equals.
DEVICE void keep_deepest(touch *found, const unsigned n) {
    unsigned last = MOST;
    real overlap = 0.0;
    for (;;) {
        unsigned next = MOST;
        for (unsigned k = 0; k < n; ++k) {
            if (!found[k].counts || !comes_after(found, k, last, overlap)) continue;
            if (next == MOST || found[k].point.w > found[next].point.w) next = k;
        }
        if (next == MOST) return;
        last = next;
        overlap = found[next].point.w;
        for (unsigned m = 0; m < n; ++m) {
            if (found[m].counts && comes_after(found, m, last, overlap) && alike(found[next].normal, found[m].normal)) found[m].counts = 0;
        }
    }
}

/// Puts a contact down and adds its force.
DEVICE void put_contact(ARGUMENTS p, const unsigned pair, const four x, const four v, const four w, const real radius, kept c, sums *s) {
    const unsigned patch = PATCH_PAIRS[pair].second;
    const real *u = wall_of(p, patch);
    const four material = {0.0, 0.0, 0.0, u[17]};
    outcome o;
    four moment = none();
    patch_force(x, v, w, u, c.point, radius, c.normal, c.velocity, law_of(p, w, material), c.memory, c.turn, STEP, &o, &moment);
    o.deep = 0;
    add(&s->force, o.force);
    add(&s->torque, o.torque_a);
    keep(p, FIRST_PATCH + pair, o);
    c.velocity.w = 1.0;
    NEW_TOUCH[3 * pair] = c.point;
    NEW_TOUCH[3 * pair + 1] = c.normal;
    NEW_TOUCH[3 * pair + 2] = c.velocity;
    ACTION[2 * pair] = o.force;
    ACTION[2 * pair + 1] = moment;
}

DEVICE kept recall(ARGUMENTS p, const unsigned pair) {
    const kept c = {OLD_TOUCH[3 * pair], OLD_TOUCH[3 * pair + 1], OLD_TOUCH[3 * pair + 2], OLD_MEMORY[FIRST_PATCH + pair],
                    old_turn(p, FIRST_PATCH + pair), 1};
    return c;
}

/// Forgets what a pair had.
DEVICE void clear(ARGUMENTS p, const unsigned pair) {
    const outcome nothing = {none(), none(), none(), {0.0, 0.0, 0.0, FRESH}, none(), 0.0, 0.0, 0};
    keep(p, FIRST_PATCH + pair, nothing);
    NEW_SPARE[pair] = OLD_SPARE[pair];
    ENDED[pair] = 0.0;
    NEW_TOUCH[3 * pair] = none();
    NEW_TOUCH[3 * pair + 1] = none();
    NEW_TOUCH[3 * pair + 2] = none();
    ACTION[2 * pair] = none();
    ACTION[2 * pair + 1] = none();
}

/// The contact of a sphere that touched one triangle, where it stays inside that and all near lie in its plane; whether it does.
DEVICE int resting(ARGUMENTS p, const unsigned from, const unsigned to, const unsigned pair, const four sphere, const four x, const four v,
                   const four w, sums *s) {
    const unsigned patch = PATCH_PAIRS[pair].second, flat = PATCHES[PATCH_WIDTH * patch + 1];
    for (unsigned k = from; k < to; ++k) {
        if (PATCHES[PATCH_WIDTH * PATCH_PAIRS[k].second + 1] != flat) return 0;
    }
    const real *f = shape_of(p, patch), *u = wall_of(p, patch);
    four on = none(), outward = none();
    if (!foot(f, to_local(u, sphere), &on)) return 0;
    kept c = recall(p, pair);
    to_world(u, f, on, &c.point, &outward, &c.velocity);
    if (!rests(sphere, c.point, outward, &c.normal, &c.point.w, &c.normal.w)) return 0;
    put_contact(p, pair, x, v, w, sphere.w, c, s);
    return 1;
}

/// The triangles that a sphere touches; how many, or MOST + 1 if they are too many.
DEVICE unsigned touches(ARGUMENTS p, const unsigned from, const unsigned to, const four sphere, touch *found) {
    unsigned n = 0;
    for (unsigned k = from; k < to; ++k) {
        const real spare = OLD_SPARE[k];
        if (spare > GONE) continue;
        const unsigned patch = PATCH_PAIRS[k].second;
        if (spare >= 0.0) {
            const real clear = clearance_of(shape_of(p, patch), to_local(wall_of(p, patch), sphere));
            if (clear > sphere.w) {
                NEW_SPARE[k] = GONE + clear - sphere.w;
                continue;
            }
        }
        touch t;
        t.point = t.normal = t.outward = t.velocity = none();
        t.pair = k;
        t.counts = 1;
        t.rank = closest(p, patch, sphere, &t.point, &t.outward, &t.velocity);
        if (!meets(sphere, t.point, t.outward, t.rank == 0, &t.normal, &t.point.w)) {
            NEW_SPARE[k] = GONE;
            continue;
        }
        NEW_SPARE[k] = -1.0;
        if (n == MOST) return MOST + 1;
        found[n++] = t;
    }
    if (n > 1) {
        count_once(p, sphere.w, found, n);
        keep_deepest(found, n);
    }
    return n;
}

/// All contacts of a sphere with triangles.
DEVICE void wall_contacts(ARGUMENTS p, const unsigned c, const unsigned there, const int second, const four x, const four v, const four w, sums *s) {
    const unsigned from = GROUPS[c], to = GROUPS[c + 1];
    const four sphere = SPHERE(PATCH_PAIRS[from].first);
    unsigned before[MOST], old = 0;
    for (unsigned k = from; k < to; ++k) {
        clear(p, k);
        if (OLD_TOUCH[3 * k + 2].w == 0.0) continue;
        if (old == MOST) {
            FLAGS[0] = 1;
            return;
        }
        before[old++] = k;
    }
    if (old == 1 && resting(p, from, to, before[0], sphere, x, v, w, s)) return;
    touch found[MOST];
    kept now[MOST], past[MOST];
    const unsigned n = touches(p, from, to, sphere, found);
    if (n > MOST) {
        FLAGS[0] = 1;
        return;
    }
    // Memory goes on with the triangle that it was of.
    int loose = 0;
    for (unsigned m = 0; m < old; ++m) {
        past[m] = recall(p, before[m]);
        past[m].alive = past[m].memory.w < FRESH;
    }
    for (unsigned k = 0; k < n; ++k) {
        const kept begun = {found[k].point, found[k].normal, found[k].velocity, {0.0, 0.0, 0.0, FRESH}, none(), 0};
        now[k] = begun;
        if (!found[k].counts) continue;
        int first = 1, deep = 0;
        now[k].normal.w = side_of(found[k], found[k].normal, 0.0, 1, sphere.w, &deep);
        for (unsigned m = 0; m < old; ++m) {
            if (before[m] != found[k].pair || !first) continue;
            first = 0;
            now[k].memory = past[m].memory;
            now[k].turn = past[m].turn;
            now[k].normal = past[m].normal;
            now[k].alive = past[m].alive;
            past[m].alive = 0;
        }
    }
    for (unsigned m = 0; m < old; ++m) loose |= past[m].alive;
    // Contacts that begin take the memory of contacts that end nearby with a similar normal.
    for (unsigned k = 0; k < n && loose; ++k) {
        if (!found[k].counts || now[k].alive) continue;
        unsigned nearest = MOST;
        real least = 0.0;
        for (unsigned m = 0; m < old; ++m) {
            real away;
            if (!past[m].alive || !may_follow(now[k].normal, now[k].point, past[m].normal, past[m].point, sphere.w, &away)) continue;
            if (nearest == MOST || away < least) {
                nearest = m;
                least = away;
            }
        }
        if (nearest == MOST) continue;
        now[k].memory = past[nearest].memory;
        now[k].turn = past[nearest].turn;
        now[k].alive = 1;
        past[nearest].alive = 0;
        now[k].normal.x = past[nearest].normal.x;
        now[k].normal.y = past[nearest].normal.y;
        now[k].normal.z = past[nearest].normal.z;
    }
    for (unsigned m = 0; m < old; ++m) {
        if (!past[m].alive) continue;
        const four material = {0.0, 0.0, 0.0, wall_of(p, PATCH_PAIRS[before[m]].second)[17]};
        ENDED[before[m]] = left_in_springs(law_of(p, w, material), past[m].memory, past[m].turn);
    }
    for (unsigned k = 0; k < n; ++k) {
        if (!found[k].counts) continue;
        int deep = 0;
        const real side = side_of(found[k], now[k].normal, now[k].normal.w, !now[k].alive, sphere.w, &deep);
        if (deep) FLAGS[0] = 1;
        now[k].point = found[k].point;
        now[k].normal = found[k].normal;
        now[k].normal.w = side;
        now[k].velocity = found[k].velocity;
        put_contact(p, found[k].pair, x, v, w, sphere.w, now[k], s);
    }
}

/// What dashpots and friction took, the latter after what ended contacts had left; then force and moment wall by wall.
DEVICE real patches_books(ARGUMENTS p, const unsigned *from, const unsigned *to, const unsigned q) {
    const unsigned first = from[PATCHES_LIST] - FIRST_PATCH, last = to[PATCHES_LIST] - FIRST_PATCH;
    real sum = 0.0;
    if (q == 1) sum = in_turn(ENDED + first, last - first, 1);
    for (unsigned k = first; k < last; ++k) {
        if (q == 0) {
            sum += SPENT[FIRST_PATCH + k].x;
        } else if (q == 1) {
            sum += SPENT[FIRST_PATCH + k].y;
        } else if (PATCHES[PATCH_WIDTH * PATCH_PAIRS[k].second] == (q - 2) / 6) {
            const unsigned d = (q - 2) % 6;
            sum += ((const real *)(ACTION + 2 * k + d / 3))[d % 3];
        }
    }
    return sum;
}

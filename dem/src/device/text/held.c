// What local damping and fixed motions did.

/// Sums over the bodies of a block that move by themselves, of one number or of two in turn.
DEVICE real of_singles(ARGUMENTS p, const unsigned *from, const unsigned *to, const unsigned one, const unsigned two) {
    real sum = 0.0;
    for (unsigned i = first_single(p, from); i < to[0]; ++i) {
        if (BY_FOUR(i)) continue;
        sum += HELD_BY[HELD_WIDTH * i + one];
        if (two != one) sum += HELD_BY[HELD_WIDTH * i + two];
    }
    return sum;
}

/// Sum of one number over those that move four at a time.
DEVICE real of_fours(ARGUMENTS p, const unsigned first, const unsigned last, const unsigned one) {
    real sum = 0.0;
    for (unsigned g = first; g + 4 <= last; g += 4) {
        if (!BY_FOUR(g)) continue;
        for (unsigned i = g; i < g + 4; ++i) sum += HELD_BY[HELD_WIDTH * i + one];
    }
    return sum;
}

/// Power of local damping in a lane: component by component of all four, and of their turns; where clumps turn, body by body.
DEVICE real power(ARGUMENTS p, const unsigned first, const unsigned last, const unsigned lane) {
    real sum = 0.0;
    for (unsigned g = first; g + 4 <= last; g += 4) {
        if (!BY_FOUR(g)) continue;
        for (unsigned i = g; i < g + 4 && lane < 3; ++i) sum += HELD_BY[HELD_WIDTH * i + lane];
        if (TURNS(g)) {
            sum += HELD_BY[HELD_WIDTH * (g + lane) + 3];
        } else {
            for (unsigned i = g; i < g + 4 && lane < 3; ++i) sum += HELD_BY[HELD_WIDTH * i + 3 + lane];
        }
    }
    return sum;
}

/// Sum of one number over those that move four at a time, of them every fourth.
DEVICE real held_lane(ARGUMENTS p, const unsigned first, const unsigned last, const unsigned one, const unsigned lane) {
    real sum = 0.0;
    for (unsigned i = first + lane; i < last; i += 4) {
        if (BY_FOUR(i)) sum += HELD_BY[HELD_WIDTH * i + one];
    }
    return sum;
}

/// What local damping and fixed motions are booked with.
DEVICE real held_books(ARGUMENTS p, const unsigned *from, const unsigned *to, const unsigned q) {
    const unsigned first = from[0], last = to[0];
    switch (q) {
    case 0:
        return LANES(power, p, first, last);
    case 1: case 2: case 3:
        return of_fours(p, first, last, 5 + q);
    case 4: case 5: case 6:
        return LANES(held_lane, p, first, last, 8 + q) + of_fours(p, first, last, 5 + q);
    case 7:
        return of_singles(p, from, to, 0, 7);
    case 8: case 9: case 10:
        return of_singles(p, from, to, q - 7, q - 7);
    case 11: case 12: case 13:
        return of_singles(p, from, to, q - 7, q - 3);
    case 14:
        return of_singles(p, from, to, 11, 11);
    case 15: case 16: case 17:
        return of_singles(p, from, to, q - 3, q - 3);
    default:
        return of_singles(p, from, to, q - 3, q);
    }
}

"""The order of the exchange, studied on two masses (docs/theory/coupling.md).

    python3 -m venv venv && venv/bin/pip install numpy
    venv/bin/python docs/two_mass.py

A surface node (mass m, weak spring below) takes one implicit step of length dt per window; a stone (mass M) takes
explicit sub-steps (leapfrog: its velocity is that of half a sub-step before its place, and of the node's instant); between
them a contact spring K and a dashpot of ratio zeta, which stay closed. One window is then a linear map; a spectral radius
above 1 means that the exchange gains energy and grows.

    A   solid first, under the contact force of the last window; then stone on the interpolated motion of the node
    A'  as A, with the force filtered: 0.4 of the new and 0.6 of the old one
    B   stone first, on the predicted motion x + v t of the node; then solid, under the mean force of the same window
    B'  as B, with the node where it is at the end of a sub-step, as a program has it that moves the surface first
    B"  as B, with the node where it is at the start of a sub-step
    S   as B, the node's mean velocity predicted by a solve with the contact's spring and dashpot in the matrix
    I   window repeated until the stone moves on the node's own mean velocity

Printed: the largest W = dt sqrt(K/m) up to which the radius stays at or below 1 + 1e-6, and the growth per window
without damping and, but for A, with zeta = 0.05.
"""

import numpy as np

GROUND = 0.05  # spring below the node over K


def window(z, scheme, dt, substeps, mass, stone, damping):
    """State after one window: x, v, a of the node, y, w of the stone, force kept for the next window. K = m = 1."""
    x, v, a, y, w, kept = z

    def solid_end_force(force):
        """Newmark 1/4, 1/2 with the force at the end of the step."""
        x1 = (force * dt**2 / 4 + mass * (x + v * dt + a * dt**2 / 4)) / (mass + GROUND * dt**2 / 4)
        a1 = 4 / dt**2 * (x1 - x - v * dt) - a
        return x1, v + dt / 2 * (a + a1), a1

    def solid_mean_force(force):
        """The window form: only the impulse counts."""
        v1 = (mass * v / dt + force - GROUND * (x + dt * v / 4)) / (mass / dt + GROUND * dt / 4)
        x1 = x + dt * (v + v1) / 2
        return x1, v1, (force - GROUND * x1) / mass

    def stone_steps(place, speed):
        h, impulse = dt / substeps, 0.0
        place_of_stone, speed_of_stone = y, w
        # The stone's place is half a sub-step ahead of its velocity, and so of the node; the node's has to be as well.
        ahead = {"B'": h, 'B"': 0.0}.get(scheme, h / 2)
        for k in range(substeps):
            t = k * h + ahead
            force = -(place(t) - place_of_stone) - damping * (speed(t) - speed_of_stone)
            impulse += force * h
            speed_of_stone -= force * h / stone
            place_of_stone += speed_of_stone * h
        return place_of_stone, speed_of_stone, impulse / dt

    if scheme == "S":
        half = dt / 2 + damping
        now = y - x + damping * (w - v) + (w - v) * dt / 2
        # mass (v1 - v)/dt + GROUND (x + dt (v + v1)/4) = now - half (v1 - v)/2
        v1 = (mass * v / dt + now - GROUND * (x + dt * v / 4) + half * v / 2) / (
            mass / dt + GROUND * dt / 4 + half / 2
        )
        mean_speed = (v + v1) / 2
        y1, w1, mean = stone_steps(lambda t: x + mean_speed * t, lambda t: mean_speed)
        return [*solid_mean_force(mean), y1, w1, mean]
    if scheme == "I":
        # The map from the node's mean velocity to itself is linear: two passes tell its fixed point.
        def again(speed):
            y1, w1, mean = stone_steps(lambda t: x + speed * t, lambda t: speed)
            solid = solid_mean_force(mean)
            return (v + solid[1]) / 2, [*solid, y1, w1, mean]

        at_0, at_1 = again(0.0)[0], again(1.0)[0]
        return again(at_0 / (1 - at_1 + at_0))[1]
    if scheme.startswith("B"):
        y1, w1, mean = stone_steps(lambda t: x + v * t, lambda t: v)
        return [*solid_mean_force(mean), y1, w1, mean]
    x1, v1, a1 = solid_end_force(kept)
    y1, w1, mean = stone_steps(lambda t: x + (x1 - x) * t / dt, lambda t: v + (v1 - v) * t / dt)
    return [x1, v1, a1, y1, w1, mean if scheme == "A" else 0.4 * mean + 0.6 * kept]


def radius(scheme, w, stone, zeta):
    substeps = max(20, int(np.ceil(w / 0.1)))
    damping = 2 * zeta * np.sqrt(stone / (1 + stone))
    columns = [window(e, scheme, w, substeps, 1.0, stone, damping) for e in np.eye(6)]
    return np.abs(np.linalg.eigvals(np.array(columns).T)).max()


def largest_stable(scheme, stone, zeta):
    """The first threshold from W = 0.02 up, to 0.1 %; 0 where that grows already, 6 where nothing up to there does."""
    grows = lambda w: radius(scheme, w, stone, zeta) > 1 + 1e-6
    high = 0.02
    if grows(high):
        return 0.0
    while not grows(high):
        low, high = high, 1.02 * high
        if low > 6.0:
            return 6.0
    while high > 1.001 * low:
        middle = (low * high) ** 0.5
        low, high = (low, middle) if grows(middle) else (middle, high)
    return low


def main():
    stones = (0.1, 0.3, 1.0, 3.0, 10.0, 100.0)
    print("largest stable W; M/m =", " ".join(f"{s:6g}" for s in stones))
    for scheme in ("A", "A'", "B", "B'", 'B"', "S", "I"):
        for zeta in (0.0, 0.05, 0.1, 0.2, 0.3):
            row = " ".join(f"{largest_stable(scheme, s, zeta):6.3f}" for s in stones)
            print(f"{scheme:2} zeta = {zeta:4.2f}          {row}")
    print("growth per window less 1 without damping, M = m")
    for scheme in ("A", "A'", "B", "B'", 'B"', "S", "I"):
        print(f"{scheme:2}", "  ".join(f"W = {w:g}: {radius(scheme, w, 1.0, 0.0) - 1:.1e}" for w in (0.05, 0.2, 0.5)))
    print("growth per window less 1, zeta = 0.05, M = 10 m")
    for scheme in ("B", "B'", 'B"', "S", "I"):
        row = (f"W = {w:g}: {radius(scheme, w, 10.0, 0.05) - 1:.1e}" for w in (0.1, 0.2, 0.3, 0.5, 1.0, 1.4))
        print(f"{scheme:2}", "  ".join(row))


if __name__ == "__main__":
    main()

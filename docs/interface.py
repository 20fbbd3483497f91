"""Stability of the coupling windows with many sticking contacts (docs/theory/coupling.md).

    python3 -m venv venv && venv/bin/pip install numpy
    venv/bin/python docs/interface.py

Linear systems drawn at random: a solid of 1 to 5 degrees of freedom with a full mass matrix and weak or strong springs below, 1 to 6
contacts, bodies of one or several contacts whose masses are 0.01 to 1000, contacts undamped, damped alike, damped at random or in part.
The window is as long as W, D and Omega allow (docs/theory/coupling.md, "how long a window"). One window of the predicted scheme is a linear
map; printed is the largest growth per window over all systems, less 1.

Then one node and one body on a tangential spring, which is a sum of velocities: its growth per window by what the spring feels between
windows: nothing, the jump of the surface, the jump and half a sub-step of the change of velocity; and of a spring of positions.
"""

import numpy as np

# What a tangential spring feels of the surface between windows.
FEELS = ("nothing", "jump", "jump, half step", "positions")


def window(solid, contacts, bodies, dt, theta, steps):
    """The map of one window: u, v of the solid, y, w of the bodies."""
    mass, springs = solid
    shape, arms, stiffness, damping = contacts
    inverse = np.linalg.inv(bodies)
    n, g, h = len(mass), len(bodies), dt / steps
    start = np.eye(2 * n + 2 * g)
    u, v, y, w = start[:n], start[n : 2 * n], start[2 * n : 2 * n + g], start[2 * n + g :]
    impulse = 0.0
    for k in range(steps):
        closing = arms @ y - shape.T @ (u + v * (k + 0.5) * h)
        force = stiffness[:, None] * closing + damping[:, None] * (arms @ w - shape.T @ v)
        impulse = impulse + h * force
        w = w - h * inverse @ (arms.T @ force + 1e-4 / dt**2 * bodies @ y)
        y = y + h * w
    change = np.linalg.solve(mass / (theta * dt) + theta * dt * springs, shape @ impulse / dt - springs @ (u + theta * dt * v))
    return np.vstack([u + dt * (v + change), v + change / theta, y, w])


def draw(random):
    """Mass of the solid, shape functions, arms of bodies, their masses, springs, dashpots."""
    n, contacts = random.integers(1, 6), random.integers(1, 7)
    bodies = random.integers(1, contacts + 1)
    root = random.normal(size=(n, n))
    mass = root @ root.T + np.diag(random.uniform(0.05, 2, n))
    shape = random.normal(size=(n, contacts))
    arms = np.eye(contacts) if bodies == contacts else random.normal(size=(contacts, bodies))
    weights = np.diag(10 ** random.uniform(-2, 3, bodies))
    stiffness = 10 ** random.uniform(-1, 0, contacts)
    ratios = [
        np.zeros(contacts),
        random.uniform(0, 1, contacts),
        np.full(contacts, random.uniform(0, 1)),
        random.uniform(0, 1, contacts) * (random.random(contacts) < 0.5),
    ][random.integers(0, 4)]
    own = 1 / np.einsum("cg,gh,ch->c", arms, np.linalg.inv(weights), arms)
    return mass, shape, arms, weights, stiffness, 2 * ratios * np.sqrt(stiffness * own)


def largest(matrix, shape, values):
    root = np.sqrt(values)
    product = shape.T @ np.linalg.solve(matrix, shape)
    return np.linalg.eigvalsh(root[:, None] * product * root).max()


def growth(limits, theta, count=300):
    """Largest growth over `count` systems in windows at the limits of W, D, Omega."""
    random, worst = np.random.default_rng(1), -1.0
    for _ in range(count):
        mass, shape, arms, bodies, stiffness, damping = draw(random)
        strong, steps = random.integers(0, 2), int(random.integers(1, 21))
        w, d = np.sqrt(largest(mass, shape, stiffness)), largest(mass, shape, damping)
        omega, own = np.sqrt(largest(bodies, arms.T, stiffness)), largest(bodies, arms.T, damping)
        dt = 1 / max(w / limits[0], d / limits[1], omega / limits[2])
        springs = mass * 10 ** random.uniform(-3, 2) / dt**2 if strong else 1e-3 * np.eye(len(mass))
        steps = max(steps, int(np.ceil(dt * omega)), int(np.ceil(dt * own / 0.8)))
        step = window((mass, springs), (shape, arms, stiffness, damping), bodies, dt, theta, steps)
        worst = max(worst, np.abs(np.linalg.eigvals(step)).max() - 1)
    return worst


def summed(feels, mass, dt, steps, windows=4000):
    """Growth per window of a node (mass 1, spring 0.3 below, theta 1/2) and a body on a spring 1 that feels `feels`."""
    h, u, v, y, w, spring, before, jump = dt / steps, 0.0, 0.0, 0.0, 1e-3, 0.0, 0.0, 0.0
    sizes = []
    for _ in range(windows):
        impulse = 0.0
        for k in range(steps):
            if k == 0 and feels in ("jump", "jump, half step"):
                spring -= jump
            if k == 0 and feels == "jump, half step":
                spring -= 0.5 * h * (before - v)
            spring = y - (u + v * (k + 0.5) * h) if feels == "positions" else spring + (w - v) * h
            impulse += h * spring
            w -= h * spring / mass
            y += h * w
        change = (impulse / dt - 0.3 * (u + 0.5 * dt * v)) / (2 / dt + 0.15 * dt)
        end = u + dt * (v + change)
        jump, before, u, v = end - u - v * dt, v, end, v + 2 * change
        sizes.append(abs(y) + abs(u) + abs(v) + abs(w))
    quarter = windows // 4
    return np.log(max(sizes[3 * quarter :]) / max(sizes[quarter : 2 * quarter])) / (2 * quarter)


def main():
    print("  W   Omega  theta covered |", "  ".join(f"theta {t:5.3f}" for t in (0.5, 0.51, 0.52, 0.55, 0.6)))
    for w in (0.2, 0.5, 1.0):
        for omega in (0.3, 0.5, 0.8, 1.0):
            row = "  ".join(f"{growth((w, 1.0, omega), t):11.0e}" for t in (0.5, 0.51, 0.52, 0.55, 0.6))
            print(f"{w:4.1f} {omega:6.1f} {0.5 + omega**2 / 24:12.4f}   |", row)
    print("steps  mass |", "  ".join(f"{feels:>15s}" for feels in FEELS))
    for steps in (1, 2, 8):
        for mass in (0.03, 0.3, 3.0):
            row = "  ".join(f"{summed(feels, mass, 0.1 if mass < 0.1 else 0.3, steps):15.0e}" for feels in FEELS)
            print(f"{steps:5d} {mass:5.2f} |", row)


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""Figure of the stability border of coupling windows: predicted against found.

    cargo test --release -p trackbed-coupling --test verification -- --ignored --nocapture border_from_both_sides | python3 docs/interface_border.py

Reads the lines "border …" of the test and writes docs/pictures/interface_border.svg. Needs Python 3 and nothing else.
"""

import math
import os
import sys

LEFT, TOP, ROW, WIDTH = 250, 40, 17, 420
LOW, HIGH = 0.6, 3.5
# Growth of amplitudes per window, below which a system counts as neutral.
NEUTRAL = 1e-6
COLOURS = {"decays": "#2b7bba", "grows": "#c8452f"}


def read(lines):
    """Rows (label, W, D, phase, [(factor, growths)])."""
    for line in lines:
        if not line.startswith("border "):
            continue
        head, numbers, rates = line.split("|")
        words = head.split()
        mass, values = numbers.split(",")
        w, d, phase = (float(values.split()[k]) for k in (1, 3, 5))
        points, tokens = [], rates.replace(",", " , ").split()
        for token in tokens:
            if token.endswith(":"):
                points.append((float(token[:-1]), []))
            elif token != ",":
                points[-1][1].append(float(token))
        limit = max((w, "W"), (d, "D"), (phase / 0.85, "Ω"))[1]
        yield f"{words[2]}, {words[3]}, {words[4]}; {mass.split()[1]} kg; {limit}", points


def x(factor):
    return LEFT + WIDTH * math.log(factor / LOW) / math.log(HIGH / LOW)


def draw(rows):
    height = TOP + ROW * len(rows) + 60
    out = [
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {LEFT + WIDTH + 30} {height}" font-family="sans-serif" font-size="11">',
        '<rect width="100%" height="100%" fill="white"/>',
        f'<text x="8" y="{TOP - 14}">contact; mass of the ball; number at its limit</text>',
        f'<rect x="{x(LOW):.0f}" y="{TOP - 6}" width="{x(1) - x(LOW):.1f}" height="{ROW * len(rows)}" fill="#eef4fa"/>',
        f'<line x1="{x(1):.1f}" x2="{x(1):.1f}" y1="{TOP - 6}" y2="{TOP - 6 + ROW * len(rows)}" stroke="black"/>',
        f'<text x="{x(1):.1f}" y="{TOP - 14}" text-anchor="middle">predicted</text>',
    ]
    for k, (label, points) in enumerate(rows):
        y = TOP + 4 + ROW * k
        out.append(f'<text x="8" y="{y + 4}">{label}</text>')
        for factor, growths in points:
            # At the limit over 10, 100 and 1,000 periods: the largest.
            last = max(growths[1:] or growths)
            kind = "grows" if last > NEUTRAL else "decays"
            size = 2.5 + (max(0.0, min(4.0, math.log10(last / NEUTRAL))) if kind == "grows" else 0.0)
            out.append(f'<circle cx="{x(factor):.1f}" cy="{y}" r="{0.8 * size:.1f}" fill="{COLOURS[kind]}"/>')
    base = TOP - 6 + ROW * len(rows)
    for factor in (0.7, 0.9, 1.1, 1.3, 2, 3):
        out.append(f'<text x="{x(factor):.1f}" y="{base + 16}" text-anchor="middle">{factor:g}</text>')
    out.append(f'<text x="{LEFT + WIDTH / 2}" y="{base + 32}" text-anchor="middle">window over the predicted limit</text>')
    for k, kind in enumerate(COLOURS):
        at = LEFT + 90 + 130 * k
        out.append(f'<circle cx="{at}" cy="{base + 44}" r="4" fill="{COLOURS[kind]}"/><text x="{at + 8}" y="{base + 48}">found: {kind}</text>')
    return "\n".join(out + ["</svg>", ""])


def main():
    rows = list(read(sys.stdin))
    if not rows:
        sys.exit('no line "border …" in the input')
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "pictures", "interface_border.svg")
    with open(path, "w") as file:
        file.write(draw(rows))
    print(f"{path}: {len(rows)} systems")


if __name__ == "__main__":
    main()

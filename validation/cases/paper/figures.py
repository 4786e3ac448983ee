# SPDX-License-Identifier: GPL-3.0-or-later
"""Line and scatter plots as plain SVG: axes with round ticks, nothing else."""
import math

WIDTH, HEIGHT, LEFT, RIGHT, TOP, BOTTOM = 720, 440, 70, 20, 40, 55
# One for each series; told apart in grey and by the colour-blind as far as ten can be (Okabe and Ito, then darker ones).
COLOURS = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#000000", "#e69f00", "#56b4e9", "#8c510a", "#6a3d9a", "#4d4d4d")


def _ticks(low, high, most=8):
    step = 10 ** math.floor(math.log10((high - low) / most))
    for factor in (1, 2, 5, 10):
        if (high - low) / (factor * step) <= most:
            step *= factor
            break
    first = math.ceil(low / step - 1e-9)
    return [k * step for k in range(first, math.floor(high / step + 1e-9) + 1)]


def plot(title, x_label, y_label, series, x_range, y_range, legend_top=TOP + 14):
    """SVG text. series: (name, points, "line" | "dashed" | "dots")."""
    if len(series) > len(COLOURS):
        raise ValueError(f"{len(series)} series, but only {len(COLOURS)} colours: two would look alike")

    def x(value):
        return LEFT + (value - x_range[0]) / (x_range[1] - x_range[0]) * (WIDTH - LEFT - RIGHT)

    def y(value):
        return HEIGHT - BOTTOM - (value - y_range[0]) / (y_range[1] - y_range[0]) * (HEIGHT - TOP - BOTTOM)

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {HEIGHT}" font-family="sans-serif" font-size="13">',
           f'<rect width="{WIDTH}" height="{HEIGHT}" fill="white"/>',
           f'<text x="{WIDTH / 2}" y="22" text-anchor="middle" font-size="15">{title}</text>',
           f'<path d="M{LEFT} {TOP}V{HEIGHT - BOTTOM}H{WIDTH - RIGHT}" fill="none" stroke="black"/>']
    for t in _ticks(*x_range):
        out.append(f'<path d="M{x(t):.1f} {HEIGHT - BOTTOM}v5" stroke="black"/><text x="{x(t):.1f}" y="{HEIGHT - BOTTOM + 19}" text-anchor="middle">{t:.4g}</text>')
    for t in _ticks(*y_range):
        out.append(f'<path d="M{LEFT} {y(t):.1f}h-5" stroke="black"/><text x="{LEFT - 8}" y="{y(t) + 4:.1f}" text-anchor="end">{t:.4g}</text>')
    out.append(f'<text x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 12}" text-anchor="middle">{x_label}</text>')
    out.append(f'<text x="18" y="{(TOP + HEIGHT - BOTTOM) / 2}" text-anchor="middle" transform="rotate(-90 18 {(TOP + HEIGHT - BOTTOM) / 2})">{y_label}</text>')
    for i, (name, points, kind) in enumerate(series):
        colour = COLOURS[i]
        inside = [(x(a), y(b)) for a, b in points if x_range[0] <= a <= x_range[1] and y_range[0] <= b <= y_range[1]]
        if kind in ("dots", "discs"):
            radius = 2 if kind == "dots" else 5
            out += [f'<circle cx="{a:.1f}" cy="{b:.1f}" r="{radius}" fill="{colour}"/>' for a, b in inside]
        else:
            dash = ' stroke-dasharray="6 4"' if kind == "dashed" else ""
            line = " ".join(f"{a:.1f},{b:.1f}" for a, b in inside)
            out.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="1.6"{dash}/>')
        out.append(f'<text x="{WIDTH - RIGHT - 8}" y="{legend_top + 17 * i}" text-anchor="end" fill="{colour}">{name}</text>')
    return "\n".join(out) + "\n</svg>\n"


def pareto(example, match, paper):
    """Front of policy matched (a dictionary of report.json's match), the meshes it made, and the paper's cases (prisms, quality)."""
    log = lambda prisms: math.log10(prisms)
    least = lambda row: min(row["mean_prism"], row["volume_weighted_prism"])
    front = [(log(p["prisms"]), least(p)) for p in match["front"]]
    knee = front[match["knee"]]
    points = [(log(s["prisms"]), least(s)) for s in match["meshes"]]
    others = [(log(prisms), quality) for prisms, quality in paper]
    return plot(f"{example}: quality over prisms", "log10 of the number of prisms", "smaller of mean and volume-weighted q_p",
                [("Pareto front of policy matched, predicted", front, "line"), ("meshes made on the way", points, "discs"),
                 ("the paper's five cases, floor", others, "discs"), (f"knee: {10 ** knee[0]:,.0f} prisms, {knee[1]:.3f}", [knee], "discs")],
                (math.floor(min(a for a, _ in front + others)), math.ceil(max(a for a, _ in others))), (0, 1.05), HEIGHT - BOTTOM - 17 * 4)


def figure4(data):
    points = data["points"]
    top = 1.05 * data["optimal_quality"]
    return plot("Prism quality over height, one random triangle (Figure 4)", "height h4", "q_p",
                [("q_p, Eq. 2", [(p[0], p[1]) for p in points], "line"),
                 ("parabola of the second derivative, F8", [(p[0], p[2]) for p in points], "dashed")],
                (points[0][0], points[-1][0]), (0.5 * data["optimal_quality"], top))


def figure6(heights_m):
    heights = [1e3 * h for h in heights_m]
    return plot(f"Optimal prism heights of the serpentine's {len(heights)} triangles (Figure 6)", "triangle", "h*, mm",
                [("h*, Eq. 3", list(enumerate(heights)), "dots"),
                 ("mean", [(0, sum(heights) / len(heights)), (len(heights), sum(heights) / len(heights))], "line")],
                (0, len(heights)), (0, 1.05 * max(heights)))

# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the measurements as Markdown: the paper's figure, ours, the difference."""
import measurements as m

CASE_NAMES = {1: "1 basic", 2: "2 average", 3: "3 maximum", 4: "4 minimum", 5: "5 thinnest layer"}


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows]) + "\n"


def percent(ours, paper):
    return f"{100 * (ours / paper - 1):+.1f} %"


def verdicts(rows):
    return table(("check", "value", "must lie in", "holds"),
                 [(what, f"{value:.7g}", f"[{low:.7g}, {high:.7g}]", "yes" if holds else "**NO**") for what, value, low, high, holds in rows])


def table1(one):
    rows = []
    for key, name in (("optimal_height", "Eq. 3"), ("average_edge", "average edge")):
        for figure in ("max", "min", "avg"):
            paper, ours = m.PRINTED["table1"][key][figure], one[key][figure]
            rows.append((name, figure, f"{paper:.6g}", f"{ours:.6g}", f"{ours - paper:+.2g}"))
    ratio = one["paired_ratio"]
    return (table(("height from", "figure", "paper", "ours", "difference"), rows)
            + f"\nSeed {one['seed']}, {one['count']:,} triangles with corners uniform in the unit square, both rows on the same sample. "
            f"Ratio of the averages {one['average_edge']['avg'] / one['optimal_height']['avg']:.5f}; paired ratio of single triangles between {ratio['min']:.5f} and {ratio['max']:.5f}; theory (F9): above 0.90640, at most 0.97428. "
            "One standard error of a mean of 20,000 is 0.0021, so the averages agree; minimum and maximum are single draws.\n")


def statistics(example, measured):
    paper, row = m.PRINTED[example]["heights_mm"], measured["cases"][0]
    ours = {"min": 1e3 * row["heights"]["min_m"], "avg": 1e3 * row["heights"]["avg_m"], "max": 1e3 * row["heights"]["max_m"],
            "percent_below": 100 * row["heights"]["share_below_average"]}
    names = {"min": "smallest h*, mm", "avg": "mean h*, mm", "max": "largest h*, mm", "percent_below": "below the mean, %"}
    return table(("figure", "paper", "ours", "difference"), [(names[k], f"{paper[k]:.6g}", f"{ours[k]:.6g}", percent(ours[k], paper[k])) for k in names])


def compat(example, measured):
    rows = []
    for row, (triangles, q_t, prisms, q_p), bound in zip(measured["cases"], m.PRINTED[example]["cases"], m.PRINTED[example]["longest_edge_mm"]):
        ours = row["compat"]
        rows.append((CASE_NAMES[row["case"]], f"{bound:.6g} / {1e3 * row['longest_edge_bound_m']:.6g}",
                     f"{triangles:,} / {row['triangles']:,} ({percent(row['triangles'], triangles)})",
                     f"{q_t:.4f} / {row['mean_triangle']:.4f} ({row['mean_triangle'] - q_t:+.4f})",
                     f"{prisms:,} / {ours['prisms']:,} ({percent(ours['prisms'], prisms)})",
                     f"{q_p:.4f} / {ours['mean_prism']:.4f} ({ours['mean_prism'] - q_p:+.4f})", f"{ours['volume_weighted_prism']:.4f}"))
    return table(("case", "longest edge, mm", "triangles", "q_t", "prisms", "q_p", "our q_p by volume"), rows) + "\nEach cell: paper / ours (difference).\n"


def compat_flag(example, measured, reports):
    """The five cases by `pcbmesh mesh --paper-compat` itself, beside the print."""
    rows = []
    for row, report, (triangles, _, prisms, q_p) in zip(measured["cases"], reports, m.PRINTED[example]["cases"]):
        counts, quality = report["counts"], report["quality"]
        rows.append((CASE_NAMES[row["case"]], f"{triangles:,} / {counts['triangles']:,}", ", ".join(str(layer["sublayers"]) for layer in reversed(report["layers"])),
                     f"{prisms:,} / {counts['prisms']:,}", f"{q_p:.4f} / {quality['mean_prism']:.4f}", f"{quality['volume_weighted_prism']:.4f}"))
    return table(("case", "triangles", "sub-layers, top to bottom", "prisms", "q_p", "our q_p by volume"), rows)


def clean(measured, key="cases"):
    rows = []
    for row in measured[key]:
        cells = [f"{c['prisms']:,}: {c['mean_prism']:.4f} ({c['volume_weighted_prism']:.4f})" for c in (row["clean"][rule] for rule in ("floor", "round", "ceil", "optimal"))]
        rows.append((CASE_NAMES[row["case"]], f"{row['triangles']:,}", *cells))
    return table(("case", "triangles", "floor", "round", "ceil", "optimal (F10)"), rows) + "\nEach cell: prisms: q_p (q_p by volume).\n"


def headline(example, measured):
    rows, paper = [], m.PRINTED[example]
    worst = paper["cases"][0][3]
    best = max(range(5), key=lambda i: paper["cases"][i][3])
    rows.append(("paper, printed", best + 1, f"{worst:.4f}", f"{paper['cases'][best][3]:.4f}", f"+{paper['headline_percent']:.1f} %"))
    ways = [("ours, compat", m.compat_quality)] + [(f"ours, clean, {rule}", m.clean_quality(rule)) for rule in ("floor", "round", "ceil", "optimal")]
    for name, quality in ways:
        case, gain = m.gain_percent(measured["cases"], quality)
        rows.append((name, case, f"{quality(measured['cases'][0]):.4f}", f"{quality(measured['cases'][case - 1]):.4f}", f"{gain:+.1f} %"))
    return table(("way", "best case", "q_p of case 1", "q_p of the best", "gain"), rows)


def audit(measured, one):
    """Slips of the print, each with the measurement that shows it."""
    serpentine, via = measured["serpentine"]["cases"], measured["via"]["cases"]
    theory = 0.9064 * m.PRINTED["table1"]["optimal_height"]["min"]
    below = [row["case"] for row in via if row["clean"]["floor"]["sublayers"] == 11]
    thin = serpentine[4]["clean"]["floor"]["sublayers"]
    return "\n".join([
        f"- *\"1 mm and 4 mm\" layers.* Table 3 has {m.PRINTED['serpentine']['longest_edge_mm'][4]} mm as minimum layer height, and 0.1 and 0.4 mm give its q_p (inferred: the best by far of 1,820 sets of thicknesses): with them cases 4 and 5 come to {m.compat_quality(serpentine[3]):.4f} and {m.compat_quality(serpentine[4]):.4f}.",
        "- *1524 prisms* (Table 3, case 3) is no multiple of 382; 4 x 382 = 1528.",
        f"- *Five layers, four meshed.* Prisms over triangles are 4 in cases 2, 4 and 5 although the text has five layers; and in case 5 the 0.4 mm layers stay whole although h = 0.1 mm. Really cut, case 5 has {thin} sub-layers and {serpentine[4]['clean']['floor']['mean_prism']:.4f}, not {m.PRINTED['serpentine']['cases'][4][3]:.4f}: the statement that case 4 is best is an artefact of layers left whole.",
        "- *Case 1, eight sub-layers.* 1 + 3 + 1 + 3 (inferred): a quotient of z differences in single precision, truncated, gives 3 where 4 was meant; ten sub-layers were.",
        f"- *Via, 12 sub-layers of \"11 layers\".* Prisms over triangles are 12 in every row. Eleven layers that are never cut (as floor gives in cases {', '.join(map(str, below))} here) and one without height reproduce all five q_p.",
        "- *\"The minimum of the layer heights is 2 mm\"* contradicts Table 4, case 5 (0.02032 mm).",
        f"- *Table 1's rows are different samples.* By F9 the second minimum is at least {theory:.3g} on one sample; 2.92e-5 is printed. On one sample ours are {one['optimal_height']['min']:.3g} and {one['average_edge']['min']:.3g}.",
        "- *\"Conjecture\"* that 1.0264 is the largest q_p: it is 16 sqrt(3) / 27 = 1.026400479 times q_t at the optimal height (F4), and q_t <= 1 is Weitzenboeck's inequality. The limit of 1 for the average edge is F9.",
        "- *Sensitivity* (Sec. 4.3): relative to its optimum every triangle has the same curve (F6), so second derivatives only compare q* / h*^2 (F8).",
        "- *B* is an upper bound on circumradius over shortest edge; CGAL's 0.125 is the lower bound sin^2(20.7 deg).",
        "- *Q = 3r/R* has its maximum at 1.5 for triangles; 2r/R is 1 for the equilateral.",
        "- *A third of the wavelength is 2 mm at 50 GHz* in vacuum; in FR-4 (eps_r 4.3) it is 0.96 mm. pcbmesh takes the material's.",
        "- *Figure 6* says centimetres, the text millimetres. *\"employed in [17]\"* means [13]. *144 s* is drawing time, not meshing.",
        "- *Plain means can be gamed*: many small good prisms in a small area lift them. pcbmesh reports q_p by volume beside every mean.",
    ]) + "\n"

#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Turns what stability_tests measured (JSON lines) into docs/stability.md and its plots.

    report.py RESULTS.jsonl [--learn] [--beyond nightly|gpu]

--learn also writes bounds.json: half as much again as the worst figures measured, and no less than what was there.
--beyond nightly, --beyond gpu: the results are of ten times the scenes, or of a GPU. --learn then leaves bounds.json alone and
writes bounds-nightly.json or bounds-gpu.json, which hold only what goes beyond it. Of a GPU no page is written.
"""
import argparse
import json
import math
import pathlib
import sys

try:
    import matplotlib
    matplotlib.use("Agg")
    matplotlib.rcParams["svg.hashsalt"] = "penumbra"
    import matplotlib.pyplot as plt
except ImportError:
    sys.exit("report.py: needs matplotlib: apt-get install python3-matplotlib")

HERE = pathlib.Path(__file__).resolve().parent
DOCS = HERE.parent.parent / "docs"
COLOURS = {"rc": "#0072B2", "reference": "#7f7f7f", "rc_fix": "#56B4E9", "hrc": "#009E73", "exact": "#D55E00"}
STYLES = {"draft": ":", "standard": "-", "high": "--"}
WAYS = [f"{m} {q}" for m in ("exact", "hrc", "rc_fix", "rc", "reference") for q in ("draft", "standard", "high")]

# What the laws are: in the order of the page.
LAWS = {
    "furnace": "Everything that shines, shapes and sky, has radiance 1: so has every free pixel. `max`: largest |value - 1|.",
    "linearity": "Two sets of lamps apart, summed, against both together.",
    "units": "The same scene in a view 10 and 0.125 times as large, 0.001 and 1e6 units wide, at the origin and 1e6 off.",
    "far origin": "View and scene moved by 1e3, 1e6, 1e8 px together.",
    "exponents": "All radiance times 2^-30, 2^-20, 2^20, 2^27.",
    "range of radiance": "Lamps of 1e6 and of 1e-6 in two rooms of one scene. `rel in the dim room`: mean |a/b - 1| there, where what leaks is 1e12 times as bright.",
    "rotation": "A lamp between three walls turned as one: error against the truth at every angle. `most / least`: of `rel`, over the angles.",
    "translation": "Moved by parts of a pixel.",
    "symmetry": "The mirrored and the turned scene against the mirrored and the turned picture. The brute force scatters by place and does not try.",
    "energy": "Light made or lost, over scenes of a few shapes of some pixels.",
    "monotonicity": "A dark shape more brightens no pixel: by how much one does, over the brightest source.",
    "closed wall of 1 px": "A lamp in a closed box: the brightest pixel outside, the lamp being 1.",
    "narrow gaps": "Behind a wall with a gap of 0.3 to 3 px: pixels that should have 2 % of the brightest there, and have less than a tenth of what they should.",
    "walls": "A lamp behind a wall of 0.1 to 2 px at all angles, on the grid and off it.",
    "motion": "A lamp glides by 1/16 px a frame past walls. Of each frame, change in the picture less change in the truth: the largest, over the mean; and the sum, over the sum of the truth's change.",
    "degenerate shapes": "Thirteen kinds, each without and under a sky. `mean of peak`: mean |a - b| over the brightest source.",
    "ten thousand emitters": "Their light summed.",
    "ten thousand shapes in a pixel": "2,000 in the quick form. `refused`: in words.",
    "canvases": "1x1, 2x1, 3x5, 1x127, 131x1, 61x7, 13x97.",
    "strips of 8192": "1x8192 and 8192x1.",
    "8192 x 8192": "The largest picture, at night only.",
    "mild": "Random scenes of shapes of some pixels. `of peak`: over the brightest source.",
    "wild": "Random scenes of everything at its extremes: sizes from 1e-3 px, aspects to 1e5, radiance from 1e-6 to 1e6, views from 1e-4 to 1e5 units a pixel, twins, shapes on the grid, over everything.",
    "no fused multiply-add": "llvmpipe with processor features cut to SSE 4.1, against itself.",
    "out of steps": "A slit of 4,000 px whose march asks 13 edges every quarter pixel: rays that run out are blocked and counted. `excess of peak`: light above the truth.",
    "loop limit": "What the driver allows, measured at start.",
}


def read(path):
    figures, points = [], []
    with open(path, encoding="utf-8") as file:
        for line in file:
            row = json.loads(line)
            (figures if "law" in row else points).append(row)
    return figures, points


def short(value):
    if value is None:
        return "no number"
    if value == 0:
        return "0"
    if value >= 100:
        return f"{value:.0f}" if value < 1e5 else f"{value:.1e}"
    return f"{value:.2g}" if value >= 1e-3 else f"{value:.1e}"


def table(rows):
    figures = sorted({row["figure"] for row in rows})
    ways = sorted({row["who"] for row in rows}, key=lambda w: WAYS.index(w) if w in WAYS else len(WAYS))
    lines = ["| | " + " | ".join(figures) + " |", "| --- |" + " --- |" * len(figures)]
    for way in ways:
        cells = []
        for figure in figures:
            found = [row for row in rows if row["who"] == way and row["figure"] == figure]
            if not found:
                cells.append("")
                continue
            row = found[0]
            scene = row["scene"].replace("|", "/")
            if len(scene) > 90:
                scene = scene[:87] + "..."
            constant = len({r["scene"] for r in rows}) == 1 or row["worst"] == 0
            cells.append(f"**{short(row['worst'])}**" + ("" if constant else f" ({scene})"))
        lines.append(f"| {way} | " + " | ".join(cells) + " |")
    return "\n".join(lines)


def draw(name, points, log_y):
    slug = name.replace(" ", "-")
    figure, axis = plt.subplots(figsize=(7.2, 3.4))
    lines = {}
    for p in points:
        lines.setdefault(p["line"], []).append((p["x"], p["y"]))
    for line, values in sorted(lines.items(), key=lambda item: WAYS.index(item[0])):
        method, quality = line.split()
        values.sort()
        ys = [v[1] for v in values]
        if log_y and max(ys) <= 0:
            continue
        axis.plot([v[0] for v in values], ys, STYLES[quality], color=COLOURS[method], label=line, linewidth=1.3,
                  marker="o" if len(values) < 12 else None, markersize=3)
    axis.set_yscale("log" if log_y else "linear")
    x, y = {"error over angle": ("degrees", "rel"), "error over position": ("moved by, px", "rel"),
            "error over wall width": ("width of the wall, px", "rel, mean over the angles"),
            "light behind a closed wall over angle": ("degrees", "brightest pixel outside"),
            "undue change over frames": ("frame", "undue / due change")}[name]
    axis.set_xlabel(x)
    axis.set_ylabel(y)
    axis.grid(True, color="#dddddd", linewidth=0.5)
    axis.legend(fontsize=7, ncol=1, loc="center left", bbox_to_anchor=(1.0, 0.5), frameon=False)
    figure.tight_layout()
    figure.savefig(DOCS / "images" / f"stability-{slug}.svg", metadata={"Date": None})
    plt.close(figure)
    return f"![{name}](images/stability-{slug}.svg)"


PLOTS = {"rotation": "error over angle", "translation": "error over position", "walls": "error over wall width",
         "closed wall of 1 px": "light behind a closed wall over angle", "motion": "undue change over frames"}

# Zero is part of these laws; elsewhere a bound leaves single precision its digits.
STRICT = {"closed wall of 1 px", "exponents"}


def learn(figures, beyond):
    path = HERE / (f"bounds-{beyond}.json" if beyond else "bounds.json")
    old = json.loads(path.read_text()) if path.exists() else {}
    quick = json.loads((HERE / "bounds.json").read_text()) if beyond else {}
    new = {}
    for row in figures:
        key = f"{row['law']}/{row['who']}/{row['figure']}"
        if beyond and key not in old and row["worst"] <= quick.get(key, -1.0):
            continue
        value = 1.5 * row["worst"]
        if row["worst"] == 0:
            bound = 0.0 if row["law"] in STRICT else 2e-6
        else:
            digits = 10.0 ** (math.floor(math.log10(value)) - 1)
            bound = max(math.ceil(value / digits) * digits, 2e-6)
        new[key] = float(f"{max(bound, old.get(key, 0.0)):.3g}")
    for key, value in old.items():
        new.setdefault(key, value)
    path.write_text("{\n" + ",\n".join(f"  {json.dumps(k)}: {v!r}" for k, v in sorted(new.items())) + "\n}\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results")
    parser.add_argument("--learn", action="store_true")
    parser.add_argument("--beyond", choices=["nightly", "gpu"])
    args = parser.parse_args()
    figures, points = read(args.results)
    if args.learn:
        learn(figures, args.beyond)
    if args.beyond == "gpu":
        print(f"{len(figures)} figures of a GPU")
        return
    text = [(HERE / "preface.md").read_text().rstrip(), "\n## Law by law\n",
            "The worst figure of each method and quality, and the scene that gave it. Bounds are in tests/stability/bounds.json.\n"]
    for law in list(LAWS) + sorted({row["law"] for row in figures} - set(LAWS)):
        rows = [row for row in figures if row["law"] == law]
        if not rows:
            continue
        cases = max(row["cases"] for row in rows)
        text.append(f"### {law[0].upper() + law[1:]}\n\n{LAWS.get(law, '')} {cases} case{'s' if cases > 1 else ''} each.\n")
        text.append(table(rows) + "\n")
        if law in PLOTS:
            mine = [p for p in points if p["plot"] == PLOTS[law]]
            if mine:
                text.append(draw(PLOTS[law], mine, True) + "\n")
    text.append((HERE / "notes.md").read_text())
    (DOCS / "stability.md").write_text("\n".join(text))
    print(f"docs/stability.md: {len(figures)} figures, {len(points)} points")


main()

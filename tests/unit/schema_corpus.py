#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Puts the corpus through docs/scene.schema.json with Debian's python3-jsonschema: every good scene must be valid,
and every bad one invalid unless its mistake is one that a schema cannot see.

  schema_corpus.py SOURCE_FOLDER    exit codes: 0 all as expected, 1 not, 77 there is no validator
"""
import json
import pathlib
import sys

try:
    from jsonschema import Draft202012Validator
except ImportError:
    print("skipped: no jsonschema with Draft 2020-12 (Debian: python3-jsonschema)")
    sys.exit(77)

# Rules across values, of the text itself, and of what a PNG holds.
BEYOND_A_SCHEMA = {"not_square", "not_in_order", "zero_area", "bad_image", "duplicate_key", "syntax", "too_many", "too_large", "bad_path", "missing_glyph"}
# Files whose code a schema sees elsewhere, with what it does not see here.
BEYOND_BY_NAME = {
    "rect_corner_too_large": "half the shorter side",
    "spot_inner_over_outer": "one angle against the other",
    "emission_too_bright": "a colour times a factor",
    "sky_row_too_large": "the picture knows its rows",
    "bit_depth_of_pfm": "one key against another",
    "bit_depth_32_of_png": "one key against another",
    "look_without_agx": "one key against another",
    "white_without_its_curve": "one key against another",
    "spot_lumens_too_narrow": "an angle against the unit",
    "floor_tile_alone": "one key against others",
    "region_outside": "a pixel against the canvas",
    "region_too_wide": "a part against the canvas",
    "path_far": "where the path data leads",
}


def main(root: pathlib.Path) -> int:
    validator = Draft202012Validator(json.loads((root / "docs/scene.schema.json").read_text()))
    validator.check_schema(validator.schema)
    wrong = []
    good = sorted((root / "tests/corpus/good").glob("*.json")) + sorted((root / "examples/scenes").glob("*.json"))
    for path in good:
        for error in validator.iter_errors(json.loads(path.read_bytes())):
            wrong.append(f"{path.name}: refused at {error.json_path}: {error.message[:200]}")
    expected = json.loads((root / "tests/corpus/bad/expected.json").read_text())
    seen = 0
    for name, problem in sorted(expected.items()):
        try:
            scene = json.loads((root / "tests/corpus/bad" / name).read_bytes())
        except ValueError:
            continue  # no JSON: no question of a schema
        valid = validator.is_valid(scene)
        beyond = problem["code"] in BEYOND_A_SCHEMA or pathlib.Path(name).stem in BEYOND_BY_NAME
        seen += not valid
        if valid and not beyond:
            wrong.append(f"{name}: taken, but {problem['pointer']} is {problem['code']}")
    if len(good) < 40 or seen < 60:
        wrong.append(f"only {len(good)} good scenes and {seen} refused ones were seen")
    print("\n".join(wrong) or f"{len(good)} good scenes are valid, {seen} bad ones are not")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(pathlib.Path(sys.argv[1])))

#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The parser against docs/scene.schema.json where neither was written for the case: every good scene of the corpus with one
thing changed somewhere, each asked of both.

  schema_mutations.py SOURCE_FOLDER PROGRAM [--count N] [--write FOLDER]

PROGRAM is penumbra. What the schema refuses, the parser must refuse; what the parser refuses, the schema must, unless it breaks
a rule that no schema can hold. N mutants are tried (2000), always the same. --write leaves them in FOLDER, for another
validator. Exit codes: 0 both agree, 1 not, 77 there is no validator.
"""
import argparse
import copy
import json
import pathlib
import random
import subprocess
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).parents[1] / "unit"))
from schema_corpus import BEYOND_A_SCHEMA  # noqa: E402

try:
    from jsonschema import Draft202012Validator
except ImportError:
    print("skipped: no jsonschema with Draft 2020-12 (Debian: python3-jsonschema)")
    sys.exit(77)

# A rule of one value against another, which mutants break in places of their own.
ACROSS_VALUES = {"conflict", "zero_area", "not_supported_yet"}
STRANGERS = [None, True, False, 0, 1, -1, 0.5, 1e12, -1e12, 65, 1000000, "", "x", "#ff8000", "auto", [], [1], [1, 2], [1, 2, 3], [1, 2, 3, 4], {}, {"color": 1}]


def places(value, path=()):
    yield path
    if isinstance(value, dict):
        for key, child in value.items():
            yield from places(child, path + (key,))
    elif isinstance(value, list):
        for index, child in enumerate(value[:4]):
            yield from places(child, path + (index,))


def mutant(scene, random_):
    scene = copy.deepcopy(scene)
    path = random_.choice([p for p in places(scene) if p])
    parent = scene
    for step in path[:-1]:
        parent = parent[step]
    last = path[-1]
    kind = random_.choice(["replace", "replace", "replace", "replace", "remove", "rename", "add"])
    if kind == "replace":
        old = parent[last]
        choices = STRANGERS + ([-old, old * 1000, old + 0.25] if isinstance(old, (int, float)) and not isinstance(old, bool) else [])
        parent[last] = random_.choice(choices)
    elif kind == "remove":
        del parent[last]
    elif kind == "rename" and isinstance(parent, dict):
        parent[last + random_.choice(["s", "_", "2"])] = parent.pop(last)
    elif kind == "add" and isinstance(parent, dict):
        parent[random_.choice(["extra", "radius", "emission", "albedo", "points", "width", "rotation", "type"])] = random_.choice(STRANGERS)
    else:
        parent.insert(last, copy.deepcopy(parent[last])) if isinstance(parent, list) else None
    return scene


def main() -> int:
    options = argparse.ArgumentParser()
    options.add_argument("root", type=pathlib.Path)
    options.add_argument("program")
    options.add_argument("--count", type=int, default=2000)
    options.add_argument("--write", type=pathlib.Path)
    options = options.parse_args()
    validator = Draft202012Validator(json.loads((options.root / "docs/scene.schema.json").read_text()))
    random_ = random.Random(20221122)
    scenes = [json.loads(path.read_bytes()) for path in sorted((options.root / "tests/corpus/good").glob("*.json"))]
    with tempfile.TemporaryDirectory() as scratch:
        folder = options.write or pathlib.Path(scratch)
        folder.mkdir(parents=True, exist_ok=True)
        mutants = {}
        for number in range(options.count):
            path = folder / f"{number:05}.json"
            path.write_text(json.dumps(mutant(scenes[number % len(scenes)], random_)))
            mutants[str(path)] = path
        names, verdicts = sorted(mutants), []
        for start in range(0, len(names), 500):
            told = subprocess.run([options.program, "validate", "--json", *names[start:start + 500]], capture_output=True, text=True)
            if told.returncode not in (0, 1, 2) or not told.stdout:
                print(f"{options.program} validate ended with {told.returncode}: {told.stderr[-2000:]}")
                return 1
            verdicts += json.loads(told.stdout)
        wrong, refused, beyond = [], 0, 0
        for verdict in verdicts:
            scene = json.loads(mutants[verdict["file"]].read_text())
            problems = [p for p in verdict["problems"] if p["code"] != "not_supported_yet"]
            errors = list(validator.iter_errors(scene))
            if not problems and errors:
                wrong.append(f"the schema alone refuses {errors[0].json_path}: {errors[0].message[:150]}\n    {json.dumps(scene)[:600]}")
            elif problems and not errors:
                if all(p["code"] in BEYOND_A_SCHEMA | ACROSS_VALUES or across(p, scene) for p in problems):
                    beyond += 1
                else:
                    wrong.append(f"the parser alone refuses {problems[0]}\n    {json.dumps(scene)[:600]}")
            refused += bool(problems)
    print("\n".join(wrong[:20]) or f"{len(verdicts)} mutants, {refused} refused, {beyond} of them by rules beyond a schema; both agree")
    if wrong:
        print(f"{len(wrong)} of {len(verdicts)} mutants")
    if not options.count // 4 < refused < options.count:
        print("the mutants are all good or all bad: nothing was tested")
        return 1
    return 1 if wrong else 0


def across(problem, scene) -> bool:
    """Whether the problem is one value against another."""
    pointer = problem["pointer"]
    names = pointer.split("/")
    if problem["code"] == "out_of_range":
        # Half the shorter side; one angle against the other; the canvas; a picture's rows; a colour times a factor.
        return (names[-1] in ("corner_radius", "inner_angle", "row") or "/region" in pointer
                or isinstance(value_at(scene, pointer), dict))
    return problem["code"] == "unknown_value" and names[-1] == "bit_depth"


def value_at(value, pointer):
    for step in pointer.split("/")[1:]:
        value = value[int(step)] if isinstance(value, list) else value.get(step) if isinstance(value, dict) else None
    return value


if __name__ == "__main__":
    sys.exit(main())

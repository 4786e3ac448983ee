#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The published JSON Schemas: valid themselves, every field explained, and the examples obey them."""
import copy
import json
import os
import pathlib
import sys

try:
    import jsonschema
except ImportError:
    print("python3-jsonschema is missing: skipped")
    sys.exit(77)

ROOT = pathlib.Path(os.environ.get("PCBMESH_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
faults = []
looked_at = 0


def load(path):
    return json.loads((ROOT / path).read_text(encoding="utf-8"))


def fields(schema, place):
    """Every (place, field schema, required) of every object in a schema."""
    if isinstance(schema, dict):
        required = set(schema.get("required", []))
        for name, field in schema.get("properties", {}).items():
            if "properties" in schema and schema.get("type") == "object":
                yield f"{place}/{name}", field, name in required
        for key, value in schema.items():
            if key not in ("if", "then", "not", "default", "examples"):
                yield from fields(value, f"{place}/{key}")
    elif isinstance(schema, list):
        for index, value in enumerate(schema):
            yield from fields(value, f"{place}/{index}")


def check_schema(path):
    global looked_at
    schema = load(path)
    jsonschema.Draft202012Validator.check_schema(schema)
    # Fields whose absence means something no value can say.
    no_default = {"$schema", "schema_version", "points", "rect", "circle", "slot", "component", "pin", "at", "nets", "thickness"}
    for place, field, required in fields(schema, path):
        looked_at += 1
        for key in ("title", "description"):
            if not field.get(key):
                faults.append(f"{place}: no {key}")
        if not required and "default" not in field and place.rsplit("/", 1)[1] not in no_default:
            faults.append(f"{place}: no default")
        if "default" in field:
            validator = jsonschema.Draft202012Validator({**{k: v for k, v in field.items()}, "$defs": schema["$defs"]})
            faults.extend(f"{place}: its default breaks it: {e.message}" for e in validator.iter_errors(field["default"]))
    return jsonschema.Draft202012Validator(schema)


def check_file(validator, path):
    found = [f"{path}: {'/'.join(map(str, e.absolute_path))}: {e.message[:200]}" for e in validator.iter_errors(load(path))]
    faults.extend(found)


def expect_refusal(validator, document, change, what):
    broken = copy.deepcopy(document)
    change(broken)
    if validator.is_valid(broken):
        faults.append(f"the schema accepts {what}")


board = check_schema("docs/schema/board.schema.json")
study = check_schema("docs/schema/study.schema.json")
materials = check_schema("docs/schema/materials.schema.json")
check_file(materials, pathlib.Path("src/study/materials.json"))
boards = studies = 0
for example in sorted((ROOT / "examples").glob("*.json")):
    is_study = example.name.endswith(".study.json")
    check_file(study if is_study else board, example.relative_to(ROOT))
    boards, studies = boards + (not is_study), studies + is_study
if boards < 3 or studies < 1:
    faults.append(f"only {boards} boards and {studies} studies in examples/")

microstrip = load("examples/microstrip.json")
expect_refusal(board, microstrip, lambda d: d.pop("pcbmesh_board"), "a board without its marker")
expect_refusal(board, microstrip, lambda d: d["tracks"][0].update(widht=1), "an unknown field")
expect_refusal(board, microstrip, lambda d: d["tracks"][0].update(width=0), "a track of width 0")
expect_refusal(board, microstrip, lambda d: d["tracks"][0].update(width="1.1"), "a string without unit")
expect_refusal(board, microstrip, lambda d: d["planes"][0].update(circle={"at": [0, 0], "diameter": 1}), "two areas at once")
expect_refusal(board, microstrip, lambda d: d["stackup"][2].pop("material"), "a dielectric without material")
expect_refusal(board, microstrip, lambda d: d["vias"][0].pop("at"), "a via without a place")
expect_refusal(study, {"schema_version": 1}, lambda d: d.update(schema_version=2), "a later schema version")
expect_refusal(study, {"schema_version": 1}, lambda d: d.update(air={"abvoe": 1}), "an unknown field of the air")
expect_refusal(study, {"schema_version": 1}, lambda d: d.update(air={"above": -1}), "negative air")
if looked_at < 80:
    faults.append(f"only {looked_at} fields seen: the check looks in the wrong place")

for fault in faults:
    print(fault)
print(f"{looked_at} fields, {boards} boards, {studies} studies, {len(faults)} faults")
sys.exit(1 if faults else 0)

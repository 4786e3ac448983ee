#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The house rules that a machine can check: arrows between rooms, names, licence lines, file length, errors and their page."""
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(os.environ.get("PCBMESH_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
CODE = [p for top in ("include", "src", "formats", "validation", "tests", "benchmarks") for p in sorted((ROOT / top).rglob("*")) if p.suffix in (".hpp", ".cpp")]
faults = []


def rooms():
    allowed = {}
    for line in (ROOT / "src/rooms.txt").read_text().splitlines():
        line = line.split("#")[0].strip()
        if line:
            room, _, others = line.partition(":")
            allowed[room.strip()] = set(others.split()) | {room.strip()}
    return allowed


def room_of(path):
    parts = path.relative_to(ROOT).parts
    if parts[0] == "include":
        return parts[2]
    if parts[0] == "src":
        return parts[1]
    if parts[:2] == ("formats", "syntax"):
        return "syntax"
    if parts[:2] == ("validation", "cases"):
        return None  # programs that use the library as any other does, not part of it
    return parts[0] if parts[0] in ("formats", "validation") else None


def target_room(include):
    parts = include.split("/")
    if parts[0] in ("pcbmesh", "src"):
        return parts[1]
    if parts[:2] == ["formats", "syntax"]:
        return "syntax"
    return parts[0] if parts[0] in ("formats", "validation") else None


def check_arrows():
    allowed, seen = rooms(), 0
    for path in CODE:
        room = room_of(path)
        if room is None:
            continue
        if room not in allowed:
            faults.append(f"{path.relative_to(ROOT)}: room '{room}' is not in src/rooms.txt")
            continue
        for number, line in enumerate(path.read_text().splitlines(), 1):
            found = re.match(r'\s*#\s*include\s+"([^"]+)"', line)
            if found:
                seen += 1
                target = target_room(found.group(1))
                if target is not None and target not in allowed[room]:
                    faults.append(f"{path.relative_to(ROOT)}:{number}: room '{room}' may not include '{target}'")
            if "CGAL/" in line and "include" in line and room != "triangulate" and path != ROOT / "validation/checks/orientation.cpp":
                faults.append(f"{path.relative_to(ROOT)}:{number}: only the room triangulate and the judge's exact sign include CGAL")
    if seen < 100:
        faults.append(f"only {seen} includes seen: the check looks in the wrong place")


def check_cycles():
    allowed = rooms()
    state = {}

    def visit(room, trail):
        if state.get(room) == "done":
            return
        if state.get(room) == "open":
            faults.append("rooms.txt has a cycle: " + " -> ".join(trail + [room]))
            return
        state[room] = "open"
        for other in sorted(allowed.get(room, set()) - {room}):
            visit(other, trail + [room])
        state[room] = "done"

    for room in sorted(allowed):
        visit(room, [])


def check_names_and_licences():
    banned = re.compile(r"(^|_)(utils?|helpers?|common|misc|manager|handler|process|tmp)(_|\.|$)")
    for path in CODE:
        name = path.relative_to(ROOT)
        if banned.search(path.name):
            faults.append(f"{name}: a name that says nothing")
        text = path.read_text()
        if "SPDX-License-Identifier: GPL-3.0-or-later" not in text.split("\n", 2)[0]:
            faults.append(f"{name}: the first line has no SPDX licence")
        if text.count("\n") > 650:
            faults.append(f"{name}: {text.count(chr(10))} lines; split it")
        if path.suffix == ".hpp" and "#pragma once" not in text:
            faults.append(f"{name}: no #pragma once")


def check_error_page():
    codes = re.findall(r"^\s+(\w+) = (\d+),", (ROOT / "include/pcbmesh/base/error.hpp").read_text(), re.M)
    page = (ROOT / "docs/errors.md").read_text()
    for name, number in codes:
        if not re.search(rf"^\| {number} \| `{name}` \|", page, re.M):
            faults.append(f"docs/errors.md: no row for {number} {name}")


def check_guarantees():
    tests = "\n".join(p.read_text() for p in (ROOT / "tests").rglob("*") if p.suffix in (".cpp", ".hpp", ".py"))
    for path in sorted((ROOT / "include").rglob("*.hpp")):
        for guarantee in re.findall(r"@guarantee ([A-Z]\d+)", path.read_text()):
            if not re.search(rf"\b{guarantee}\b|_{guarantee}_|{guarantee}[A-Z_]", tests):
                faults.append(f"{path.relative_to(ROOT)}: guarantee {guarantee} is named by no test")


def check_formatting():
    files = [str(p) for p in CODE]
    try:
        done = subprocess.run(["clang-format", "--dry-run", "-Werror", *files], capture_output=True, text=True)
    except FileNotFoundError:
        return
    if done.returncode != 0:
        faults.append("clang-format: " + "; ".join(sorted({line.split(":")[0] for line in done.stderr.splitlines() if "error:" in line})))


for check in (check_arrows, check_cycles, check_names_and_licences, check_error_page, check_guarantees, check_formatting):
    check()
for fault in faults:
    print(fault)
print(f"{len(CODE)} files looked at, {len(faults)} faults")
sys.exit(1 if faults else 0)

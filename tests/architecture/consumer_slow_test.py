#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Installs the package into a scratch folder, then builds and runs a stranger's program against it."""
import os
import pathlib
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(os.environ.get("PCBMESH_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
BUILD = pathlib.Path(os.environ["PCBMESH_PROGRAM"]).parents[1] if "PCBMESH_PROGRAM" in os.environ else ROOT / "build"

with tempfile.TemporaryDirectory() as scratch:
    folder = pathlib.Path(scratch)
    for command in (
        ["cmake", "--install", BUILD, "--prefix", folder / "installed"],
        ["cmake", "-S", ROOT / "tests/consumer", "-B", folder / "build", "-G", "Ninja", f"-DCMAKE_PREFIX_PATH={folder / 'installed'}"],
        ["cmake", "--build", folder / "build"],
        [folder / "build/consumer", ROOT / "examples/serpentine.json", folder / "serpentine.msh"],
        [folder / "installed/bin/pcbmesh", "check", folder / "serpentine.msh"],
    ):
        done = subprocess.run([str(part) for part in command], capture_output=True, text=True)
        if done.returncode != 0:
            print(done.stdout, done.stderr, sep="\n")
            sys.exit(1)
print("installed, found, linked, meshed, checked")

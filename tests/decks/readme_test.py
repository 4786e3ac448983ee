#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""The tutorial of README, command by command, with one frequency instead of its sweep: board to Touchstone by what is printed there."""
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

from program import PROGRAM, ROOT, SKIPPED

DATA = pathlib.Path(os.environ.get("PCBMESH_TEST_DATA", ROOT / "../shared/data")) / "kicad"


def tutorial():
    """The commands of the section, in order, as lists of words."""
    section = (ROOT / "README.md").read_text().split("## From a board to a Touchstone file")[1].split("\n## ")[0]
    return [shlex.split(command) for command in re.findall(r"^\$ (.*)$", section.replace("\\\n", " "), re.M)]


def main():
    if not shutil.which("getdp"):
        print("skipped: getdp is not installed; scripts/setup installs it")
        return SKIPPED
    commands = tutorial()
    assert len(commands) == 4 and [c[0] for c in commands] == ["pcbmesh", "sh"] * 2, commands
    environment = {**os.environ, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}", "OMP_NUM_THREADS": "1"}
    for mesh, solve in zip(commands[::2], commands[1::2]):
        board = ROOT / mesh[2] if (ROOT / mesh[2]).exists() else DATA / mesh[2]
        if not board.exists():
            print(f"{mesh[2]} is not in PCBMESH_TEST_DATA: its command is not run")
            continue
        words = [str(board) if word == mesh[2] else word for word in mesh]
        words[words.index("--sweep") + 1] = "2GHz:2GHz:1"
        with tempfile.TemporaryDirectory() as folder:
            done = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True)
            assert done.returncode == 0, done.stderr
            printed = shlex.split(done.stdout.strip().splitlines()[-1])
            assert printed == solve, f"README says {solve}, the program {printed}"
            solved = subprocess.run(printed, cwd=folder, env=environment, capture_output=True, text=True)
            assert solved.returncode == 0, solved.stdout[-2000:] + solved.stderr
            ports = done.stderr.count("\nport ") + done.stderr.startswith("port ")
            networks = [file.name for file in pathlib.Path(folder, "out").glob(f"*.s{ports}p")]
            assert len(networks) == 1 and ports >= 2, (ports, networks)
            assert "  passive" in solved.stdout and "  reciprocal" in solved.stdout, solved.stdout[-500:]
            print(f"{mesh[2]}: {networks[0]}")
    return 0


if __name__ == "__main__":
    sys.exit(main())

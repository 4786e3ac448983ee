# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs the built program as a user would, and finds the data the tests need."""
import json
import os
import pathlib
import resource
import subprocess
import sys

ROOT = pathlib.Path(os.environ.get("PCBMESH_SOURCE_DIR", pathlib.Path(__file__).resolve().parents[2]))
PROGRAM = pathlib.Path(os.environ.get("PCBMESH_PROGRAM", ROOT / "build/bin/pcbmesh"))
DATA = pathlib.Path(os.environ.get("PCBMESH_TEST_DATA", ROOT.parent / "shared/data"))
SKIPPED = 77


def require_data():
    """Ends the test as skipped, with a clear word, where the real boards are absent."""
    if not DATA.is_dir():
        print(f"skipped: no test data at {DATA}; set PCBMESH_TEST_DATA to a folder with kicad/ and oracle/")
        sys.exit(SKIPPED)


def run(*arguments, timeout=600, **options):
    """Completed process with text output."""
    return subprocess.run([str(PROGRAM), *map(str, arguments)], capture_output=True, text=True, timeout=timeout, **options)


def run_json(*arguments, timeout=600):
    done = run(*arguments, "--json", timeout=timeout)
    if done.returncode not in (0, 1):
        raise RuntimeError(f"{' '.join(map(str, arguments))}: exit {done.returncode}\n{done.stderr}")
    return json.loads(done.stdout)


def run_measured(*arguments, timeout=1200, memory_limit_gib=None):
    """(exit code, stdout, stderr, CPU seconds, peak MiB) of one run."""
    def limit():
        if memory_limit_gib:
            resource.setrlimit(resource.RLIMIT_AS, (int(memory_limit_gib * 2**30),) * 2)
    out_read, out_write = os.pipe()
    process = subprocess.Popen([str(PROGRAM), *map(str, arguments)], stdout=out_write, stderr=subprocess.PIPE, text=True, preexec_fn=limit)
    os.close(out_write)
    import threading
    chunks = []
    reader = threading.Thread(target=lambda: chunks.append(os.fdopen(out_read).read()))
    reader.start()
    errors = []
    error_reader = threading.Thread(target=lambda: errors.append(process.stderr.read()))
    error_reader.start()
    timer = threading.Timer(timeout, process.kill)
    timer.start()
    _, status, usage = os.wait4(process.pid, 0)
    timer.cancel()
    reader.join()
    error_reader.join()
    process.returncode = os.waitstatus_to_exitcode(status)
    return process.returncode, chunks[0], errors[0], usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024

#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Our writers beside those of meshio and Gmsh, in one run: as many prisms, the same folder, CPU seconds of writing alone and the growth
of resident memory by what is needed to write.

    benchmarks/write_peers.py build/benchmarks/write_bench [folder = /dev/shm] [millions of prisms = 10]

A peer needs the whole mesh in memory: nodes and cells count as its growth. Each job is a process of its own, run once.
"""
import json
import os
import pathlib
import subprocess
import sys
import time

SUBLAYERS = 20


def resident_mb():
    for line in open("/proc/self/status"):
        if line.startswith("VmHWM:"):
            return int(line.split()[1]) / 1024


def cpu_s():
    t = os.times()
    return t.user + t.system


def arrays(num_prisms):
    """The mesh of write_bench, without its regions: squares of two triangles, all sub-layers."""
    import numpy
    n = int((num_prisms / (2 * SUBLAYERS)) ** 0.5)
    i, j = numpy.meshgrid(numpy.arange(n + 1), numpy.arange(n + 1))
    plane = numpy.column_stack([i.ravel() * 1e-4 / 3, j.ravel() * 1e-4 / 7])
    nodes = numpy.vstack([numpy.column_stack([plane, numpy.full(len(plane), k * 1e-5)]) for k in range(SUBLAYERS + 1)])
    a = (j[:-1, :-1] * (n + 1) + i[:-1, :-1]).ravel()
    triangles = numpy.vstack([numpy.column_stack([a, a + 1, a + n + 2]), numpy.column_stack([a, a + n + 2, a + n + 1])])
    wedges = numpy.vstack([numpy.hstack([triangles + k * len(plane), triangles + (k + 1) * len(plane)]) for k in range(SUBLAYERS)])
    return nodes, wedges


def write_by_meshio(file, nodes, wedges, options):
    import meshio
    import numpy
    tags = numpy.ones(len(wedges), dtype=numpy.int32)
    mesh = meshio.Mesh(nodes, [("wedge", wedges)], cell_data={"gmsh:physical": [tags], "gmsh:geometrical": [tags]})
    return lambda: meshio.write(file, mesh, **options)


def write_by_gmsh(file, nodes, wedges, version):
    import gmsh
    import numpy
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.Binary", 1)
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.model.addDiscreteEntity(3, 1)
    gmsh.model.addPhysicalGroup(3, [1], 1)
    gmsh.model.mesh.addNodes(3, 1, numpy.arange(1, len(nodes) + 1), nodes.ravel())
    gmsh.model.mesh.addElementsByType(1, 6, numpy.arange(1, len(wedges) + 1), (wedges + 1).ravel())
    return lambda: gmsh.write(file)


PEERS = {
    "MSH 4.1 binary": [("meshio", "p.msh", {"file_format": "gmsh"}), ("Gmsh", "p.msh", 4.1)],
    "MSH 2.2 binary": [("meshio", "p.msh", {"file_format": "gmsh22"}), ("Gmsh", "p.msh", 2.2)],
    "VTU raw": [("meshio", "p.vtu", {"compression": None}), ("Gmsh", "p.vtk", 4.1)],
    "HDF5 contiguous": [("meshio", "p.xdmf", {"compression": None})],
}


def child(case, index, folder, num_prisms):
    peer, file, options = PEERS[case][index]
    import numpy  # the interpreter's own memory is not the peer's fault
    if peer == "meshio":
        import meshio
    else:
        import gmsh
    before = resident_mb()
    nodes, wedges = arrays(num_prisms)
    path = pathlib.Path(folder) / file
    write = (write_by_meshio if peer == "meshio" else write_by_gmsh)(str(path), nodes, wedges, options)
    cpu, wall = cpu_s(), time.monotonic()
    write()
    print(json.dumps({"cpu_s": cpu_s() - cpu, "wall_s": time.monotonic() - wall, "growth_mb": resident_mb() - before}))
    for made in (path, path.with_suffix(".h5")):
        made.unlink(missing_ok=True)


def main():
    if sys.argv[1] == "--child":
        return child(sys.argv[2], int(sys.argv[3]), sys.argv[4], float(sys.argv[5]))
    bench = sys.argv[1]
    folder = sys.argv[2] if len(sys.argv) > 2 else "/dev/shm"
    millions = float(sys.argv[3]) if len(sys.argv) > 3 else 10
    printed = subprocess.run([bench, folder, str(millions), "json"], capture_output=True, text=True, check=True).stdout
    print(printed)
    ours = {row["case"]: row for row in (json.loads(line) for line in printed.splitlines() if line.startswith("{"))}
    print(f"| case | ours: CPU s | growth MB | peer | CPU s | growth MB | CPU ratio | memory ratio |\n|---|---|---|---|---|---|---|---|")
    for case, peers in PEERS.items():
        own = ours[case]
        for index, (peer, _, _) in enumerate(peers):
            done = subprocess.run([sys.executable, __file__, "--child", case, str(index), folder, str(millions * 1e6)], capture_output=True, text=True)
            if done.returncode != 0:
                print(f"| {case} | {own['cpu_s']:.2f} | {own['growth_mb']:.1f} | {peer} | failed: {done.stderr.strip().splitlines()[-1]} | | | |")
                continue
            row = json.loads(done.stdout.splitlines()[-1])
            print(f"| {case} | {own['cpu_s']:.2f} | {own['growth_mb']:.1f} | {peer} | {row['cpu_s']:.2f} | {row['growth_mb']:.0f} | "
                  f"{row['cpu_s'] / own['cpu_s']:.1f} | {row['growth_mb'] / own['growth_mb']:.0f} |")


main()

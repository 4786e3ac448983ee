# SPDX-License-Identifier: GPL-3.0-or-later
"""The pieces of the test board that are solved: flags of `pcbmesh mesh` for each, and the copies of the board's file they are cut from.

Every piece ends where a straight trace is cut 1.2 mm behind a connector's pad (at the ring of the region: a lumped port), so that pieces join on a plain microstrip."""
import os
import pathlib
import re
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[3]
DATA = pathlib.Path(os.environ.get("PCBMESH_TEST_DATA", ROOT / "../shared/data"))
PROGRAM = ROOT / "build/bin/pcbmesh"
BOARD = "04_antmicro_si_test_4L_v6"

COMMON = "--conductors hollow --air-below 0 --policy none --sublayers none --for getdp"
LINE_MESH = "--air-above 0.6mm --longest-edge 0.4mm --growth 0.6 --height-growth 2 --edge-at-copper {edge}"
# The launch over the cut-out reaches down to In2, 1.4 mm below; its pad is large, its mesh coarser.
LAUNCH_MESH = "--air-above 0.8mm --longest-edge 0.8mm --growth 1 --height-growth 3 --edge-at-copper {launch_edge}"
SHORT_PIECE = "--sweep 200MHz,2GHz,4GHz,6GHz"
LAUNCH_PIECE = "--sweep 200MHz,1GHz,2GHz,3GHz,4GHz,5GHz,6GHz"
LONG_PIECE = "--sweep 200MHz,900MHz,1.8GHz,2.7GHz,3.6GHz,4.2GHz,4.8GHz,5.4GHz,6GHz"

# (lowest copper layer kept, flags).
PIECES = {
    "thru_2mm": ("In1.Cu", f"--region 102,-96.8,104,-95.2 --port P1,net=Net-(J10-Pad1),at=xmin --port P2,net=Net-(J10-Pad1),at=xmax {LINE_MESH} {SHORT_PIECE}"),
    "thru_4mm": ("In1.Cu", f"--region 102,-96.8,106,-95.2 --port P1,net=Net-(J10-Pad1),at=xmin --port P2,net=Net-(J10-Pad1),at=xmax {LINE_MESH} {SHORT_PIECE}"),
    "open": ("In1.Cu", f"--region 136,-66.8,138.38,-65.2 --port P1,net=unconnected-(J3-Pad1),at=xmax {LINE_MESH} {SHORT_PIECE}"),
    "short": ("In1.Cu", f"--region 99.57,-66.8,102,-65.2 --port P1,net=unconnected-(J3-Pad1),at=xmin {LINE_MESH} {SHORT_PIECE}"),
    "load": ("In1.Cu", f"--region 99.57,-57,103,-55 --port P1,net=Net-(R2-Pad1),at=xmin --port R2,net=Net-(R2-Pad1),reference=GND,at=R2.1,shape=gap {LINE_MESH} {SHORT_PIECE}"),
    "launch": ("In2.Cu", "--region 94,-99.8,99.62,-92.2 --boundary xmin=none --port A,net=Net-(J10-Pad1),reference=GND,at=95:-95.1:F.Cu,shape=gap "
               f"--port B,net=Net-(J10-Pad1),reference=GND,at=95:-96.9:F.Cu,shape=gap --port P2,net=Net-(J10-Pad1),at=xmax {LAUNCH_MESH} {LAUNCH_PIECE}"),
    "launch_whole_plane": ("In1.Cu", "--region 120.25,-57.52,127.85,-52 --boundary ymax=none --port A,net=unconnected-(J22-Pad1),reference=GND,at=123.15:-53:F.Cu,shape=gap "
                           f"--port B,net=unconnected-(J22-Pad1),reference=GND,at=124.95:-53:F.Cu,shape=gap --port P2,net=unconnected-(J22-Pad1),at=ymin {LAUNCH_MESH} {LAUNCH_PIECE}"),
    "stub": ("In1.Cu", f"--region 109,-99.9,117,-95.2 --port P1,net=Net-(J10-Pad1),at=xmin --port P2,net=Net-(J10-Pad1),at=xmax {LINE_MESH} {LONG_PIECE}"),
    "meander": ("In1.Cu", f"--region 122.4,-64.7,125.75,-58.4 --port P1,net=unconnected-(J22-Pad1),at=ymax --port P2,net=unconnected-(J22-Pad1),at=ymin {LINE_MESH} {LONG_PIECE}"),
}

TOKEN = re.compile(r'"(?:[^"\\]|\\.)*"|[()]|[^\s()"]+')


def parsed(text):
    stack = [[]]
    for match in TOKEN.finditer(text):
        if match[0] == "(":
            stack.append([])
        elif match[0] == ")":
            node = stack.pop()
            stack[-1].append(node)
        else:
            stack[-1].append(match[0])
    return stack[0][0]


def written(node):
    return node if isinstance(node, str) else "(" + " ".join(map(written, node)) + ")\n"


def entry(node, key):
    return next((child for child in node if isinstance(child, list) and child and child[0] == key), None)


def cut_below(board, last):
    """The board cut off below a copper layer, which becomes B.Cu: nothing below it takes part, and the publishers' own model of these structures is cut off so."""
    inner = ['"In1.Cu"', '"In2.Cu"', '"B.Cu"']
    gone = set(inner[inner.index(last) + 1:])

    def lies_below(node):
        layers = entry(node, "layer") or entry(node, "layers")
        return node[0] != "via" and layers is not None and set(layers[1:]) & gone and not (({'"F.Cu"', '"*.Cu"', *inner} - gone) & set(layers[1:]))

    def kept(node, inside):
        children = []
        for child in node:
            if not isinstance(child, list):
                children.append(child)
            elif inside == "kicad_pcb" and child[0] == "layers":
                children.append([child[0]] + [["31", '"B.Cu"', "signal"] if layer[1] == last else layer for layer in child[1:] if layer[1] not in gone])
            elif child[0] == "stackup":
                names = [layer[1] for layer in child[1:] if layer[0] == "layer"]
                children.append([child[0]] + [layer for layer in child[1:] if layer[0] != "layer" or names.index(layer[1]) <= names.index(last)])
            elif not lies_below(child):
                children.append(kept(child, child[0]))
        return children

    return kept(board, "kicad_pcb")


def with_net_of_short(board):
    """The shorted standard is all GND in the file; a port wants two nets, so its pad and trace get the one of the open standard."""
    other = ["net", "3", '"unconnected-(J3-Pad1)"']
    for node in board:
        if isinstance(node, list) and node[0] == "segment" and entry(node, "net")[1] == "2" and entry(node, "start")[1:] == ["100.95", "65.9925"]:
            node[node.index(entry(node, "net"))] = other[:2]
        if isinstance(node, list) and node[0] == "footprint" and any(isinstance(c, list) and c[0] == "fp_text" and c[2] == '"J4"' for c in node):
            for pad in node:
                if isinstance(pad, list) and pad[0] == "pad" and pad[1] == '"1"':
                    pad[pad.index(entry(pad, "net"))] = other
    return board


def solve(name, folder, last="In1.Cu", flags=""):
    """(Touchstone file, unknowns) of a piece; one that lies in `folder` is taken as it is."""
    out = folder / name
    found = next(out.glob("*.s[0-9]p"), None)
    if found is None:
        out.mkdir(parents=True, exist_ok=True)
        board = out / "board.kicad_pcb"
        whole = parsed((DATA / "kicad" / f"{BOARD}.kicad_pcb").read_text())
        board.write_text(written(with_net_of_short(cut_below(whole, f'"{last}"'))).replace(f'"{last}"', '"B.Cu"'))
        done = subprocess.run([PROGRAM, "mesh", board, *flags.split(), "-o", f"{out}/", "--quiet"], capture_output=True, text=True)
        if done.returncode:
            raise RuntimeError(f"piece {name}: {done.stderr.strip().splitlines()[-1]}")
        log = subprocess.run(["sh", next(out.glob("*.run.sh"))], check=True, capture_output=True, text=True, env={**os.environ, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}"}).stdout
        (out / "log").write_text(log)
        for mesh in out.glob("*.msh"):
            mesh.unlink()
        found = next(out.glob("*.s[0-9]p"))
    unknowns = int((out / "log").read_text().split("System 1/1:")[1].split()[0])
    return found, unknowns


def solver_cpu_s(folder):
    """Processor time of the solver over all pieces in a folder, by its own logs."""
    return sum(float(re.search(r"Stopped .* CPU = ([\d.]+)s", log.read_text())[1]) for log in folder.glob("*/log"))


def solve_piece(name, folder, edge="0.09mm", launch_edge="0.18mm"):
    last, flags = PIECES[name]
    return solve(name, folder, last, f"{flags} {COMMON}".format(edge=edge, launch_edge=launch_edge))

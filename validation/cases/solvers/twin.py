# SPDX-License-Identifier: GPL-3.0-or-later
"""The tetrahedral twin of a prism mesh: same nodes, same tags, three tetrahedra per prism, cut by the smallest node numbers.
Written from the MSH file alone, so that it shares no code with pcbmesh."""
import struct

NODES = {2: 3, 3: 4, 6: 6}


def read(file):
    """(opening bytes up to the elements, [(type, tag, nodes)]) of a binary MSH 2.2 file."""
    data = file.read_bytes()
    start = data.index(b"$Elements\n") + len(b"$Elements\n")
    end = data.index(b"\n", start)
    count, at, elements = int(data[start:end]), end + 1, []
    while len(elements) < count:
        kind, number, tags = struct.unpack_from("<3i", data, at)
        at += 12
        for _ in range(number):
            row = struct.unpack_from(f"<{1 + tags + NODES[kind]}i", data, at)
            at += 4 * len(row)
            elements.append((kind, row[1], row[1 + tags:]))
    return data[:start - len(b"$Elements\n")], elements


def cut_prism(p):
    """Turned so that the smallest node comes first; then the quadrangle opposite is cut at its own smallest."""
    turns = {0: (0, 1, 2, 3, 4, 5), 1: (1, 2, 0, 4, 5, 3), 2: (2, 0, 1, 5, 3, 4), 3: (3, 5, 4, 0, 2, 1), 4: (4, 3, 5, 1, 0, 2), 5: (5, 4, 3, 2, 1, 0)}
    v = [p[i] for i in turns[p.index(min(p))]]
    if min(v[1], v[5]) < min(v[2], v[4]):
        return (v[0], v[1], v[2], v[5]), (v[0], v[1], v[5], v[4]), (v[0], v[4], v[5], v[3])
    return (v[0], v[1], v[2], v[4]), (v[0], v[4], v[2], v[5]), (v[0], v[4], v[5], v[3])


def cut_quadrangle(q):
    i = q.index(min(q))
    a, b, c, d = q[i:] + q[:i]
    return (a, b, c), (a, c, d)


def write(source, target):
    opening, elements = read(source)
    out = []
    for kind, tag, nodes in elements:
        if kind == 6:
            out += [(4, tag, part) for part in cut_prism(nodes)]
        elif kind == 3:
            out += [(2, tag, part) for part in cut_quadrangle(nodes)]
        else:
            out.append((kind, tag, nodes))
    rows = b"".join(struct.pack(f"<{6 + len(nodes)}i", kind, 1, 2, number, tag, tag, *nodes) for number, (kind, tag, nodes) in enumerate(out, 1))
    target.write_bytes(opening + b"$Elements\n" + str(len(out)).encode() + b"\n" + rows + b"\n$EndElements\n")
    return len(out)

# SPDX-License-Identifier: GPL-3.0-or-later
# ---- Everything above is the study. Everything below is the same in every deck. ----
# Full wave by Nedelec elements on tetrahedra, capacitances by nodal elements on prisms or tetrahedra; time is exp(+i omega t).
# Run with dolfinx 0.5.2 of Debian 12. The branches for later versions follow their documentation and were not run.
import math
import os
import sys

import h5py
import numpy
import ufl
import dolfinx
import dolfinx.fem.petsc
import dolfinx.mesh
from dolfinx import fem
from mpi4py import MPI
from petsc4py import PETSc

DEGREE = int(os.environ.get("DEGREE", "1"))  # of the edge elements: 2 has about five times the unknowns, and its error falls with the fourth power of the edge
LIGHT, EPS0, MU0, Z0 = 299792458.0, 8.8541878128e-12, 1.25663706212e-6, 376.730313668
UNIT = PROBLEM["unit_m"]  # metres per mesh unit
IS_OLD = tuple(int(part) for part in dolfinx.__version__.split(".")[:2]) < (0, 7)
if not numpy.issubdtype(PETSc.ScalarType, numpy.complexfloating):
    sys.exit("this deck wants PETSc with complex numbers (Debian: PETSC_DIR=/usr/lib/petscdir/petsc-complex)")


# ---- mesh ----

def read_faces(group):
    """[(face tag, corners)]"""
    if "faces" not in group:
        return list(zip(group["triangle_face_tag"][:], group["triangle"][:])) if "triangle" in group else []
    stream, out, at = group["faces"][:], [], 0
    for tag in group["faces_face_tag"][:]:
        corners = {4: 3, 5: 4}[stream[at]]  # XDMF's numbers of triangle and quadrangle
        out.append((tag, stream[at + 1:at + 1 + corners]))
        at += 1 + corners
    return out


def domain_of(points, cells, is_prism):
    cell = "prism" if is_prism else "tetrahedron"
    if not IS_OLD:
        import basix.ufl
        return dolfinx.mesh.create_mesh(MPI.COMM_SELF, cells, x=points, e=ufl.Mesh(basix.ufl.element("Lagrange", cell, 1, shape=(3,))))
    element = ufl.Mesh(ufl.VectorElement("Lagrange", ufl.Cell(cell, geometric_dimension=3), 1))
    if not is_prism:
        return dolfinx.mesh.create_mesh(MPI.COMM_SELF, cells, points, element)
    # The Python layer of 0.5 does not know the name of prisms; the library does.
    cpp = dolfinx.cpp
    made = cpp.mesh.create_mesh(MPI.COMM_SELF, cpp.graph.AdjacencyList_int64(cells), cpp.fem.CoordinateElement(cpp.mesh.CellType.prism, 1),
                                points, cpp.mesh.GhostMode.none, cpp.mesh.create_cell_partitioner())
    return dolfinx.mesh.Mesh(made, element)


def rows(adjacency, width):
    return numpy.asarray(getattr(adjacency, "array", adjacency)).reshape(-1, width)


class Mesh:
    """The mesh as dolfinx holds it, with the tags of the file."""

    def __init__(self, file_name):
        with h5py.File(file_name, "r") as file:
            group = file["mesh"]
            kind = "wedge" if "wedge" in group else "tetrahedron"
            cells, tags = group[kind][:].astype(numpy.int64), group[kind + "_volume_tag"][:]
            points = group["points"][:]
            self.faces = {}
            for tag, corners in read_faces(group):
                self.faces.setdefault(int(tag), []).append(corners)
        self.domain = domain_of(points, cells, kind == "wedge")
        self.cell_tags = tags[numpy.array(self.domain.topology.original_cell_index)]
        self.corners = cells.shape[1]
        self.nodes = numpy.array(self.domain.geometry.input_global_indices)[rows(self.domain.geometry.dofmap, self.corners)]  # of the file, by cell
        self.num_nodes = len(points)
        file_points = numpy.empty_like(points)
        file_points[numpy.array(self.domain.geometry.input_global_indices)] = self.domain.geometry.x
        self.cell_z = file_points[self.nodes][:, :, 2].mean(axis=1)

    def cells(self, ids):
        return numpy.flatnonzero(numpy.isin(self.cell_tags, ids)).astype(numpy.int32)

    def by_cell(self, value_of_volume):
        """Array over cells from a dictionary over volume ids."""
        lookup = numpy.zeros(max(v["id"] for v in PROBLEM["volumes"]) + 1, dtype=PETSc.ScalarType)
        for volume, value in value_of_volume.items():
            lookup[volume] = value
        return lookup[self.cell_tags]

    def index_facets(self):
        """Facets of tetrahedra by their corners, for facets()."""
        topology = self.domain.topology
        topology.create_entities(2)
        for a, b in ((2, 3), (3, 2), (2, 0), (3, 0)):
            topology.create_connectivity(a, b)
        node_of_vertex = numpy.zeros(self.num_nodes, dtype=numpy.int64)
        node_of_vertex[rows(topology.connectivity(3, 0), 4)] = self.nodes
        self.facet_keys = self.key(node_of_vertex[rows(topology.connectivity(2, 0), 3)])
        self.facet_order = numpy.argsort(self.facet_keys)

    def key(self, corners):
        a = numpy.sort(numpy.asarray(corners, dtype=numpy.int64), axis=1)
        assert self.num_nodes < 2 ** 21, "more nodes than this deck's facet keys hold"
        return (a[:, 0] * self.num_nodes + a[:, 1]) * self.num_nodes + a[:, 2]

    def facets(self, ids):
        corners = [c for i in ids for c in self.faces.get(i, [])]
        if not corners:
            return numpy.empty(0, dtype=numpy.int32)
        keys = self.key(corners)
        at = numpy.searchsorted(self.facet_keys, keys, sorter=self.facet_order)
        found = self.facet_order[numpy.minimum(at, len(self.facet_order) - 1)]
        assert (self.facet_keys[found] == keys).all(), "a tagged face is no face of a cell"
        return numpy.unique(found).astype(numpy.int32)


def space(domain, family, degree):
    return (fem.FunctionSpace if IS_OLD else fem.functionspace)(domain, (family, degree))


def index_set(indices):
    return PETSc.IS().createGeneral(numpy.asarray(indices, dtype=PETSc.IntType), comm=PETSc.COMM_SELF)


def direct_solver():
    solver = PETSc.KSP().create(PETSc.COMM_SELF)
    solver.setType("preonly")
    solver.getPC().setType("lu")
    solver.getPC().setFactorSolverType("mumps")
    PETSc.Options()["mat_mumps_icntl_14"] = 60  # room for fill, per cent more than estimated
    solver.setFromOptions()
    return solver


# ---- physics ----

def permittivity(material, hz):
    return material["eps_r"] * (1 - 1j * material["tan_delta"]) - 1j * material["sigma_s_per_m"] / (2 * math.pi * hz * EPS0)


def admittance(face, hz, cell_z):
    """Surface admittance relative to free space, by cell beside the face."""
    if face["condition"] == "impedance":
        value = Z0 / face["impedance_ohm"]
    elif face["condition"] == "conductor":
        # Both sides of a sheet carry current: half the impedance of a slab of its thickness, coth of half the thickness.
        metal, sides = face["metal"], 2 if face["is_inner"] else 1
        gamma = (1 + 1j) * math.sqrt(math.pi * hz * MU0 * metal["mu_r"] * metal["sigma_s_per_m"])
        value = sides * Z0 * metal["sigma_s_per_m"] / gamma
        if metal["thickness_m"] > 0:
            value *= numpy.tanh(gamma * metal["thickness_m"] / sides)
    elif face["condition"] == "port":
        port = PROBLEM["ports"][face["port"]]
        value = Z0 * port["length_m"] / (port["impedance_ohm"] * port["width_m"])
    else:  # absorbing: what it looks into, by height
        out = numpy.ones(len(cell_z), dtype=PETSc.ScalarType)
        for medium in reversed(face["media"]):
            out[cell_z * UNIT < medium["z_high_m"]] = numpy.sqrt(permittivity(medium, hz) / medium["mu_r"])
        if face["media"]:
            out[cell_z * UNIT >= face["media"][-1]["z_high_m"]] = numpy.sqrt(permittivity(face["media"][-1], hz) / face["media"][-1]["mu_r"])
        return out
    return numpy.full(len(cell_z), value, dtype=PETSc.ScalarType)


class EdgeElements:
    """curl nu curl - w in the volumes, tangential terms on faces, no tangential field on metal."""

    def __init__(self, mesh, metal_conditions):
        self.mesh = mesh
        mesh.index_facets()
        domain = mesh.domain
        self.space = space(domain, "N1curl", DEGREE)
        self.size = self.space.dofmap.index_map.size_global
        piecewise = space(domain, "DG", 0)
        self.nu, self.weight, self.surface = fem.Function(piecewise), fem.Function(piecewise), fem.Function(piecewise)
        self.nu.x.array[:] = mesh.by_cell({v["id"]: 1 / v["mu_r"] for v in PROBLEM["volumes"]})
        self.u, self.v, self.normal = ufl.TrialFunction(self.space), ufl.TestFunction(self.space), ufl.FacetNormal(domain)
        self.curls = fem.form(self.nu * ufl.inner(ufl.curl(self.u), ufl.curl(self.v)) * ufl.dx)
        self.masses = fem.form(self.weight * ufl.inner(self.u, self.v) * ufl.dx)
        metal = [fem.locate_dofs_topological(self.space, 2, mesh.facets([f["id"] for f in PROBLEM["faces"] if f["condition"] in metal_conditions])),
                 fem.locate_dofs_topological(self.space, 3, mesh.cells([v["id"] for v in PROBLEM["volumes"] if v["is_conductor"]]))]
        self.free = numpy.setdiff1d(numpy.arange(self.size), numpy.concatenate(metal))
        self.free_set = index_set(self.free)

    def measures(self, face_ids):
        """ds, and dS of the same facets: faces on the hull and faces inside."""
        facets = self.mesh.facets(face_ids)
        tags = dolfinx.mesh.meshtags(self.mesh.domain, 2, facets, numpy.ones(len(facets), dtype=numpy.int32))
        return [ufl.Measure(kind, domain=self.mesh.domain, subdomain_data=tags)(1) for kind in ("ds", "dS")]

    def tangential(self, face_ids):
        """Forms of self.surface times the product of tangential fields over these faces."""
        outer, inner = self.measures(face_ids)
        u, v, n, y = self.u, self.v, self.normal, self.surface
        return [fem.form(y * ufl.inner(ufl.cross(n, u), ufl.cross(n, v)) * outer),
                fem.form(y("+") * ufl.inner(ufl.cross(n("+"), u("+")), ufl.cross(n("+"), v("+"))) * inner)]

    def along(self, direction, face_ids):
        """Integral of the field along a direction over faces, as a vector over the free unknowns."""
        outer, inner = self.measures(face_ids)
        d = fem.Constant(self.mesh.domain, numpy.array(direction, dtype=PETSc.ScalarType))
        vector = fem.petsc.assemble_vector(fem.form(ufl.inner(d, self.v) * outer))
        return (vector.array + fem.petsc.assemble_vector(fem.form(ufl.inner(d, self.v("+")) * inner)).array)[self.free]

    def matrix(self, forms):
        """Sum of forms; each is a form, or (form, surface values) to be set before it is assembled."""
        matrix = fem.petsc.create_matrix(self.curls)
        matrix.setOption(PETSc.Mat.Option.IGNORE_ZERO_ENTRIES, True)  # of the cell across a face
        for form in forms:
            if isinstance(form, tuple):
                self.surface.x.array[:] = form[1]
                form = form[0]
            fem.petsc.assemble_matrix(matrix, form)
        matrix.assemble()
        return matrix.createSubMatrix(self.free_set, self.free_set)


def driven(mesh):
    edges = EdgeElements(mesh, ("pec",))
    print(f"{edges.size} unknowns of degree {DEGREE}, {len(edges.free)} free", flush=True)
    terms = [(face, edges.tangential([face["id"]])) for face in PROBLEM["faces"] if face["condition"] in ("absorbing", "impedance", "conductor", "port")]
    ports = PROBLEM["ports"]
    along = [edges.along(port["direction"], port["faces"]) for port in ports]
    dielectrics = [v for v in PROBLEM["volumes"] if not v["is_conductor"]]
    solver = direct_solver()
    with open(PROBLEM["result"], "w") as file:
        file.write("# pcbmesh port results 1\n")
        for number, port in enumerate(ports, 1):
            file.write(f"# port {number} {port['impedance_ohm']:.17g} {port['name']}\n")
        file.write("# frequency_hz excited observed re im\n")
        for hz in PROBLEM["frequencies_hz"]:
            k0 = 2 * math.pi * hz * UNIT / LIGHT
            edges.weight.x.array[:] = mesh.by_cell({v["id"]: -k0 ** 2 * permittivity(v, hz) for v in dielectrics})
            parts = [edges.curls, edges.masses]
            for face, forms in terms:
                parts += [(form, 1j * k0 * admittance(face, hz, mesh.cell_z)) for form in forms]
            matrix = edges.matrix(parts)
            solver.setOperators(matrix)
            field, source = matrix.createVecs()
            for j, fed in enumerate(ports):
                if not fed["is_excited"]:
                    continue
                y = Z0 * fed["length_m"] / (fed["impedance_ohm"] * fed["width_m"])
                source.array[:] = 2j * k0 * y / (fed["length_m"] / UNIT) * along[j]  # a wave of 1 V inwards
                solver.solve(source, field)
                for i, seen in enumerate(ports):
                    s = along[i] @ field.array / (seen["width_m"] / UNIT) - (1 if i == j else 0)
                    file.write(f"{hz:.17g} {j + 1} {i + 1} {s.real:.17g} {s.imag:.17g}\n")
            print(f"{hz:g} Hz", flush=True)
            matrix.destroy()


def resonances(mesh):
    from slepc4py import SLEPc
    # Loss of the skins is second order in the frequency of a resonance: they are ideal here.
    edges = EdgeElements(mesh, ("pec", "conductor"))
    print(f"{edges.size} unknowns of degree {DEGREE}, {len(edges.free)} free", flush=True)
    modes = PROBLEM["modes"]
    dielectrics = [v for v in PROBLEM["volumes"] if not v["is_conductor"]]
    loss = {v["id"]: v["tan_delta"] + v["sigma_s_per_m"] / (2 * math.pi * modes["above_hz"] * EPS0 * v["eps_r"]) for v in dielectrics}
    stiffness = edges.matrix([edges.curls])
    edges.weight.x.array[:] = mesh.by_cell({v["id"]: v["eps_r"] for v in dielectrics})
    mass = edges.matrix([edges.masses])
    edges.weight.x.array[:] = mesh.by_cell({v["id"]: v["eps_r"] * loss[v["id"]] for v in dielectrics})
    lossy_mass = edges.matrix([edges.masses])
    hz_per_root = LIGHT / (2 * math.pi * UNIT)
    target = (modes["above_hz"] / hz_per_root) ** 2
    solver = SLEPc.EPS().create(PETSc.COMM_SELF)
    solver.setOperators(stiffness, mass)
    solver.setProblemType(SLEPc.EPS.ProblemType.GHEP)
    solver.setDimensions(nev=modes["number"])
    solver.setWhichEigenpairs(SLEPc.EPS.Which.TARGET_REAL)
    solver.setTarget(target)
    # Gradients are static solutions of no interest; they lie at zero but for rounding.
    region = solver.getRG()
    region.setType(SLEPc.RG.Type.INTERVAL)
    region.setIntervalEndpoints(1e-3 * target, 1e6 * target, -target, target)
    transform = solver.getST()
    transform.setType(SLEPc.ST.Type.SINVERT)
    transform.setKSP(direct_solver())
    solver.setTolerances(1e-10, 500)
    solver.solve()
    found, (vector, _) = [], stiffness.createVecs()
    for i in range(solver.getConverged()):
        value = solver.getEigenpair(i, vector).real
        if value > 1e-3 * target:
            found.append((hz_per_root * math.sqrt(value), vector.dot(mass * vector).real, vector.dot(lossy_mass * vector).real))
    found = sorted(found)[:modes["number"]]
    if len(found) < modes["number"]:
        print(f"only {len(found)} of {modes['number']} modes converged", file=sys.stderr)
    with open(PROBLEM["result"], "w") as file:  # rows: mode, value; Q of the dielectric = stored/lost
        for column, title in enumerate(("frequency_hz", "stored", "lost")):
            file.write(f"# {title}\n" + "".join(f"{number} {mode[column]:.17g}\n" for number, mode in enumerate(found)))


def capacitances(mesh):
    nodal = space(mesh.domain, "CG", 1)
    size = nodal.dofmap.index_map.size_global
    dof_of_node = numpy.zeros(mesh.num_nodes, dtype=numpy.int64)
    dof_of_node[mesh.nodes] = rows(nodal.dofmap.list, mesh.corners)
    eps = fem.Function(space(mesh.domain, "DG", 0))
    # Copper without a net floats: a field inside is eight orders below that outside.
    eps.x.array[:] = mesh.by_cell({v["id"]: 1e8 if v["id"] in PROBLEM["floating"] else 0 if v["is_conductor"] else v["eps_r"] for v in PROBLEM["volumes"]})
    u, v = ufl.TrialFunction(nodal), ufl.TestFunction(nodal)
    # The degree that UFL takes by itself counts prisms as tetrahedra, whose gradients are constant: one point is too few.
    volumes = ufl.dx(metadata={"quadrature_degree": 2 if mesh.corners == 6 else 0})
    energy = fem.petsc.assemble_matrix(fem.form(eps * ufl.inner(ufl.grad(u), ufl.grad(v)) * volumes))
    energy.assemble()

    def dofs(faces, volumes=()):
        nodes = [numpy.concatenate(mesh.faces[i]) for i in faces if i in mesh.faces] + [mesh.nodes[mesh.cells(list(volumes))].ravel()]
        return numpy.unique(dof_of_node[numpy.concatenate(nodes).astype(numpy.int64)])

    conductors = [dofs(c["faces"], c["volumes"]) for c in PROBLEM["conductors"]]
    ground = dofs([f["id"] for f in PROBLEM["faces"] if f["condition"] == "pec" and f["kind"] == "outer"])
    free = numpy.setdiff1d(numpy.arange(size), numpy.concatenate([*conductors, ground]))
    print(f"{size} unknowns, {len(free)} free", flush=True)
    solver, potentials = direct_solver(), []
    if len(free):
        matrix = energy.createSubMatrix(index_set(free), index_set(free))
        solver.setOperators(matrix)
    for own in conductors:
        potential, right = energy.createVecs()
        potential.array[own] = 1
        energy.mult(potential, right)
        if len(free):
            inner, source = matrix.createVecs()
            source.array[:] = -right.array[free]
            solver.solve(source, inner)
            potential.array[free] = inner.array
        potentials.append(potential)
    # Energy of two fields: symmetric, and its error is the square of theirs.
    with open(PROBLEM["result"], "w") as file:
        file.write("# pcbmesh capacitance results 1\n" + "".join(f"# net {i} {c['name']}\n" for i, c in enumerate(PROBLEM["conductors"], 1)) + "# net net farad\n")
        for a, first in enumerate(potentials):
            for b in range(a, len(potentials)):
                farad = EPS0 * UNIT * potentials[b].dot(energy * first).real
                file.write(f"{a + 1} {b + 1} {farad:.17g}\n")


if __name__ == "__main__":
    {"driven": driven, "eigenmode": resonances, "electrostatic": capacitances}[PROBLEM["problem"]](Mesh(PROBLEM["mesh"]))

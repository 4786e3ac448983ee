// SPDX-License-Identifier: GPL-3.0-or-later
// Solves what pcbmesh wrote for MFEM (--for mfem): capacitances by nodal elements, driven sweeps and resonances by Nedelec
// elements, on prisms or tetrahedra. Resonances take ARPACK for the eigenvalues: compile with -DPCBMESH_ARPACK -larpack. Every group is found by its name, which MFEM reads from the mesh (format 1.3). Time is exp(+i omega t).
// usage: solve x.problem.txt [order]
#include <algorithm>
#include <complex>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iomanip>
#include <iostream>
#include <map>
#include <memory>
#include <sstream>

#include "mfem.hpp"
#ifdef PCBMESH_ARPACK
#include <arpack/arpack.h>
#endif

namespace {

using Complex = std::complex<double>;
constexpr double light = 299792458.0, eps0 = 8.8541878128e-12, mu0 = 1.25663706212e-6, free_space = 376.730313668;
constexpr double pi = 3.14159265358979324;
constexpr double floating_eps_r = 1e8;  // copper without a net: a field inside is eight orders below that outside

struct Material {
  double eps_r = 1, tan_delta = 0, mu_r = 1, sigma = 0;
  Complex permittivity(double hz) const { return {eps_r, -eps_r * tan_delta - sigma / (2 * pi * hz * eps0)}; }
};
struct Volume {
  std::string name, kind;  // dielectric, conductor or floating
  Material material;
};
struct Face {
  std::string name, condition;
  double impedance = 0, thickness = 0, sides = 1;
  Material metal;
  std::size_t port = 0;
  std::vector<std::pair<double, Material>> media;  // up to a height, in metres
};
struct Port {
  std::string name;
  double impedance = 50, length = 0, width = 0;
  mfem::Vector direction = mfem::Vector(3);
  bool is_excited = true;
};
struct Net {
  std::string name;
  std::vector<std::string> volumes, faces;
};
struct Problem {
  std::string kind, mesh, result;
  double unit = 1;
  std::vector<double> frequencies;
  int num_modes = 0;
  double above = 0;  // Hz
  std::vector<Volume> volumes;
  std::vector<Face> faces;
  std::vector<Port> ports;
  std::vector<Net> nets;
  std::vector<std::string> ground;
};

std::istream& operator>>(std::istream& in, Material& m) {
  return in >> m.eps_r >> m.tan_delta >> m.mu_r >> m.sigma;
}

std::vector<std::string> names(std::istream& in) {
  std::size_t count = 0;
  in >> count;
  std::vector<std::string> out(count);
  for (std::string& name : out) in >> std::quoted(name);
  return out;
}

Face read_face(std::istream& in) {
  Face face;
  in >> std::quoted(face.name) >> face.condition;
  if (face.condition == "impedance") in >> face.impedance;
  if (face.condition == "conductor") in >> face.thickness >> face.sides >> face.metal;
  if (face.condition == "port") in >> face.port;
  if (face.condition == "absorbing") {
    std::size_t count = 0;
    in >> count;
    face.media.resize(count);
    for (auto& [z, material] : face.media) in >> z >> material;
  }
  return face;
}

Problem read(const char* name) {
  std::ifstream file(name);
  if (!file) mfem::mfem_error("the problem can't be opened");
  Problem problem;
  for (std::string line; std::getline(file, line);) {
    std::istringstream in(line);
    std::string key;
    if (!(in >> key) || key[0] == '#') continue;
    if (key == "problem") in >> problem.kind;
    else if (key == "mesh") in >> std::quoted(problem.mesh);
    else if (key == "result") in >> std::quoted(problem.result);
    else if (key == "unit_m") in >> problem.unit;
    else if (key == "frequency_hz") in >> problem.frequencies.emplace_back();
    else if (key == "modes") in >> problem.num_modes >> problem.above;
    else if (key == "volume") {
      Volume& v = problem.volumes.emplace_back();
      in >> std::quoted(v.name) >> v.kind >> v.material;
    } else if (key == "face") problem.faces.push_back(read_face(in));
    else if (key == "port") {
      Port& p = problem.ports.emplace_back();
      in >> std::quoted(p.name) >> p.impedance >> p.length >> p.width >> p.direction[0] >> p.direction[1] >> p.direction[2] >> p.is_excited;
    } else if (key == "net") {
      Net& net = problem.nets.emplace_back();
      in >> std::quoted(net.name);
      net.volumes = names(in);
      net.faces = names(in);
    } else if (key == "ground") problem.ground = names(in);
    else in.setstate(std::ios::failbit);
    if (in.fail()) mfem::mfem_error(("this line is not understood: " + line).c_str());
  }
  return problem;
}

/// What the names of a mesh mean to a space on it.
class Groups {
 public:
  Groups(mfem::Mesh& mesh, mfem::FiniteElementSpace& space) : mesh_(mesh), space_(space) {}

  mfem::Array<int> face_marker(const std::string& name) const {
    mfem::Array<int> marker = mesh_.bdr_attribute_sets.GetAttributeSetMarker(name);
    return marker;
  }
  /// One value per volume group, for PWConstCoefficient.
  template <class Value>
  mfem::Vector by_attribute(const Problem& problem, Value value) const {
    mfem::Vector out(mesh_.attributes.Max());
    out = 0.0;
    for (const Volume& volume : problem.volumes)
      for (const int attribute : mesh_.attribute_sets.GetAttributeSet(volume.name)) out[attribute - 1] = value(volume);
    return out;
  }
  void add_unknowns_of_face(const std::string& name, mfem::Array<int>& out) const {
    mfem::Array<int> marker = face_marker(name), unknowns;
    space_.GetEssentialTrueDofs(marker, unknowns);
    out.Append(unknowns);
  }
  void add_unknowns_of_volume(const std::string& name, mfem::Array<int>& out) const {
    mfem::Array<int> unknowns;
    for (const int attribute : mesh_.attribute_sets.GetAttributeSet(name))
      for (int e = 0; e < mesh_.GetNE(); ++e) {
        if (mesh_.GetAttribute(e) != attribute) continue;
        space_.GetElementDofs(e, unknowns);
        for (int& dof : unknowns) dof = dof < 0 ? -1 - dof : dof;
        out.Append(unknowns);
      }
  }

 private:
  mfem::Mesh& mesh_;
  mfem::FiniteElementSpace& space_;
};

void capacitances(const Problem& problem, mfem::Mesh& mesh, int order) {
  const mfem::H1_FECollection elements(order, 3);
  mfem::FiniteElementSpace space(&mesh, &elements);
  const Groups groups(mesh, space);
  std::cout << space.GetVSize() << " unknowns of order " << order << std::endl;
  mfem::Vector eps = groups.by_attribute(problem, [](const Volume& v) {
    return v.kind == "dielectric" ? v.material.eps_r : v.kind == "floating" ? floating_eps_r : 0.0;
  });
  mfem::PWConstCoefficient coefficient(eps);
  mfem::BilinearForm energy(&space);
  energy.AddDomainIntegrator(new mfem::DiffusionIntegrator(coefficient));
  energy.Assemble();
  energy.Finalize();
  std::vector<mfem::Array<int>> held(problem.nets.size());
  mfem::Array<int> all;
  for (std::size_t n = 0; n < held.size(); ++n) {
    for (const std::string& name : problem.nets[n].faces) groups.add_unknowns_of_face(name, held[n]);
    for (const std::string& name : problem.nets[n].volumes) groups.add_unknowns_of_volume(name, held[n]);
    all.Append(held[n]);
  }
  for (const std::string& name : problem.ground) groups.add_unknowns_of_face(name, all);
  all.Sort();
  all.Unique();
  std::vector<mfem::Vector> potentials;
  for (const mfem::Array<int>& own : held) {
    mfem::Vector x(space.GetVSize()), b(space.GetVSize());
    x = 0.0;
    b = 0.0;
    for (const int dof : own) x[dof] = 1;
    mfem::SparseMatrix matrix(energy.SpMat());
    for (const int dof : all) matrix.EliminateRowCol(dof, x[dof], b, mfem::Operator::DIAG_ONE);
    mfem::GSSmoother smoother(matrix);
    mfem::PCG(matrix, smoother, b, x, 0, 5000, 1e-24, 0.0);
    potentials.push_back(x);
  }
  std::ofstream file(problem.result);
  file << std::setprecision(17) << "# pcbmesh capacitance results 1\n";
  for (std::size_t n = 0; n < held.size(); ++n) file << "# net " << n + 1 << " " << problem.nets[n].name << "\n";
  file << "# net net farad\n";
  for (std::size_t a = 0; a < held.size(); ++a)
    for (std::size_t b = a; b < held.size(); ++b)
      file << a + 1 << " " << b + 1 << " " << eps0 * problem.unit * energy.SpMat().InnerProduct(potentials[a], potentials[b]) << "\n";
}

/// Surface admittance relative to free space, at a height.
Complex admittance(const Face& face, const Problem& problem, double hz, double z_m) {
  if (face.condition == "impedance") return free_space / face.impedance;
  if (face.condition == "port") {
    const Port& port = problem.ports[face.port];
    return free_space * port.length / (port.impedance * port.width);
  }
  if (face.condition == "conductor") {
    // Both sides of a sheet carry current: half the impedance of a slab of its thickness, coth of half the thickness.
    const Complex gamma = Complex(1, 1) * std::sqrt(pi * hz * mu0 * face.metal.mu_r * face.metal.sigma);
    const Complex thick = face.sides * free_space * face.metal.sigma / gamma;
    return face.thickness > 0 ? thick * std::tanh(gamma * face.thickness / face.sides) : thick;
  }
  const Material* medium = nullptr;
  for (const auto& [z_high, material] : face.media) {
    medium = &material;
    if (z_m < z_high) break;
  }
  return medium == nullptr ? 1.0 : std::sqrt(medium->permittivity(hz) / medium->mu_r);
}

/// Unknowns of the edges on faces with one of these conditions, and in metal.
mfem::Array<int> metal_unknowns(const Problem& problem, const Groups& groups, const std::vector<std::string>& conditions) {
  mfem::Array<int> metal;
  for (const Face& face : problem.faces)
    if (std::find(conditions.begin(), conditions.end(), face.condition) != conditions.end())
      groups.add_unknowns_of_face(face.name, metal);
  for (const Volume& volume : problem.volumes)
    if (volume.kind != "dielectric") groups.add_unknowns_of_volume(volume.name, metal);
  metal.Sort();
  metal.Unique();
  return metal;
}

#if defined(MFEM_USE_SUITESPARSE) && defined(PCBMESH_ARPACK)
struct Mode {
  double value;
  mfem::Vector field;
};

/// The `number` lowest eigenvalues of stiffness x = value mass x above `shift`, by shift and invert. Static solutions lie at
/// zero, below every shift, so they are never among them.
std::vector<Mode> modes_above(double shift, int number, const mfem::SparseMatrix& stiffness, const mfem::SparseMatrix& mass) {
  std::unique_ptr<mfem::SparseMatrix> shifted(mfem::Add(1.0, stiffness, -shift, mass));
  mfem::UMFPackSolver inverse(*shifted);
  const int n = stiffness.Height(), basis = std::min(n, std::max(2 * number + 1, 20)), work = basis * (basis + 8);
  std::vector<double> start(n), vectors(static_cast<std::size_t>(n) * basis), room(3 * static_cast<std::size_t>(n)), inner(work), values(number);
  std::vector<int> choice(basis);
  int step = 0, info = 0, pointers[14] = {}, parameters[11] = {1, 0, 500, 1, 0, 0, 3};
  mfem::Vector right(n);
  for (;;) {
    dsaupd_c(&step, "G", n, "LA", number, 1e-12, start.data(), basis, vectors.data(), n, parameters, pointers, room.data(), inner.data(), work, &info);
    if (step != -1 && step != 1 && step != 2) break;
    mfem::Vector in(&room[pointers[0] - 1], n), out(&room[pointers[1] - 1], n);
    if (step == 2) {
      mass.Mult(in, out);
      continue;
    }
    if (step == -1) mass.Mult(in, right);
    inverse.Mult(step == -1 ? right : mfem::Vector(&room[pointers[2] - 1], n), out);
  }
  if (info < 0 || parameters[4] < number) mfem::mfem_error("the eigenvalues do not converge; ask for fewer modes, or from another frequency");
  dseupd_c(1, "A", choice.data(), values.data(), vectors.data(), n, shift, "G", n, "LA", number, 1e-12, start.data(), basis, vectors.data(), n,
           parameters, pointers, room.data(), inner.data(), work, &info);
  if (info != 0) mfem::mfem_error("ARPACK gives no eigenvectors");
  std::vector<Mode> modes;
  for (int m = 0; m < number; ++m) {
    modes.push_back({values[m], mfem::Vector(n)});
    std::copy_n(&vectors[static_cast<std::size_t>(m) * n], n, modes.back().field.GetData());
  }
  std::sort(modes.begin(), modes.end(), [](const Mode& a, const Mode& b) { return a.value < b.value; });
  return modes;
}
#endif

void resonances(const Problem& problem, mfem::Mesh& mesh, int order) {
#if defined(MFEM_USE_SUITESPARSE) && defined(PCBMESH_ARPACK)
  const mfem::ND_FECollection elements(order, 3);
  mfem::FiniteElementSpace space(&mesh, &elements);
  const Groups groups(mesh, space);
  std::cout << space.GetVSize() << " unknowns of order " << order << std::endl;
  // Loss of the skins is second order in the frequency of a resonance: they are ideal here.
  const mfem::Array<int> metal = metal_unknowns(problem, groups, {"pec", "conductor"});
  const auto matrix = [&](mfem::BilinearFormIntegrator* term, mfem::Operator::DiagonalPolicy diagonal) {
    auto form = std::make_unique<mfem::BilinearForm>(&space);
    form->AddDomainIntegrator(term);
    form->Assemble(0);
    form->Finalize(0);
    for (const int dof : metal) form->SpMat().EliminateRowCol(dof, diagonal);
    return form;
  };
  const auto by_volume = [&](auto value) {
    return groups.by_attribute(problem, [&](const Volume& v) { return v.kind == "dielectric" ? value(v.material) : 0.0; });
  };
  mfem::Vector nu = groups.by_attribute(problem, [](const Volume& v) { return 1 / v.material.mu_r; });
  mfem::Vector eps = by_volume([](const Material& m) { return m.eps_r; });
  mfem::Vector loss = by_volume([&](const Material& m) { return -m.permittivity(problem.above).imag(); });
  mfem::PWConstCoefficient reluctivity(nu), permittivity(eps), lost(loss);
  const auto stiffness = matrix(new mfem::CurlCurlIntegrator(reluctivity), mfem::Operator::DIAG_ONE);
  const auto mass = matrix(new mfem::VectorFEMassIntegrator(permittivity), mfem::Operator::DIAG_ZERO);
  const auto lossy = matrix(new mfem::VectorFEMassIntegrator(lost), mfem::Operator::DIAG_ZERO);
  const double hz_per_root = light / (2 * pi * problem.unit);
  const std::vector<Mode> modes =
      modes_above(std::pow(problem.above / hz_per_root, 2), problem.num_modes, stiffness->SpMat(), mass->SpMat());
  std::ofstream file(problem.result);
  file << std::setprecision(17);  // rows: mode, value; Q of the dielectric = stored/lost
  const auto column = [&](const char* title, auto value) {
    file << "# " << title << "\n";
    for (std::size_t m = 0; m < modes.size(); ++m) file << m << " " << value(modes[m]) << "\n";
  };
  column("frequency_hz", [&](const Mode& mode) { return hz_per_root * std::sqrt(mode.value); });
  column("stored", [&](const Mode& mode) { return mass->SpMat().InnerProduct(mode.field, mode.field); });
  column("lost", [&](const Mode& mode) { return lossy->SpMat().InnerProduct(mode.field, mode.field); });
#else
  mfem::mfem_error("resonances want MFEM with SuiteSparse (MFEM_USE_SUITESPARSE=YES) and ARPACK (-DPCBMESH_ARPACK -larpack)");
#endif
}

void driven(const Problem& problem, mfem::Mesh& mesh, int order) {
#ifdef MFEM_USE_SUITESPARSE
  const mfem::ND_FECollection elements(order, 3);
  mfem::FiniteElementSpace space(&mesh, &elements);
  const Groups groups(mesh, space);
  std::cout << space.GetVSize() << " unknowns of order " << order << std::endl;
  const mfem::Array<int> metal = metal_unknowns(problem, groups, {"pec"});
  // Integral of the field along each port: source and voltmeter in one.
  std::vector<mfem::Vector> along;
  for (std::size_t p = 0; p < problem.ports.size(); ++p) {
    mfem::VectorConstantCoefficient direction(problem.ports[p].direction);
    mfem::Vector sum(space.GetVSize());
    sum = 0.0;
    for (const Face& face : problem.faces) {
      if (face.condition != "port" || face.port != p) continue;
      mfem::Array<int> marker = groups.face_marker(face.name);
      mfem::LinearForm form(&space);
      form.AddBoundaryIntegrator(new mfem::VectorFEDomainLFIntegrator(direction), marker);
      form.Assemble();
      sum += form;
    }
    for (const int dof : metal) sum[dof] = 0;
    along.push_back(sum);
  }
  mfem::Vector nu = groups.by_attribute(problem, [](const Volume& v) { return 1 / v.material.mu_r; });
  mfem::PWConstCoefficient reluctivity(nu);
  std::ofstream file(problem.result);
  file << std::setprecision(17) << "# pcbmesh port results 1\n";
  for (std::size_t p = 0; p < problem.ports.size(); ++p)
    file << "# port " << p + 1 << " " << problem.ports[p].impedance << " " << problem.ports[p].name << "\n";
  file << "# frequency_hz excited observed re im\n";
  for (const double hz : problem.frequencies) {
    const double k0 = 2 * pi * hz * problem.unit / light;
    const auto weight = [&](const Volume& v) { return v.kind == "dielectric" ? -k0 * k0 * v.material.permittivity(hz) : 0.0; };
    mfem::Vector real = groups.by_attribute(problem, [&](const Volume& v) { return weight(v).real(); });
    mfem::Vector imag = groups.by_attribute(problem, [&](const Volume& v) { return weight(v).imag(); });
    mfem::PWConstCoefficient real_weight(real), imag_weight(imag);
    mfem::BilinearForm re(&space), im(&space);
    re.AddDomainIntegrator(new mfem::CurlCurlIntegrator(reluctivity));
    re.AddDomainIntegrator(new mfem::VectorFEMassIntegrator(real_weight));
    im.AddDomainIntegrator(new mfem::VectorFEMassIntegrator(imag_weight));
    std::vector<mfem::FunctionCoefficient> coefficients;
    std::vector<mfem::Array<int>> markers;
    coefficients.reserve(2 * problem.faces.size());
    markers.reserve(problem.faces.size());
    for (const Face& face : problem.faces) {
      if (face.condition == "pec" || face.condition == "pmc") continue;
      const auto y = [&, hz](const mfem::Vector& x) { return Complex(0, k0) * admittance(face, problem, hz, x[2] * problem.unit); };
      markers.push_back(groups.face_marker(face.name));
      coefficients.emplace_back([y](const mfem::Vector& x) { return y(x).real(); });
      re.AddBoundaryIntegrator(new mfem::VectorFEMassIntegrator(coefficients.back()), markers.back());
      coefficients.emplace_back([y](const mfem::Vector& x) { return y(x).imag(); });
      im.AddBoundaryIntegrator(new mfem::VectorFEMassIntegrator(coefficients.back()), markers.back());
    }
    for (mfem::BilinearForm* form : {&re, &im}) {
      form->Assemble(0);
      form->Finalize(0);
      for (const int dof : metal)
        form->SpMat().EliminateRowCol(dof, form == &re ? mfem::Operator::DIAG_ONE : mfem::Operator::DIAG_ZERO);
    }
    mfem::ComplexSparseMatrix matrix(&re.SpMat(), &im.SpMat(), false, false);
    mfem::ComplexUMFPackSolver solver;
    solver.SetOperator(matrix);
    for (std::size_t j = 0; j < problem.ports.size(); ++j) {
      const Port& fed = problem.ports[j];
      if (!fed.is_excited) continue;
      const int n = space.GetVSize();
      mfem::Vector source(2 * n), field(2 * n);
      source = 0.0;
      const double strength = 2 * k0 * free_space * fed.length / (fed.impedance * fed.width) / (fed.length / problem.unit);  // 1 V inwards
      for (int i = 0; i < n; ++i) source[n + i] = strength * along[j][i];
      solver.Mult(source, field);
      for (std::size_t i = 0; i < problem.ports.size(); ++i) {
        Complex volts = 0;
        for (int k = 0; k < n; ++k) volts += along[i][k] * Complex(field[k], field[n + k]);
        const Complex s = volts / (problem.ports[i].width / problem.unit) - (i == j ? 1.0 : 0.0);
        file << hz << " " << j + 1 << " " << i + 1 << " " << s.real() << " " << s.imag() << "\n";
      }
    }
    std::cout << hz << " Hz" << std::endl;
  }
#else
  mfem::mfem_error("a driven sweep wants MFEM with SuiteSparse (MFEM_USE_SUITESPARSE=YES) for its direct solver");
#endif
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return std::cerr << "usage: solve x.problem.txt [order]\n", 2;
  const Problem problem = read(argv[1]);
  const int order = argc > 2 ? std::atoi(argv[2]) : 1;
  mfem::Mesh mesh(problem.mesh.c_str(), 1, 0);
  (problem.kind == "driven" ? driven : problem.kind == "eigenmode" ? resonances : capacitances)(problem, mesh, order);
  return 0;
}

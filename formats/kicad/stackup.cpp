// SPDX-License-Identifier: GPL-3.0-or-later
#include "formats/kicad/stackup.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <set>
#include <utility>

#include "pcbmesh/base/error.hpp"

namespace pcbmesh::formats::kicad {
namespace {

using board::LayerKind;
using board::Material;
using board::StackupLayer;
using syntax::Sexpr;

constexpr double default_eps_r = 4.5, default_tan_delta = 0.02, mask_eps_r = 3.3;
constexpr Nm default_copper_nm = 35 * nm_per_um, thinnest_default_nm = 10 * nm_per_um, spare_dielectric_nm = 100 * nm_per_um;
constexpr double default_board_mm = 1.6;
constexpr double copper_sigma = 5.8e7;

std::int32_t material_index(board::BoardParts& parts, Material material) {
  const std::string base = material.name;
  for (int copy = 2;; ++copy) {
    const auto same_name = std::find_if(parts.materials.begin(), parts.materials.end(),
                                        [&](const Material& m) { return m.name == material.name; });
    if (same_name == parts.materials.end()) break;
    if (*same_name == material) return static_cast<std::int32_t>(same_name - parts.materials.begin());
    material.name = fmt::format("{} {}", base, copy);
  }
  parts.materials.push_back(std::move(material));
  return static_cast<std::int32_t>(parts.materials.size() - 1);
}

std::int32_t copper_material(board::BoardParts& parts) {
  return material_index(parts, {.name = "copper", .sigma_s_per_m = copper_sigma});
}

/// One ply of a dielectric: sums of thickness, t/er and t/er*tan d, for layers in series.
struct Plies {
  double thickness_mm = 0, series = 0, lossy = 0;
  bool is_assumed = false;  ///< some ply does not state its permittivity
  std::string material;
  void add(double t, double eps_r, double tan_delta, const std::string& name) {
    thickness_mm += t;
    series += t / eps_r;
    lossy += t / eps_r * tan_delta;
    if (material.empty())
      material = name;
    else if (!name.empty() && material.find(name) == std::string::npos)
      material += " + " + name;
  }
};

struct Ply {
  std::optional<double> thickness_mm{}, eps_r{}, tan_delta{};
  std::string material{};
};

class StackupReader {
 public:
  StackupReader(Reading& reading, Sexpr root) : reading_(reading), root_(root) {}

  void run() {
    const Sexpr section = root_.child("setup").child("stackup");
    if (section && read_section(section)) {
      require_dielectrics(section);
      return;
    }
    reading_.parts.stackup.clear();
    reading_.parts.materials.clear();
    names_.clear();
    take_default(section);
  }

 private:
  bool read_section(Sexpr section) {
    std::vector<int> copper_order;
    for (const Sexpr layer : section) {
      if (!layer.is_list()) continue;
      if (layer.head() == "layer")
        read_layer(layer, copper_order);
      else if (layer.head() != "copper_finish" && layer.head() != "dielectric_constraints" &&
               layer.head() != "castellated_pads" && layer.head() != "edge_plating" && layer.head() != "edge_connector")
        reading_.count_unknown_list(layer);
    }
    std::vector<int> expected;
    for (int i = 0; i < reading_.layers.num_copper(); ++i) expected.push_back(i);
    if (copper_order == expected) return true;
    reading_.warn("kicad.stackup_mismatch",
                  fmt::format("the stackup lists {} copper layers in another order or number than the layer table ({}); the "
                              "default stackup is used",
                              copper_order.size(), expected.size()),
                  section);
    return false;
  }

  void read_layer(Sexpr layer, std::vector<int>& copper_order) {
    const std::string name = layer.arg(0).text();
    const std::string_view type = layer.child("type").arg(0).raw();
    const int copper = reading_.layers.find(name);
    if (copper >= 0) {
      copper_order.push_back(copper);
      read_copper(layer, copper);
      return;
    }
    const auto is_about = [&](std::string_view word) {
      return name.find(word) != std::string::npos || type.find(word) != std::string_view::npos;
    };
    if (is_about("Mask")) {
      read_dielectric(layer, name, LayerKind::solder_mask);
    } else if (name.starts_with("dielectric") || type == "core" || type == "prepreg") {
      read_dielectric(layer, name, LayerKind::dielectric);
    } else if (!is_about("Silk") && !is_about("Paste")) {
      reading_.warn("kicad.stackup_layer",
                    fmt::format("stackup layer '{}' of type '{}' is neither copper, dielectric nor mask; skipped", shown(name),
                                shown(type)),
                    layer);
    }
  }

  void read_copper(Sexpr layer, int copper) {
    Nm thickness = reading_.length(reading_.number_of(layer, "thickness").value_or(0), layer);
    if (thickness <= 0) {
      reading_.assume("kicad.copper_thickness", "copper layer without a thickness; 35 um is used", layer);
      thickness = default_copper_nm;
    }
    push_copper(copper, thickness);
  }

  void push_copper(int copper, Nm thickness) {
    const LayerTable::Copper& names = reading_.layers.copper(copper);
    reading_.parts.stackup.push_back(
        {unique(names.name), names.user_name, LayerKind::copper, thickness, copper_material(reading_.parts)});
  }

  void read_dielectric(Sexpr layer, const std::string& name, LayerKind kind) {
    Plies plies;
    Ply ply;
    for (const Sexpr part : layer) {
      if (part.is_word() && part.raw() == "addsublayer") {
        add_ply(plies, std::exchange(ply, {}), kind, layer);
      } else if (part.is_list()) {
        const std::string_view word = part.head();
        if (word == "thickness")
          ply.thickness_mm = reading_.number(part.arg(0));
        else if (word == "epsilon_r")
          ply.eps_r = reading_.number(part.arg(0));
        else if (word == "loss_tangent")
          ply.tan_delta = reading_.number(part.arg(0));
        else if (word == "material")
          ply.material = part.arg(0).text();
        else if (word != "type" && word != "color")
          reading_.count_unknown_list(part);
      }
    }
    add_ply(plies, std::move(ply), kind, layer);
    const Nm thickness = reading_.length(plies.thickness_mm, layer);
    if (thickness <= 0) {
      reading_.warn("kicad.zero_thickness", fmt::format("stackup layer '{}' has no thickness; left out", shown(name)), layer);
      return;
    }
    std::string material =
        plies.material.empty() ? (kind == LayerKind::solder_mask ? "solder mask" : "dielectric") : plies.material;
    const std::int32_t index = material_index(reading_.parts, {.name = std::move(material),
                                                               .eps_r = rounded(plies.thickness_mm / plies.series),
                                                               .tan_delta = rounded(plies.lossy / plies.series),
                                                               .is_assumed = plies.is_assumed});
    reading_.parts.stackup.push_back({unique(name), "", kind, thickness, index});
  }

  /// Ten digits: equal plies joined in series must give back their own value, not one a rounding error away.
  static double rounded(double value) {
    const std::string text = fmt::format("{:.10g}", value);
    std::from_chars(text.data(), text.data() + text.size(), value);
    return value;
  }

  void add_ply(Plies& plies, Ply ply, LayerKind kind, Sexpr layer) {
    const double t = ply.thickness_mm.value_or(0);
    if (!(t > 0)) return;
    (void)reading_.length(t, layer);
    const bool mask = kind == LayerKind::solder_mask;
    if (!ply.eps_r || !(*ply.eps_r >= 1) || !(*ply.eps_r <= 1e6)) {
      if (ply.eps_r || !mask)
        reading_.assume("kicad.epsilon_r",
                        fmt::format("permittivity absent or impossible; {} is used unless a library knows the material",
                                    mask ? mask_eps_r : default_eps_r),
                        layer);
      else
        reading_.diagnostics.assume(Severity::note, "kicad.mask_epsilon_r", "solder mask without a permittivity; 3.3 is used",
                                    reading_.spot(layer));
      ply.eps_r = mask ? mask_eps_r : default_eps_r;
      plies.is_assumed = true;
    }
    if (!ply.tan_delta || !(*ply.tan_delta >= 0) || !(*ply.tan_delta <= 1e3)) {
      if (ply.tan_delta || !mask)
        reading_.assume("kicad.loss_tangent",
                        fmt::format("loss tangent absent or impossible; {} is used", mask ? 0 : default_tan_delta), layer);
      ply.tan_delta = mask ? 0 : default_tan_delta;
    }
    plies.add(t, *ply.eps_r, *ply.tan_delta, ply.material);
  }

  void take_default(Sexpr section) {
    const Sexpr general = root_.child("general");
    double board_mm = reading_.number_of(general, "thickness").value_or(0);
    if (!(board_mm > 0)) {
      reading_.assume("kicad.board_thickness", "board thickness absent or zero; 1.6 mm is used", general ? general : root_);
      board_mm = default_board_mm;
    }
    const int n = reading_.layers.num_copper();
    const Nm total = reading_.length(board_mm, general), gaps = std::max(1, n - 1);
    Nm dielectric = (total - n * default_copper_nm) / gaps;
    if (dielectric < thinnest_default_nm) {
      reading_.assume("kicad.board_thickness",
                      fmt::format("{} copper layers of 35 um do not fit into a board of {} mm; dielectrics of 100 um are used",
                                  n, board_mm),
                      general);
      dielectric = spare_dielectric_nm;
    }
    if (!section)
      reading_.assume(
          "kicad.default_stackup",
          fmt::format("the file has no stackup; copper 35 um and {} dielectric layers of {} (er 4.5, tan d 0.02) are used",
                      gaps, format_length(dielectric)),
          root_);
    const std::int32_t material = material_index(
        reading_.parts, {.name = "FR4 (default)", .eps_r = default_eps_r, .tan_delta = default_tan_delta, .is_assumed = true});
    for (int i = 0; i < n; ++i) {
      push_copper(i, default_copper_nm);
      if (i < gaps)
        reading_.parts.stackup.push_back(
            {fmt::format("dielectric {}", i + 1), "", LayerKind::dielectric, dielectric, material});
    }
  }

  void require_dielectrics(Sexpr section) const {
    const auto& stackup = reading_.parts.stackup;
    for (std::size_t i = 0; i + 1 < stackup.size(); ++i)
      if (stackup[i].kind == LayerKind::copper && stackup[i + 1].kind == LayerKind::copper) {
        Spot spot = reading_.spot(section);
        spot.layer = stackup[i].name;
        throw Error(ErrorCode::stackup_invalid,
                    fmt::format("no dielectric of a thickness above 0 lies between {} and {}: mend the stackup in KiCad (Board "
                                "Setup, Physical Stackup)",
                                stackup[i].name, stackup[i + 1].name),
                    spot);
      }
  }

  std::string unique(std::string name) {
    if (name.empty()) name = "unnamed";
    const std::string base = name;
    for (int copy = 2; !names_.insert(name).second; ++copy) name = fmt::format("{} ({})", base, copy);
    return name;
  }

  Reading& reading_;
  Sexpr root_;
  std::set<std::string> names_;
};

}  // namespace

void read_stackup(Reading& reading, Sexpr root) {
  StackupReader(reading, root).run();
}

}  // namespace pcbmesh::formats::kicad

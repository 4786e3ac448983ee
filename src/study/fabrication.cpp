// SPDX-License-Identifier: GPL-3.0-or-later
#include "pcbmesh/study/fabrication.hpp"

#include <fmt/format.h>

#include "src/study/faults.hpp"

namespace pcbmesh::study {
namespace {

void check_hole(const std::string& field, const HoleFill& how, FaultList& faults) {
  if (how.plating < nm_per_um || how.plating > nm_per_mm)
    faults.add(field + "/plating", fmt::format("{} is out of range; expected 1 um to 1 mm", format_length(how.plating)));
  if (how.fill == ViaFill::plugged && how.plug.empty())
    faults.add(field + "/plug", "a plugged hole needs the name of the material in it");
  if (how.fill != ViaFill::plugged && !how.plug.empty())
    faults.add(field + "/plug", fmt::format("holes of fill '{}' have no plug; take fill 'plugged'", name_of(how.fill)));
}

}  // namespace

void check_fabrication(const Fabrication& f, FaultList& faults) {
  check_hole("/vias", f.vias, faults);
  for (std::size_t i = 0; i < f.hole_rules.size(); ++i)
    check_hole(fmt::format("/vias/rules/{}", i), f.hole_rules[i].how, faults);
  for (std::size_t i = 0; i < f.backdrills.size(); ++i) {
    const Backdrill& b = f.backdrills[i];
    const std::string field = fmt::format("/backdrill/{}", i);
    if (b.from.empty() || b.to.empty()) faults.add(field, "a backdrill needs the copper layers it starts from and goes to");
    if (b.oversize < 1 || b.oversize > 10 * nm_per_mm)
      faults.add(field + "/oversize",
                 fmt::format("{} is out of range; expected above 0 and up to 10 mm", format_length(b.oversize)));
  }
  if (f.merge_vias && (*f.merge_vias < 1 || *f.merge_vias > 100 * nm_per_mm))
    faults.add("/merge_vias/pitch",
               fmt::format("{} is out of range; expected above 0 and up to 100 mm", format_length(*f.merge_vias)));
  if (f.etch) {
    if (!(f.etch->factor >= 0.5 && f.etch->factor <= 100))
      faults.add("/etch/factor", fmt::format("{} is out of range; expected 0.5 to 100", f.etch->factor));
    if (f.etch->steps < 1 || f.etch->steps > 8)
      faults.add("/etch/steps", fmt::format("{} is out of range; expected 1 to 8", f.etch->steps));
  }
  if (!(f.materials.stated.at_hz > 1e3 && f.materials.stated.at_hz < 1e12))
    faults.add("/materials/stated/at",
               fmt::format("{} Hz is out of range; expected above 1 kHz and below 1 THz", f.materials.stated.at_hz));
  if (f.max_unknowns && *f.max_unknowns < 1)
    faults.add("/limits/max_unknowns", fmt::format("{} is out of range; expected at least 1", *f.max_unknowns));
}

}  // namespace pcbmesh::study

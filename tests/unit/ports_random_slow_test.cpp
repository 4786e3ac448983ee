// SPDX-License-Identifier: GPL-3.0-or-later
// Ports strewn over real boards: what is wrong with one is found before anything is meshed.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <string>

#include "pcbmesh/base/error.hpp"
#include "pcbmesh/compose/compose.hpp"
#include "pcbmesh/formats/registry.hpp"
#include "pcbmesh/pipeline/mesh_board.hpp"
#include "test_data.hpp"

namespace pcbmesh {
namespace {

constexpr Nm mm = nm_per_mm;

/// Chance, the same on every machine.
class Dice {
 public:
  explicit Dice(unsigned seed) : engine_(seed) {}
  /// 0 ... below - 1
  Nm operator()(Nm below) { return static_cast<Nm>(engine_() % static_cast<std::uint64_t>(below)); }
  template <class Value>
  Value one_of(std::initializer_list<Value> values) {
    return values.begin()[(*this)(static_cast<Nm>(values.size()))];
  }

 private:
  std::mt19937_64 engine_;
};

/// A port of any kind on copper of any net, in a small region about it; nothing where chance met no net.
std::optional<study::Study> strewn(const board::Board& board, Dice& dice) {
  const board::Shape& shape = board.shapes()[static_cast<std::size_t>(dice(static_cast<Nm>(board.shapes().size())))];
  if (shape.net < 0 || shape.kind == board::ShapeKind::graphic) return std::nullopt;
  const geometry::Box box = geometry::bounds(shape.figure);
  geometry::Point p{box.min.x + dice(box.max.x - box.min.x + 1), box.min.y + dice(box.max.y - box.min.y + 1)};
  if (!shape.figure.filled && dice(2) == 0) p = shape.figure.path.points.front();
  study::Study study;
  study.region = study::RegionKind::box;
  study.box = geometry::Box{{p.x - mm - dice(mm), p.y - mm - dice(mm)}, {p.x + mm + dice(mm), p.y + dice(2 * mm) + 1}};
  study.policy = study::HeightPolicy::none;
  study.conductors = dice.one_of({study::ConductorMode::solid, study::ConductorMode::hollow, study::ConductorMode::sheet});
  if (dice(3) == 0) study.air_above = study.air_below = 0;
  study::Port port;
  port.name = "P";
  port.net = board.net_name(shape.net);
  if (dice(5) == 0) {
    using study::HullSide;
    port.at.side = dice.one_of({HullSide::xmin, HullSide::xmax, HullSide::ymin, HullSide::ymax});
    port.kind = dice.one_of({study::PortKind::lumped, study::PortKind::wave});
  } else {
    port.at.point = p;
    if (dice(2) == 0) port.at.layer = board.copper_name(shape.copper_layer);
    using study::PortShape;
    port.shape = dice.one_of({PortShape::automatic, PortShape::vertical, PortShape::gap, PortShape::coaxial});
  }
  if (port.shape != study::PortShape::coaxial && dice(2) == 0) port.width = 30 * nm_per_um + dice(800 * nm_per_um);
  study.ports = {port};
  return study;
}

struct Tally {
  int strewn = 0, refused = 0, meshed = 0, late = 0;
};

void strew(const std::string& file, int number, unsigned seed, Tally& tally) {
  const auto path = tests::test_data() / "kicad" / file;
  const board::Board board = formats::read_board(path, "", Progress{}).board;
  Dice dice(seed);
  for (int i = 0; i < number;) {
    const std::optional<study::Study> study = strewn(board, dice);
    if (!study) continue;
    ++i;
    ++tally.strewn;
    try {
      Diagnostics words;
      (void)compose::compose(board, *study, words);
    } catch (const Error& error) {
      EXPECT_TRUE(error.code() == ErrorCode::port_invalid || error.code() == ErrorCode::region_empty) << error.text();
      ++tally.refused;
      continue;
    }
    try {
      (void)pipeline::mesh_board(board, *study);
      ++tally.meshed;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::port_invalid) << file << ": " << error.text();
      fmt::print("late: {}: {}\n", file, error.text());
      ++tally.late;
    }
  }
}

TEST(StrewnPorts, WhatIsWrongIsFoundBeforeMeshing) {
  PCBMESH_NEEDS_TEST_DATA();
  Tally tally;
  for (const char* file :
       {"05_stickhub_2L_v6.kicad_pcb", "04_antmicro_si_test_4L_v6.kicad_pcb", "11_hackrf_one_rf_4L_v6.kicad_pcb.xz",
        "08_pico_ice_4L_v8.kicad_pcb.xz", "07_antmicro_myra_sip_4L_v7.kicad_pcb.xz"})
    for (const unsigned seed : {7U, 8U, 9U, 10U}) strew(file, 250, seed, tally);
  fmt::print("{} ports: {} refused before meshing, {} meshed, {} refused by the mesh alone\n", tally.strewn, tally.refused,
             tally.meshed, tally.late);
  EXPECT_GT(tally.meshed, 100);
  EXPECT_EQ(tally.late, 0);
}

}  // namespace
}  // namespace pcbmesh

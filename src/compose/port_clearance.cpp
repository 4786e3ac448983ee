// SPDX-License-Identifier: GPL-3.0-or-later
#include "src/compose/port_clearance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "pcbmesh/geometry/ring_contact.hpp"
#include "src/compose/port_words.hpp"

namespace pcbmesh::compose {
namespace {

using geometry::Point;
using geometry::Ring;
using Place = std::array<double, 2>;

/// Lines are looked at so far on either side of them: well above rounding to the grid, well below any feature.
constexpr double beside_nm = 25;
/// What is narrower than this is rounding, or closed by the tolerance of the overlay.
constexpr double sliver_nm = 500;
/// The least tolerance of the overlay.
constexpr double least_apart_nm = 1000;
/// Share of an edge that may miss its conductor; the mesh is held to the same.
constexpr double relative_tolerance = 2e-3;
/// Lines across a flat port, besides one through the middle of all that meets it.
constexpr int num_scans = 16;

int winding(const Ring& ring, Place p) {
  int turns = 0;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    const double ax = static_cast<double>(ring[j].x), ay = static_cast<double>(ring[j].y);
    const double bx = static_cast<double>(ring[i].x), by = static_cast<double>(ring[i].y);
    if ((ay <= p[1]) == (by <= p[1])) continue;
    const double side = (bx - ax) * (p[1] - ay) - (p[0] - ax) * (by - ay);
    if (by > ay && side > 0) ++turns;
    if (by < ay && side < 0) --turns;
  }
  return turns;
}

Point rounded(Place p) {
  return {std::llround(p[0]), std::llround(p[1])};
}
Place place_of(Point p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y)};
}

/// Something in the way, and how much of a line it takes.
struct Obstacle {
  std::string what;
  Place at{};
};

class Clearance {
 public:
  Clearance(const model::Model& model, const model::Port& port)
      : model_(model), port_(port), body_(model.bodies()[static_cast<std::size_t>(port.body)]) {
    geometry::Box box;
    for (const model::BodyShape& shape : model.shapes())
      if (shape.body == port.body)
        for (const Ring& ring : shape.rings) {
          footprint_.push_back(ring);
          box.add(geometry::bounds(ring));
        }
    box = box.grown(nm_per_um);
    for (const model::BodyShape& shape : model.shapes()) {
      if (shape.body >= model.first_guide_body()) continue;
      if (std::ranges::any_of(shape.rings, [&](const Ring& ring) { return geometry::bounds(ring).touches(box); }))
        near_.push_back(&shape);
    }
  }

  /// Empty = nothing is wrong.
  [[nodiscard]] std::string fault() const {
    if (std::string text = fault_of_corners(); !text.empty()) return text;
    return port_.faces == model::PortFaces::wall ? fault_of_wall() : fault_of_cap();
  }

 private:
  /// No tolerance is small enough to keep apart what lies nearer than this, and a port that is moved is none.
  [[nodiscard]] std::string fault_of_corners() const {
    std::vector<Point> corners;
    if (port_.faces == model::PortFaces::wall)
      corners.assign(port_.line.begin(), port_.line.end());
    else
      for (const Ring& ring : footprint_) corners.insert(corners.end(), ring.begin(), ring.end());
    for (const model::BodyShape* shape : near_) {
      if (shape->body != 0) continue;
      for (const Ring& ring : shape->rings)
        for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++)
          for (const Point p : corners)
            if (const double apart = geometry::distance_to_segment(p, ring[j], ring[i]); apart > 1 && apart < least_apart_nm)
              return fmt::format("lies {:.0f} nm from the side of the domain at {}; move it, or the side", apart,
                                 place_text(p));
    }
    return "";
  }

  /// What lies at a place, through the height of the domain.
  struct Column {
    std::vector<std::int32_t> present;  ///< bodies, ascending
  };

  [[nodiscard]] Column at(Place p) const {
    Column column;
    for (const model::BodyShape* shape : near_) {
      if (!column.present.empty() && column.present.back() == shape->body) continue;
      int turns = 0;
      for (const Ring& ring : shape->rings) turns += winding(ring, p);
      if (turns != 0) column.present.push_back(shape->body);
    }
    std::ranges::sort(column.present);
    column.present.erase(std::unique(column.present.begin(), column.present.end()), column.present.end());
    return column;
  }

  [[nodiscard]] model::Label label(const Column& column, std::int32_t slab) const {
    const auto num_slabs = static_cast<std::int32_t>(model_.slabs().size());
    return slab < 0 || slab >= num_slabs ? model::Label{} : model_.resolve(slab, column.present);
  }
  [[nodiscard]] static bool is_conductor(const model::Label& label) {
    return label.is_void() ? label.hollow_net >= board::no_net : label.net >= 0;
  }
  [[nodiscard]] bool has_conductor(const Column& column, std::int32_t face, std::int32_t slab, std::int32_t net) const {
    const std::int32_t sheet = model_.sheet_at(face, column.present);
    if (sheet >= 0 && model_.bodies()[static_cast<std::size_t>(sheet)].net == net) return true;
    const model::Label here = label(column, slab);
    return is_conductor(here) && (here.is_void() ? here.hollow_net : here.net) == net;
  }

  /// Why a terminal's copper is not there.
  [[nodiscard]] std::string what_is_at(const Column& column) const {
    if (column.present.empty() || column.present[0] != 0) return "the domain ends";
    if (column.present.size() < 2 || column.present[1] != 1) return "the board is cut out or ends";
    const model::Body* top = nullptr;
    for (const std::int32_t index : column.present) {
      const model::Body& body = model_.bodies()[static_cast<std::size_t>(index)];
      const bool is_hole = body.kind == model::BodyKind::hole || body.kind == model::BodyKind::filler;
      if (is_hole && (top == nullptr || body.priority >= top->priority)) top = &body;
    }
    return top != nullptr ? fmt::format("'{}' takes the copper away", top->name) : std::string("the copper ends");
  }
  [[nodiscard]] std::string net_in(const model::Label& label) const {
    return fmt::format("copper of net '{}' stands in it", model_.net_name(label.is_void() ? label.hollow_net : label.net));
  }

  /// Where a line from `a` to `b` crosses outlines, with its ends, in order; and the pieces between that are wide enough.
  [[nodiscard]] std::vector<std::pair<double, double>> pieces(Place a, Place b) const {
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    const double dx = (b[0] - a[0]) / length, dy = (b[1] - a[1]) / length;
    std::vector<double> marks{0, length};
    const auto add = [&](const Ring& ring) {
      for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
        const double px = static_cast<double>(ring[j].x) - a[0], py = static_cast<double>(ring[j].y) - a[1];
        const double qx = static_cast<double>(ring[i].x) - a[0], qy = static_cast<double>(ring[i].y) - a[1];
        const double p_side = dx * py - dy * px, q_side = dx * qy - dy * qx;
        if ((p_side < 0) == (q_side < 0)) continue;
        const double share = p_side / (p_side - q_side);
        const double t = dx * (px + share * (qx - px)) + dy * (py + share * (qy - py));
        if (t > 0 && t < length) marks.push_back(t);
      }
    };
    for (const model::BodyShape* shape : near_)
      for (const Ring& ring : shape->rings) add(ring);
    for (const Ring& ring : footprint_) add(ring);
    std::ranges::sort(marks);
    std::vector<std::pair<double, double>> found;
    for (std::size_t i = 1; i < marks.size(); ++i)
      if (marks[i] - marks[i - 1] > 2) found.emplace_back(marks[i - 1], marks[i]);
    return found;
  }

  /// How much of one edge of the port lies on its conductor, and what is where it does not.
  struct Edge {
    double touched_nm = 0, longest_gap_nm = 0;
    Obstacle missing;
    void add(double length, bool touches, const std::function<Obstacle()>& why) {
      if (touches) {
        touched_nm += length;
      } else if (length > longest_gap_nm) {
        longest_gap_nm = length;
        missing = why();
      }
    }
  };

  [[nodiscard]] std::string not_touched(const Edge& edge, double wanted_m, std::int32_t net) const {
    const double wanted_nm = wanted_m / metres_per_nm;
    if (edge.touched_nm >= wanted_nm * (1 - relative_tolerance)) return "";
    return fmt::format("touches net '{}' along {:.4g} um of its {:.4g} um long edge: near {} {}; move it or make it narrower",
                       model_.net_name(net), edge.touched_nm * 1e-3, wanted_nm * 1e-3, place_text(rounded(edge.missing.at)),
                       edge.missing.what.empty() ? "the copper ends" : edge.missing.what);
  }

  [[nodiscard]] std::string fault_of_wall() const {
    const Place a = place_of(port_.line[0]), b = place_of(port_.line[1]);
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    const Place along{(b[0] - a[0]) / length, (b[1] - a[1]) / length};
    const auto beside = [&](double t, double sign) {
      return Place{a[0] + t * along[0] - sign * beside_nm * along[1], a[1] + t * along[1] + sign * beside_nm * along[0]};
    };
    std::vector<std::pair<double, double>> both = pieces(beside(0, 1), beside(length, 1));
    const auto right_pieces = pieces(beside(0, -1), beside(length, -1));
    both.insert(both.end(), right_pieces.begin(), right_pieces.end());
    std::vector<double> marks;
    for (const auto& [from, to] : both) marks.insert(marks.end(), {from, to});
    std::ranges::sort(marks);
    Edge positive, negative;
    bool has_face = false;
    for (std::size_t i = 1; i < marks.size(); ++i) {
      const double piece = marks[i] - marks[i - 1], middle = 0.5 * (marks[i] + marks[i - 1]);
      if (piece <= 2) continue;
      const Column left = at(beside(middle, 1)), right = at(beside(middle, -1));
      const Place here{a[0] + middle * along[0], a[1] + middle * along[1]};
      for (std::int32_t slab = body_.first_slab; slab <= body_.last_slab; ++slab) {
        const model::Label one = label(left, slab), other = label(right, slab);
        const bool is_barred = is_conductor(one) || is_conductor(other);
        has_face = has_face || !(one.is_void() && other.is_void());
        if (port_.is_wave) {
          if (!is_barred && !one.is_void() && !other.is_void() && piece > sliver_nm)
            return fmt::format("must be on the hull, but the domain goes on beyond it near {}; give a side of the region",
                               place_text(rounded(here)));
          continue;
        }
        if (piece <= sliver_nm) continue;
        if (is_barred)
          return fmt::format("is barred near {}: {}; move it or make it narrower", place_text(rounded(here)),
                             net_in(is_conductor(one) ? one : other));
        if (one.is_void() && other.is_void())
          return fmt::format("is barred near {}: {}; move it or make it narrower", place_text(rounded(here)),
                             what_is_at(left.present.size() < right.present.size() ? right : left));
      }
      if (port_.is_wave) continue;
      const auto touches = [&](bool above, std::int32_t net) {
        const std::int32_t face = above ? body_.last_slab + 1 : body_.first_slab, slab = above ? face : face - 1;
        return has_conductor(left, face, slab, net) || has_conductor(right, face, slab, net);
      };
      const bool is_above = port_.direction[2] > 0;
      // On the hull one side is no part of the domain.
      const auto why = [&] { return Obstacle{what_is_at(left.present.size() < right.present.size() ? right : left), here}; };
      positive.add(piece, touches(is_above, port_.positive_net), why);
      negative.add(piece, touches(!is_above, port_.negative_net), why);
    }
    if (!has_face) return "has no face: it lies in copper or outside the board; move it";
    if (port_.is_wave) return "";
    if (std::string text = not_touched(positive, port_.positive_edge_m, port_.positive_net); !text.empty()) return text;
    return not_touched(negative, port_.negative_edge_m, port_.negative_net);
  }

  [[nodiscard]] bool is_inside(Place p) const {
    int turns = 0;
    for (const Ring& ring : footprint_) turns += winding(ring, p);
    return turns != 0;
  }

  /// What bars a flat port along one line across it.
  [[nodiscard]] std::optional<Obstacle> barred_along(Place a, Place b) const {
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    for (const auto& [from, to] : pieces(a, b)) {
      if (to - from <= sliver_nm) continue;
      const double share = 0.5 * (from + to) / length;
      const Place here{a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])};
      if (!is_inside(here)) continue;
      const Column column = at(here);
      const model::Label below = label(column, port_.face - 1), above = label(column, port_.face);
      if (is_conductor(below)) return Obstacle{net_in(below), here};
      if (is_conductor(above)) return Obstacle{net_in(above), here};
      if (const std::int32_t sheet = model_.sheet_at(port_.face, column.present); sheet >= 0)
        return Obstacle{fmt::format("'{}' lies in it", model_.bodies()[static_cast<std::size_t>(sheet)].name), here};
      if (below.is_void() && above.is_void()) return Obstacle{what_is_at(column), here};
    }
    return std::nullopt;
  }

  [[nodiscard]] std::string fault_of_cap() const {
    geometry::Box box;
    for (const Ring& ring : footprint_) box.add(geometry::bounds(ring));
    std::vector<double> heights;
    for (int i = 0; i < num_scans; ++i)
      heights.push_back(static_cast<double>(box.min.y) + (i + 0.5) / num_scans * static_cast<double>(box.max.y - box.min.y));
    for (const model::BodyShape* shape : near_)
      for (const Ring& ring : shape->rings) {
        const geometry::Box own = geometry::bounds(ring);
        if (own.min.y > box.min.y && own.max.y < box.max.y)
          heights.push_back(0.5 * static_cast<double>(own.min.y + own.max.y) + 0.5);
      }
    for (const double y : heights)
      if (const auto barred =
              barred_along({static_cast<double>(box.min.x) - 100, y}, {static_cast<double>(box.max.x) + 100, y}))
        return fmt::format("is barred near {}: {}; move it or make it narrower", place_text(rounded(barred->at)), barred->what);
    Edge positive, negative;
    for (const Ring& ring : footprint_)
      for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) measure_rim(ring[j], ring[i], positive, negative);
    if (std::string text = not_touched(positive, port_.positive_edge_m, port_.positive_net); !text.empty()) return text;
    return not_touched(negative, port_.negative_edge_m, port_.negative_net);
  }

  /// Edges of the footprint run counter-clockwise round it: what is beyond lies to their right.
  void measure_rim(Point from, Point to, Edge& positive, Edge& negative) const {
    const Place a = place_of(from), b = place_of(to);
    const double length = std::hypot(b[0] - a[0], b[1] - a[1]);
    if (length == 0) return;
    const Place out{(b[1] - a[1]) / length * beside_nm, -(b[0] - a[0]) / length * beside_nm};
    const Place shifted_a{a[0] + out[0], a[1] + out[1]}, shifted_b{b[0] + out[0], b[1] + out[1]};
    for (const auto& [begin, end] : pieces(shifted_a, shifted_b)) {
      const double share = 0.5 * (begin + end) / length;
      const Place here{shifted_a[0] + share * (b[0] - a[0]), shifted_a[1] + share * (b[1] - a[1])};
      const Column column = at(here);
      const auto touches = [&](std::int32_t net) {
        return has_conductor(column, port_.face, port_.face, net) || has_conductor(column, port_.face, port_.face - 1, net);
      };
      const auto why = [&] { return Obstacle{what_is_at(column), here}; };
      positive.add(end - begin, touches(port_.positive_net), why);
      negative.add(end - begin, touches(port_.negative_net), why);
    }
  }

  const model::Model& model_;
  const model::Port& port_;
  const model::Body& body_;
  std::vector<Ring> footprint_;
  std::vector<const model::BodyShape*> near_;
};

}  // namespace

std::vector<study::Fault> port_faults(const model::Model& model) {
  std::vector<study::Fault> faults;
  for (const model::Port& port : model.ports())
    if (const std::string fault = Clearance(model, port).fault(); !fault.empty())
      faults.push_back(
          {fmt::format("/ports/{}", port.study_index),
           fmt::format("port '{}' at ({:.6g}, {:.6g}) mm {}", port.name, port.at_m[0] * 1e3, port.at_m[1] * 1e3, fault)});
  return faults;
}

}  // namespace pcbmesh::compose

// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "pcbmesh/view/render.hpp"

namespace pcbmesh::view {

using Vec3 = std::array<double, 3>;

/// What shows of a mesh, before stretching: its box, and which of its storeys (slabs, or bands of cells) have a part in it.
struct Shown {
  explicit Shown(std::size_t num_storeys) : layers(num_storeys, -1) {}
  void add(const Vec3& p) {
    for (std::size_t k = 0; k < 3; ++k) {
      min[k] = std::min(min[k], p[k]);
      max[k] = std::max(max[k], p[k]);
    }
  }
  [[nodiscard]] bool is_empty() const { return min[0] > max[0]; }
  Vec3 min{std::numeric_limits<double>::max(), std::numeric_limits<double>::max(), std::numeric_limits<double>::max()};
  Vec3 max{std::numeric_limits<double>::lowest(), std::numeric_limits<double>::lowest(), std::numeric_limits<double>::lowest()};
  std::vector<std::int32_t> layers;  ///< per storey, from below: storeys of one layer stay together; -1 = nothing shows
};
[[nodiscard]] Shown shown_of(const mesh::PrismMesh& mesh, const Visibility& visibility);

/// Storeys set apart and stretched, and the camera in front of them.
class Stage {
 public:
  Stage(const Shown& shown, const PictureOptions& options);

  /// Mesh coordinates to the stage: z stretched, layers set apart.
  [[nodiscard]] Vec3 place(const Vec3& p, std::int32_t storey) const {
    return {p[0], p[1], p[2] * stretch_ + lift_[static_cast<std::size_t>(storey)]};
  }
  /// Stage to picture: x and y in pixels from the upper left corner, and nearness (greater = nearer, linear on the picture).
  [[nodiscard]] Vec3 project(const Vec3& p) const {
    const Vec3 seen = {right_[0] * p[0] + right_[1] * p[1] + right_[2] * p[2] - eye_[0],
                       up_[0] * p[0] + up_[1] * p[1] + up_[2] * p[2] - eye_[1],
                       towards_[0] * p[0] + towards_[1] * p[1] + towards_[2] * p[2] - eye_[2]};
    const double near = perspective_ ? 1.0 / -seen[2] : 1.0;
    return {centre_[0] + scale_ * seen[0] * near, centre_[1] - scale_ * seen[1] * near, perspective_ ? near : seen[2]};
  }
  [[nodiscard]] bool is_empty() const { return is_empty_; }

 private:
  void look(const PictureOptions& options, const std::array<Vec3, 8>& corners);
  double stretch_ = 1;
  std::vector<double> lift_;  ///< per storey
  Vec3 right_{}, up_{}, towards_{}, eye_{};
  std::array<double, 2> centre_{};
  double scale_ = 1;
  bool perspective_ = true, is_empty_ = true;
};

}  // namespace pcbmesh::view

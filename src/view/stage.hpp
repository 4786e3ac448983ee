// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <vector>

#include "pcbmesh/view/render.hpp"

namespace pcbmesh::view {

using Vec3 = std::array<double, 3>;

/// Slabs set apart and stretched, and the camera in front of them.
class Stage {
 public:
  Stage(const mesh::PrismMesh& mesh, const PictureOptions& options);

  /// Mesh coordinates to the stage: z stretched, layers set apart.
  [[nodiscard]] Vec3 place(const Vec3& p, std::int32_t slab) const {
    return {p[0], p[1], p[2] * stretch_ + lift_[static_cast<std::size_t>(slab)]};
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
  std::vector<double> lift_;  ///< per slab
  Vec3 right_{}, up_{}, towards_{}, eye_{};
  std::array<double, 2> centre_{};
  double scale_ = 1;
  bool perspective_ = true, is_empty_ = true;
};

}  // namespace pcbmesh::view

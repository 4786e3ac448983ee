// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cmath>

namespace pcbmesh::validation::checks {

using Vector3 = std::array<double, 3>;

[[nodiscard]] inline Vector3 operator-(const Vector3& a, const Vector3& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
[[nodiscard]] inline Vector3 cross(const Vector3& a, const Vector3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
[[nodiscard]] inline double dot(const Vector3& a, const Vector3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
[[nodiscard]] inline double triple(const Vector3& a, const Vector3& b, const Vector3& c) {
  return dot(cross(a, b), c);
}
[[nodiscard]] inline double length(const Vector3& a) {
  return std::sqrt(dot(a, a));
}

/// Six times the volume between the origin and the triangle a b c, positive if it is counter-clockwise seen from outside.
[[nodiscard]] inline double flux(const Vector3& a, const Vector3& b, const Vector3& c) {
  return triple(a, b, c);
}
/// The same for the bilinear patch over a b c d: exactly the mean of both ways to split it in triangles.
[[nodiscard]] inline double flux(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) {
  return 0.5 * (flux(a, b, c) + flux(a, c, d) + flux(a, b, d) + flux(b, c, d));
}

/// Sum with a running correction (Neumaier 1974): its error does not grow with the number of terms.
class CompensatedSum {
 public:
  void add(double x) {
    const double t = sum_ + x;
    correction_ += std::abs(sum_) >= std::abs(x) ? (sum_ - t) + x : (x - t) + sum_;
    sum_ = t;
  }
  [[nodiscard]] double value() const { return sum_ + correction_; }

 private:
  double sum_ = 0, correction_ = 0;
};

}  // namespace pcbmesh::validation::checks

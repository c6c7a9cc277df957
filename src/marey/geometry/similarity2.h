#pragma once

#include <cmath>

#include "marey/geometry/box.h"
#include "marey/geometry/vector.h"

namespace marey::geometry {

/// Turns, scales and shifts the image plane: what panning, tilting, zooming and rolling a distant camera does to an image, px.
/// Names of instances say what is mapped to what: `view_from_scene`.
struct Similarity2 {
  Matrix<2> turn = Matrix<2>::Identity();  ///< rotation times scale
  Vector<2> shift = Vector<2>::Zero();

  /// Scales by `scale` and turns by `angle` (rad, from x to y) about `centre`, then moves by `shift`.
  static Similarity2 about(const Vector<2>& centre, double scale, double angle, const Vector<2>& shift) {
    const double a = scale * std::cos(angle), b = scale * std::sin(angle);
    Matrix<2> turn;
    turn << a, -b, b, a;
    return {turn, centre - turn * centre + shift};
  }

  Vector<2> operator*(const Vector<2>& point) const { return turn * point + shift; }
  /// This one after the other.
  Similarity2 operator*(const Similarity2& other) const { return {turn * other.turn, turn * other.shift + shift}; }

  double scale() const { return std::hypot(turn(0, 0), turn(1, 0)); }

  Similarity2 inverse() const {
    const Matrix<2> back = turn.transpose() / (turn(0, 0) * turn(0, 0) + turn(1, 0) * turn(1, 0));
    return {back, -(back * shift)};
  }

  /// The box whose centre is moved and whose sides are scaled: boxes stay upright.
  Box operator*(const Box& box) const {
    const double by = scale();
    return Box::from_centre(*this * box.centre(), by * box.width, by * box.height);
  }
};

}  // namespace marey::geometry

#include "marey/solve/bodies/symmetry.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "marey/geometry/layout.h"

namespace marey::solve::bodies {
namespace {

/// Exchanges markers one by one, as long as all distances stay.
class Backtracking {
 public:
  Backtracking(std::span<const Vector<3>> layout, double tolerance) : layout_(layout), tolerance_(tolerance) {
    onto_.reserve(layout.size());
  }

  std::vector<Symmetry> run() {
    extend();
    return std::move(found_);
  }

 private:
  bool fits(int candidate) const {
    const auto next = onto_.size();
    for (std::size_t i = 0; i < next; ++i) {
      if (onto_[i] == candidate) return false;
      const double was = (layout_[next] - layout_[i]).norm();
      const double is = (layout_[static_cast<std::size_t>(candidate)] - layout_[static_cast<std::size_t>(onto_[i])]).norm();
      if (std::abs(was - is) > tolerance_) return false;
    }
    return true;
  }

  void extend() {
    if (found_.size() >= kMaxSymmetries) return;
    if (onto_.size() == layout_.size()) return keep();
    for (int candidate = 0; candidate < std::ssize(layout_); ++candidate) {
      if (!fits(candidate)) continue;
      onto_.push_back(candidate);
      extend();
      onto_.pop_back();
    }
  }

  void keep() {
    bool same = true;
    std::vector<Vector<3>> to;
    for (std::size_t i = 0; i < onto_.size(); ++i) {
      same &= onto_[i] == static_cast<int>(i);
      to.push_back(layout_[static_cast<std::size_t>(onto_[i])]);
    }
    if (same) return;
    Symmetry symmetry{onto_, geometry::rigid_fit(layout_, to), 0};
    for (std::size_t i = 0; i < to.size(); ++i)
      symmetry.worst = std::max(symmetry.worst, (symmetry.body_from_body * layout_[i] - to[i]).norm());
    if (symmetry.worst <= tolerance_) found_.push_back(std::move(symmetry));  // else it is the mirror's
  }

  std::span<const Vector<3>> layout_;
  double tolerance_;
  std::vector<int> onto_;
  std::vector<Symmetry> found_;
};

}  // namespace

std::vector<Symmetry> symmetries(std::span<const Vector<3>> layout, double tolerance) {
  return Backtracking(layout, tolerance).run();
}

std::string words_of(const Symmetry& symmetry) {
  const Vector<3> turn = geometry::angle_axis_of(symmetry.body_from_body.rotation);
  const double degrees = turn.norm() * 180 / std::numbers::pi;
  const Vector<3> axis = turn.normalized();
  int along = 0;
  axis.cwiseAbs().maxCoeff(&along);
  if (std::abs(axis[along]) > 0.99) return fmt::format("turned {:.0f}° about its {} axis", degrees, "xyz"[along]);
  return fmt::format("turned {:.0f}° about its axis ({:.2f}, {:.2f}, {:.2f})", degrees, axis.x(), axis.y(), axis.z());
}

}  // namespace marey::solve::bodies

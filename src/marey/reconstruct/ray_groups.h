#pragma once

#include <bit>
#include <optional>
#include <span>
#include <vector>

#include "marey/reconstruct/frame_rays.h"
#include "marey/reconstruct/triangulate.h"

namespace marey::reconstruct {

/// The rays of one frame as they are given away to points, each once.
class RayGroups {
 public:
  struct Group {
    SpacePoint point;
    int begin = 0, count = 0;  // in `members_`
    std::optional<int> expected;
  };

  void clear(const FrameRays& frame) {
    groups_.clear();
    members_.clear();
    taken_.assign(static_cast<std::size_t>(frame.size()), 0);
  }

  /// Those of `rays` that the point uses become its own. None of them may be taken.
  void add(std::span<const int> rays, const SpacePoint& point, std::optional<int> expected = std::nullopt) {
    Group group{point, static_cast<int>(members_.size()), 0, expected};
    for (std::size_t i = 0; i < rays.size(); ++i) {
      if (!(point.used >> i & 1)) continue;
      members_.push_back(rays[i]);
      taken_[static_cast<std::size_t>(rays[i])] = 1;
      ++group.count;
    }
    group.point.used = group.count == 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << group.count) - 1;
    groups_.push_back(group);
  }

  bool taken(int ray) const { return taken_[static_cast<std::size_t>(ray)] != 0; }
  std::span<const char> taken() const { return taken_; }
  std::span<const Group> groups() const { return groups_; }
  std::span<const int> members(const Group& group) const {
    return std::span(members_).subspan(static_cast<std::size_t>(group.begin), static_cast<std::size_t>(group.count));
  }

 private:
  std::vector<Group> groups_;
  std::vector<int> members_;
  std::vector<char> taken_;
};

/// A list of rays and their sight lines, side by side, to be triangulated. At most one ray a camera, at most 64.
class RayList {
 public:
  void clear() { rays_.clear(), lines_.clear(); }
  void add(const FrameRays& frame, int ray) {
    rays_.push_back(ray);
    lines_.push_back(frame.line(ray));
  }
  std::span<const int> rays() const { return rays_; }
  std::span<const SightLine> lines() const { return lines_; }
  int size() const { return static_cast<int>(rays_.size()); }

 private:
  std::vector<int> rays_;
  std::vector<SightLine> lines_;
};

}  // namespace marey::reconstruct

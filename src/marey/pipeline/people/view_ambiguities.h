// What a user should know of a camera that ought to stand, where its images show that it does not: it shakes, was turned or
// zooms, the video is cut, it shows a screen that is scrolled. Each sentence names the cause, and what helps; the first of each
// kind is known while the images still pass.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/frame.h"
#include "marey/core/rig.h"
#include "marey/source/stabilise/view_watch.h"

namespace marey::pipeline::people {

class ViewAmbiguities {
 public:
  /// `steadied`: the images were brought to the camera's rest.
  ViewAmbiguities(const RigCamera& camera, bool stabilised) : camera_(camera), stabilised_(stabilised) {}

  /// Whether it shakes, before the first frame: that holds where nothing worse is known later.
  void inspect_at_beginning(std::span<const Frame> samples);
  /// Each frame in order.
  void add(const Frame& frame) { view_.add(frame); }

  /// What is new since the last call, with the camera's name where it has one; each kind of thing once.
  std::vector<std::string> news();
  /// All that is known, the same.
  std::vector<std::string> warnings() const;

 private:
  RigCamera camera_;
  bool stabilised_;
  source::stabilise::ViewWatch view_;
  std::optional<std::string> shaking_;  // what to say of a camera that was not stabilised
  bool cut_reported_ = false, moved_reported_ = false, shaking_reported_ = false;
  std::int64_t next_search_ = 20;  // images whose motion is known
};

}  // namespace marey::pipeline::people

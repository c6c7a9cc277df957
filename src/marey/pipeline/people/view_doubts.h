// What a user should know of a camera that ought to stand, where its pictures show that it does not: it shakes, was turned or
// zooms, the video is cut, it shows a screen that is scrolled. Each sentence names the cause, and what helps; the first of each
// kind is known while the pictures still pass.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/frame.h"
#include "marey/core/rig.h"
#include "marey/source/steady/view_watch.h"

namespace marey::pipeline::people {

class ViewDoubts {
 public:
  /// `steadied`: the pictures were brought to the camera's rest.
  ViewDoubts(const RigCamera& camera, bool steadied) : camera_(camera), steadied_(steadied) {}

  /// Whether it shakes, before the first frame: that holds where nothing worse is known later.
  void look_at_beginning(std::span<const Frame> samples);
  /// Each frame in order.
  void add(const Frame& frame) { view_.add(frame); }

  /// What is new since the last call, with the camera's name where it has one; each kind of thing once.
  std::vector<std::string> news();
  /// All that is known, the same.
  std::vector<std::string> warnings() const;

 private:
  RigCamera camera_;
  bool steadied_;
  source::steady::ViewWatch view_;
  std::optional<std::string> shaking_;  // what to say of a camera that was not steadied
  bool cut_told_ = false, moved_told_ = false, shaking_told_ = false;
  std::int64_t next_look_ = 20;  // pictures whose motion is known
};

}  // namespace marey::pipeline::people

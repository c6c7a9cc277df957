#pragma once

#include <optional>
#include <string>

#include "marey/draw/mask_folder.h"
#include "marey/pipeline/corridor/foreground_sink.h"

namespace marey::pipeline::people {

/// Foregrounds of one camera's frames as a folder of masks (draw/mask_folder.h).
class MaskSink final : public corridor::ForegroundSink {
 public:
  /// The folder is made now. Throws Error if it cannot be made, or holds something.
  explicit MaskSink(const std::string& folder) : folder_(folder), name_(folder) {}

  std::string name() const override { return name_; }
  void write_foreground(const corridor::FrameForeground& given) override {
    const Foreground& all = given.foreground;
    folder_.add(given.frame, all.covered.empty() ? all.mask : all.covered, given.size);
  }
  void finish() override { folder_.finish(); }

 private:
  draw::MaskFolder folder_;
  std::string name_;
};

}  // namespace marey::pipeline::people

// What was done to a take, edit by edit, in words for people.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/edit/operation.h"
#include "marey/pipeline/take/edit_take.h"

namespace marey::pipeline::take {

/// One edit of a take's history. All text is plain: names and edits may be an untrusted client's.
struct EditLine {
  struct Gap {
    std::string track;
    edit::FrameRange frames;
    edit::FillMethod method{};
    double expected_m = 0;
  };

  std::int64_t id = 0;
  std::optional<std::int64_t> parent;
  std::string operation;  ///< "swap"
  std::string words;      ///< "swap LKNE, RKNE, frames 120 to 180"; tracks are called as they were when it was done
  std::vector<Gap> gaps;  ///< of a fill
  bool counts = false;
};

/// All of them, by id.
std::vector<EditLine> lines_of(const EditHistory& history);

}  // namespace marey::pipeline::take

#pragma once

#include <cstddef>
#include <span>

namespace marey {

/// What one input may ask for at most, so that a few bytes cannot make hours of work or gigabytes of memory. Each stands far above
/// today's recordings; users who have more raise it. Messages name the limit as it is named here.
struct Limits {
  std::size_t label_bytes = 4096;         ///< of a track's or a team's name
  std::size_t tracks = 100'000;           ///< of one recording
  std::size_t pairs_a_frame = 4'000'000;  ///< true things × reported ones of one frame that are compared: 2,000 × 2,000
  std::size_t observations = 20'000;      ///< of all cameras at one instant, matched with each other
  std::size_t image_px = 268'435'456;     ///< of one image: 16,384 × 16,384

  /// What holds in this process where a caller says nothing else.
  static const Limits& in_force();
  /// To be called before anything is read: by a program for its whole run.
  static void put_in_force(const Limits& limits);
};

struct NamedLimit {
  const char* name;
  const char* meaning;
  std::size_t Limits::* value;
};

/// Every limit, in the order of the struct.
std::span<const NamedLimit> all_limits();

}  // namespace marey

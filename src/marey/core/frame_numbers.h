#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace marey {

/// How a file numbers its frames and when it says they were, gathered while it is read. One number that is wrong (frame
/// 999,999,999, a time years ahead) is found before a person walks through all the frames between, and does not change the rate.
class FrameNumbers {
 public:
  /// More frames than this within a file's range and not there are a mistake: a day at 100 Hz.
  static constexpr std::int64_t kMaxMissing = 10'000'000;

  /// A row of the file; rows of one frame stand together. `time` is s.
  void add(std::int64_t frame, std::optional<double> time = std::nullopt);

  /// Throws Error, "name: frames 0 to 1000000000 are named, of which 5 are there; a number must be wrong". To be asked when all is
  /// read: of frames in any order each run of rows counts as one that is there.
  void check(std::string_view name) const;

  /// Frames a second: that of the median step, as exactly as all steps that agree with it give it. Nothing if no two frames have
  /// times that go likewise as their numbers.
  std::optional<double> rate_hz() const;

  std::int64_t count() const { return count_; }

 private:
  std::int64_t first_ = 0, last_ = 0, here_ = 0, count_ = 0;
  std::optional<double> time_;
  std::vector<std::pair<double, double>> steps_;  // frames, s; this many of the first as settle the rate
};

}  // namespace marey

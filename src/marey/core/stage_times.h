#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace marey {

/// How long one step took, over any number of frames, in constant memory: counts in bins that grow by 5 %, from 0.1 µs to minutes.
class StageTimes {
 public:
  void add(double seconds) {
    const double bin = seconds > kMinValue ? std::log(seconds / kMinValue) / kStep : 0;
    ++counts_[static_cast<std::size_t>(std::min<double>(bin, kBins - 1))];
    ++total_;
  }

  std::int64_t count() const { return total_; }

  /// s that `share` in (0, 1] of the frames did not take longer than, to 5 %; 0 where there was none.
  double quantile(double fraction) const {
    if (total_ == 0) return 0;
    const auto required = static_cast<std::int64_t>(std::ceil(fraction * static_cast<double>(total_)));
    std::int64_t below = 0;
    for (std::size_t i = 0; i < kBins; ++i) {
      below += counts_[i];
      if (below >= required) return kMinValue * std::exp(kStep * (static_cast<double>(i) + 0.5));
    }
    return kMinValue * std::exp(kStep * kBins);
  }

 private:
  static constexpr std::size_t kBins = 440;
  static constexpr double kMinValue = 1e-7;  // s
  static constexpr double kStep = 0.05;

  std::array<std::int64_t, kBins> counts_{};
  std::int64_t total_ = 0;
};

}  // namespace marey

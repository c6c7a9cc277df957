#pragma once

#include <chrono>

#include "marey/core/stage_times.h"

namespace marey::pipeline::keypoints {

/// Adds to the times of a step how long it lives.
class Stopwatch {
 public:
  explicit Stopwatch(StageTimes& times) : times_(times) {}
  ~Stopwatch() { times_.add(std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_).count()); }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  StageTimes& times_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace marey::pipeline::keypoints

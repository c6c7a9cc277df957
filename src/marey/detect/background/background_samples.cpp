#include "marey/detect/background/background_samples.h"

#include <utility>

namespace marey::detect::background {

void SceneSamples::begin() {
  *this = {};
  thinned_ = 0;
}

bool SceneSamples::keep(const FramePlanes& planes, double age_s) {
  if (thinned_ >= kTimes || age_s < next_s_) return false;
  next_s_ += interval_s_;
  luma_.push_back(planes.luma.clone());
  if (!planes.cb.empty()) {
    cb_.push_back(planes.cb.clone());
    cr_.push_back(planes.cr.clone());
  }
  const std::size_t count = luma_.size();
  return count == kMaxCount || (thinned_ == 0 && (count == kMaxCount / 4 || count == kMaxCount / 2));
}

void SceneSamples::forget() {
  for (std::vector<cv::Mat>* planes : {&luma_, &cb_, &cr_}) planes->clear();
}

void SceneSamples::thin() {
  if (luma_.size() < kMaxCount) return;
  interval_s_ *= 2;
  const bool last = ++thinned_ >= kTimes;
  for (std::vector<cv::Mat>* planes : {&luma_, &cb_, &cr_}) {
    std::vector<cv::Mat> left;
    for (std::size_t i = 1; i < planes->size() && !last; i += 2) left.push_back(std::move((*planes)[i]));
    *planes = std::move(left);
  }
}

}  // namespace marey::detect::background

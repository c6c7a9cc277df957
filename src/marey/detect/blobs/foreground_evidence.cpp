#include "marey/detect/blobs/foreground_evidence.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "marey/core/error.h"

namespace marey::detect::blobs {
namespace {

constexpr int kUsualStep = 5;             // px, as the paper's grid is remembered
constexpr float kForeground = 4;          // standard deviations from all that was learned of a point
constexpr std::size_t kFewestFrames = 3;  // frames that a median can be taken of

}  // namespace

ForegroundEvidence::ForegroundEvidence(const ForegroundEvidenceOptions& options) : options_(options) {
  if (options.step && *options.step < 1) throw Error("the grid's points are {} px apart; 1 is the least", *options.step);
  if (options.foreground_kinds < 1) throw Error("{} kinds of foreground; 1 is the least", options.foreground_kinds);
  if (!(options.most_evidence > 0)) throw Error("a point tells {} nats at most; it must be positive", options.most_evidence);
}

void ForegroundEvidence::prime(std::span<const Frame> samples) {
  std::vector<cv::Mat> seen;
  for (const Frame& frame : samples) seen.push_back(filter_responses(frame.picture, options_.step.value_or(kUsualStep)));
  if (seen.size() >= kFewestFrames) learn(seen);
}

std::shared_ptr<const BlobEvidence> ForegroundEvidence::of(const Frame& frame) {
  const int step = options_.step.value_or(kUsualStep);
  const cv::Mat responses = filter_responses(frame.picture, step);
  if (background_.empty()) {
    waiting_.push_back(responses);
    if (std::ssize(waiting_) >= options_.learning_frames) learn(std::exchange(waiting_, {}));
    return nullptr;
  }
  if (responses.size() != grid_) throw Error("{}", "the pictures of a camera change their size within the recording");
  auto evidence = std::make_shared<BlobEvidence>();
  evidence->step = step;
  evidence->origin = Vector<2>::Constant(0.5 * (step - 1));
  evidence->log_ratio.create(grid_, CV_32FC1);
  const auto most = static_cast<float>(options_.most_evidence);
  for (int row = 0; row < grid_.height; ++row) {
    const Response* response = responses.ptr<Response>(row);
    const PointBackground* background = &background_[static_cast<std::size_t>(row) * static_cast<std::size_t>(grid_.width)];
    float* ratio = evidence->log_ratio.ptr<float>(row);
    for (int column = 0; column < grid_.width; ++column) {
      ratio[column] =
          std::clamp(log_density(foreground_, response[column]) - background[column].log_density(response[column]), -most, most);
    }
  }
  return evidence;
}

void ForegroundEvidence::learn(const std::vector<cv::Mat>& seen) {
  grid_ = seen.front().size();
  const Response noise = response_noise(seen);
  std::vector<Response> of_point;
  background_.clear();
  background_.reserve(static_cast<std::size_t>(grid_.area()));
  for (int at = 0; at < grid_.area(); ++at) {
    of_point.clear();
    for (const cv::Mat& grid : seen) of_point.push_back(grid.at<Response>(at / grid_.width, at % grid_.width));
    background_.emplace_back(of_point, noise);
  }
  foreground_ = learn_foreground(outliers(seen), options_.foreground_kinds, options_.seed);
}

std::vector<Response> ForegroundEvidence::outliers(const std::vector<cv::Mat>& seen) const {
  std::vector<Response> found;
  for (const cv::Mat& grid : seen) {
    for (int at = 0; at < grid_.area(); ++at) {
      const Response& response = grid.at<Response>(at / grid_.width, at % grid_.width);
      if (background_[static_cast<std::size_t>(at)].distance(response) > kForeground) found.push_back(response);
    }
  }
  return found;
}

}  // namespace marey::detect::blobs

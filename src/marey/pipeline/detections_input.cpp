#include "marey/pipeline/detections_input.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/mot.h"

namespace marey {
namespace {

constexpr double kUsualRate = 25;
/// The share of detections, by rank, that is too weak to begin a track (TrackerOptions::confident).
constexpr double kWeakShare = 0.25;
constexpr double kConfident = 0.5;

bool is_probability(const std::vector<LabelledBox>& boxes) {
  return std::all_of(boxes.begin(), boxes.end(), [](const LabelledBox& box) { return box.score >= 0 && box.score <= 1; });
}

/// Replaces scores of an unknown scale by their rank, bent so that kWeakShare of them stay below kConfident.
void rank_scores(std::vector<LabelledBox>& boxes) {
  std::vector<double> sorted;
  for (const LabelledBox& box : boxes) sorted.push_back(box.score);
  std::sort(sorted.begin(), sorted.end());
  for (LabelledBox& box : boxes) {
    const auto not_better = std::upper_bound(sorted.begin(), sorted.end(), box.score) - sorted.begin();
    const double rank = static_cast<double>(not_better) / static_cast<double>(sorted.size());
    box.score =
        rank < kWeakShare ? rank / kWeakShare * kConfident : kConfident + (rank - kWeakShare) / (1 - kWeakShare) * (1 - kConfident);
  }
}

class EmptyFrames final : public Source {
 public:
  EmptyFrames(const std::string& name, double rate_hz, std::int64_t count, std::vector<std::string> warnings)
      : rate_hz_(rate_hz), count_(count), warnings_(std::move(warnings)) {
    info_.name = name;
    info_.rate_hz = rate_hz;
    info_.frame_count = count;
  }

  const SourceInfo& info() const override { return info_; }
  std::vector<std::string> warnings() const override { return warnings_; }
  std::optional<Frame> next() override {
    if (next_index_ == count_) return std::nullopt;
    Frame frame;
    frame.index = next_index_++;
    frame.time = timestamp_from_seconds(static_cast<double>(frame.index) / rate_hz_);
    return frame;
  }

 private:
  SourceInfo info_;
  double rate_hz_;
  std::int64_t count_;
  std::vector<std::string> warnings_;
  std::int64_t next_index_ = 0;
};

constexpr double kPlaceNoise = 0.05;  // of a detector's boxes, in their heights

class KnownDetections final : public Detector {
 public:
  explicit KnownDetections(std::vector<LabelledBox> boxes) : boxes_(std::move(boxes)) {}

  Detections detect(const Frame& frame, std::span<const Expected> /*expected*/) override {
    Detections result;
    for (; at_ < boxes_.size() && boxes_[at_].frame <= frame.index; ++at_) {
      const LabelledBox& seen = boxes_[at_];
      if (seen.frame < frame.index) continue;  // of a frame that nobody asked for
      Detection detection;
      detection.centre = seen.box.centre();
      detection.covariance = std::pow(kPlaceNoise * seen.box.height, 2) * Matrix<2>::Identity();
      detection.area = seen.box.area();
      detection.box = seen.box;
      detection.score = seen.score;
      result.detections.push_back(detection);
    }
    return result;
  }

 private:
  std::vector<LabelledBox> boxes_;  // by frame
  std::size_t at_ = 0;
};

}  // namespace

DetectionsInput open_detections(const std::string& path, std::optional<double> rate_hz) {
  MotTable table = read_mot(path, MotKind::detections);
  if (table.boxes.empty()) throw Error("{}: holds no detections; lines are frame,-1,left,top,width,height,score", path);
  if (!rate_hz) {
    table.warnings.push_back(fmt::format(
        "{}: detections do not tell their rate: {} frames a second were assumed; say otherwise with --rate", path, kUsualRate));
  }
  if (!is_probability(table.boxes)) {
    rank_scores(table.boxes);
    table.warnings.push_back(fmt::format("{}: scores are not within 0 and 1; they were ranked instead", path));
  } else if (std::none_of(table.boxes.begin(), table.boxes.end(), [](const LabelledBox& box) { return box.score >= kConfident; })) {
    rank_scores(table.boxes);
    table.warnings.push_back(
        fmt::format("{}: no score reaches {}, from which a track begins; they were ranked instead", path, kConfident));
  }
  const std::int64_t count = std::int64_t{table.boxes.back().frame} + 1;
  return {std::make_unique<EmptyFrames>(path, rate_hz.value_or(kUsualRate), count, std::move(table.warnings)),
          std::make_unique<KnownDetections>(std::move(table.boxes))};
}

}  // namespace marey

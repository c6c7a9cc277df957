#include "marey/format/tracks/detections.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <optional>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/frame_numbers.h"
#include "marey/core/time.h"
#include "marey/format/tracks/mot.h"

namespace marey::format::tracks {
namespace {

/// The share of detections, by rank, that is too weak to begin a track (TrackerOptions::confident).
constexpr double kWeakFraction = 0.25;
constexpr double kConfident = 0.5;

/// Replaces scores of an unknown scale by their rank, bent so that kWeakFraction of them stay below kConfident.
void rank_scores(std::vector<LabelledBox>& boxes) {
  std::vector<double> sorted;
  for (const LabelledBox& box : boxes) sorted.push_back(box.score);
  std::sort(sorted.begin(), sorted.end());
  for (LabelledBox& box : boxes) {
    const auto not_better = std::upper_bound(sorted.begin(), sorted.end(), box.score) - sorted.begin();
    const double rank = static_cast<double>(not_better) / static_cast<double>(sorted.size());
    box.score = rank < kWeakFraction ? rank / kWeakFraction * kConfident
                                     : kConfident + (rank - kWeakFraction) / (1 - kWeakFraction) * (1 - kConfident);
  }
}

constexpr double kPositionNoise = 0.05;  // of a detector's boxes, in their heights

Detection detection_of(const LabelledBox& detected) {
  Detection detection;
  detection.centre = detected.box.centre();
  detection.covariance = std::pow(kPositionNoise * detected.box.height, 2) * Matrix<2>::Identity();
  detection.area = detected.box.area();
  detection.box = detected.box;
  detection.score = detected.score;
  return detection;
}

/// What has to be known of all detections before the first is inspected.
struct Survey {
  std::int64_t frames = 0;  ///< up to the last box's; 0 without any
  bool in_order = true;
  bool probabilities = true;  ///< scores are within 0 and 1
  bool confident = false;     ///< one reaches kConfident
  std::vector<std::string> warnings;
  FrameNumbers numbers;  ///< from 1, as in the file

  void add(const LabelledBox& box) {
    numbers.add(box.frame + 1);
    in_order &= box.frame + 1 >= frames;
    frames = std::max<std::int64_t>(frames, box.frame + 1);
    probabilities &= box.score >= 0 && box.score <= 1;
    confident |= box.score >= kConfident;
  }
};

Survey survey(const std::string& path) {
  Survey found;
  MotReader reader(path);
  while (const auto piece = reader.next()) {
    for (const LabelledBox& box : *piece) found.add(box);
  }
  found.warnings = reader.warnings();
  found.numbers.check(path);
  return found;
}

Survey survey(const MotTable& table) {
  Survey found;
  for (const LabelledBox& box : table.boxes) found.add(box);
  found.warnings = table.warnings;
  return found;
}

/// Whether it can be read twice.
bool is_plain_file(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored);
}

}  // namespace

/// Boxes by frame, one at a time: from memory, or from a file as they are wanted.
class DetectionReader::Boxes {
 public:
  explicit Boxes(std::vector<LabelledBox> boxes) : own_(std::move(boxes)), piece_(own_) {}
  explicit Boxes(MotReader reader) : reader_(std::move(reader)) {}

  /// The next box; none at the end.
  const LabelledBox* front() {
    while (piece_.empty()) {
      const auto next = reader_ ? reader_->next() : std::nullopt;
      if (!next) return nullptr;
      piece_ = *next;
    }
    return &piece_.front();
  }

  /// After `front`.
  void pop() { piece_ = piece_.subspan(1); }

 private:
  std::vector<LabelledBox> own_;
  std::optional<MotReader> reader_;
  std::span<const LabelledBox> piece_;  // the rest of it
};

DetectionReader::DetectionReader(const std::string& path, std::optional<double> rate_hz) {
  MotTable table;
  Survey known;
  const bool twice = is_plain_file(path);
  if (twice) known = survey(path);
  const bool piecewise = twice && known.in_order && known.probabilities && known.confident;
  if (!piecewise) {
    table = read_mot(path, MotKind::detections);
    known = survey(table);
  }
  if (known.frames == 0) throw Error("{}: holds no detections; lines are frame,-1,left,top,width,height,score", path);
  warnings_ = std::move(known.warnings);
  if (!rate_hz) {
    warnings_.push_back(
        fmt::format("{}: detections do not specify their rate: {} frames a second were assumed; say otherwise with --rate", path,
                    kDefaultRate));
  }
  if (!known.probabilities || !known.confident) rank_scores(table.boxes);
  if (!known.probabilities) {
    warnings_.push_back(fmt::format("{}: scores are not within 0 and 1; they were ranked instead", path));
  } else if (!known.confident) {
    warnings_.push_back(
        fmt::format("{}: no score reaches {}, from which a track begins; they were ranked instead", path, kConfident));
  }
  info_.name = path;
  info_.rate_hz = rate_hz.value_or(kDefaultRate);
  info_.frame_count = known.frames;
  boxes_ = piecewise ? std::make_unique<Boxes>(MotReader(path)) : std::make_unique<Boxes>(std::move(table.boxes));
}

DetectionReader::~DetectionReader() = default;
DetectionReader::DetectionReader(DetectionReader&&) noexcept = default;

std::optional<CameraFrame> DetectionReader::next() {
  if (next_index_ == info_.frame_count) return std::nullopt;
  CameraFrame result;
  result.frame.index = next_index_++;
  result.frame.time = timestamp_from_seconds(static_cast<double>(result.frame.index) / *info_.rate_hz);
  auto& detections = result.detections.emplace();
  for (const LabelledBox* detected = boxes_->front(); detected != nullptr && detected->frame <= result.frame.index;
       detected = boxes_->front()) {
    if (detected->frame == result.frame.index) detections.push_back(detection_of(*detected));  // else its frame went by
    boxes_->pop();
  }
  return result;
}

}  // namespace marey::format::tracks

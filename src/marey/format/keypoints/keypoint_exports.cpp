#include "marey/format/keypoints/keypoint_exports.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/core/frame_numbers.h"
#include "marey/core/keypoint_sets.h"
#include "marey/format/format.h"
#include "marey/format/keypoints/keypoint_file.h"

namespace marey::format::keypoints {
namespace {

double confidence_of(const Keypoint<2>& point) {
  return point.visibility * point.presence;
}

/// x, y, confidence, x, …; 0, 0, 0 for a point that is absent.
void append_triples(std::string& text, const Keypoints<2>& person) {
  auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < person.points.size(); ++i) {
    if (i > 0) text += ',';
    const auto& point = person.points[i];
    // Who reads it takes a confidence of 0 for a point that is absent.
    if (point) {
      fmt::format_to(out, "{:.3f},{:.3f},{:.4f}", point->position.x(), point->position.y(), std::max(1e-4, confidence_of(*point)));
    } else {
      text += "0,0,0";
    }
  }
}

void require_frame(std::int64_t frame, const std::string& path) {
  if (frame < 0 || frame > FrameNumbers::kMaxMissing)
    throw Error("{}: frame {} is not supported; a video has at most {}", path, frame, FrameNumbers::kMaxMissing);
}

/// What both sinks share: the people of an image's instants.
class KeypointExport : public Sink {
 public:
  explicit KeypointExport(std::string path) : path_(std::move(path)) {}

  std::string name() const override { return path_; }
  SinkRequirements begin(const RecordingHeader& header) override {
    if (header.frame.metric() || !header.keypoints)
      throw Error("{}: such a file holds people's keypoints in images; marey track --targets keypoints finds them", path_);
    begin_export(header);
    return {};
  }
  void write(const Instant& instant) override {
    require_frame(instant.index, path_);
    people_.clear();
    for (const Sample& sample : instant.samples) {
      if (sample.keypoints) people_.push_back({sample.keypoints.get(), sample.box, number(sample.track)});
    }
    add(instant.index, people_);
  }

 protected:
  virtual void begin_export(const RecordingHeader& header) = 0;
  virtual void add(std::int64_t frame, std::vector<ExportedPerson>& people) = 0;

 private:
  std::string path_;
  std::vector<ExportedPerson> people_;
};

class CocoExport final : public KeypointExport {
 public:
  explicit CocoExport(const std::string& path) : KeypointExport(path), writer_(path) {}
  void finish() override { writer_.finish(); }

 private:
  void begin_export(const RecordingHeader& header) override {
    std::optional<cv::Size> size;
    if (header.rig && !header.rig->cameras.empty()) size = header.rig->cameras.front().size;
    writer_.begin(*header.keypoints, header.rate_hz > 0 ? std::optional(header.rate_hz) : std::nullopt, size);
  }
  void add(std::int64_t frame, std::vector<ExportedPerson>& people) override { writer_.add(frame, people); }

  CocoWriter writer_;
};

class OpenPoseExport final : public KeypointExport {
 public:
  explicit OpenPoseExport(const std::string& path) : KeypointExport(path), folder_(path) {}
  void finish() override { folder_.finish(); }

 private:
  void begin_export(const RecordingHeader& header) override { body_.emplace(*header.keypoints); }
  void add(std::int64_t frame, std::vector<ExportedPerson>& people) override {
    bodies_.clear();
    bodies_.reserve(people.size());
    for (ExportedPerson& person : people) {
      bodies_.push_back(body_->of(*person.keypoints));
      person.keypoints = &bodies_.back();
    }
    folder_.add(frame, people);
  }

  OpenPoseFolder folder_;
  std::optional<OpenPoseBody> body_;
  std::vector<Keypoints<2>> bodies_;
};

template <typename Export>
std::unique_ptr<Sink> create_export(const std::string& path, const WritePlan&) {
  return std::make_unique<Export>(path);
}

}  // namespace

void CocoWriter::begin(const KeypointSet& set, std::optional<double> rate_hz, std::optional<cv::Size> size) {
  size_ = size;
  nlohmann::json category = {{"id", 1}, {"name", "person"}, {"keypoints", set.points}, {"skeleton", nlohmann::json::array()}};
  for (const auto& [from, to] : set.bones) category["skeleton"].push_back({from + 1, to + 1});
  std::string text = "{";
  if (rate_hz) text += fmt::format(R"("info":{{"rate_hz":{}}},)", *rate_hz);
  file_.write(fmt::format("{}\"categories\":[{}],\n\"annotations\":[", text, category.dump()));
}

void CocoWriter::add(std::int64_t frame, const std::vector<ExportedPerson>& people) {
  std::string text;
  auto out = std::back_inserter(text);
  for (const ExportedPerson& person : people) {
    const auto known = std::count_if(person.keypoints->points.begin(), person.keypoints->points.end(),
                                     [](const auto& point) { return point.has_value(); });
    fmt::format_to(out, "{}\n{{\"id\":{},\"image_id\":{},\"category_id\":1,\"iscrowd\":0,\"score\":{:.4f},\"num_keypoints\":{},",
                   annotations_ > 0 ? "," : "", annotations_ + 1, frame, person.keypoints->presence, known);
    ++annotations_;
    if (person.id) fmt::format_to(out, "\"track_id\":{},", *person.id);
    if (person.box)
      fmt::format_to(out, "\"bbox\":[{:.2f},{:.2f},{:.2f},{:.2f}],\"area\":{:.1f},", person.box->left, person.box->top,
                     person.box->width, person.box->height, person.box->width * person.box->height);
    text += "\"keypoints\":[";
    append_triples(text, *person.keypoints);
    text += "]}";
  }
  file_.write(text);
  frames_ = std::max(frames_, frame + 1);
}

void CocoWriter::finish() {
  file_.write("\n],\n\"images\":[");
  for (std::int64_t frame = 0; frame < frames_; ++frame) {
    std::string image = fmt::format(R"({}{{"id":{})", frame == 0 ? "" : ",", frame);
    if (size_) image += fmt::format(R"(,"width":{},"height":{})", size_->width, size_->height);
    file_.write(image + "}");
  }
  file_.write("]}\n");
  file_.finish();
}

OpenPoseBody::OpenPoseBody(const KeypointSet& set) {
  const auto find = [&](std::string_view name) -> std::optional<int> {
    for (std::size_t i = 0; i < set.points.size(); ++i) {
      if (common_keypoint_name(set.points[i]) == name) return static_cast<int>(i);
    }
    return std::nullopt;
  };
  for (const std::string& name : keypoint_set_named("body_25").points) {
    From from{.point = find(name), .left = {}, .right = {}};
    if (!from.point && (name == "neck" || name == "mid_hip")) {
      const std::string of = name == "neck" ? "shoulder" : "hip";
      from.left = find("left_" + of), from.right = find("right_" + of);
    }
    from_.push_back(from);
  }
}

Keypoints<2> OpenPoseBody::of(const Keypoints<2>& person) const {
  Keypoints<2> body;
  body.presence = person.presence;
  const auto at = [&](const std::optional<int>& index) {
    return index ? person.points[static_cast<std::size_t>(*index)] : std::optional<Keypoint<2>>();
  };
  for (const From& from : from_) {
    std::optional<Keypoint<2>> point = at(from.point);
    const std::optional<Keypoint<2>> left = at(from.left), right = at(from.right);
    if (!from.point && left && right) {
      point = Keypoint<2>{.position = (left->position + right->position) / 2,
                          .covariance = (left->covariance + right->covariance) / 4,
                          .visibility = std::min(left->visibility, right->visibility),
                          .presence = std::min(left->presence, right->presence)};
    }
    body.points.push_back(point);
  }
  return body;
}

OpenPoseFolder::OpenPoseFolder(const std::string& folder) : folder_(folder) {
  while (folder_.size() > 1 && folder_.ends_with('/')) folder_.pop_back();
  name_ = std::filesystem::path(folder_).filename().string();
  if (name_.ends_with("_json")) name_.resize(name_.size() - 5);
  std::error_code problem;
  made_ = std::filesystem::create_directories(folder_, problem);
  if (problem || !std::filesystem::is_directory(folder_, problem))
    throw Error("{}: cannot be made a folder for OpenPose's files", folder_);
  if (!std::filesystem::is_empty(folder_, problem) || problem)
    throw Error("{}: is not empty; OpenPose's files go into a folder of their own", folder_);
}

OpenPoseFolder::~OpenPoseFolder() {
  if (finished_) return;
  std::error_code ignored;
  for (std::int64_t frame = 0; frame < frames_; ++frame) std::filesystem::remove(path_of(frame), ignored);
  if (made_) std::filesystem::remove(folder_, ignored);  // only where it is empty
}

std::string OpenPoseFolder::path_of(std::int64_t frame) const {
  return (std::filesystem::path(folder_) / fmt::format("{}_{:012}_keypoints.json", name_, frame)).string();
}

void OpenPoseFolder::add(std::int64_t frame, const std::vector<ExportedPerson>& people) {
  for (; frames_ <= frame; ++frames_) {
    std::string text = R"({"version":1.3,"people":[)";
    for (std::size_t i = 0; frames_ == frame && i < people.size(); ++i) {
      text += fmt::format(R"({}{{"person_id":[{}],"pose_keypoints_2d":[)", i > 0 ? "," : "", people[i].id.value_or(-1));
      append_triples(text, *people[i].keypoints);
      text += "]}";
    }
    WholeFile file(path_of(frames_));
    file.write(text + "]}\n");
    file.finish();
  }
}

void write_coco_keypoints(const KeypointSequence& sequence, const std::string& path) {
  CocoWriter writer(path);
  writer.begin(sequence.set, sequence.rate_hz, sequence.size);
  for (std::size_t frame = 0; frame < sequence.frames.size(); ++frame) {
    std::vector<ExportedPerson> people;
    for (const Keypoints<2>& person : sequence.frames[frame]) people.push_back({.keypoints = &person, .box = {}, .id = {}});
    writer.add(static_cast<std::int64_t>(frame), people);
  }
  writer.finish();
}

Format coco_format() {
  return {.name = "coco",
          .title = "COCO keypoints",
          .endings = ".json",
          .holds = Content::image,
          .detail =
              "px; annotations with `track_id`, images and a category that names the points; a point's third number is its "
              "visibility × presence. `marey reconstruct --targets keypoints` reads it",
          .create = create_export<CocoExport>,
          .while_recording = true};
}

Format openpose_format() {
  return {.name = "openpose",
          .title = "OpenPose's folder of keypoints",
          .endings = "_json",
          .holds = Content::image,
          .detail =
              "px; a new folder, a JSON file per frame with BODY_25: the neck is midway between the shoulders, small toes are "
              "absent. `marey reconstruct --targets keypoints` reads it",
          .create = create_export<OpenPoseExport>,
          .while_recording = true};
}

}  // namespace marey::format::keypoints

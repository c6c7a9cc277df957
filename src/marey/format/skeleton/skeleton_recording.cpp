#include "marey/format/skeleton/skeleton_recording.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <optional>
#include <utility>
#include <vector>

#include "marey/core/error.h"

namespace marey::format::skeleton {
namespace {

namespace fs = std::filesystem;

constexpr double kRestRateHz = 30;
constexpr std::size_t kFewJoints = 100, kMaxJointsACoordinate = 10;

class SkeletonReader : public FileReader {
 public:
  SkeletonReader(SkeletonFile file, const std::string& path) : file_(std::move(file)) {
    Skeleton& skeleton = file_.skeleton;
    if (skeleton.segments.size() > kFewJoints &&
        skeleton.segments.size() > kMaxJointsACoordinate * std::max<std::size_t>(1, skeleton.coordinates.size()))
      throw Error("{}: {} joints that {} numbers a frame move; is this a skeleton?", path, skeleton.segments.size(),
                  skeleton.coordinates.size());
    if (skeleton.name.empty()) skeleton.name = fs::path(path).stem().string();
    if (!file_.motion) {
      file_.warnings.push_back(path + ": has no motion; its skeleton stands in one frame as it rests");
      file_.motion = SkeletonMotion{.rate_hz = kRestRateHz, .times = {Timestamp{}}, .rows = {skeleton.rest()}};
    }
    rest_ = rest_of(skeleton);
    info_.header.rate_hz = file_.motion->rate_hz;
    info_.header.bodies = bodies_of(skeleton);
    info_.frame_count = std::ssize(file_.motion->rows);
    name_points();
  }

  const FileInfo& info() const override { return info_; }
  std::vector<std::string> warnings() const override { return file_.warnings; }

  std::optional<Instant> next() override {
    if (row_ == file_.motion->rows.size()) return std::nullopt;
    Instant instant;
    instant.index = static_cast<std::int64_t>(row_);
    instant.time = file_.motion->times[row_];
    const std::vector<Rigid3> world_from = pose_of(file_.skeleton, file_.motion->rows[row_++]);
    for (std::size_t i = 0; i < world_from.size(); ++i) {
      BodyPose pose;
      pose.body = info_.header.bodies[i].id;
      pose.world_from_body = body_pose(world_from[i], rest_[i]);
      instant.bodies.push_back(pose);
      add_point(instant, world_from[i].translation);
    }
    for (const std::size_t i : ends_) add_point(instant, world_from[i] * *file_.skeleton.segments[i].end);
    return instant;
  }

 private:
  void name_points() {
    const std::vector<Segment>& segments = file_.skeleton.segments;
    std::vector<bool> has_child(segments.size(), false);
    for (const Segment& segment : segments) {
      if (segment.parent) has_child[static_cast<std::size_t>(*segment.parent)] = true;
      name_point(segment.name);
    }
    for (std::size_t i = 0; i < segments.size(); ++i) {
      if (has_child[i] || !segments[i].end) continue;
      ends_.push_back(i);
      name_point(segments[i].name + ".end");
    }
  }

  void name_point(const std::string& label) {
    info_.tracks.push_back({TrackId(static_cast<int>(info_.tracks.size()) + 1), label, {}});
  }

  static void add_point(Instant& instant, const Vector<3>& location) {
    Sample sample;
    sample.track = TrackId(static_cast<int>(instant.samples.size()) + 1);
    sample.position = location;
    sample.provenance = Provenance::solved;
    instant.samples.push_back(sample);
  }

  SkeletonFile file_;
  FileInfo info_;
  std::vector<Matrix<3>> rest_;
  std::vector<std::size_t> ends_;  // segments whose end is a point
  std::size_t row_ = 0;
};

bool is_asf(const fs::path& path) {
  std::string ending = path.extension().string();
  for (char& c : ending) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return ending == ".asf";
}

}  // namespace

std::unique_ptr<FileReader> recording_of(SkeletonFile file, const std::string& path) {
  return std::make_unique<SkeletonReader>(std::move(file), path);
}

std::string asf_for(const std::string& amc) {
  const fs::path path(amc), folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  const std::string stem = path.stem().string();
  std::vector<fs::path> all;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) {
    if (is_asf(entry.path())) all.push_back(entry.path());
  }
  for (const std::string& required : {stem, stem.substr(0, stem.find('_'))}) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const fs::path& one) { return one.stem() == required; });
    if (found != all.end()) return found->string();
  }
  if (all.size() == 1) return all.front().string();
  throw Error("{}: moves the bones of an .asf file, and {} beside it; name it with --metadata", amc,
              all.empty() ? "there is none" : "it is not clear which");
}

}  // namespace marey::format::skeleton

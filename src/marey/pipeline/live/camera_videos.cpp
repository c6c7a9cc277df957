#include "marey/pipeline/live/camera_videos.h"

#include <algorithm>
#include <utility>

#include "marey/core/error.h"
#include "marey/draw/canvas.h"
#include "marey/format/rig/rig_file.h"

namespace marey::pipeline::live {
namespace {

constexpr const char* kRigFile = "rig.toml";
constexpr const char* kVideoEnding = ".mp4";

}  // namespace

CameraVideos::CameraVideos(std::string folder, std::shared_ptr<const corridor::RecordSwitch> required)
    : folder_(std::move(folder)), required_(std::move(required)) {}

CameraVideos::~CameraVideos() {
  videos_.clear();
  std::error_code ignored;
  if (made_) std::filesystem::remove(folder_, ignored);  // where nothing was put in
}

std::vector<std::string> CameraVideos::files_of(const std::string& folder, const Rig& rig) {
  std::vector<std::string> files{std::filesystem::path(folder) / kRigFile};
  for (const RigCamera& camera : rig.cameras) files.push_back(std::filesystem::path(folder) / (camera.name + kVideoEnding));
  return files;
}

Sink::SinkRequirements CameraVideos::begin(const RecordingHeader& header) {
  if (header.rig) rig_ = *header.rig;
  std::error_code failure;
  made_ = std::filesystem::create_directories(folder_, failure);
  if (failure) throw Error("{}: cannot be made: {}", folder_.string(), failure.message());
  return {.images = true};
}

std::string CameraVideos::file_of(CameraId camera) const {
  const auto index = static_cast<std::size_t>(number(camera));
  return (index < rig_.cameras.size() ? rig_.cameras[index].name : "cam" + std::to_string(index + 1)) + kVideoEnding;
}

CameraVideos::SweepVideo CameraVideos::open(const Frame& frame) const {
  const auto index = static_cast<std::size_t>(number(frame.camera));
  const auto rate_hz = index < rig_.cameras.size() ? rig_.cameras[index].rate_hz : std::nullopt;
  const std::string path = (folder_ / file_of(frame.camera)).string();
  using draw::MovieWriter;
  return {
      std::make_unique<MovieWriter>(path, frame.image.size(), rate_hz, MovieWriter::Quality::to_record, MovieWriter::Keep::always),
      frame.time, frame.time};
}

void CameraVideos::write(const Instant& instant) {
  if (!required_->on()) return;
  const std::size_t known = videos_.size();
  for (const Frame& frame : instant.frames) {
    auto video = videos_.find(frame.camera);
    if (video == videos_.end()) {
      video = videos_.emplace(frame.camera, open(frame)).first;
    } else if (frame.time <= video->second.last) {
      continue;  // a camera slower than the others is in several instants with one image
    }
    video->second.movie->write(draw::Canvas(frame.image).take(), frame.time - video->second.begin + Timestamp{});
    video->second.last = frame.time;
  }
  if (videos_.size() > known) write_rig();
}

void CameraVideos::finish() {
  for (auto& [id, video] : videos_) video.movie->finish();
}

void CameraVideos::write_rig() const {
  const Timestamp first = std::min_element(videos_.begin(), videos_.end(), [](const auto& a, const auto& b) {
                            return a.second.begin < b.second.begin;
                          })->second.begin;
  Rig kept = rig_;
  kept.cameras.clear();
  for (const auto& [id, video] : videos_) {
    const auto index = static_cast<std::size_t>(number(id));
    RigCamera camera = index < rig_.cameras.size() ? rig_.cameras[index] : RigCamera{};
    if (camera.name.empty()) camera.name = std::filesystem::path(file_of(id)).stem().string();
    camera.source = (folder_ / file_of(id)).string();
    camera.detections.clear();
    camera.region.reset();                           // a video is of that part alone
    camera.offset_s = seconds(video.begin - first);  // frames' times are by the rig's clock
    kept.cameras.push_back(std::move(camera));
  }
  format::rig::write_rig(kept, (folder_ / kRigFile).string());
}

}  // namespace marey::pipeline::live

#include "marey/pipeline/live/camera_films.h"

#include <algorithm>
#include <utility>

#include "marey/core/error.h"
#include "marey/draw/canvas.h"
#include "marey/format/rig/rig_file.h"

namespace marey::pipeline::live {
namespace {

constexpr const char* kRigFile = "rig.toml";
constexpr const char* kFilmEnding = ".mp4";

}  // namespace

CameraFilms::CameraFilms(std::string folder, std::shared_ptr<const corridor::RecordSwitch> wanted)
    : folder_(std::move(folder)), wanted_(std::move(wanted)) {}

CameraFilms::~CameraFilms() {
  films_.clear();
  std::error_code ignored;
  if (made_) std::filesystem::remove(folder_, ignored);  // where nothing was put in
}

std::vector<std::string> CameraFilms::files_of(const std::string& folder, const Rig& rig) {
  std::vector<std::string> files{std::filesystem::path(folder) / kRigFile};
  for (const RigCamera& camera : rig.cameras) files.push_back(std::filesystem::path(folder) / (camera.name + kFilmEnding));
  return files;
}

Sink::Wants CameraFilms::begin(const RecordingHeader& header) {
  if (header.rig) rig_ = *header.rig;
  std::error_code failure;
  made_ = std::filesystem::create_directories(folder_, failure);
  if (failure) throw Error("{}: cannot be made: {}", folder_.string(), failure.message());
  return {.pictures = true};
}

std::string CameraFilms::file_of(CameraId camera) const {
  const auto index = static_cast<std::size_t>(number(camera));
  return (index < rig_.cameras.size() ? rig_.cameras[index].name : "cam" + std::to_string(index + 1)) + kFilmEnding;
}

CameraFilms::Film CameraFilms::open(const Frame& frame) const {
  const auto index = static_cast<std::size_t>(number(frame.camera));
  const auto rate_hz = index < rig_.cameras.size() ? rig_.cameras[index].rate_hz : std::nullopt;
  const std::string path = (folder_ / file_of(frame.camera)).string();
  using draw::MovieWriter;
  return {std::make_unique<MovieWriter>(path, frame.picture.size(), rate_hz, MovieWriter::Quality::to_record,
                                        MovieWriter::Keep::always),
          frame.time, frame.time};
}

void CameraFilms::write(const Instant& instant) {
  if (!wanted_->on()) return;
  const std::size_t known = films_.size();
  for (const Frame& frame : instant.frames) {
    auto film = films_.find(frame.camera);
    if (film == films_.end()) {
      film = films_.emplace(frame.camera, open(frame)).first;
    } else if (frame.time <= film->second.last) {
      continue;  // a camera slower than the others is in several moments with one picture
    }
    film->second.movie->write(draw::Canvas(frame.picture).take(), frame.time - film->second.begin + Timestamp{});
    film->second.last = frame.time;
  }
  if (films_.size() > known) write_rig();
}

void CameraFilms::finish() {
  for (auto& [id, film] : films_) film.movie->finish();
}

void CameraFilms::write_rig() const {
  const Timestamp first = std::min_element(films_.begin(), films_.end(), [](const auto& a, const auto& b) {
                            return a.second.begin < b.second.begin;
                          })->second.begin;
  Rig kept = rig_;
  kept.cameras.clear();
  for (const auto& [id, film] : films_) {
    const auto index = static_cast<std::size_t>(number(id));
    RigCamera camera = index < rig_.cameras.size() ? rig_.cameras[index] : RigCamera{};
    if (camera.name.empty()) camera.name = std::filesystem::path(file_of(id)).stem().string();
    camera.source = (folder_ / file_of(id)).string();
    camera.detections.clear();
    camera.region.reset();  // a film is of that part alone
    camera.offset_s = camera.offset_s.value_or(0) + seconds(film.begin - first);
    kept.cameras.push_back(std::move(camera));
  }
  format::rig::write_rig(kept, (folder_ / kRigFile).string());
}

}  // namespace marey::pipeline::live

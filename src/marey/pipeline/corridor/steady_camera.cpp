#include "marey/pipeline/corridor/steady_camera.h"

#include <algorithm>
#include <filesystem>
#include <mutex>
#include <utility>
#include <variant>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/source/open_source.h"

namespace marey::pipeline::corridor {
namespace {

constexpr double kWorthIt = 0.5;  // of the pictures of the beginning: with fewer, what is left out costs more than shaking does

/// The calibrated lens, without its distortion, in pixels of the whole picture.
std::optional<source::steady::PinholeView> pinhole_of(const RigCamera& camera, cv::Size picture) {
  if (!camera.lens || !camera.size || camera.size->empty()) return std::nullopt;
  source::steady::PinholeView view;
  std::visit(
      [&](const auto& lens) {
        view.focal = lens.focal.mean();
        view.principal = lens.principal;
      },
      *camera.lens);
  if (camera.region) {
    view.principal += Vector<2>(camera.region->x, camera.region->y);
    return view;
  }
  const double scale = static_cast<double>(picture.width) / camera.size->width;
  view.focal *= scale;
  view.principal = scale * (view.principal + Vector<2>(0.5, 0.5)) - Vector<2>(0.5, 0.5);
  return view;
}

/// A file or a folder can, or a pattern of names; a pipe cannot.
bool can_be_read_twice(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::is_regular_file(path, ignored) || std::filesystem::is_directory(path, ignored) ||
         !std::filesystem::exists(path, ignored);
}

}  // namespace

struct SteadyCamera::Shared {
  std::optional<source::steady::StandingScene> scene;
  std::shared_ptr<source::steady::SteadyLog> log = std::make_shared<source::steady::SteadyLog>();
  std::mutex opening;
  bool opened = false;
  std::size_t found = 0, looked_at = 0;  // pictures of the beginning: steadied, and all
};

SteadyCamera::SteadyCamera(const RigCamera& camera, const FeedOptions& options, bool live)
    : shared_(std::make_shared<Shared>()), camera_(camera), options_(options), opens_again_(can_be_read_twice(camera.source)) {
  if (live || !opens_again_) return;
  RigCamera whole;
  whole.name = camera.name;
  whole.source = camera.source;
  whole.rate_hz = camera.rate_hz;
  std::vector<Picture> pictures;
  for (const Frame& frame : Feed(whole, CameraId{}, options).sample_beginning()) pictures.push_back(frame.picture);
  if (pictures.empty()) return;
  shared_->scene.emplace(pictures.front().size(), pinhole_of(camera, pictures.front().size()));
  if (!shared_->scene->learn(pictures))
    throw Error("{}",
                said_of(camera, fmt::format("{}: its pictures show nothing that stands, by which they could be steadied; leave "
                                            "out --steady",
                                            camera.source)));
  source::steady::StandingScene trial = *shared_->scene;
  shared_->looked_at = pictures.size();
  shared_->found = static_cast<std::size_t>(
      std::count_if(pictures.begin(), pictures.end(), [&](const Picture& picture) { return trial.find(picture).has_value(); }));
}

bool SteadyCamera::steadies() const {
  return static_cast<double>(shared_->found) >= kWorthIt * static_cast<double>(shared_->looked_at);
}

FeedOptions SteadyCamera::feed_options() const {
  if (!steadies()) return options_;
  FeedOptions options = options_;
  options.opens_again = opens_again_;
  options.open = [shared = shared_, camera = camera_, rate = camera_.rate_hz ? camera_.rate_hz : options_.rate_hz] {
    auto source = source::open_source(camera.source, rate);
    const std::lock_guard lock(shared->opening);
    const cv::Size size = source->info().size;
    if (!shared->scene) shared->scene.emplace(size, pinhole_of(camera, size));
    // Only the first reading is counted: what is sampled or drawn is read once more.
    auto log = std::exchange(shared->opened, true) ? std::make_shared<source::steady::SteadyLog>() : shared->log;
    return source::steady::steadied(std::move(source), *shared->scene, std::move(log));
  };
  return options;
}

void SteadyCamera::report(Summary& summary) const {
  if (!steadies()) {
    summary.warnings.push_back(said_of(
        camera_, fmt::format("--steady would leave out too many pictures ({} of {} of the beginning could not be steadied): "
                             "they were tracked as they are",
                             shared_->looked_at - shared_->found, shared_->looked_at)));
    return;
  }
  const auto counts = shared_->log->report();
  summary.notes.push_back(said_of(camera_, source::steady::said(counts)));
  for (const std::string& warning : source::steady::warned(counts)) summary.warnings.push_back(said_of(camera_, warning));
}

std::string shaking_warning(double px) {
  return fmt::format("the camera shakes, by {:.1f} px (root mean square); --steady steadies its pictures first", px);
}

std::optional<std::string> shaking(std::span<const Frame> samples) {
  const auto moved = source::steady::motion_among(samples);
  if (!moved || *moved < kShakes) return std::nullopt;
  return shaking_warning(*moved);
}

}  // namespace marey::pipeline::corridor

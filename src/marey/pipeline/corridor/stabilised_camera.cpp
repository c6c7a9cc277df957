#include "marey/pipeline/corridor/stabilised_camera.h"

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

constexpr double kMinGain = 0.5;  // of the images of the beginning: with fewer, what is omitted costs more than shaking does

/// The calibrated lens, without its distortion, in pixels of the whole image.
std::optional<source::stabilise::PinholeView> pinhole_of(const RigCamera& camera, cv::Size image) {
  if (!camera.lens || !camera.size || camera.size->empty()) return std::nullopt;
  source::stabilise::PinholeView view;
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
  const double scale = static_cast<double>(image.width) / camera.size->width;
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

struct StabilisedCamera::Shared {
  std::optional<source::stabilise::ReferenceScene> scene;
  std::shared_ptr<source::stabilise::StabilisationLog> log = std::make_shared<source::stabilise::StabilisationLog>();
  std::mutex opening;
  bool opened = false;
  std::size_t found = 0, images = 0;  // images of the beginning: stabilised, and all
};

StabilisedCamera::StabilisedCamera(const RigCamera& camera, const FeedOptions& options, bool live)
    : shared_(std::make_shared<Shared>()), camera_(camera), options_(options), opens_again_(can_be_read_twice(camera.source)) {
  if (live || !opens_again_) return;
  RigCamera whole;
  whole.name = camera.name;
  whole.source = camera.source;
  whole.rate_hz = camera.rate_hz;
  std::vector<Image> images;
  for (const Frame& frame : Feed(whole, CameraId{}, options).sample_beginning()) images.push_back(frame.image);
  if (images.empty()) return;
  shared_->scene.emplace(images.front().size(), pinhole_of(camera, images.front().size()));
  if (!shared_->scene->learn(images))
    throw Error("{}",
                stated_of(camera, fmt::format("{}: its images show nothing that stands, by which they could be stabilised; leave "
                                              "out --stabilise",
                                              camera.source)));
  source::stabilise::ReferenceScene trial = *shared_->scene;
  shared_->images = images.size();
  shared_->found = static_cast<std::size_t>(
      std::count_if(images.begin(), images.end(), [&](const Image& image) { return trial.find(image).has_value(); }));
}

bool StabilisedCamera::steadies() const {
  return static_cast<double>(shared_->found) >= kMinGain * static_cast<double>(shared_->images);
}

FeedOptions StabilisedCamera::feed_options() const {
  if (!steadies()) return options_;
  FeedOptions options = options_;
  options.opens_again = opens_again_;
  options.open = [shared = shared_, camera = camera_, rate = camera_.rate_hz ? camera_.rate_hz : options_.rate_hz] {
    auto source = source::open_source(camera.source, rate);
    const std::lock_guard lock(shared->opening);
    const cv::Size size = source->info().size;
    if (!shared->scene) shared->scene.emplace(size, pinhole_of(camera, size));
    // Only the first reading is counted: what is sampled or drawn is read once more.
    auto log = std::exchange(shared->opened, true) ? std::make_shared<source::stabilise::StabilisationLog>() : shared->log;
    return source::stabilise::stabilised(std::move(source), *shared->scene, std::move(log));
  };
  return options;
}

void StabilisedCamera::report(Summary& summary) const {
  if (!steadies()) {
    summary.warnings.push_back(stated_of(
        camera_, fmt::format("--stabilise would omit too many images ({} of {} of the beginning could not be stabilised): "
                             "they were tracked as they are",
                             shared_->images - shared_->found, shared_->images)));
    return;
  }
  const auto counts = shared_->log->report();
  summary.notes.push_back(stated_of(camera_, source::stabilise::stated(counts)));
  for (const std::string& warning : source::stabilise::warned(counts)) summary.warnings.push_back(stated_of(camera_, warning));
}

std::string shaking_warning(double px) {
  return fmt::format("the camera shakes, by {:.1f} px (root mean square); --stabilise steadies its images first", px);
}

std::optional<std::string> shaking(std::span<const Frame> samples) {
  const auto moved = source::stabilise::motion_among(samples);
  if (!moved || *moved < kShakes) return std::nullopt;
  return shaking_warning(*moved);
}

}  // namespace marey::pipeline::corridor

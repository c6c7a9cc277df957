#include "marey/calibrate/wand/wand.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "marey/calibrate/incremental_rig.h"
#include "marey/calibrate/wand/wand_checks.h"
#include "marey/calibrate/wand/wand_fit.h"
#include "marey/calibrate/wand/wand_lens.h"
#include "marey/calibrate/wand/wand_offsets.h"
#include "marey/calibrate/wand/wand_table.h"
#include "marey/calibrate/world_frame.h"
#include "marey/core/error.h"

namespace marey::calibrate::wand {
namespace {

constexpr int kMinShared = 12;                                        // instants that link two cameras
constexpr std::size_t kGrowPerCamera = 60;                            // instants a camera by which the rig grows
constexpr std::size_t kGuessPerCamera = 30;                           // where several focal lengths are tried
constexpr double kKnownLensSigma = 1, kUnknownLensSigma = 3;          // px in an image of 1280 columns
constexpr std::array kFocalGuesses = {0.5, 0.8, 1.2, 1.8, 2.7, 4.0};  // of the longer side
constexpr double kLikelyFocal = 1.2;
constexpr double kRefinedIsBetter = 0.97;  // of the noise with the given lenses

/// Instants from which the cameras can be related: for each camera, spread over time, those that most others share.
std::vector<std::size_t> spread_instants(const MarkTable& table, std::size_t cameras, std::size_t per_camera) {
  std::vector<char> chosen(table.size(), 0);
  std::vector<std::size_t> count(table.size(), 0);
  for (std::size_t i = 0; i < table.size(); ++i) {
    count[i] =
        static_cast<std::size_t>(std::count_if(table[i].begin(), table[i].end(), [](const auto& m) { return m.has_value(); }));
  }
  for (std::size_t c = 0; c < cameras; ++c) {
    std::vector<std::size_t> detected;
    for (std::size_t i = 0; i < table.size(); ++i) {
      if (table[i][c] && count[i] >= 2) detected.push_back(i);
    }
    // One of each segment of time: that which most cameras see.
    const std::size_t segments = std::min(per_camera, detected.size());
    for (std::size_t s = 0; s < segments; ++s) {
      const auto begin = detected.begin() + static_cast<std::ptrdiff_t>(s * detected.size() / segments);
      const auto end = detected.begin() + static_cast<std::ptrdiff_t>((s + 1) * detected.size() / segments);
      chosen[*std::max_element(begin, end, [&](std::size_t a, std::size_t b) { return count[a] < count[b]; })] = 1;
    }
  }
  std::vector<std::size_t> instants;
  for (std::size_t i = 0; i < chosen.size(); ++i) {
    if (chosen[i]) instants.push_back(i);
  }
  return instants;
}

class WandCalibration {
 public:
  WandCalibration(const WandInput& input, const WandOptions& options, const Hooks& hooks)
      : in_(input), options_(options), hooks_(hooks), result_{input.rig, {}, {}} {}

  WandResult run() {
    check_wand_input(in_, options_);
    find();
    grow();
    fit();
    return std::move(result_);
  }

 private:
  std::size_t cameras() const { return in_.rig.cameras.size(); }
  void step(std::string_view what) { hooks_.advance({what, steps_++, std::nullopt}); }
  bool any_unknown_lens() const {
    return std::any_of(in_.rig.cameras.begin(), in_.rig.cameras.end(), [](const RigCamera& camera) { return !camera.lens; });
  }

  void find() {
    step("finding the wand");
    for (std::size_t c = 0; c < cameras(); ++c) {
      const RigCamera& camera = in_.rig.cameras[c];
      tracks_.push_back({find_marks(in_.detected[c], in_.wand, camera.lens, *camera.size), period_of(in_.detected[c]),
                         camera.offset_s.value_or(0)});
    }
    check_tracks(in_, tracks_);
    if (options_.find_offsets) {
      step("comparing the clocks");
      const double sigma_px = any_unknown_lens() ? kUnknownLensSigma : kKnownLensSigma;
      settle_offsets(tracks_, grown_cameras(kLikelyFocal, sigma_px, false), in_.wand, options_.seed);
    }
    table_ = table_of(tracks_, instants_of(tracks_), in_.wand.markers());
    std::vector<std::string> names;
    for (const RigCamera& camera : in_.rig.cameras) names.push_back(camera.name);
    require_connected(names, shared_views(table_, cameras()), kMinShared);
  }

  std::vector<StartingCamera> grown_cameras(double guess, double sigma_px, bool free) const {
    std::vector<StartingCamera> cameras;
    for (const RigCamera& camera : in_.rig.cameras) {
      const double scale = std::max(1.0, camera.size->width / 1280.0);
      cameras.push_back({camera.name, starting_lens(camera, guess), *camera.size,
                         camera.lens && !free ? bundle::LensFreedom{} : growing_lens(), sigma_px * scale});
    }
    return cameras;
  }

  /// Robust cost of a growth over all that was to be explained, px².
  double cost_of(const Growth& growth, std::size_t required) const {
    constexpr double cap = 25;
    double cost = 0;
    std::size_t explained = 0;
    const auto errors = bundle::errors_of(growth.bundle);
    for (const auto& error : errors) {
      cost += error ? std::min(cap, error->squaredNorm()) : cap;
      ++explained;
    }
    return cost + cap * static_cast<double>(required - std::min(required, explained));
  }

  void grow() {
    step("relating the cameras");
    const bool guess = any_unknown_lens();
    const auto instants = spread_instants(table_, cameras(), guess ? kGuessPerCamera : kGrowPerCamera);
    MarkTable some;
    std::size_t required = 0;
    for (const std::size_t i : instants) {
      some.push_back(table_[i]);
      for (const auto& marks : table_[i]) required += marks ? in_.wand.markers() : 0;
    }
    std::string cause;
    double best = std::numeric_limits<double>::infinity();
    const auto attempt = [&](double focal, double sigma_px, bool free) {
      try {
        Growth growth = grow_rig(grown_cameras(focal, sigma_px, free), in_.wand, some, options_.seed);
        const double cost = cost_of(growth, required);
        if (cost >= best) return;
        best = cost;
        growth_ = std::move(growth);
      } catch (const Error& error) {
        if (cause.empty()) cause = error.what();
      }
    };
    if (guess) {
      for (const double focal : kFocalGuesses) attempt(focal, kUnknownLensSigma, false);
    } else {
      attempt(1, kKnownLensSigma, false);
      if (!std::isfinite(best)) attempt(1, kUnknownLensSigma, false);
      if (!std::isfinite(best) && options_.lens != LensUse::fixed) attempt(1, kUnknownLensSigma, true);
    }
    if (!std::isfinite(best)) throw Error("{}", cause);
  }

  void fit() {
    step("looking again");
    WandFit fit(in_, tracks_, growth_.bundle, growth_.fit.noise_px);
    fit.free_lenses(options_.lens == LensUse::refined);
    fit.match_blobs();
    step("adjusting everything");
    std::optional<HeldOutReport> held_out;
    fit.adjust_held_out(options_.find_offsets, held_out);
    if (options_.lens == LensUse::automatic && refining_helps(fit)) {
      fit.free_lenses(true);
      fit.match_blobs();
      fit.adjust_held_out(options_.find_offsets, held_out);
    }
    const bundle::BundleResult result = fit.adjust_all();
    bundle::Bundle& bundle = fit.bundle();
    check_fitted_rig(in_, bundle, result);
    put_into_world(bundle, in_, options_, result_.notes);
    report(bundle, result);
    result_.report.held_out = held_out;
    grade_it();
    store(bundle);
  }

  bool refining_helps(const WandFit& fit) {
    const bool any_known = std::any_of(in_.rig.cameras.begin(), in_.rig.cameras.end(),
                                       [](const RigCamera& camera) { return camera.lens.has_value(); });
    if (!any_known) return false;
    const auto [held, refined] = fit.noise_held_and_refined();
    if (refined >= kRefinedIsBetter * held) return false;
    result_.notes.push_back(
        fmt::format("the lenses as given leave {:.2f} px where refined ones leave {:.2f} px: they were refined", held, refined));
    return true;
  }

  void report(const bundle::Bundle& bundle, const bundle::BundleResult& fit) {
    std::vector<std::string> names;
    std::vector<cv::Size> sizes;
    for (const RigCamera& camera : in_.rig.cameras) names.push_back(camera.name), sizes.push_back(*camera.size);
    result_.report = report_on(bundle, fit, names, sizes);
  }

  void grade_it() {
    int columns = 0;
    for (const RigCamera& camera : in_.rig.cameras) columns = std::max(columns, camera.size->width);
    grade(result_.report, columns, in_.wand.length());
  }

  void store(const bundle::Bundle& bundle) {
    const RigReport& report = result_.report;
    for (std::size_t c = 0; c < cameras(); ++c) {
      RigCamera& camera = result_.rig.cameras[c];
      camera.lens = bundle.cameras[c].lens;
      camera.camera_from_world = bundle.cameras[c].camera_from_world;
      camera.offset_s = tracks_[c].offset_s + bundle.cameras[c].offset_s;
      camera.rms_px = report.cameras[c].fit.rms_px;
    }
    result_.rig.calibration = Rig::Calibration{in_.wand.markers() == 1 ? "led" : "wand",
                                               report.all.mean_px,
                                               report.all.rms_px,
                                               report.all.inliers,
                                               report.all.observations,
                                               report.grade};
  }

  const WandInput& in_;
  const WandOptions& options_;
  const Hooks& hooks_;
  std::int64_t steps_ = 0;
  WandResult result_;
  std::vector<MarkTrack> tracks_;
  MarkTable table_;
  Growth growth_;
};

}  // namespace

WandResult calibrate_wand(const WandInput& input, const WandOptions& options, const Hooks& hooks) {
  const StopScope scope(hooks.stop);
  return WandCalibration(input, options, hooks).run();
}

}  // namespace marey::calibrate::wand

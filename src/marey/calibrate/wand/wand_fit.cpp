#include "marey/calibrate/wand/wand_fit.h"

#include <algorithm>
#include <cmath>

#include "marey/calibrate/line_placement.h"
#include "marey/calibrate/wand/wand_checks.h"
#include "marey/calibrate/wand/wand_lens.h"
#include "marey/core/geometry.h"
#include "marey/geometry/camera.h"

namespace marey::calibrate::wand {
namespace {

constexpr double kMinGatePx = 2;        // in an image of 1280 columns, within which a blob is matched
constexpr double kGateNoise = 8;        // times the noise
constexpr std::size_t kHeldOutOf = 10;  // every this many-th place of the wand is held out
constexpr std::size_t kMinToHold = 200;
constexpr double kResample = 0.02;   // of a period: from here on a time offset asks for samples at other instants
constexpr double kOffsetSigmas = 5;  // a time offset is trusted from here on
constexpr int kOffsetRounds = 4;

std::vector<StartingCamera> wand_cameras(const WandInput& input, const bundle::Bundle& bundle, double noise_px) {
  std::vector<StartingCamera> cameras;
  for (std::size_t c = 0; c < bundle.cameras.size(); ++c) {
    const RigCamera& camera = input.rig.cameras[c];
    cameras.push_back({camera.name, bundle.cameras[c].lens, *camera.size, {}, std::max(0.5, 2 * noise_px)});
  }
  return cameras;
}

/// A value between the bodies' at an instant: the one of that instant, or through the neighbours'.
class BodyAt {
 public:
  BodyAt(const std::vector<double>& instants, const std::vector<std::optional<bundle::Body>>& bodies, const MarkerLine& wand)
      : instants_(instants), bodies_(bodies), wand_(wand) {}

  std::optional<Vector<3>> marker(double time_s, std::size_t m) const {
    const auto later = std::lower_bound(instants_.begin(), instants_.end(), time_s - 1e-7);
    if (later == instants_.end()) return std::nullopt;
    const auto k = static_cast<std::size_t>(later - instants_.begin());
    if (*later <= time_s + 1e-7) return at(k, m);
    if (k == 0) return std::nullopt;
    const auto a = at(k - 1, m), b = at(k, m);
    const double step = instants_[k] - instants_[k - 1];
    if (!a || !b || step > 0.1) return std::nullopt;
    const double u = (time_s - instants_[k - 1]) / step;
    const auto before = k >= 2 ? at(k - 2, m) : std::nullopt, after = k + 1 < instants_.size() ? at(k + 1, m) : std::nullopt;
    if (!before || !after) return Vector<3>(*a + u * (*b - *a));
    const auto w = cubic_weights(u);
    return Vector<3>(w[0] * *before + w[1] * *a + w[2] * *b + w[3] * *after);
  }

 private:
  std::optional<Vector<3>> at(std::size_t k, std::size_t m) const {
    if (!bodies_[k]) return std::nullopt;
    if (const auto* point = std::get_if<Vector<3>>(&*bodies_[k])) return *point;
    const auto& wand = std::get<bundle::WandPose>(*bodies_[k]);
    return Vector<3>(wand.origin + wand_.distances[m] * wand.direction);
  }

  const std::vector<double>& instants_;
  const std::vector<std::optional<bundle::Body>>& bodies_;
  const MarkerLine& wand_;
};

}  // namespace

WandFit::WandFit(const WandInput& input, std::vector<MarkTrack>& tracks, const bundle::Bundle& start, double noise_px)
    : in_(input), tracks_(tracks), noise_px_(noise_px) {
  bundle_.cameras = start.cameras;
  bundle_.wand = input.wand.distances;
}

void WandFit::free_lenses(bool given_too) {
  for (std::size_t c = 0; c < bundle_.cameras.size(); ++c) {
    const RigCamera& camera = in_.rig.cameras[c];
    bundle_.cameras[c].freedom = !camera.lens ? estimated_lens(*camera.size)
                                 : given_too  ? refined_lens(*camera.size)
                                              : bundle::LensFreedom{};
    bundle_.cameras[c].known =
        starting_lens(camera, geometry::focal_of(bundle_.cameras[c].lens).x() / std::max(camera.size->width, camera.size->height));
    if (camera.lens && !given_too) bundle_.cameras[c].lens = *camera.lens;
  }
}

void WandFit::match_blobs() {
  instants_ = instants_of(tracks_);
  const MarkTable table = table_of(tracks_, instants_, in_.wand.markers());
  LinePlacement placement(wand_cameras(in_, bundle_, noise_px_), in_.wand, table);
  for (std::size_t c = 0; c < bundle_.cameras.size(); ++c) placement.poses[c] = bundle_.cameras[c].camera_from_world;
  std::vector<double> lengths;
  for (std::size_t i = 0; in_.wand.markers() > 1 && i < placement.instants(); ++i) {
    const auto locations = placement.markers(i);
    if (locations) lengths.push_back(((*locations)[in_.wand.markers() - 1] - (*locations)[0]).norm());
  }
  check_lengths(lengths, in_.wand);
  placement.position_all();
  bodies_ = placement.bodies;
  const BodyAt body_at(instants_, bodies_, in_.wand);
  for (std::size_t c = 0; c < tracks_.size(); ++c) {
    const cv::Size size = *in_.rig.cameras[c].size;
    const Camera camera(bundle_.cameras[c].lens, bundle_.cameras[c].camera_from_world, size);
    const double gate = std::max(kMinGatePx * size.width / 1280, kGateNoise * noise_px_);
    tracks_[c].frames.clear();
    for (const BlobFrame& frame : in_.detected[c]) {
      Marks expected;
      for (std::size_t m = 0; m < in_.wand.markers(); ++m) {
        const auto point = body_at.marker(frame.time_s + tracks_[c].offset_s, m);
        if (point) expected[m] = camera.project(*point);
      }
      const Marks marks = match_marks(frame, expected, gate);
      if (std::any_of(marks.begin(), marks.end(), [](const auto& mark) { return mark.has_value(); })) {
        tracks_[c].frames.push_back({frame.time_s, marks});
      }
    }
  }
  gather();
}

/// The bundle's bodies and observations at the instants.
void WandFit::gather() {
  bundle_.bodies.clear();
  bundle_.observations.clear();
  for (std::size_t i = 0; i < instants_.size(); ++i) {
    if (!bodies_[i]) continue;
    const int body = static_cast<int>(bundle_.bodies.size());
    bundle_.bodies.push_back(*bodies_[i]);
    for (std::size_t c = 0; c < tracks_.size(); ++c) {
      const MarkSamples samples = sample_at(tracks_[c], instants_[i]);
      for (std::size_t m = 0; m < in_.wand.markers(); ++m) {
        if (!samples[m]) continue;
        bundle_.observations.push_back({static_cast<int>(c), body, static_cast<int>(m), samples[m]->pixel, samples[m]->velocity});
      }
    }
  }
}

/// Offsets that are trusted stay, others are 0; true where one is so large that samples are to be taken again.
bool WandFit::take_over_offsets(const bundle::BundleResult& fit) {
  bool resample = false;
  for (std::size_t c = 0; c < tracks_.size(); ++c) {
    double& offset = bundle_.cameras[c].offset_s;
    const double sigma = fit.deviations[c].offset_s;
    if (std::abs(offset) < std::max(kOffsetSigmas * sigma, 1e-3 * tracks_[c].period_s)) offset = 0;
    if (std::abs(offset) <= kResample * tracks_[c].period_s) continue;
    tracks_[c].offset_s += offset;
    offset = 0;
    resample = true;
  }
  return resample;
}

void WandFit::adjust_held_out(bool find_offsets, std::optional<HeldOutReport>& report) {
  const bool moving = std::any_of(bundle_.observations.begin(), bundle_.observations.end(),
                                  [](const bundle::BundleObservation& detected) { return detected.velocity != Vector<2>::Zero(); });
  const bool hold = in_.wand.markers() > 1 && bundle_.bodies.size() >= kMinToHold;
  for (int round = 0; round < kOffsetRounds; ++round) {
    bundle::Bundle train = bundle_, evaluated = bundle_;
    if (hold) {
      const auto held = [](const bundle::BundleObservation& detected) {
        return static_cast<std::size_t>(detected.body) % kHeldOutOf == kHeldOutOf / 2;
      };
      std::erase_if(train.observations, held);
      std::erase_if(evaluated.observations, [&](const bundle::BundleObservation& detected) { return !held(detected); });
    }
    for (std::size_t c = 1; c < train.cameras.size(); ++c) train.cameras[c].refine_offset = find_offsets && moving;
    bundle::BundleOptions options;
    options.noise_px = std::max(0.02, noise_px_);
    options.tolerance = 1e-8;
    options.rounds = 2;
    options.deviations = find_offsets && moving;
    const bundle::BundleResult fit = bundle::adjust(train, options);
    noise_px_ = fit.noise_px;
    bundle_.cameras = train.cameras;
    bundle_.bodies = train.bodies;
    for (bundle::BundleCamera& camera : bundle_.cameras) camera.refine_offset = false;
    if (hold) {
      evaluated.cameras = bundle_.cameras;
      std::vector<cv::Size> sizes;
      for (const RigCamera& camera : in_.rig.cameras) sizes.push_back(*camera.size);
      report = evaluate_held_out(evaluated, sizes);
    }
    if (!find_offsets || !moving || !take_over_offsets(fit)) return;
    match_blobs();
  }
}

WandFit::Noise WandFit::noise_held_and_refined() const {
  constexpr std::size_t bodies = 400;
  bundle::Bundle some = bundle_;
  const std::size_t every = std::max<std::size_t>(1, some.bodies.size() / bodies);
  std::erase_if(some.observations,
                [&](const bundle::BundleObservation& detected) { return static_cast<std::size_t>(detected.body) % every != 0; });
  bundle::BundleOptions options;
  options.noise_px = std::max(0.02, noise_px_);
  options.tolerance = 1e-7;
  options.deviations = false;
  bundle::Bundle refined = some;
  for (std::size_t c = 0; c < refined.cameras.size(); ++c) {
    if (in_.rig.cameras[c].lens) refined.cameras[c].freedom = refined_lens(*in_.rig.cameras[c].size);
  }
  return {bundle::adjust(some, options).noise_px, bundle::adjust(refined, options).noise_px};
}

bundle::BundleResult WandFit::adjust_all() {
  bundle::BundleOptions options;
  options.noise_px = std::max(0.02, noise_px_);
  options.tolerance = 1e-9;
  return bundle::adjust(bundle_, options);
}

}  // namespace marey::calibrate::wand

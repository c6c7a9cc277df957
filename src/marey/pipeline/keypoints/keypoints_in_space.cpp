#include "marey/pipeline/keypoints/keypoints_in_space.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/keypoint_sets.h"
#include "marey/core/recording_reader.h"
#include "marey/files/source_name.h"
#include "marey/format/input_hash.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/geometry/median.h"
#include "marey/pipeline/keypoints/keypoint_frames.h"
#include "marey/pipeline/keypoints/keypoint_misfit.h"
#include "marey/pipeline/keypoints/keypoint_tracks.h"
#include "marey/pipeline/keypoints/tracked_people.h"
#include "marey/reconstruct/keypoints/clock_offsets.h"
#include "marey/reconstruct/keypoints/person_path.h"

namespace marey::pipeline::keypoints {
namespace {

namespace rk = reconstruct::keypoints;

constexpr double kGateSlack = 1.3;       // times the learned noise, for the question who is who
constexpr double kWorstNoise = 2.5;      // times what the files state: the rig does not fit
constexpr double kFewLocated = 0.5;      // share of views
constexpr double kMaxLocated = 0.75;     // share of views below which it is asked why
constexpr double kWorstCamera = 2.5;     // times the median of all cameras
constexpr double kMedianLength = 1.177;  // by definition: of a vector of two standard normal variables

/// The steps of the job, which share the cameras and their frames.
class KeypointJob {
 public:
  KeypointJob(Rig rig, const KeypointsInSpaceOptions& options, KeypointsSummary& summary, const Hooks& hooks)
      : rig_(std::move(rig)),
        options_(options),
        summary_(summary),
        hooks_(hooks),
        files_(
            read_keypoint_cameras(rig_, Cameras::calibrated, options.set, options.rate_hz, options.find, hooks, summary.warnings)) {
    for (std::size_t c = 0; c < files_.size(); ++c) cameras_.push_back(files_[c] ? rig_.cameras[c].camera() : std::nullopt);
    for (const auto& file : files_) {
      if (file && !file->sequence.frames.empty()) {
        set_ = file->sequence.set;
        break;
      }
    }
  }

  Recording run();

 private:
  bool one_camera() const {
    return std::count_if(files_.begin(), files_.end(), [](const auto& file) { return file.has_value(); }) == 1;
  }
  void find_offsets();
  std::vector<rk::PersonTrack> people_kept(std::map<int, rk::PersonTrack> tracks) const;
  rk::PersonPath smooth(rk::PersonTrack& track, double noise) const;
  void add_person(const rk::PersonTrack& track, const rk::PersonPath* path, std::size_t number, std::size_t of,
                  Recording& recording);
  void count(const rk::PersonTrack& track, const rk::PersonPath* path);
  void count_cameras();
  void report(const TrackedPeople& tracked);
  void warn_of_misfit();
  RecordingHeader header() const;

  Rig rig_;
  const KeypointsInSpaceOptions& options_;
  KeypointsSummary& summary_;
  const Hooks& hooks_;
  std::vector<std::optional<KeypointCamera>> files_;
  std::vector<std::optional<Camera>> cameras_;
  KeypointSet set_;
  std::unique_ptr<KeypointFrames> frames_;
  std::vector<std::vector<double>> residuals_;  // by camera, px
  std::vector<std::vector<double>> ratios_;     // of each of them to the deviation that the keypoint states
};

void KeypointJob::find_offsets() {
  std::vector<rk::CameraFrames> frames(files_.size());
  bool any = false;
  for (std::size_t c = 0; c < files_.size(); ++c) {
    if (!files_[c] || files_[c]->sequence.frames.empty()) continue;
    frames[c] = {.camera = &*cameras_[c],
                 .people = &files_[c]->sequence.frames,
                 .rate_hz = files_[c]->rate_hz,
                 .offset_s = files_[c]->offset_s,
                 .known = rig_.cameras[c].offset_s.has_value()};
    any |= !frames[c].known;
  }
  if (!any) return;
  const auto offsets = rk::find_clock_offsets(frames, {.farthest_s = options_.farthest_offset_s});
  for (std::size_t c = 0; c < files_.size(); ++c) {
    if (!offsets[c]) continue;
    files_[c]->offset_s = offsets[c]->offset_s;
    rig_.cameras[c].offset_s = offsets[c]->offset_s;
    summary_.cameras[c].offset_s = offsets[c]->offset_s;
    summary_.cameras[c].offset_sigma_s = offsets[c]->sigma_s;
  }
}

/// Those who are there for long enough, the most seen first where only some are wanted; by the order in which they came.
std::vector<rk::PersonTrack> KeypointJob::people_kept(std::map<int, rk::PersonTrack> tracks) const {
  const auto views_of = [](const rk::PersonTrack& track) {
    std::int64_t views = 0;
    for (const rk::LocatedPerson& person : track.instants)
      views += std::count_if(person.views.begin(), person.views.end(), [](int view) { return view >= 0; });
    return views;
  };
  std::vector<std::pair<std::int64_t, rk::PersonTrack>> kept;
  for (auto& [id, track] : tracks) {
    const double located = static_cast<double>(
        std::count_if(track.instants.begin(), track.instants.end(), [](const auto& person) { return !person.points.empty(); }));
    if (located >= options_.shortest_s * frames_->rate_hz()) kept.emplace_back(views_of(track), std::move(track));
  }
  if (options_.people > 0 && std::ssize(kept) > options_.people) {
    std::stable_sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    kept.resize(static_cast<std::size_t>(options_.people));
    std::stable_sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.second.id < b.second.id; });
  }
  std::vector<rk::PersonTrack> people;
  for (auto& [views, track] : kept) people.push_back(std::move(track));
  return people;
}

rk::PersonPath KeypointJob::smooth(rk::PersonTrack& track, double noise) const {
  const rk::FindKeypoints find = [this](std::size_t instant, int camera, int index) {
    return &frames_->at(instant, static_cast<std::size_t>(camera))[static_cast<std::size_t>(index)];
  };
  rk::PersonPathOptions how;
  how.noise = noise;
  return rk::path_of(track, set_, cameras_, find, 1 / frames_->rate_hz(), how);
}

void KeypointJob::count(const rk::PersonTrack& track, const rk::PersonPath* path) {
  for (std::size_t k = 0; k < track.instants.size(); ++k) {
    const rk::LocatedPerson& person = track.instants[k];
    for (std::size_t c = 0; c < person.views.size(); ++c) {
      if (person.views[c] < 0) continue;
      KeypointsSummary::Camera& camera = summary_.cameras[c];
      ++camera.located;
      camera.swapped += (person.mirrored[c].arms ? 1 : 0) + (person.mirrored[c].legs ? 1 : 0);
      const Keypoints<2>& detected = frames_->at(track.first + k, c)[static_cast<std::size_t>(person.views[c])];
      for (std::size_t i = 0; i < set_.points.size(); ++i) {
        std::optional<Vector<3>> location;
        if (path != nullptr && !path->points[i].empty()) location = path->points[i][k].position;
        if (path == nullptr && person.points[i]) location = person.points[i]->position;
        if (!location || !detected.points[i]) continue;
        const auto pixel = cameras_[c]->project(*location);
        if (!pixel) continue;
        residuals_[c].push_back((*pixel - detected.points[i]->position).norm());
        ratios_[c].push_back(residuals_[c].back() / std::sqrt(std::sqrt(detected.points[i]->covariance.determinant())));
      }
    }
  }
}

void KeypointJob::add_person(const rk::PersonTrack& track, const rk::PersonPath* path, std::size_t number, std::size_t of,
                             Recording& recording) {
  for (std::size_t i = 0; i < set_.points.size(); ++i) {
    TrackName name;
    name.id = TrackId{static_cast<int>(number * set_.points.size() + i) + 1};
    name.label = of > 1 ? fmt::format("P{}:{}", number + 1, set_.points[i]) : set_.points[i];
    TrackColumns columns(name, 3);
    if (path == nullptr) {
      add_instants(track, i, columns);
    } else if (!path->points[i].empty()) {
      add_path(path->points[i], track.first, static_cast<std::size_t>(options_.fill_s * frames_->rate_hz()), columns);
    }
    for (const Provenance provenance : columns.provenance())
      ++(provenance == Provenance::measured ? summary_.measured : summary_.filled);
    if (!columns.empty()) recording.put(std::move(columns));
  }
}

RecordingHeader KeypointJob::header() const {
  RecordingHeader header;
  header.frame.kind = FrameOfReference::Kind::space;
  header.time_base.kind = TimeBase::Kind::rig;
  header.track_kind = TrackKind::keypoint;
  header.rate_hz = frames_->rate_hz();
  header.rig = rig_;
  for (RigCamera& camera : header.rig->cameras) camera.source = shown_source(camera.source);
  header.smoothed = options_.smooth && !summary_.one_camera;
  header.made_by.program = "marey reconstruct";
  header.made_by.options = hooks_.options;
  header.made_by.options["keypoint set"] = set_.name;
  if (summary_.one_camera)
    header.made_by.options["positions"] = "one camera: feet on the floor, bodies in vertical planes that face the camera";
  for (std::size_t c = 0; c < files_.size(); ++c) {
    if (files_[c]) header.made_by.inputs.push_back(format::input_of(shown_source(keypoint_file_of(rig_.cameras[c]))));
  }
  return header;
}

void KeypointJob::count_cameras() {
  for (std::size_t c = 0; c < rig_.cameras.size(); ++c) {
    KeypointsSummary::Camera camera;
    camera.name = rig_.cameras[c].name;
    if (files_[c]) {
      camera.frames = std::ssize(files_[c]->sequence.frames);
      for (const auto& people : files_[c]->sequence.frames) camera.people += std::ssize(people);
    }
    summary_.cameras.push_back(std::move(camera));
  }
}

KeypointsSummary::Person person_of(const rk::PersonTrack& track, std::string label) {
  KeypointsSummary::Person stated{.label = std::move(label)};
  for (const rk::LocatedPerson& person : track.instants) {
    if (person.points.empty()) continue;
    ++stated.instants;
    stated.views +=
        static_cast<double>(std::count_if(person.views.begin(), person.views.end(), [](int view) { return view >= 0; }));
  }
  stated.views /= static_cast<double>(std::max<std::int64_t>(1, stated.instants));
  return stated;
}

void KeypointJob::report(const TrackedPeople& tracked) {
  summary_.set = set_.name;
  summary_.points = static_cast<int>(set_.points.size());
  summary_.frames = static_cast<std::int64_t>(frames_->size());
  summary_.rate_hz = frames_->rate_hz();
  summary_.seconds = static_cast<double>(frames_->size() - 1) / frames_->rate_hz();
  std::vector<double> all, ratios, times = tracked.times_ms;
  for (std::size_t c = 0; c < residuals_.size(); ++c) {
    all.insert(all.end(), residuals_[c].begin(), residuals_[c].end());
    ratios.insert(ratios.end(), ratios_[c].begin(), ratios_[c].end());
    summary_.cameras[c].residual_px = geometry::median_or(residuals_[c], 0);
    summary_.cameras[c].noise = geometry::median_or(ratios_[c], 0) / kMedianLength;
  }
  summary_.residual_px = geometry::median_or(all, 0);
  summary_.noise = geometry::median_or(ratios, 0) / kMedianLength;
  summary_.position_ms = geometry::median_or(times, 0);
  summary_.views = tracked.detected;
  summary_.located = tracked.located;
  warn_of_misfit();
}

void KeypointJob::warn_of_misfit() {
  if (summary_.one_camera) {
    summary_.warnings.push_back(
        "one camera: people stand where their feet meet the floor (z = 0), and their bodies lie in vertical planes that face the "
        "camera; how far a limb is in front of its plane or behind it is not known");
    return;
  }
  const bool few = static_cast<double>(summary_.located) < kFewLocated * static_cast<double>(summary_.views);
  if (few)
    summary_.warnings.push_back(fmt::format("only {} of {} people in images are placed: two cameras must see the same person",
                                            summary_.located, summary_.views));
  if (summary_.noise > kWorstNoise)
    summary_.warnings.push_back(fmt::format(
        "the rig does not fit these keypoints: they lie {:.0f} px (median) from where space has them, {:.1f} times what "
        "keypoints of their confidence do",
        summary_.residual_px, summary_.noise));
  bool misfit =
      static_cast<double>(summary_.located) < kMaxLocated * static_cast<double>(summary_.views) || summary_.noise > kWorstNoise;
  for (const KeypointsSummary::Camera& camera : summary_.cameras) {
    if (camera.noise <= kWorstCamera * summary_.noise) continue;
    misfit = true;
    summary_.warnings.push_back(fmt::format(
        "camera \"{}\": keypoints lie {:.0f} px (median) from where space has them, and {:.0f} px in all cameras: was it "
        "moved since it was calibrated, or does it run unsynchronised?",
        camera.name, camera.residual_px, summary_.residual_px));
  }
  if (!misfit) return;
  for (std::string& message_text : reasons_of_misfit(rig_, *frames_, set_)) summary_.warnings.push_back(std::move(message_text));
}

Recording KeypointJob::run() {
  count_cameras();
  summary_.one_camera = one_camera();
  if (options_.find_offsets && !summary_.one_camera) find_offsets();
  frames_ = std::make_unique<KeypointFrames>(files_);
  if (frames_->size() == 0)
    throw Error(
        "no two cameras have frames at the same time: the offsets in the rig are wrong, or the files are of other recordings");
  residuals_.resize(cameras_.size());
  ratios_.resize(cameras_.size());
  const double noise = summary_.one_camera ? 1 : keypoint_noise(cameras_, *frames_, set_);
  TrackedPeople tracked = summary_.one_camera ? track_on_floor(cameras_, *frames_, set_)
                                              : track_in_views(cameras_, *frames_, set_, kGateSlack * noise, hooks_);
  std::vector<rk::PersonTrack> people = people_kept(std::move(tracked.tracks));
  if (people.empty() && summary_.one_camera)
    throw Error("no person is placed: of {} people in the images none stands on the floor; is z = 0 the floor in the rig?",
                tracked.detected);
  if (people.empty()) {
    const std::vector<std::string> reasons = reasons_of_misfit(rig_, *frames_, set_);
    throw Error("no person is placed: no two cameras see the same person among {} people in their images; {}", tracked.detected,
                reasons.empty() ? "are the keypoints of this rig's cameras, and at the same time?" : reasons.front());
  }
  Recording recording(header());
  for (std::size_t t = 0; t < frames_->size(); ++t)
    recording.add_time_step({static_cast<std::int64_t>(t), timestamp_from_seconds(static_cast<double>(t) / frames_->rate_hz())});
  for (std::size_t p = 0; p < people.size(); ++p) {
    std::optional<rk::PersonPath> path;
    if (options_.smooth && !summary_.one_camera) path = smooth(people[p], noise);
    add_person(people[p], path ? &*path : nullptr, p, people.size(), recording);
    count(people[p], path ? &*path : nullptr);
    summary_.people.push_back(person_of(people[p], people.size() > 1 ? fmt::format("P{}", p + 1) : ""));
    hooks_.advance({.step = "smoothing", .done = static_cast<std::int64_t>(p) + 1, .total = std::ssize(people)});
  }
  report(tracked);
  return recording;
}

}  // namespace

Recording keypoints_in_space(const Rig& rig, const KeypointsInSpaceOptions& options, KeypointsSummary& summary,
                             const Hooks& hooks) {
  return KeypointJob(rig, options, summary, hooks).run();
}

KeypointsSummary reconstruct_keypoints(const Rig& rig, const std::string& out, const KeypointsInSpaceOptions& options,
                                       const Hooks& hooks) {
  const format::Format& format = format::format_to_write(out, {}, format::Content::space);
  KeypointsSummary summary;
  const Recording recording = keypoints_in_space(rig, options, summary, hooks);
  const auto sink = format::create_recording(out, format, format::plan_of(*format::reader_of(recording), out), &summary.warnings);
  MemoryReader reader(recording);
  replay(reader, *sink);
  return summary;
}

}  // namespace marey::pipeline::keypoints

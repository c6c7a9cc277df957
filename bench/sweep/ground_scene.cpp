#include "ground_scene.h"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <map>

#include <Eigen/LU>
#include <fmt/core.h>

#include "marey/assign/gated_assignment.h"
#include "marey/core/error.h"
#include "marey/format/match/ground_file.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/tracks/detections.h"
#include "marey/pipeline/corridor/clock.h"
#include "marey/pipeline/people/ground/track_ground.h"
#include "marey/pipeline/take/evaluate_match.h"
#include "marey/reconstruct/place_people.h"

#include "experiments/markdown_table.h"

namespace marey::sweep {
namespace {

GroundScores scores_of(const std::string& folder, const Recording& tracks, double farthest) {
  const Recording truth = format::match::read_ground(folder + "/truth.csv");
  const pipeline::take::MatchEvaluation evaluated = pipeline::take::evaluate_match(truth, tracks, farthest);
  const evaluate::Evaluation& scores = evaluated.evaluation.scores;
  GroundScores result;
  result.mota = scores.clear.mota.value_or(0);
  result.idf1 = scores.identity.f1.value_or(0);
  result.hota = scores.hota.hota;
  result.switches = scores.clear.switches;
  result.people = static_cast<int>(truth.tracks().size());
  result.tracks = static_cast<int>(tracks.tracks().size());
  if (evaluated.evaluation.position) result.median_error = evaluated.evaluation.position->median;
  return result;
}

struct NaiveTrack {
  int id = 0;
  double detected = 0;  // s
  int hits = 1;
  Vector<2> location = Vector<2>::Zero(), velocity = Vector<2>::Zero();
};

/// Places of all cameras at one instant, those near each other from different cameras as one, weighted by how sure they are.
std::vector<Vector<2>> fused(const std::vector<Observation<2>>& all) {
  struct Cluster {
    Matrix<2> weight = Matrix<2>::Zero();
    Vector<2> sum = Vector<2>::Zero();
    std::vector<int> cameras;
    Vector<2> location() const { return weight.inverse() * sum; }
  };
  std::vector<Cluster> clusters;
  for (const Observation<2>& one : all) {
    Cluster* best = nullptr;
    double nearest = 0.8;
    for (Cluster& cluster : clusters) {
      const double distance = (cluster.location() - one.value).norm();
      const bool taken = std::count(cluster.cameras.begin(), cluster.cameras.end(), number(one.camera)) > 0;
      if (taken || distance > nearest) continue;
      nearest = distance;
      best = &cluster;
    }
    if (best == nullptr) best = &clusters.emplace_back();
    const Matrix<2> weight = one.covariance->inverse();
    best->weight += weight;
    best->sum += weight * one.value;
    best->cameras.push_back(number(one.camera));
  }
  std::vector<Vector<2>> locations;
  for (const Cluster& cluster : clusters) {
    if (cluster.cameras.size() > 1) locations.push_back(cluster.location());
  }
  return locations;
}

/// The tracks' next instant; rows go into `rows` by track.
void track_naively(double time, const std::vector<Vector<2>>& locations, std::vector<NaiveTrack>& tracks, int& next_id,
                   std::vector<std::pair<int, Vector<2>>>& rows) {
  constexpr double gate = 1.2, patience = 1;
  std::vector<assign::GatedPair> pairs;
  for (int t = 0; t < std::ssize(tracks); ++t) {
    const Vector<2> ahead = tracks[t].location + (time - tracks[t].detected) * tracks[t].velocity;
    for (int p = 0; p < std::ssize(locations); ++p) {
      const double distance = (locations[p] - ahead).norm();
      if (distance < gate) pairs.push_back({t, p, gate - distance});
    }
  }
  assign::GatedAssigner assigner;
  const auto given = assigner.assign(static_cast<int>(tracks.size()), static_cast<int>(locations.size()), pairs);
  std::vector<char> taken(locations.size(), 0);
  for (std::size_t t = 0; t < tracks.size(); ++t) {
    if (given[t] == assign::kNoIndex) continue;
    NaiveTrack& track = tracks[t];
    taken[static_cast<std::size_t>(given[t])] = 1;
    const Vector<2>& location = locations[static_cast<std::size_t>(given[t])];
    const Vector<2> velocity = (location - track.location) / (time - track.detected);
    track.velocity = track.hits == 1 ? velocity : Vector<2>(0.5 * track.velocity + 0.5 * velocity);
    track.location = location;
    track.detected = time;
    ++track.hits;
    rows.emplace_back(track.id, location);
  }
  for (std::size_t p = 0; p < locations.size(); ++p) {
    if (taken[p]) continue;
    tracks.push_back({next_id, time, 1, locations[p], Vector<2>::Zero()});
    rows.emplace_back(next_id++, locations[p]);
  }
  std::erase_if(tracks, [&](const NaiveTrack& track) { return time - track.detected > patience; });
}

}  // namespace

GroundScores run_ours(const std::string& folder, const pipeline::people::ground::PeopleOnGroundOptions& options, double farthest) {
  const Rig rig = format::rig::read_rig(folder + "/rig.toml");
  pipeline::people::ground::GroundOutput output;
  output.tracks = folder + "/ours.csv";
  pipeline::people::ground::track_ground(rig, output, options);
  return scores_of(folder, format::match::read_ground(output.tracks), farthest);
}

GroundScores run_naive(const std::string& folder, double farthest) {
  const Rig rig = format::rig::read_rig(folder + "/rig.toml");
  pipeline::corridor::Clock clock(pipeline::corridor::open_feeds(rig, {}));
  std::vector<NaiveTrack> tracks;
  std::map<int, TrackColumns> columns;
  Recording recording;
  recording.header.frame.kind = FrameOfReference::Kind::user_ground;
  int next_id = 1;
  for (std::int32_t instant = 0; const auto frames = clock.next(); ++instant) {
    std::vector<Observation<2>> all;
    for (std::size_t i = 0; i < frames->cameras.size(); ++i) {
      if (!frames->cameras[i] || !frames->cameras[i]->detections) continue;
      reconstruct::LocalisePeopleOptions feet;
      feet.height_spread = 1e6;  // feet alone
      const auto located = reconstruct::localise_people(
          *frames->cameras[i]->detections, rig.cameras[i].ground_view(rig.ground).value(), CameraId{static_cast<int>(i)}, feet);
      all.insert(all.end(), located.detected.begin(), located.detected.end());
    }
    recording.add_time_step({frames->index, frames->time});
    std::vector<std::pair<int, Vector<2>>> rows;
    track_naively(seconds(frames->time), fused(all), tracks, next_id, rows);
    for (const auto& [id, location] : rows) {
      Sample sample;
      sample.position.head<2>() = location;
      columns.try_emplace(id, TrackName{TrackId{id}, {}, {}}, 2).first->second.add(instant, sample);
    }
  }
  for (auto& [id, track] : columns) {
    if (track.size() > 1) recording.put(std::move(track));
  }
  return scores_of(folder, recording, farthest);
}

void print_titles() {
  fmt::print("{}",
             experiments::markdown_header({"seed", "", "IDF1", "MOTA", "HOTA", "switches", "tracks", "people", "median error, m"}));
}

void print_scores(int seed, const std::string& name, const GroundScores& scores) {
  using experiments::markdown_figure;
  fmt::print("{}", experiments::markdown_row({std::to_string(seed), name, markdown_figure(scores.idf1, 3),
                                              markdown_figure(scores.mota, 3), markdown_figure(scores.hota, 3),
                                              std::to_string(scores.switches), std::to_string(scores.tracks),
                                              std::to_string(scores.people), markdown_figure(scores.median_error, 3)}));
}

ScratchFolder::ScratchFolder() {
  std::string pattern = (std::filesystem::temp_directory_path() / "marey_sweep_XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw Error("{}: cannot be made", pattern);
  path_ = pattern;
}

ScratchFolder::~ScratchFolder() {
  std::error_code error;
  std::filesystem::remove_all(path_, error);
}

}  // namespace marey::sweep

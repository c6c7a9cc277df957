#include "marey/pipeline/markers/reconstruct.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/rig/rig_file.h"
#include "marey/format/take/take_file.h"
#include "marey/geometry/layout.h"
#include "marey/pipeline/simulate/room_files.h"
#include "marey/simulate/room/room.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::pipeline::markers {
namespace {

struct Score {
  std::int64_t points = 0, far = 0;
  std::vector<double> errors;             // m, of measured points
  std::vector<double> of_filled;          // m
  std::map<int, std::map<int, int>> ids;  // frames by marker and track

  double median() { return middle(errors); }
  static double middle(std::vector<double>& list) {
    if (list.empty()) return 0;
    std::nth_element(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2), list.end());
    return list[list.size() / 2];
  }
};

/// Every point of a take against the nearest true marker at its time.
Score score_of(const std::string& path, const marey::simulate::room::RoomScene& scene) {
  Score score;
  format::take::TakeReader reader(path);
  while (const auto frame = reader.next()) {
    const auto truth = scene.points(seconds(frame->time));
    for (const Sample& point : frame->samples) {
      int nearest = 0;
      for (int m = 0; m < std::ssize(truth); ++m) {
        if ((truth[m] - point.position).norm() < (truth[nearest] - point.position).norm()) nearest = m;
      }
      const double error = (truth[nearest] - point.position).norm();
      ++score.points;
      score.far += point.provenance == Provenance::measured && error > 0.01;
      if (point.provenance == Provenance::measured) {
        score.errors.push_back(error);
        ++score.ids[nearest][number(point.track)];
      } else {
        score.of_filled.push_back(error);
      }
    }
  }
  return score;
}

TEST(Reconstruct, AWalkBecomesATakeWithTheNamesKept) {
  const test::TemporaryFolder folder;
  marey::simulate::room::RoomOptions room{
      .markers = 30, .frames = 600, .dropped = 0.05, .ghosts = 0.05, .gap_fraction = 0.02, .bump = {}};
  const marey::simulate::room::RoomScene scene(room);
  simulate::write_room(scene, folder.path());
  const auto summary = reconstruct(format::rig::read_rig(folder / "rig.toml"), folder / "observations.csv", folder / "walk.marey");
  EXPECT_EQ(summary.frames, 600);
  EXPECT_NEAR(summary.figures.at("noise_px"), 0.1, 0.02);
  EXPECT_EQ(summary.steps.size(), 5);
  Score score = score_of(folder / "walk.marey", scene);
  EXPECT_GT(score.points, 0.95 * 600 * 30);
  EXPECT_LT(static_cast<double>(score.far), 0.002 * static_cast<double>(score.points));
  EXPECT_LT(score.median(), 0.0006);
  ASSERT_FALSE(score.of_filled.empty());
  EXPECT_LT(Score::middle(score.of_filled), 0.03);
  EXPECT_EQ(score.ids.size(), 30);
  for (const auto& [marker, ids] : score.ids) {
    int maximum = 0, all = 0;
    for (const auto& [id, frames] : ids) maximum = std::max(maximum, frames), all += frames;
    EXPECT_GT(maximum, 0.98 * all) << "marker " << marker;
  }
}

/// Each track's share of points on the marker that it is on the most; the least of all tracks.
double min_purity(const Score& score) {
  std::map<int, std::map<int, int>> markers;
  for (const auto& [marker, ids] : score.ids) {
    for (const auto& [id, points] : ids) markers[id][marker] += points;
  }
  double minimum = 1;
  for (const auto& [id, on] : markers) {
    int maximum = 0, all = 0;
    for (const auto& [marker, points] : on) maximum = std::max(maximum, points), all += points;
    if (all > 60) minimum = std::min(minimum, static_cast<double>(maximum) / all);
  }
  return minimum;
}

TEST(Reconstruct, WithFourCamerasNoNameGoesToAnotherMarker) {
  const test::TemporaryFolder folder;
  const marey::simulate::room::RoomScene scene(
      {.cameras = 4, .frames = 900, .dropped = 0.05, .ghosts = 0.05, .gap_fraction = 0.05, .bump = {}, .seed = 2});
  simulate::write_room(scene, folder.path());
  reconstruct(format::rig::read_rig(folder / "rig.toml"), folder / "observations.csv", folder / "walk.marey");
  const Score score = score_of(folder / "walk.marey", scene);
  EXPECT_GT(score.points, 0.4 * 900 * 50);
  EXPECT_GT(min_purity(score), 0.9);
}

TEST(Reconstruct, ACameraThatWasBumpedIsNamedAndSeesOn) {
  const test::TemporaryFolder folder;
  marey::simulate::room::RoomOptions room{.cameras = 5, .markers = 30, .frames = 300, .bump = {}};
  room.bump = {.camera = 2, .time_s = 1, .angle = 0.01};
  const marey::simulate::room::RoomScene scene(room);
  simulate::write_room(scene, folder.path());
  const auto summary = reconstruct(format::rig::read_rig(folder / "rig.toml"), folder / "observations.csv", folder / "walk.marey");
  ASSERT_EQ(summary.warnings.size(), 1);
  EXPECT_NE(summary.warnings[0].find("\"cam3\" was moved at 1.0"), std::string::npos) << summary.warnings[0];
  EXPECT_TRUE(std::regex_search(summary.warnings[0], std::regex("by 0\\.5[678]°"))) << summary.warnings[0];
  std::int64_t by_three = 0, all = 0;
  format::take::TakeReader reader(folder / "walk.marey");
  while (const auto frame = reader.next()) {
    if (frame->index < 200) continue;
    for (const Sample& point : frame->samples) {
      by_three += (point.cameras & mask_of(CameraId{2})) != 0;
      ++all;
    }
  }
  EXPECT_GT(static_cast<double>(by_three), 0.4 * static_cast<double>(all));
  const Score score = score_of(folder / "walk.marey", scene);
  EXPECT_LT(static_cast<double>(score.far), 0.002 * static_cast<double>(score.points));
}

TEST(Reconstruct, CamerasOutOfStepAreBroughtToOneInstant) {
  const test::TemporaryFolder folder;
  const marey::simulate::room::RoomScene scene({.markers = 20, .frames = 240, .occlusion = false, .offset_s = 0.02, .bump = {}});
  simulate::write_room(scene, folder.path());
  reconstruct(format::rig::read_rig(folder / "rig.toml"), folder / "observations.csv", folder / "walk.marey");
  Score score = score_of(folder / "walk.marey", scene);
  EXPECT_GT(score.points, 0.85 * 240 * 20);
  EXPECT_LT(score.median(), 0.001);
}

TEST(Reconstruct, ATakeIsSolvedAgainFromWhatItsCamerasSaw) {
  const test::TemporaryFolder folder;
  const marey::simulate::room::RoomScene scene({.markers = 20, .frames = 240, .gap_fraction = 0.02, .offset_s = 0.02, .bump = {}});
  simulate::write_room(scene, folder.path());
  const Rig rig = format::rig::read_rig(folder / "rig.toml");
  MarkersInSpaceOptions no_gaps;
  no_gaps.fill_s = 0;
  const auto first = reconstruct(rig, folder / "observations.csv", folder / "walk.marey", no_gaps);
  EXPECT_EQ(first.filled, 0);
  const auto better = reconstruct(rig, folder / "walk.marey", folder / "better.marey");
  EXPECT_EQ(better.frames, first.frames);
  EXPECT_EQ(better.rate_hz, first.rate_hz);
  EXPECT_EQ(better.figures.at("observations"), first.figures.at("observations"));
  EXPECT_NEAR(static_cast<double>(better.measured), static_cast<double>(first.measured),
              0.001 * static_cast<double>(first.measured));
  EXPECT_GT(better.filled, 0);
  Score score = score_of(folder / "better.marey", scene);
  EXPECT_LT(score.median(), 0.001) << "what was moved to an instant is not moved again";

  // What a take keeps of a blob it keeps permanently.
  reconstruct(rig, folder / "better.marey", folder / "again.marey");
  const Recording one = format::take::read_recording(folder / "better.marey");
  const Recording two = format::take::read_recording(folder / "again.marey");
  ASSERT_EQ(one.samples(), two.samples());
  InstantsOf some(one), others(two);
  while (const auto a = some.next()) {
    const auto b = others.next();
    ASSERT_TRUE(b);
    ASSERT_EQ(a->time, b->time);
    ASSERT_EQ(a->detected, b->detected);
    for (std::size_t i = 0; i < a->samples.size(); ++i) ASSERT_EQ(a->samples[i].position, b->samples[i].position);
  }
}

TEST(Reconstruct, ATakeIsSolvedAgainOnlyWithItsCameras) {
  const test::TemporaryFolder folder;
  const marey::simulate::room::RoomScene scene({.markers = 5, .frames = 20, .bump = {}});
  simulate::write_room(scene, folder.path());
  Rig rig = format::rig::read_rig(folder / "rig.toml");
  reconstruct(rig, folder / "observations.csv", folder / "walk.marey");
  rig.cameras[1].name = "another";
  EXPECT_THROW(reconstruct(rig, folder / "walk.marey", folder / "better.marey"), Error);
  Recording bare;
  bare.header.frame.kind = FrameOfReference::Kind::space;
  bare.header.rate_hz = 100;
  bare.header.rig = rig;
  format::take::write_recording(folder / "bare.marey", bare);
  EXPECT_THROW(reconstruct(rig, folder / "bare.marey", folder / "better.marey"), Error) << "nothing was seen";
}

TEST(Reconstruct, ACameraThatStopsCostsOnlyItsRays) {
  const test::TemporaryFolder folder;
  const marey::simulate::room::RoomScene scene({.markers = 20, .frames = 240, .occlusion = false, .bump = {}});
  simulate::write_room(scene, folder.path());
  {
    std::ifstream all(folder / "observations.csv");
    std::ofstream some(folder / "some.csv");
    for (std::string line; std::getline(all, line);) {
      if (line.starts_with("cam3,") && std::stoi(line.substr(5)) > 60) continue;
      some << line << '\n';
    }
  }
  reconstruct(format::rig::read_rig(folder / "rig.toml"), folder / "some.csv", folder / "walk.marey");
  reconstruct(format::rig::read_rig(folder / "rig.toml"), folder / "some.csv", folder / "walk.c3d");
  EXPECT_GT(std::filesystem::file_size(folder / "walk.c3d"), 240 * 20 * 16);
  EXPECT_FALSE(std::filesystem::exists(folder / "walk.c3d.part.marey"));
  Score score = score_of(folder / "walk.marey", scene);
  EXPECT_GT(score.points, 0.97 * 240 * 20);
  EXPECT_EQ(score.far, 0);
}

TEST(Reconstruct, AMarkerSetNamesTheMarkers) {
  const test::TemporaryFolder folder;
  const marey::simulate::room::RoomScene scene(
      {.motion = marey::simulate::room::RoomMotion::still, .markers = 20, .frames = 60, .occlusion = false, .bump = {}});
  simulate::write_room(scene, folder.path());
  MarkersInSpaceOptions options;
  options.set.labels = scene.labels();
  const Rigid3 rotated{geometry::rotation_from({0, 0, 0.3}), {0.5, -1, 0.2}};
  for (const Vector<3>& location : scene.points(0)) options.set.locations.push_back(rotated * location);
  const auto summary =
      reconstruct(format::rig::read_rig(folder / "rig.toml"), folder / "observations.csv", folder / "still.marey", options);
  EXPECT_EQ(summary.labelled, 20);
  format::take::TakeReader reader(folder / "still.marey");
  const auto frame = reader.next().value();
  const auto tracks = reader.tracks();
  const auto truth = scene.points(0);
  for (const Sample& point : frame.samples) {
    const auto track = std::find_if(tracks.begin(), tracks.end(), [&](const TrackName& one) { return one.id == point.track; });
    ASSERT_NE(track, tracks.end());
    const auto label = std::find(scene.labels().begin(), scene.labels().end(), track->label);
    ASSERT_NE(label, scene.labels().end()) << track->label;
    EXPECT_LT((truth[static_cast<std::size_t>(label - scene.labels().begin())] - point.position).norm(), 0.005);
  }
}

TEST(Reconstruct, RefusesWhatCannotBe) {
  const test::TemporaryFolder folder;
  const marey::simulate::room::RoomScene scene({.cameras = 2, .markers = 4, .frames = 3, .bump = {}});
  simulate::write_room(scene, folder.path());
  Rig rig = format::rig::read_rig(folder / "rig.toml");
  EXPECT_THROW(reconstruct(rig, "", folder / "a.marey"), Error) << "no sources";
  EXPECT_THROW(reconstruct(rig, folder / "observations.csv", folder / "a.docx"), Error);
  EXPECT_THROW(reconstruct(rig, folder / "nothing.csv", folder / "a.marey"), Error);
  rig.cameras[1].lens.reset();
  EXPECT_THROW(reconstruct(rig, folder / "observations.csv", folder / "a.marey"), Error) << "one calibrated camera";
}

/// The wing's calibration, as its author gives it.
Rig rig_of_wing(const std::string& folder) {
  Rig rig;
  std::ifstream file(folder + "/cameras.toml");
  const auto numbers = [](std::string line) {
    std::erase_if(line, [](char c) { return c == '[' || c == ']'; });
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream text(line.substr(line.find('=') + 1));
    std::vector<double> list;
    for (double value = 0; text >> value;) list.push_back(value);
    return list;
  };
  geometry::BrownLens lens;
  Rigid3 pose;
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("focal_px")) lens.focal = Vector<2>::Constant(numbers(line)[0]);
    if (line.starts_with("principal_px")) lens.principal = Vector<2>(numbers(line)[0], numbers(line)[1]);
    if (line.starts_with("R =")) {
      const auto values = numbers(line);
      for (int i = 0; i < 9; ++i) pose.rotation(i / 3, i % 3) = values[static_cast<std::size_t>(i)];
    }
    if (!line.starts_with("t_mm")) continue;
    const auto values = numbers(line);
    pose.translation = Vector<3>(values[0], values[1], values[2]) / 1000;
    RigCamera camera;
    const int number = static_cast<int>(rig.cameras.size());
    camera.name = "cam" + std::to_string(number + 1);
    camera.source = folder + "/pitching_wing_5hz";
    camera.region = cv::Rect(0, 1024 * number, 1024, 1024);
    camera.rate_hz = 50;
    camera.size = cv::Size(1024, 1024);
    camera.lens = lens;
    camera.camera_from_world = pose;
    rig.cameras.push_back(camera);
  }
  return rig;
}

/// Root mean square, of all and of the rest when each group's mean is taken away.
struct Spread {
  std::map<int, std::vector<Eigen::VectorXd>> groups;

  double all() const {
    double sum = 0, count = 0;
    for (const auto& [key, list] : groups) {
      for (const auto& value : list) sum += value.squaredNorm(), ++count;
    }
    return std::sqrt(sum / count);
  }
  double random() const {
    double sum = 0, count = 0;
    for (const auto& [key, list] : groups) {
      Eigen::VectorXd mean = Eigen::VectorXd::Zero(list.front().size());
      for (const auto& value : list) mean += value / static_cast<double>(list.size());
      for (const auto& value : list) sum += (value - mean).squaredNorm();
      count += static_cast<double>(list.size()) - 1;
    }
    return std::sqrt(sum / count);
  }
};

/// The names and places of the wing's markers, m. Its layout is symmetric, but for its frame: in the world x and y run the other
/// direction.
MarkerSet set_of_wing(const std::string& data) {
  MarkerSet set;
  std::ifstream layout(data + "/marker_layout_mm.csv");
  std::string line;
  for (std::getline(layout, line); std::getline(layout, line);) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream text(line);
    std::string label;
    Vector<3> location;
    text >> label >> location.x() >> location.y() >> location.z();
    set.labels.push_back(label);
    set.locations.push_back(Vector<3>(-location.x(), -location.y(), location.z()) / 1000);
  }
  return set;
}

/// How far the markers of a take are from what the cameras saw of them, and from the rigid wing.
struct WingErrors {
  Spread pixels, locations;
  double sum_px = 0;
  int count_px = 0;

  /// Markers by track.
  void add(const Instant& instant, const std::map<TrackId, int>& marker_of, const Rig& rig, const MarkerSet& set) {
    std::vector<Vector<3>> from, to;
    std::vector<int> markers;
    for (const Sample& point : instant.samples) {
      const auto marker = marker_of.find(point.track);
      if (marker == marker_of.end()) continue;
      markers.push_back(marker->second);
      from.push_back(set.locations[static_cast<std::size_t>(markers.back())]);
      to.push_back(point.position);
      for (const ImageObservation& detected : instant.detected) {
        if (detected.track != point.track) continue;
        const int camera = number(detected.camera);
        const Vector<2> error =
            rig.cameras[static_cast<std::size_t>(camera)].camera()->project(point.position).value() - detected.pixel;
        sum_px += error.norm();
        ++count_px;
        pixels.groups[16 * camera + markers.back()].push_back(error);
      }
    }
    ASSERT_EQ(markers.size(), 16) << "at " << instant.index;
    const Rigid3 fit = geometry::rigid_fit(from, to);
    for (std::size_t i = 0; i < from.size(); ++i) {
      locations.groups[markers[i]].push_back(fit.rotation.transpose() * (to[i] - fit * from[i]));
    }
  }
};

TEST(Reconstruct, TheWingFromItsRawPictures) {
  const std::string data = test::data("wing");
  if (!std::filesystem::exists(data)) GTEST_SKIP() << data << " is not here";
  const test::TemporaryFolder folder;
  MarkersInSpaceOptions options;
  options.markers.dark = true;
  options.markers.widest = 9;
  options.markers.min_area = 4;
  options.markers.min_roundness = 0.5;
  options.set = set_of_wing(data);
  ASSERT_EQ(options.set.labels.size(), 16);
  const Rig rig = rig_of_wing(data);
  const auto summary = reconstruct(rig, "", folder / "wing.marey", options);
  EXPECT_EQ(summary.frames, 6);
  EXPECT_EQ(summary.labelled, 16);

  format::take::TakeReader reader(folder / "wing.marey");
  std::map<TrackId, int> marker_of;
  for (const TrackName& track : reader.tracks()) {
    if (!track.label.empty()) marker_of[track.id] = std::stoi(track.label) - 1;
  }
  WingErrors errors;
  while (const auto frame = reader.next()) errors.add(*frame, marker_of, rig, options.set);
  RecordProperty("mean_px", std::to_string(errors.sum_px / errors.count_px));
  RecordProperty("rigid_mm", std::to_string(1000 * errors.locations.all()));
  RecordProperty("random_px", std::to_string(errors.pixels.random()));
  RecordProperty("random_mm", std::to_string(1000 * errors.locations.random()));
  EXPECT_GE(errors.count_px, 3 * 16 * 6 - 6);
  EXPECT_LE(errors.sum_px / errors.count_px, 0.25);
  EXPECT_LE(errors.locations.all(), 0.60e-3);
  EXPECT_LE(errors.pixels.random(), 0.10);
  EXPECT_LE(errors.locations.random(), 0.13e-3);
}

}  // namespace
}  // namespace marey::pipeline::markers

// Against the biomechZoo children: strikes and offs that people marked, and Plug-in Gait's own angles.
#include "marey/pipeline/bodies/measure_gait.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/mapped_file.h"
#include "marey/format/motion/c3d.h"
#include "marey/format/motion/c3d_parameters.h"
#include "marey/format/recording_file.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::pipeline::bodies {
namespace {

namespace fs = std::filesystem;
namespace gait = analyse::gait;

struct Child {
  std::string static_trial;
  std::vector<std::string> walks;
};

std::vector<Child> children() {
  std::vector<Child> all;
  const std::string folder = test::data("gait_children");
  if (!fs::exists(folder)) return all;
  std::vector<fs::path> folders;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_directory()) folders.push_back(entry.path());
  }
  std::sort(folders.begin(), folders.end());
  for (const fs::path& own : folders) {
    Child child;
    for (const auto& file : fs::directory_iterator(own)) {
      const std::string name = file.path().filename().string();
      if (name.starts_with("static")) child.static_trial = file.path().string();
      if (name.starts_with("straight") || name.starts_with("turn")) child.walks.push_back(file.path().string());
    }
    std::sort(child.walks.begin(), child.walks.end());
    all.push_back(child);
  }
  return all;
}

/// The file's events: EVENT:TIMES count from frame 1.
std::vector<gait::GaitEvent> events_in(const std::string& path) {
  const format::MappedFile file(path);
  const auto head = format::motion::read_c3d_head(file.bytes(), path);
  std::vector<gait::GaitEvent> events;
  const auto labels = head.parameters.find("EVENT:LABELS"), sides = head.parameters.find("EVENT:CONTEXTS");
  if (labels == head.parameters.end() || sides == head.parameters.end()) return events;
  for (std::size_t i = 0; i < labels->second.texts.size(); ++i) {
    const double time = 60 * head.number("EVENT:TIMES", 2 * i).value_or(0) + head.number("EVENT:TIMES", 2 * i + 1).value_or(0);
    events.push_back({sides->second.texts.at(i) == "Left" ? gait::Side::left : gait::Side::right,
                      labels->second.texts[i] == "Foot Strike", time - (head.first_frame - 1) / head.rate_hz, 0});
  }
  return events;
}

struct Offsets {
  std::vector<double> values;
  double mean() const {
    double sum = 0;
    for (const double v : values) sum += v;
    return sum / static_cast<double>(values.size());
  }
  double deviation() const {
    double sum = 0;
    for (const double v : values) sum += (v - mean()) * (v - mean());
    return std::sqrt(sum / static_cast<double>(values.size()));
  }
};

TEST(MeasureGait, FindsTheStepsThatPeopleMarked) {
  const std::vector<Child> all = children();
  if (all.empty()) GTEST_SKIP() << test::data("gait_children") << " is not here";
  int marked = 0, missed = 0;
  Offsets strikes, offs;
  for (const Child& child : all) {
    for (const std::string& walk : child.walks) {
      const GaitMeasure measure = measure_gait(walk, {.static_trial = child.static_trial});
      for (const gait::GaitEvent& truth : events_in(walk)) {
        if (truth.time_s < -0.001 || truth.time_s > static_cast<double>(measure.frames) / measure.rate_hz) continue;
        ++marked;
        double nearest = 1;
        for (const gait::GaitEvent& found : measure.events) {
          if (found.side == truth.side && found.strike == truth.strike && std::abs(found.time_s - truth.time_s) < std::abs(nearest))
            nearest = found.time_s - truth.time_s;
        }
        if (std::abs(nearest) > 0.1) {
          ++missed;
        } else {
          (truth.strike ? strikes : offs).values.push_back(nearest);
        }
      }
    }
  }
  std::printf("%d marked, %d missed; strikes %+.1f ms, deviation %.1f; offs %+.1f ms, deviation %.1f\n", marked, missed,
              1000 * strikes.mean(), 1000 * strikes.deviation(), 1000 * offs.mean(), 1000 * offs.deviation());
  EXPECT_GE(marked, 125);
  EXPECT_LE(missed, marked / 50);
  EXPECT_LT(std::abs(strikes.mean()), 0.005);
  EXPECT_LT(std::abs(offs.mean()), 0.005);
  EXPECT_LT(strikes.deviation(), 0.015);
  EXPECT_LT(offs.deviation(), 0.015);
}

/// The file's own curve, degrees: it stands among the points, as if it were millimetres.
std::vector<std::optional<double>> curve_in(const std::string& path, const std::string& label, std::size_t rows) {
  std::vector<std::optional<double>> values(rows);
  const auto reader = format::motion::open_c3d(path, format::motion::C3dPoints::all);
  std::optional<TrackId> track;
  for (const TrackName& name : reader->tracks()) {
    if (name.label == label) track = name.id;
  }
  for (std::size_t row = 0; row < rows; ++row) {
    const auto instant = reader->next();
    if (!instant) break;
    for (const Sample& sample : instant->samples) {
      if (sample.track == track) values[row] = 1000 * sample.position.x();
    }
  }
  return values;
}

TEST(MeasureGait, AgreesWithPlugInGait) {
  const std::vector<Child> all = children();
  if (all.empty()) GTEST_SKIP() << test::data("gait_children") << " is not here";
  const std::map<std::string, std::string> theirs = {
      {"left_hip_flexion", "LHipAngles"},     {"left_knee_flexion", "LKneeAngles"},   {"left_ankle_dorsiflexion", "LAnkleAngles"},
      {"right_hip_flexion", "RHipAngles"},    {"right_knee_flexion", "RKneeAngles"},  {"right_ankle_dorsiflexion", "RAnkleAngles"},
      {"left_elbow_flexion", "LElbowAngles"}, {"right_elbow_flexion", "RElbowAngles"}};
  std::map<std::string, std::pair<double, int>> squares;
  for (const Child& child : all) {
    for (const std::string& walk : child.walks) {
      if (walk.find("straight") == std::string::npos) continue;
      const GaitMeasure measure = measure_gait(walk, {.static_trial = child.static_trial});
      for (const gait::AngleCurve& curve : measure.angles) {
        const auto other = theirs.find(curve.name);
        if (other == theirs.end()) continue;
        const auto there = curve_in(walk, other->second, curve.values.size());
        double sum = 0;
        int count = 0;
        for (std::size_t r = 0; r < there.size(); ++r) {
          if (!there[r] || !curve.values[r]) continue;
          const double off = *curve.values[r] * 180 / std::numbers::pi - *there[r];
          sum += off * off;
          ++count;
        }
        if (count == 0) continue;
        std::printf("%s %s: %.2f deg RMSE over %d\n", fs::path(walk).filename().c_str(), curve.name.c_str(), std::sqrt(sum / count),
                    count);
        squares[curve.name.substr(curve.name.find('_') + 1)].first += sum;
        squares[curve.name.substr(curve.name.find('_') + 1)].second += count;
      }
    }
  }
  ASSERT_EQ(squares.size(), 4U);
  for (const auto& [name, sum] : squares) {
    const double rmse = std::sqrt(sum.first / sum.second);
    std::printf("%s: %.2f deg RMSE\n", name.c_str(), rmse);
    EXPECT_LT(rmse, name == "elbow_flexion" ? 0.1 : 3) << name;
  }
}

/// The file's own third coordinate, in its own number.
std::vector<double> third_in(const std::string& path, const std::string& label) {
  std::vector<double> values;
  const auto reader = format::motion::open_c3d(path, format::motion::C3dPoints::all);
  std::optional<TrackId> track;
  for (const TrackName& name : reader->tracks()) {
    if (name.label == label) track = name.id;
  }
  while (const auto instant = reader->next()) {
    for (const Sample& sample : instant->samples) {
      if (sample.track == track) values.push_back(1000 * sample.position.z());
    }
  }
  return values;
}

TEST(MeasureGait, FootProgressionAndForcesAgreeWithPlugInGait) {
  const std::vector<Child> all = children();
  if (all.empty()) GTEST_SKIP() << test::data("gait_children") << " is not here";
  int forces = 0;
  for (const Child& child : all) {
    for (const std::string& walk : child.walks) {
      if (walk.find("straight") == std::string::npos) continue;
      const GaitMeasure measure = measure_gait(walk, {.static_trial = child.static_trial});
      for (const char* side : {"left", "right"}) {
        const std::vector<double> theirs =
            third_in(walk, side == std::string("left") ? "LFootProgressAngles" : "RFootProgressAngles");
        const auto ours = std::find_if(measure.angles.begin(), measure.angles.end(),
                                       [&](const auto& curve) { return curve.name == std::string(side) + "_foot_progression"; });
        ASSERT_NE(ours, measure.angles.end());
        double squares = 0, count = 0;
        for (std::size_t r = 0; r < std::min(theirs.size(), ours->values.size()); ++r) {
          if (!ours->values[r]) continue;
          squares += std::pow(*ours->values[r] * 180 / std::numbers::pi - theirs[r], 2);
          ++count;
        }
        std::printf("%s %s progression: %.2f deg RMSE over %.0f\n", fs::path(walk).filename().c_str(), side,
                    std::sqrt(squares / count), count);
        // Plug-in Gait measures against the laboratory's axis: HC030A walks 2° across it.
        EXPECT_LT(std::sqrt(squares / count), walk.find("HC030A") == std::string::npos ? 2.5 : 5) << walk << " " << side;
      }
      for (const gait::SignalCurve& curve : measure.ground) {
        if (curve.label != "up") continue;
        const std::vector<double> theirs = third_in(walk, curve.side == gait::Side::left ? "LNormalisedGRF" : "RNormalisedGRF");
        const double most = *std::max_element(theirs.begin(), theirs.end()),
                     found = *std::max_element(curve.mean.begin(), curve.mean.end());
        std::printf("%s up: %.1f %% of weight, the file has %.1f\n", fs::path(walk).filename().c_str(), found, most);
        EXPECT_NEAR(found, most, 2) << walk;
        EXPECT_EQ(curve.unit, "% of weight");
        ++forces;
      }
    }
  }
  EXPECT_GE(forces, 6);
}

TEST(MeasureGait, CyclesOfStraightWalksDoNotTurn) {
  const std::vector<Child> all = children();
  if (all.empty()) GTEST_SKIP() << test::data("gait_children") << " is not here";
  for (const Child& child : all) {
    for (const std::string& walk : child.walks) {
      const GaitMeasure measure = measure_gait(walk, {.static_trial = child.static_trial});
      for (const auto& cycle : measure.cycles.cycles) {
        std::printf("%s: turns by %.1f deg\n", fs::path(walk).filename().c_str(), cycle.turn.value_or(9) * 180 / std::numbers::pi);
        if (walk.find("straight") == std::string::npos) continue;
        EXPECT_LT(std::abs(cycle.turn.value_or(9)), max_reference_turn()) << walk;
      }
    }
  }
}

TEST(MeasureGait, ArmsDoNotTurnOver) {
  const std::vector<Child> all = children();
  if (all.empty()) GTEST_SKIP() << test::data("gait_children") << " is not here";
  for (const Child& child : all) {
    for (const std::string& walk : child.walks) {
      const GaitMeasure measure = measure_gait(walk, {.static_trial = child.static_trial});
      for (const gait::AngleCurve& curve : measure.angles) {
        if (curve.name.find("elbow") == std::string::npos && curve.name.find("shoulder") == std::string::npos) continue;
        for (std::size_t r = 1; r < curve.values.size(); ++r) {
          if (!curve.values[r] || !curve.values[r - 1]) continue;
          const double step = std::abs(*curve.values[r] - *curve.values[r - 1]) * 180 / std::numbers::pi;
          EXPECT_LT(step, 20) << walk << ": " << curve.name << " in row " << r;
        }
      }
    }
  }
}

TEST(MeasureGait, WritesWhatItFound) {
  const std::vector<Child> all = children();
  if (all.empty()) GTEST_SKIP() << test::data("gait_children") << " is not here";
  const test::TemporaryFolder here;
  const GaitMeasure measure =
      measure_gait(all[0].walks[0], {.cycles = here / "cycles.csv", .angles = here / "angles.csv", .report = here / "report.html"},
                   {.static_trial = all[0].static_trial});
  EXPECT_GE(measure.cycles.cycles.size(), 3U);
  EXPECT_NE(test::read_file(here / "cycles.csv").find("left_knee_flexion,60,"), std::string::npos);
  const std::string report = test::read_file(here / "report.html");
  EXPECT_NE(report.find("knee flexion"), std::string::npos);
  EXPECT_NE(report.find("stride length"), std::string::npos);
  EXPECT_NE(report.find("left shoulder plane, left shoulder rotation: not known for"), std::string::npos)
      << "an arm that hangs down";
  EXPECT_EQ(report.find(fs::path(all[0].walks[0]).parent_path().string()), std::string::npos) << "a page tells no folders";
}

bool warns_of_another_person(const GaitMeasure& measure) {
  return std::any_of(measure.warnings.begin(), measure.warnings.end(),
                     [](const std::string& warning) { return warning.find("another person") != std::string::npos; });
}

TEST(MeasureGait, KnowsAStaticTrialOfAnotherPerson) {
  const std::vector<Child> all = children();
  if (all.empty()) GTEST_SKIP() << test::data("gait_children") << " is not here";
  for (const Child& walker : all) {
    for (const Child& standing : all) {
      for (const std::string& walk : walker.walks)
        EXPECT_EQ(warns_of_another_person(measure_gait(walk, {.static_trial = standing.static_trial})), &walker != &standing)
            << walk << ", " << standing.static_trial;
    }
  }
}

TEST(MeasureGait, WritesNoCyclesWhereThereAreNone) {
  const std::string punches = test::data("cmu_02_05/cmu_02_05.c3d");
  if (!fs::exists(punches)) GTEST_SKIP() << punches << " is not here";
  const test::TemporaryFolder here;
  EXPECT_THROW(measure_gait(punches, {.cycles = here / "c.csv", .angles = here / "a.csv", .report = {}}, {}), Error);
  EXPECT_THROW(measure_gait(punches, {.cycles = {}, .angles = {}, .report = here / "r.html"}, {}), Error);
  EXPECT_FALSE(fs::exists(here / "c.csv"));
  EXPECT_FALSE(fs::exists(here / "r.html"));
  EXPECT_TRUE(fs::exists(here / "a.csv"));
}

TEST(MeasureGait, SaysWhichMarkersItNeeds) {
  const test::TemporaryFolder here;
  test::write_file(here / "a.trc",
                   "PathFileType\t4\t(X/Y/"
                   "Z)\ta.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n100\t100\t1\t1\tm\nFrame#"
                   "\tTime\tNOSE\t\t\n\t\tX1\tY1\tZ1\n\n1\t0\t1\t2\t3\n");
  EXPECT_THROW(measure_gait(here / "a.trc", {}), Error);
}

}  // namespace
}  // namespace marey::pipeline::bodies

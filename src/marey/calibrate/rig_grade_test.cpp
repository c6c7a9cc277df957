// `grade` of rig_report.h, which has a source of its own.
#include <gtest/gtest.h>

#include "marey/calibrate/rig_report.h"

namespace marey::calibrate {
namespace {

/// A rig without fault: 0.1 px, half of each image covered, no outlier, the wand's length right to 0.1 mm.
RigReport faultless() {
  RigReport report;
  report.noise_px = 0.1;
  report.all.inliers = report.all.observations = 1000;
  for (const char* name : {"left", "right"}) {
    report.cameras.emplace_back();
    report.cameras.back().name = name;
    report.cameras.back().coverage = 0.5;
  }
  report.held_out.emplace().length_rms_mm = 0.1;
  return report;
}

std::string graded(RigReport report, int columns = 1280, double wand_m = 0.3) {
  grade(report, columns, wand_m);
  return report.grade;
}

TEST(RigGrade, WithoutFaultIsExcellentAndNamesNoLimit) {
  RigReport report = faultless();
  grade(report, 1280, 0.3);
  EXPECT_EQ(report.grade, "excellent");
  EXPECT_EQ(report.meaning, "fit for measuring");
}

TEST(RigGrade, TheWorstMeasureDecidesAndIsNamed) {
  RigReport report = faultless();
  report.noise_px = 0.4;               // good
  report.held_out->length_rms_mm = 3;  // 1 %: fair
  report.cameras[1].coverage = 0.25;   // good
  grade(report, 1280, 0.3);
  EXPECT_EQ(report.grade, "fair");
  EXPECT_NE(report.meaning.find("the wand's length, off by 3.0 mm"), std::string::npos) << report.meaning;
}

TEST(RigGrade, NoiseCountsByThePicturesWidth) {
  RigReport report = faultless();
  report.noise_px = 0.4;
  EXPECT_EQ(graded(report, 1280), "good");
  EXPECT_EQ(graded(report, 2560), "excellent");
  EXPECT_EQ(graded(report, 640), "fair");
}

TEST(RigGrade, EachMeasureAloneLowersIt) {
  RigReport noisy = faultless(), bare = faultless(), wild = faultless();
  noisy.noise_px = 1.5;
  bare.cameras[0].coverage = 0.1;
  wild.all.inliers = 700;
  EXPECT_EQ(graded(noisy), "poor");
  EXPECT_EQ(graded(bare), "fair");
  EXPECT_EQ(graded(wild), "poor");
}

TEST(RigGrade, ASingleLightHasNoLengthToBeJudgedBy) {
  RigReport report = faultless();
  report.held_out->length_rms_mm = 50;
  EXPECT_EQ(graded(report, 1280, 0), "excellent");
  EXPECT_EQ(graded(report, 1280, 0.3), "poor");
  report.held_out.reset();
  EXPECT_EQ(graded(report, 1280, 0.3), "excellent");
}

}  // namespace
}  // namespace marey::calibrate

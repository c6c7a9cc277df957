#include "marey/detect/keypoints/landmark_network.h"

#include <cstdlib>
#include <filesystem>
#include <vector>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/core/image.h"
#include "marey/detect/keypoints/blazepose.h"
#include "marey/detect/keypoints/model_folder.h"

#include "support/data.h"
#include "support/files.h"

namespace marey::detect::keypoints {
namespace {

/// Empty if script/model has not made it.
std::string lite() {
  try {
    return landmark_model("lite");
  } catch (const Error&) {
    return {};
  }
}

std::string refused_landmarks(const std::string& path) {
  try {
    LandmarkNetwork network(path);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(LandmarkNetwork, LogitsOfAMaskAreChances) {
  std::vector<network::Tensor> outputs(2);
  outputs[0].values.assign(static_cast<std::size_t>(PersonRegion::kCrop) * PersonRegion::kCrop, -20);
  outputs[0].values[10 * PersonRegion::kCrop + 30] = 0;
  outputs[0].values[10 * PersonRegion::kCrop + 31] = 20;
  outputs[1].values = {0.8F};
  const BodyPixels pixels = pixels_of(outputs, region_of(Box{100, 50, 40, 128}));
  EXPECT_NEAR(pixels.chance.at<float>(10, 30), 0.5, 1e-6);
  EXPECT_NEAR(pixels.chance.at<float>(10, 31), 1, 1e-6);
  EXPECT_NEAR(pixels.chance.at<float>(11, 31), 0, 1e-6);
  EXPECT_NEAR(pixels.presence, 0.8, 1e-6);
  EXPECT_EQ(pixels.region.centre, (Box{100, 50, 40, 128}.centre()));
  outputs[0].values.pop_back();
  EXPECT_THROW(pixels_of(outputs, {}), Error);
}

TEST(Blazepose, EveryPointHasItsOtherSide) {
  const KeypointSet& set = blazepose();
  ASSERT_EQ(set.points.size(), 33U);
  ASSERT_EQ(set.mirrored.size(), 33U);
  EXPECT_EQ(set.mirrored[0], 0);
  EXPECT_EQ(set.mirrored[27], 28);
  for (std::size_t i = 0; i < 33; ++i) {
    EXPECT_EQ(set.mirrored[static_cast<std::size_t>(set.mirrored[i])], static_cast<int>(i));
    EXPECT_TRUE(i == 0 || set.mirrored[i] != static_cast<int>(i)) << set.points[i];
  }
  EXPECT_EQ(set.bones.size(), 35U);
}

TEST(LandmarkNetwork, AModelThatIsNotThereIsOneSentence) {
  const test::TemporaryFolder folder;
  const char* before = std::getenv("MAREY_MODELS");
  const std::string kept = before == nullptr ? "" : before;
  setenv("MAREY_MODELS", folder.path().c_str(), 1);
  try {
    landmark_model("lite");
    ADD_FAILURE() << "found in an empty folder";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("script/model"), std::string::npos) << error.what();
    EXPECT_NE(std::string(error.what()).find("pose_landmark_lite.onnx"), std::string::npos) << error.what();
  }
  if (before == nullptr) {
    unsetenv("MAREY_MODELS");
  } else {
    setenv("MAREY_MODELS", kept.c_str(), 1);
  }
  EXPECT_NE(refused_landmarks(folder / "none.onnx").find("is not there"), std::string::npos);
}

TEST(LandmarkNetwork, AModelThatIsNoneIsOneSentence) {
  const test::TemporaryFolder folder;
  test::write_file(folder / "text.onnx", "no network");
  EXPECT_NE(refused_landmarks(folder / "text.onnx").find("cannot be loaded"), std::string::npos);
  if (lite().empty()) GTEST_SKIP() << "script/model has not made the networks";
  for (const double fraction : {0.0, 0.1, 0.5, 0.9, 0.999}) {
    std::filesystem::copy_file(lite(), folder / "cut.onnx", std::filesystem::copy_options::overwrite_existing);
    test::cut_file(folder / "cut.onnx", fraction);
    const std::string message_text = refused_landmarks(folder / "cut.onnx");
    EXPECT_NE(message_text.find("script/model"), std::string::npos) << fraction << ": " << message_text;
    EXPECT_EQ(message_text.find('\n'), std::string::npos) << message_text;
  }
}

TEST(LandmarkNetwork, AnotherNetworkIsRefused) {
  std::string other;
  try {
    other = model_file("person.onnx");
  } catch (const Error&) {
    GTEST_SKIP() << "script/model has not made the networks";
  }
  EXPECT_NE(refused_landmarks(other).find("another network"), std::string::npos) << refused_landmarks(other);
}

TEST(LandmarkNetwork, SeesNobodyOnGrey) {
  if (lite().empty()) GTEST_SKIP() << "script/model has not made the networks";
  LandmarkNetwork network(lite());
  const std::vector<PersonRegion> regions{region_of(Box{10, 10, 50, 100}), region_of(Box{100, 100, 200, 500})};
  for (const Body& body : network.find(cv::Mat(600, 600, CV_8UC3, cv::Scalar(90, 120, 110)), regions)) {
    EXPECT_LT(body.keypoints.presence, 0.5);
    EXPECT_EQ(body.keypoints.points.size(), 33U);
  }
}

}  // namespace
}  // namespace marey::detect::keypoints

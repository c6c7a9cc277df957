#include "marey/format/rig/soccernet_camera.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::format::rig {
namespace {

const std::string kCamera = R"({"pan_degrees": -30.0, "tilt_degrees": 75.0, "roll_degrees": 2.0,
  "position_meters": [3.0, 60.0, -15.0], "x_focal_length": 2100.0, "y_focal_length": 2100.0, "principal_point": [480.0, 270.0],
  "radial_distortion": [0.1, 0, 0, 0, 0, 0], "tangential_distortion": [0, 0], "thin_prism_distortion": [0, 0, 0, 0]})";

/// The pixel of a place in SoccerNet's frame, written out as its own code does.
Vector<2> pixel_by_soccernet(const Vector<3>& location) {
  const double p = -30 * std::numbers::pi / 180, t = 75 * std::numbers::pi / 180, r = 2 * std::numbers::pi / 180;
  Matrix<3> pan, tilt, roll;
  pan << std::cos(p), -std::sin(p), 0, std::sin(p), std::cos(p), 0, 0, 0, 1;
  tilt << 1, 0, 0, 0, std::cos(t), -std::sin(t), 0, std::sin(t), std::cos(t);
  roll << std::cos(r), -std::sin(r), 0, std::sin(r), std::cos(r), 0, 0, 0, 1;
  const Vector<3> at = (pan * tilt * roll).transpose() * (location - Vector<3>(3, 60, -15));
  const Vector<2> plane(at.x() / at.z(), at.y() / at.z());
  return 2100 * plane * (1 + 0.1 * plane.squaredNorm()) + Vector<2>(480, 270);
}

TEST(SoccernetCamera, SeesWhatTheirCodeSees) {
  const Camera camera = parse_soccernet_camera(kCamera, "camera.json", {});
  EXPECT_EQ(camera.size(), cv::Size(960, 540));
  for (const Vector<3>& location : {Vector<3>(40, 0, 0), Vector<3>(20, -20, 0), Vector<3>(52.5, 3.66, -2.44)}) {
    const auto pixel = camera.project({location.x() + 52.5, 34 - location.y(), -location.z()});
    ASSERT_TRUE(pixel);
    EXPECT_LT((*pixel - pixel_by_soccernet(location)).norm(), 1e-9);
  }
}

TEST(SoccernetCamera, IsWrittenAndReadBack) {
  const geometry::PitchSize size{101, 66};
  const Camera camera = parse_soccernet_camera(kCamera, "camera.json", size);
  const Camera again = parse_soccernet_camera(soccernet_camera_text(camera, size), "again.json", size);
  EXPECT_LT((again.camera_from_world().rotation - camera.camera_from_world().rotation).norm(), 1e-9);
  EXPECT_LT((again.centre() - camera.centre()).norm(), 1e-7);
  EXPECT_EQ(again.size(), camera.size());
}

TEST(SoccernetCamera, ReportsMissingAndImpossibleValues) {
  const auto refused = [](std::string text, const std::string& from, const std::string& to) -> std::string {
    text.replace(text.find(from), from.size(), to);
    try {
      parse_soccernet_camera(text, "camera.json", {});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refused(kCamera, "tilt_degrees", "tilt"), "camera.json: \"tilt_degrees\" is missing, which a camera of SoccerNet has");
  EXPECT_EQ(refused(kCamera, "\"x_focal_length\": 2100.0", "\"x_focal_length\": -1"),
            "camera.json: focal lengths must be positive");
  EXPECT_EQ(refused(kCamera, "\"thin_prism_distortion\": [0", "\"thin_prism_distortion\": [1"),
            "camera.json: has thin prism distortion, which cannot be read; calibrate without it");
}

}  // namespace
}  // namespace marey::format::rig

#include "marey/format/scene/blender_scene.h"

#include <string>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/read_file.h"
#include "marey/geometry/lens.h"

#include "support/files.h"

namespace marey::format::scene {
namespace {

RecordingHeader header_in_space() {
  RecordingHeader header;
  header.name = "a \"walk\"\nimport os";
  header.frame.kind = FrameOfReference::Kind::space;
  header.rate_hz = 50;
  return header;
}

RigCamera camera_before_origin() {
  geometry::BrownLens lens;
  lens.focal = {800, 800}, lens.principal = {319.5, 239.5};
  RigCamera camera;
  camera.name = "left";
  camera.source = "left.mp4";
  camera.size = cv::Size(640, 480);
  camera.lens = lens;
  camera.camera_from_world = Rigid3{Matrix<3>::Identity(), Vector<3>(0, 0, 4)};
  return camera;
}

std::string written(const RecordingHeader& header) {
  const test::TemporaryFolder folder;
  const auto sink = create_blender_scene(folder / "scene.py");
  sink->begin(header);
  for (const int index : {10, 12}) {
    Instant instant;
    instant.index = index;
    if (index == 10) instant.named = {{TrackId{1}, "LA\"NK", ""}};
    Sample sample;
    sample.track = TrackId{1};
    sample.position = {1, 2, 0.5 * index};
    instant.samples = {sample};
    sink->write(instant);
  }
  sink->finish();
  return read_file(folder / "scene.py");
}

TEST(BlenderScene, MarkersAndCamerasAreInTheScript) {
  RecordingHeader header = header_in_space();
  header.rig.emplace().cameras = {camera_before_origin()};
  const std::string text = written(header);
  EXPECT_NE(text.find("(\"LA\\\"NK\", [(1.00000,2.00000,5.00000),None,(1.00000,2.00000,6.00000)])"), std::string::npos)
      << text.substr(0, 900);
  EXPECT_NE(text.find("\"size\": (640, 480), \"fx\": 800.000000"), std::string::npos);
  EXPECT_NE(text.find("\"video\": \"left.mp4\""), std::string::npos);
  EXPECT_EQ(text.find("bends the corners"), std::string::npos) << "a pinhole bends nothing";
  EXPECT_EQ(text.find("\nimport os"), std::string::npos) << "names stay on their line";
}

TEST(BlenderScene, StatesMissingFeaturesOfBlender) {
  RecordingHeader header = header_in_space();
  RigCamera bent = camera_before_origin(), part = camera_before_origin();
  geometry::BrownLens lens = std::get<geometry::BrownLens>(*bent.lens);
  lens.distortion[0] = -0.2;
  bent.lens = lens;
  part.name = "part", part.region = cv::Rect(0, 0, 640, 480);
  header.rig.emplace().cameras = {bent, part};
  const std::string text = written(header);
  EXPECT_NE(text.find("its lens bends the corners by"), std::string::npos);
  EXPECT_NE(text.find("a part of a larger image"), std::string::npos);
}

TEST(BlenderScene, OnlySpaceIsAScene) {
  const test::TemporaryFolder folder;
  RecordingHeader header = header_in_space();
  header.frame.kind = FrameOfReference::Kind::image;
  EXPECT_THROW(create_blender_scene(folder / "scene.py")->begin(header), Error);
}

}  // namespace
}  // namespace marey::format::scene

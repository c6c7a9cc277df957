#include "marey/format/skeleton/gltf.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/format/read_file.h"
#include "marey/format/skeleton/skeleton_file.h"
#include "marey/geometry/lens.h"

#include "support/files.h"

namespace marey::format::skeleton {
namespace {

/// A .glb file apart: its description, and the floats of an accessor.
struct Scene {
  nlohmann::json json;
  std::string buffer;

  static Scene of(const std::string& bytes) {
    const auto word = [&](std::size_t at) {
      std::uint32_t value = 0;
      std::memcpy(&value, bytes.data() + at, sizeof value);
      return value;
    };
    EXPECT_EQ(bytes.substr(0, 4), "glTF");
    EXPECT_EQ(word(8), bytes.size());
    const std::size_t end = 20 + word(12);
    Scene scene{nlohmann::json::parse(bytes.substr(20, word(12))), {}};
    if (end < bytes.size()) {
      EXPECT_EQ(end + 8 + word(end), bytes.size());
      scene.buffer = bytes.substr(end + 8);
    }
    return scene;
  }

  std::vector<float> floats(int accessor) const {
    const auto& view = json["bufferViews"][json["accessors"][static_cast<std::size_t>(accessor)]["bufferView"].get<std::size_t>()];
    std::vector<float> values(view["byteLength"].get<std::size_t>() / sizeof(float));
    std::memcpy(values.data(), buffer.data() + view["byteOffset"].get<std::size_t>(), values.size() * sizeof(float));
    return values;
  }

  const nlohmann::json* node(const std::string& name) const {
    for (const auto& one : json["nodes"]) {
      if (one["name"] == name) return &one;
    }
    return nullptr;
  }

  /// What moves a node; empty if nothing does.
  std::vector<float> motion(const std::string& name, const std::string& path) const {
    if (!json.contains("animations")) return {};
    const auto& animation = json["animations"][0];
    for (const auto& channel : animation["channels"]) {
      const auto& target = channel["target"];
      if (json["nodes"][target["node"].get<std::size_t>()]["name"] != name || target["path"] != path) continue;
      return floats(animation["samplers"][channel["sampler"].get<std::size_t>()]["output"].get<int>());
    }
    return {};
  }
};

RecordingHeader header_with_camera() {
  RecordingHeader header;
  header.frame.kind = FrameOfReference::Kind::space;
  header.rate_hz = 50;
  geometry::BrownLens lens;
  lens.focal = {800, 820}, lens.principal = {319.5, 239.5};
  RigCamera camera;
  camera.name = "left";
  camera.source = "left \"hand\".mp4";
  camera.size = cv::Size(640, 480);
  camera.lens = lens;
  const Matrix<3> turn = Eigen::AngleAxisd(1.9, Vector<3>(1, 0.3, -0.2).normalized()).toRotationMatrix();
  camera.camera_from_world = Rigid3{turn, Vector<3>(0.2, 0.1, 4)};
  header.rig.emplace().cameras = {camera};
  return header;
}

/// Three instants; the second without the point "head".
std::string written(const std::string& path, const RecordingHeader& header, GlbContent content = GlbContent::scene) {
  const auto sink = create_glb(path, content);
  sink->begin(header);
  for (const int index : {0, 1, 2}) {
    Instant instant;
    instant.index = index;
    instant.time = timestamp_from_seconds(0.02 * index);
    if (index == 0) instant.named = {{TrackId{7}, "head", ""}, {TrackId{9}, "foot", ""}};
    Sample head, foot;
    head.track = TrackId{7}, head.position = {0.1, 0.2 + index, 1.7};
    foot.track = TrackId{9}, foot.position = {0.3, -0.4, 0.05};
    if (index == 1) {
      instant.samples = {foot};
    } else {
      instant.samples = {head, foot};
    }
    sink->write(instant);
  }
  sink->finish();
  return read_file(path);
}

TEST(GlbScene, MarkersMoveWithYUpAndHaveNoSizeWhileUnknown) {
  const test::TemporaryFolder folder;
  const Scene scene = Scene::of(written(folder / "scene.glb", header_with_camera()));
  const std::vector<float> head = scene.motion("head", "translation"), size = scene.motion("head", "scale");
  ASSERT_EQ(head.size(), 9U);
  EXPECT_EQ(size, (std::vector<float>{1, 1, 1, 0, 0, 0, 1, 1, 1}));
  // z up (x, y, z) is y up (y, z, x), as in BVH files: a turn, not a mirror.
  const Matrix<3> file_from_world = z_up_from(UpAxis::y).transpose();
  for (const int index : {0, 2}) {
    const Vector<3> expected = file_from_world * Vector<3>(0.1, 0.2 + index, 1.7);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(head[static_cast<std::size_t>(3 * index + i)], expected[i], 1e-6);
  }
  EXPECT_NEAR((file_from_world * Vector<3>::UnitZ() - Vector<3>::UnitY()).norm(), 0, 1e-12);
  EXPECT_TRUE(scene.motion("foot", "scale").empty()) << "always known";
  EXPECT_FALSE(scene.json.contains("skins"));
}

TEST(GlbScene, CamerasSeeMarkersWhereTheRigsCamerasDo) {
  const test::TemporaryFolder folder;
  const RecordingHeader header = header_with_camera();
  const Scene scene = Scene::of(written(folder / "scene.glb", header));
  const nlohmann::json* node = scene.node("left");
  ASSERT_NE(node, nullptr);
  const auto& camera = scene.json["cameras"][(*node)["camera"].get<std::size_t>()]["perspective"];
  const auto r = (*node)["rotation"].get<std::array<double, 4>>();
  const auto t = (*node)["translation"].get<std::array<double, 3>>();
  const Eigen::Quaterniond turn(r[3], r[0], r[1], r[2]);
  const std::vector<float> foot = scene.motion("foot", "translation");
  const Vector<3> at = turn.conjugate() * (Vector<3>(foot[0], foot[1], foot[2]) - Vector<3>(t[0], t[1], t[2]));
  // Section 3.10.3 of glTF: aimed along −z, y up; the image's half height is tan(yfov / 2).
  ASSERT_LT(at.z(), 0);
  const double half = std::tan(camera["yfov"].get<double>() / 2);
  const double x = at.x() / -at.z() / (half * camera["aspectRatio"].get<double>()), y = at.y() / -at.z() / half;
  const auto pixel = header.rig->cameras[0].camera()->project(Vector<3>(0.3, -0.4, 0.05));
  ASSERT_TRUE(pixel);
  EXPECT_NEAR((x + 1) / 2 * 640 - 0.5, pixel->x(), 1e-3);
  EXPECT_NEAR((1 - y) / 2 * 480 - 0.5, pixel->y(), 1e-3);
  EXPECT_EQ((*node)["extras"]["video"], "left \"hand\".mp4");
  EXPECT_EQ((*node)["extras"]["fy_px"], 820);
}

TEST(GlbScene, BonesAloneAndImagesAreRefused) {
  const test::TemporaryFolder folder;
  RecordingHeader header = header_with_camera();
  EXPECT_THROW(create_glb(folder / "a.glb", GlbContent::bones)->begin(header), Error) << "no skeleton";
  header.frame.kind = FrameOfReference::Kind::image;
  EXPECT_THROW(create_glb(folder / "b.glb")->begin(header), Error);
}

TEST(GlbScene, BonesAloneHaveNeitherMarkersNorCameras) {
  const test::TemporaryFolder folder;
  RecordingHeader header = header_with_camera();
  Body body;
  body.id = BodyId{1}, body.label = "hips", body.skeleton = "walker";
  header.bodies = {body};
  const Scene all = Scene::of(written(folder / "all.glb", header)),
              bones = Scene::of(written(folder / "bones.glb", header, GlbContent::bones));
  EXPECT_NE(all.node("head"), nullptr);
  EXPECT_NE(all.node("hips"), nullptr);
  EXPECT_EQ(bones.node("head"), nullptr);
  EXPECT_FALSE(bones.json.contains("cameras"));
  EXPECT_EQ(bones.json["nodes"].size(), 3U) << "the segment, what holds it, the figure";
}

}  // namespace
}  // namespace marey::format::skeleton

#include "marey/core/rig.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey {
namespace {

Rig two_cameras() {
  Rig rig;
  RigCamera left;
  left.name = "left";
  left.source = "left_camera.mp4";
  left.size = cv::Size(3072, 1728);
  geometry::BrownLens lens;
  lens.focal = {2123.1, 2123.1};
  lens.principal = {1642.7, 875.7};
  lens.distortion = {-0.348, 0.124, 0, 0, -0.014};
  left.lens = lens;
  left.camera_from_world = Rigid3{Matrix<3>::Identity(), {0, 0, 5}};
  RigCamera far;
  far.name = "far";
  far.size = cv::Size(640, 480);
  far.ground_from_image = Matrix<3>{{0.1, 0, -3}, {0, 0.1, 2}, {0, 0.001, 1}};
  rig.cameras = {left, far};
  return rig;
}

TEST(FitToSize, ACalibrationIsScaledWhereTheShapeFits) {
  Rig rig = two_cameras();
  RigCamera& left = rig.cameras[0];
  const Vector<3> point(0.3, -0.2, 1);
  const Vector<2> before = *left.camera()->project(point);
  fit_to_size(left, {1536, 864});
  EXPECT_EQ(left.size, cv::Size(1536, 864));
  EXPECT_LT((*left.camera()->project(point) - ((before.array() + 0.5) / 2 - 0.5).matrix()).norm(), 1e-9);
  EXPECT_THROW(fit_to_size(left, {1440, 1080}), Error);

  RigCamera& far = rig.cameras[1];
  const Vector<2> ground = far.ground_view({})->location({100.25, 300})->ground;
  fit_to_size(far, {1280, 960});
  EXPECT_LT((far.ground_view({})->location({200.5 + 0.5, 600.5})->ground - ground).norm(), 1e-12);
}

TEST(FitToSize, MasksCoverWhatTheyCovered) {
  Rig rig = two_cameras();
  RigCamera& left = rig.cameras[0];
  left.size = {3072, 1728};
  left.masks = {{3, 5, 10, 20}};
  fit_to_size(left, {1536, 864});
  EXPECT_EQ(left.masks.front(), Mask(1, 2, 6, 11));
  fit_to_size(left, {3072, 1728});
  EXPECT_EQ(left.masks.front(), Mask(2, 4, 12, 22));
}

TEST(FitToSize, ACodecsPaddingIsLeftOut) {
  RigCamera camera;
  camera.size = cv::Size(1088, 1920);
  geometry::BrownLens lens;
  lens.focal = {1500, 1500};
  camera.lens = lens;
  fit_to_size(camera, {1080, 1920});
  EXPECT_EQ(camera.size, cv::Size(1080, 1920));
  EXPECT_EQ(std::get<geometry::BrownLens>(*camera.lens).focal.x(), 1500);
  camera.size = cv::Size(1088, 1920);
  EXPECT_THROW(fit_to_size(camera, {1070, 1920}), Error);
}

TEST(FitToSize, GivesASizeWhereThereIsNone) {
  Rig rig = two_cameras();
  rig.cameras[0].size.reset();
  fit_to_size(rig.cameras[0], {1920, 1080});
  EXPECT_EQ(rig.cameras[0].size, cv::Size(1920, 1080));
}

TEST(CameraNamed, NamesTheOthersWhereThereIsNone) {
  Rig rig = two_cameras();
  EXPECT_EQ(&camera_named(rig, "far"), &rig.cameras[1]);
  try {
    camera_named(rig, "right");
    FAIL() << "there is none";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("left, far"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace marey

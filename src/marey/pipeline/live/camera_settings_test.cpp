#include "marey/pipeline/live/camera_settings.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/rig/rig_file.h"
#include "marey/source/live/connection.h"

#include "support/files.h"

namespace marey::pipeline::live {
namespace {

using source::live::Control;
using source::live::ControlRange;

/// A camera that takes exposures up to 10 ms, and no gain.
class SettingsCamera final : public source::live::Connection {
 public:
  const SourceInfo& info() const override { return info_; }
  source::live::Came next(source::live::Shot&) override { return source::live::Came::nothing; }
  std::vector<ControlRange> controls() override { return {{Control::exposure, 0.1, 10, exposure_ms}}; }
  void set(Control control, double value) override {
    if (control != Control::exposure) return Connection::set(control, value);
    if (value > 10) throw Error("{}", "too long");
    exposure_ms = value;
  }
  double exposure_ms = 5;

 private:
  SourceInfo info_{.name = "eye", .size = {}, .rate_hz = {}, .frame_count = {}};
};

Rig two_on_a_settings() {
  return format::rig::parse_rig(
      "[[camera]]\nname = \"left\"\nsource = \"gige:1\"\nsize = [1280, 960]\nexposure = 4.0\nmasks = [[20, 40, 20, 20]]\n"
      "[[camera]]\nname = \"right\"\nsource = \"gige:2\"\n",
      "rig.toml");
}

class CameraSettingsTest : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
  std::string file_ = folder_ / "rig.toml";
  Rig rig_ = two_on_a_settings();
  CameraSettings camera_settings_{rig_};
  SettingsCamera left_;
};

TEST_F(CameraSettingsTest, TheRigsExposureIsSetWhenTheCameraComesAndWhatWasAskedForWhenItComesBack) {
  camera_settings_.controls(0)->begin(left_);
  EXPECT_EQ(left_.exposure_ms, 4);
  EXPECT_FALSE(camera_settings_.has_changed()) << "that is what the rig says";
  camera_settings_.controls(0)->request(Control::exposure, 2);
  camera_settings_.controls(0)->apply(left_);
  EXPECT_EQ(left_.exposure_ms, 2);
  EXPECT_TRUE(camera_settings_.has_changed());
  EXPECT_EQ(camera_settings_.camera(0).controls.at(0).now, 2);
  SettingsCamera back;
  camera_settings_.controls(0)->begin(back);
  EXPECT_EQ(back.exposure_ms, 2);
}

TEST_F(CameraSettingsTest, ReportsRefusedControlWithoutStoringIt) {
  camera_settings_.controls(0)->begin(left_);
  camera_settings_.controls(0)->request(Control::exposure, 20);
  camera_settings_.controls(0)->apply(left_);
  EXPECT_EQ(camera_settings_.camera(0).refused, "left: too long");
  EXPECT_EQ(left_.exposure_ms, 4);
  EXPECT_FALSE(camera_settings_.has_changed());
  camera_settings_.controls(0)->request(Control::gain, 2);
  camera_settings_.controls(0)->apply(left_);
  EXPECT_EQ(camera_settings_.camera(0).refused, "left: its gain cannot be set from here");
  camera_settings_.controls(0)->request(Control::exposure, 3);
  camera_settings_.controls(0)->apply(left_);
  EXPECT_EQ(camera_settings_.camera(0).refused, "");
}

TEST_F(CameraSettingsTest, AThresholdThatFindsNothingIsRefused) {
  camera_settings_.set_threshold(1, 90);
  for (const double level : {-1.0, 0.0, 65535.0, 99999.0}) EXPECT_THROW(camera_settings_.set_threshold(1, level), Error) << level;
  EXPECT_EQ(camera_settings_.camera(1).markers.threshold, 90.0) << "what was refused changes nothing";
  camera_settings_.set_threshold(1, {});
  EXPECT_FALSE(camera_settings_.camera(1).markers.threshold) << "automatic again";
}

TEST_F(CameraSettingsTest, SavesWhatWasChangedAndLeavesTheRestAsItIs) {
  Rig in_file = rig_;
  in_file.cameras[1].gain = 7;  // by another hand, in the meantime
  format::rig::write_rig(in_file, file_);
  camera_settings_.controls(0)->begin(left_);
  camera_settings_.controls(0)->request(Control::exposure, 2);
  camera_settings_.controls(0)->apply(left_);
  camera_settings_.tuning(1)->set_threshold(90);
  camera_settings_.tuning(1)->mask({1, 2, 3, 4});
  camera_settings_.save(file_);
  EXPECT_FALSE(camera_settings_.has_changed());
  const Rig saved = format::rig::read_rig(file_);
  EXPECT_EQ(saved.cameras[0].exposure_ms, 2.0);
  EXPECT_EQ(saved.cameras[0].masks, rig_.cameras[0].masks);
  EXPECT_EQ(saved.cameras[1].threshold, 90.0);
  EXPECT_EQ(saved.cameras[1].gain, 7.0);
  EXPECT_EQ(saved.cameras[1].masks, (std::vector<Mask>{{1, 2, 3, 4}}));
  EXPECT_EQ(saved.cameras[1].source, "gige:2");
}

TEST_F(CameraSettingsTest, MasksOfASmallerPictureAreSavedInTheRigsPixels) {
  format::rig::write_rig(rig_, file_);
  camera_settings_.tuning(1)->mask({1, 2, 3, 4});
  camera_settings_.fit(1, rig_.cameras[1]);
  EXPECT_EQ(camera_settings_.camera(1).markers.masks.size(), 1u) << "what was drawn before the camera was there stays";
  camera_settings_.tuning(1)->set_masks({});
  RigCamera fed = rig_.cameras[0];
  fit_to_size(fed, {640, 480});
  camera_settings_.fit(0, fed);
  EXPECT_EQ(camera_settings_.camera(0).markers.masks, (std::vector<Mask>{{10, 20, 10, 10}}));
  EXPECT_FALSE(camera_settings_.has_changed());
  camera_settings_.tuning(0)->mask({100, 100, 5, 5});
  camera_settings_.tuning(0)->mask(Mask::polygon({{10, 20}, {40, 20}, {10, 60}}));
  camera_settings_.save(file_);
  EXPECT_EQ(format::rig::read_rig(file_).cameras[0].masks,
            (std::vector<Mask>{{20, 40, 20, 20}, {200, 200, 10, 10}, Mask::polygon({{21, 41}, {81, 41}, {21, 121}})}));
}

TEST_F(CameraSettingsTest, ARigFileThatHasNoSuchCameraAnyMoreIsRefused) {
  Rig other = rig_;
  other.cameras[1].name = "middle";
  format::rig::write_rig(other, file_);
  camera_settings_.tuning(0)->set_threshold(90);
  EXPECT_THROW(camera_settings_.save(file_), Error);
  EXPECT_FALSE(format::rig::read_rig(file_).cameras[0].threshold) << "nothing of it is written";
  EXPECT_THROW(camera_settings_.save(file_ + ".gone"), Error);
}

}  // namespace
}  // namespace marey::pipeline::live

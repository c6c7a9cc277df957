#include "marey/files/source_name.h"

#include <gtest/gtest.h>

namespace marey {
namespace {

TEST(SourceName, OnlyKnownSchemesAreNoPaths) {
  EXPECT_EQ(scheme_of("v4l2:/dev/video0"), "v4l2");
  EXPECT_EQ(scheme_of("sim://room?cameras=8"), "sim");
  EXPECT_EQ(scheme_of("walk: take 3.avi"), "");
  EXPECT_EQ(scheme_of("walk.avi"), "");
}

TEST(SourceName, APasswordIsNotShown) {
  EXPECT_EQ(shown_source("rtsp://eve:se@cret@10.0.0.8:554/left"), "rtsp://10.0.0.8:554/left");
  EXPECT_EQ(shown_source("http://host/a@b"), "http://host/a@b");
  EXPECT_EQ(shown_source("v4l2:/dev/video0"), "v4l2:/dev/video0");
}

TEST(SourceName, PathsLieBesideTheRigAndDevicesDoNot) {
  EXPECT_EQ(source_in_folder("rigs", "left.avi"), "rigs/left.avi");
  EXPECT_EQ(source_in_folder("rigs", "/films/left.avi"), "/films/left.avi");
  EXPECT_EQ(source_in_folder("rigs", "play:left.avi?loop"), "play:rigs/left.avi?loop");
  EXPECT_EQ(source_in_folder("rigs", "v4l2:/dev/video0"), "v4l2:/dev/video0");
  EXPECT_EQ(source_in_folder("rigs", "gige:Basler-21"), "gige:Basler-21");
  EXPECT_EQ(source_in_folder("", "left.avi"), "left.avi");
}

TEST(SourceName, APathIsFoundInWhatIsPlayed) {
  EXPECT_EQ(path_of_source("left.avi"), "left.avi");
  EXPECT_EQ(path_of_source("play:left.avi?loop"), "left.avi");
  EXPECT_EQ(path_of_source("play:left.avi"), "left.avi");
  EXPECT_EQ(path_of_source("v4l2:/dev/video0"), "");
  EXPECT_EQ(path_of_source(""), "");
}

}  // namespace
}  // namespace marey

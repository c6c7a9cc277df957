#include "marey/core/rig_sources.h"

#include <vector>

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey {
namespace {

TEST(RigSources, AreReplacedByPairs) {
  Rig rig;
  rig.cameras.resize(2);
  rig.cameras[0].name = "left";
  rig.cameras[0].source = "left_camera.mp4";
  rig.cameras[1].name = "far";
  const std::vector<std::string> pairs{"left=other.mp4", "far=boxes.txt"};
  set_sources(rig, pairs);
  EXPECT_EQ(rig.cameras[0].source, "other.mp4");
  EXPECT_EQ(rig.cameras[1].detections, "boxes.txt");
  for (const char* wrong : {"left", "=a.mp4", "left=", "right=a.mp4"}) {
    const std::vector<std::string> bad{wrong};
    EXPECT_THROW(set_sources(rig, bad), Error) << wrong;
  }
  const std::vector<std::string> twice{"left=a.mp4", "left=b.mp4"};
  EXPECT_THROW(set_sources(rig, twice), Error);
}

}  // namespace
}  // namespace marey

// What a node knows of the ground reaches the rig of the host.
#include "marey/pipeline/live/live_node.h"

#include <memory>
#include <random>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/format/rig/rig_file.h"
#include "marey/pipeline/live/live_feeds.h"
#include "marey/source/live/node.h"

namespace marey::pipeline::live {
namespace {

Rig crowned_rig(double across) {
  Rig rig;
  rig.cameras.emplace_back().name = "stand";
  rig.ground.across = across;
  rig.ground.half = {50, 32};
  rig.ground_from_world = Matrix<3>{{1, 0, 52.5}, {0, -1, 34}, {0, 0, 1}};
  return rig;
}

/// A node that knows this rig, at a port that is free.
class RigNode {
 public:
  explicit RigNode(const Rig& rig) {
    std::mt19937 random(std::random_device{}());
    for (int tries = 0; server_ == nullptr; ++tries) {
      port_ = 20'000 + static_cast<int>(random() % 20'000) * 2;
      try {
        server_ = std::make_unique<source::live::NodeServer>(
            "127.0.0.1", port_, [](const std::string&) { return source::live::NodeAnswer{}; },
            [text = format::rig::rig_text(rig)] { return text; });
      } catch (const Error&) {
        if (tries == 100) throw;
      }
    }
  }

  std::string source() const { return "node:127.0.0.1:" + std::to_string(port_); }

 private:
  int port_ = 0;
  std::unique_ptr<source::live::NodeServer> server_;
};

TEST(LiveNode, BringsItsGround) {
  if (!source::live::has_nodes()) GTEST_SKIP() << "built without ZeroMQ";
  const Rig known = crowned_rig(0.2);
  const RigNode node(known);
  const std::vector<std::string> given{"a=sim://people", node.source()};
  const Rig rig = rig_of_sources(given);
  ASSERT_EQ(rig.cameras.size(), 2u);
  EXPECT_EQ(rig.cameras[1].source, node.source() + "/stand");
  EXPECT_DOUBLE_EQ(rig.ground.across, 0.2);
  EXPECT_EQ(rig.ground.half, known.ground.half);
  ASSERT_TRUE(rig.ground_from_world);
  EXPECT_TRUE(rig.ground_from_world->isApprox(*known.ground_from_world, 1e-12));
}

TEST(LiveNode, TwoGroundsThatDifferAreRefused) {
  if (!source::live::has_nodes()) GTEST_SKIP() << "built without ZeroMQ";
  const RigNode left(crowned_rig(0.2)), right(crowned_rig(0.3)), same(crowned_rig(0.2));
  const std::vector<std::string> differ{"a=" + left.source(), "b=" + right.source()};
  EXPECT_THROW(rig_of_sources(differ), Error);
  const std::vector<std::string> agree{"a=" + left.source(), "b=" + same.source()};
  EXPECT_EQ(rig_of_sources(agree).cameras.size(), 2u);
}

}  // namespace
}  // namespace marey::pipeline::live

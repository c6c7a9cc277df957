#include "marey/pipeline/take/play.h"

#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "marey/core/error.h"

#include "support/moving_bodies.h"

namespace marey::pipeline::take {
namespace {

/// What a sink was given, and when.
struct Received {
  std::vector<Instant> instants;
  std::vector<std::int64_t> at_ns;
  int begun = 0, finished = 0;
};

class HearingSink : public Sink {
 public:
  explicit HearingSink(Received& received) : received_(received) {}
  std::string name() const override { return "heard"; }
  SinkRequirements begin(const RecordingHeader&) override {
    ++received_.begun;
    return {};
  }
  void write(const Instant& instant) override {
    received_.instants.push_back(instant);
    received_.at_ns.push_back(stream::steady_now_ns());
  }
  void finish() override { ++received_.finished; }

 private:
  Received& received_;
};

PlaySummary played(Received& received, int instants, const PlayOptions& options, stream::CaptureClock* clock = nullptr,
                   const Hooks& hooks = {}) {
  std::vector<std::unique_ptr<Sink>> sinks;
  sinks.push_back(std::make_unique<HearingSink>(received));
  return play([&] { return std::make_unique<test::MovingBodies>(instants); }, sinks, options, clock, hooks);
}

TEST(Play, EveryInstantComesOnceInOrderAndNoneBeforeItIsDue) {
  Received received;
  stream::CaptureClock clock;
  const PlaySummary done = played(received, 40, {.name = {}, .speed = 4}, &clock);
  EXPECT_EQ(done.instants + done.skipped, 40);
  EXPECT_EQ(received.begun, 1);
  EXPECT_EQ(received.finished, 1);
  ASSERT_FALSE(received.instants.empty());
  EXPECT_EQ(received.instants[0].named.size(), 2u);
  for (std::size_t i = 0; i < received.instants.size(); ++i) {
    EXPECT_FALSE(received.instants[i].bodies.empty());
    const auto since_first = (received.instants[i].time - received.instants[0].time).count() / 4;
    EXPECT_GE(received.at_ns[i] - clock.capture_ns(received.instants[0].time, received.at_ns[i]), since_first);
    if (i > 0) {
      EXPECT_GT(received.instants[i].index, received.instants[i - 1].index);
    }
  }
}

TEST(Play, ALoopGoesOnCounting) {
  Received received;
  std::stop_source stop;
  Hooks hooks{.progress =
                  [&](const Progress& now) {
                    if (now.done >= 25) stop.request_stop();
                  },
              .stop = stop.get_token()};
  const PlaySummary done = played(received, 10, {.name = {}, .loop = true, .speed = 10}, nullptr, hooks);
  EXPECT_TRUE(done.stopped);
  EXPECT_EQ(done.rounds, 3);
  EXPECT_EQ(received.finished, 1);
  for (std::size_t i = 1; i < received.instants.size(); ++i) {
    EXPECT_GT(received.instants[i].index, received.instants[i - 1].index);
    EXPECT_GT(received.instants[i].time, received.instants[i - 1].time);
  }
  EXPECT_EQ(received.instants.back().index, 24);
  EXPECT_EQ(received.instants.back().time, Timestamp(std::chrono::milliseconds(240)));
}

TEST(Play, ARateLeavesInstantsOut) {
  Received received;
  const PlaySummary done = played(received, 100, {.name = {}, .speed = 20, .rate_hz = 25});
  EXPECT_EQ(done.excluded, 75);
  EXPECT_EQ(done.instants + done.skipped, 25);
}

TEST(Play, AStopIsHeededWithinATenthOfASecondAndFinishes) {
  Received received;
  std::stop_source stop;
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    stop.request_stop();
  });
  const PlaySummary done = played(received, 100, {.name = {}, .speed = 0.01}, nullptr, {.progress = {}, .stop = stop.get_token()});
  later.join();
  EXPECT_TRUE(done.stopped);
  EXPECT_LT(done.seconds, 1);
  EXPECT_EQ(received.finished, 1);
}

TEST(Play, ARecordingWithoutInstantsIsRefused) {
  Received received;
  EXPECT_THROW(played(received, 0, {}), Error);
}

}  // namespace
}  // namespace marey::pipeline::take

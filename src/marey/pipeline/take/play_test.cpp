#include "marey/pipeline/take/play.h"

#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "marey/core/error.h"

#include "support/moving_bodies.h"

namespace marey::pipeline::take {
namespace {

/// What a sink was given, and when.
struct Heard {
  std::vector<Instant> instants;
  std::vector<std::int64_t> at_ns;
  int begun = 0, finished = 0;
};

class HearingSink : public Sink {
 public:
  explicit HearingSink(Heard& heard) : heard_(heard) {}
  std::string name() const override { return "heard"; }
  Wants begin(const RecordingHeader&) override {
    ++heard_.begun;
    return {};
  }
  void write(const Instant& instant) override {
    heard_.instants.push_back(instant);
    heard_.at_ns.push_back(stream::steady_now_ns());
  }
  void finish() override { ++heard_.finished; }

 private:
  Heard& heard_;
};

PlaySummary played(Heard& heard, int instants, const PlayOptions& options, stream::CaptureClock* clock = nullptr,
                   const Hooks& hooks = {}) {
  std::vector<std::unique_ptr<Sink>> sinks;
  sinks.push_back(std::make_unique<HearingSink>(heard));
  return play([&] { return std::make_unique<test::MovingBodies>(instants); }, sinks, options, clock, hooks);
}

TEST(Play, EveryInstantComesOnceInOrderAndNoneBeforeItIsDue) {
  Heard heard;
  stream::CaptureClock clock;
  const PlaySummary done = played(heard, 40, {.name = {}, .speed = 4}, &clock);
  EXPECT_EQ(done.instants + done.skipped, 40);
  EXPECT_EQ(heard.begun, 1);
  EXPECT_EQ(heard.finished, 1);
  ASSERT_FALSE(heard.instants.empty());
  EXPECT_EQ(heard.instants[0].named.size(), 2u);
  for (std::size_t i = 0; i < heard.instants.size(); ++i) {
    EXPECT_FALSE(heard.instants[i].bodies.empty());
    const auto since_first = (heard.instants[i].time - heard.instants[0].time).count() / 4;
    EXPECT_GE(heard.at_ns[i] - clock.capture_ns(heard.instants[0].time, heard.at_ns[i]), since_first);
    if (i > 0) {
      EXPECT_GT(heard.instants[i].index, heard.instants[i - 1].index);
    }
  }
}

TEST(Play, ALoopGoesOnCounting) {
  Heard heard;
  std::stop_source stop;
  Hooks hooks{.progress =
                  [&](const Progress& now) {
                    if (now.done >= 25) stop.request_stop();
                  },
              .stop = stop.get_token()};
  const PlaySummary done = played(heard, 10, {.name = {}, .loop = true, .speed = 10}, nullptr, hooks);
  EXPECT_TRUE(done.stopped);
  EXPECT_EQ(done.rounds, 3);
  EXPECT_EQ(heard.finished, 1);
  for (std::size_t i = 1; i < heard.instants.size(); ++i) {
    EXPECT_GT(heard.instants[i].index, heard.instants[i - 1].index);
    EXPECT_GT(heard.instants[i].time, heard.instants[i - 1].time);
  }
  EXPECT_EQ(heard.instants.back().index, 24);
  EXPECT_EQ(heard.instants.back().time, Timestamp(std::chrono::milliseconds(240)));
}

TEST(Play, ARateLeavesInstantsOut) {
  Heard heard;
  const PlaySummary done = played(heard, 100, {.name = {}, .speed = 20, .rate_hz = 25});
  EXPECT_EQ(done.left_out, 75);
  EXPECT_EQ(done.instants + done.skipped, 25);
}

TEST(Play, AStopIsHeededWithinATenthOfASecondAndFinishes) {
  Heard heard;
  std::stop_source stop;
  std::thread later([&] {
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    stop.request_stop();
  });
  const PlaySummary done = played(heard, 100, {.name = {}, .speed = 0.01}, nullptr, {.progress = {}, .stop = stop.get_token()});
  later.join();
  EXPECT_TRUE(done.stopped);
  EXPECT_LT(done.seconds, 1);
  EXPECT_EQ(heard.finished, 1);
}

TEST(Play, ARecordingWithoutInstantsIsRefused) {
  Heard heard;
  EXPECT_THROW(played(heard, 0, {}), Error);
}

}  // namespace
}  // namespace marey::pipeline::take

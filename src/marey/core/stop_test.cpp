#include "marey/core/stop.h"

#include <thread>

#include <gtest/gtest.h>

#include "marey/core/hooks.h"

namespace marey {
namespace {

TEST(StopScope, TheInnermostCountsAndAnEmptyOneShields) {
  std::stop_source source;
  EXPECT_NO_THROW(stop_point());
  const StopScope outer(source.get_token());
  EXPECT_NO_THROW(stop_point());
  source.request_stop();
  EXPECT_THROW(stop_point(), Stopped);
  {
    const StopScope shield{{}};
    EXPECT_NO_THROW(stop_point());
  }
  EXPECT_THROW(stop_point(), Stopped);
}

TEST(StopScope, IsOfItsThreadAlone) {
  std::stop_source source;
  source.request_stop();
  const StopScope scope(source.get_token());
  std::thread([] { EXPECT_NO_THROW(stop_point()); }).join();
}

TEST(Hooks, AdvanceThrowsWhereItIsToLeaveOff) {
  std::stop_source source;
  int shown = 0;
  const Hooks hooks{.progress = [&](const Progress&) { ++shown; }, .stop = source.get_token()};
  hooks.advance({"counting", 1, 2});
  source.request_stop();
  EXPECT_EQ(hooks.report({"counting", 2, 2}), Continue::no);
  EXPECT_THROW(hooks.advance({"counting", 2, 2}), Stopped);
  EXPECT_EQ(shown, 3);
  EXPECT_NO_THROW(Hooks().advance({"not shown", 1, {}}));
}

}  // namespace
}  // namespace marey

#include "live_viewer.h"

#include <gtest/gtest.h>

#include "marey/core/error.h"

namespace marey::viewer {
namespace {

const LiveViewOptions kAnyPort{.location = {.listen = "127.0.0.1", .port = 0}};

Instant instant_at(double time_s) {
  Instant instant;
  instant.time = timestamp_from_seconds(time_s);
  instant.samples.emplace_back().track = TrackId{1};
  return instant;
}

TEST(LiveViewer, AsksForPicturesAndForWhatWasFound) {
  LiveViewer viewer(kAnyPort);
  EXPECT_TRUE(viewer.address().starts_with("http://127.0.0.1:"));
  EXPECT_NE(viewer.address().find("/?token="), std::string::npos);
  const auto sink = viewer.make_sink();
  const Sink::SinkRequirements needs = sink->begin({});
  EXPECT_TRUE(needs.images && needs.boxes && needs.detected);
  for (int i = 0; i < 1000; ++i) sink->write(instant_at(i / 100.0));
  sink->finish();
  EXPECT_EQ(viewer.count().sent, 0U);  // no page is connected
}

TEST(LiveViewer, ItsSinkMayOutliveIt) {
  std::unique_ptr<Sink> sink;
  {
    LiveViewer viewer(kAnyPort);
    sink = viewer.make_sink();
    sink->begin({});
    viewer.report({});
    viewer.recording(true, "walk.marey");
  }
  sink->write(instant_at(1));
  sink->finish();
}

TEST(LiveViewer, APortThatIsTakenIsSaid) {
  const LiveViewer one(kAnyPort);
  const std::string address = one.address();
  const std::size_t colon = address.rfind(':');
  const int port = std::stoi(address.substr(colon + 1));
  try {
    LiveViewer({.location = {.listen = "127.0.0.1", .port = port}});
    FAIL() << "both listen at one port";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("--port 0"), std::string::npos) << error.what();
  }
}

TEST(LiveViewer, RejectsForeignListenAddress) {
  for (const char* listen : {"no.such.name", "8.8.8.8", "", "127.0.0.1:80"})
    EXPECT_THROW(LiveViewer({.location = {.listen = listen, .port = 0}}), Error) << listen;
}

}  // namespace
}  // namespace marey::viewer

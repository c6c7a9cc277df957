// A take played into the live viewer as if its cameras ran now, with images drawn from what they saw. For tests of the page and
// for figures: live_scene TAKE [RATE_HZ]. Prints the address, then "record on" and "record off" as the page's button is pressed,
// and a line of figures at its end, which is when standard input ends.
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <thread>
#include <vector>

#include <fmt/core.h>
#include <opencv2/imgproc.hpp>
#include <sys/resource.h>

#include "marey/core/error.h"
#include "marey/core/recording_reader.h"
#include "marey/format/recording_file.h"

#include "viewer/live_viewer.h"

namespace {

using namespace marey;
using Stabilise = std::chrono::steady_clock;

constexpr int kDrawn = 90;  // instants that are played forth and back; their images are drawn beforehand

Image drawn(const Recording& take, std::size_t instant, CameraId camera, cv::Size size) {
  cv::Mat grey(size, CV_8UC1, cv::Scalar(18));
  for (int y = 0; y < size.height; ++y) grey.row(y).setTo(cv::Scalar(14 + 22 * y / size.height));
  for (const ImageObservation& point : take.detected(instant)) {
    if (point.camera != camera) continue;
    cv::circle(grey, cv::Point2d(16 * point.pixel.x(), 16 * point.pixel.y()), 32, cv::Scalar(240), cv::FILLED, cv::LINE_AA, 4);
  }
  if (take.header.frame.kind == FrameOfReference::Kind::image) {
    for (const TrackColumns& track : take.tracks()) {
      const auto row = track.row_at(static_cast<std::int32_t>(instant));
      const auto box = row ? track.sample(*row).box : std::nullopt;
      if (box)
        cv::rectangle(grey, cv::Rect2d(box->left, box->top, box->width, box->height),
                      cv::Scalar(110 + 20 * (number(track.id()) % 5)), cv::FILLED);
    }
  }
  return Image(grey);
}

/// By camera, then by instant.
std::vector<std::vector<Image>> drawn_beforehand(const Recording& take) {
  std::vector<std::vector<Image>> images;
  const Rig rig = take.header.rig.value_or(Rig{});
  for (std::size_t camera = 0; camera < rig.cameras.size(); ++camera) {
    images.emplace_back();
    for (std::size_t i = 0; i < std::min<std::size_t>(kDrawn, take.instants().size()); ++i)
      images.back().push_back(
          drawn(take, i, CameraId{static_cast<int>(camera)}, rig.cameras[camera].size.value_or(cv::Size(320, 240))));
  }
  return images;
}

/// A body that hangs on the first marker, so that the page has one to draw.
Body some_body() {
  Body body;
  body.id = BodyId{1};
  body.label = "wand";
  body.markers = {{"a", {0.2, 0, 0}}, {"b", {0, 0.2, 0}}, {"c", {0, 0, 0.2}}};
  return body;
}

Instant played(const Recording& take, const std::vector<Instant>& instants, const std::vector<std::vector<Image>>& images,
               std::int64_t count, double rate_hz) {
  const std::size_t length = std::min(instants.size(), images.front().size()),
                    phase = static_cast<std::size_t>(count) % (2 * length);
  const std::size_t at = phase < length ? phase : 2 * length - 1 - phase;
  Instant instant = instants[at];
  instant.index = count;
  instant.time = timestamp_from_seconds(static_cast<double>(count) / rate_hz);
  const auto detected = take.detected(at);
  instant.detected.assign(detected.begin(), detected.end());
  for (std::size_t camera = 0; camera < images.size(); ++camera)
    instant.frames.push_back({CameraId{static_cast<int>(camera)}, count, instant.time, images[camera][at]});
  BodyPose pose;
  pose.body = BodyId{1};
  if (!instant.samples.empty()) pose.world_from_body.translation = instant.samples.front().position;
  instant.bodies = {pose};
  return instant;
}

viewer::LiveReport report_of(const Recording& take, std::int64_t count, double rate_hz) {
  viewer::LiveReport report;
  const std::size_t cameras = take.header.rig ? take.header.rig->cameras.size() : 0;
  for (std::size_t camera = 0; camera < cameras; ++camera)
    report.cameras.push_back({.health = {.state = camera == 5 ? FeedState::stalled : FeedState::live,
                                         .rate_hz = rate_hz,
                                         .frames = count,
                                         .lost = camera == 2 ? 7 : 0}});
  report.steps = {{"Decode", 0.0011, 0.0024}, {"Track", 0.0016, 0.0031}};
  return report;
}

double cpu_s() {
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  const auto s = [](const timeval& time) { return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec); };
  return s(used.ru_utime) + s(used.ru_stime);
}

void play(const std::string& path, double rate_hz) {
  const auto reader = format::open_recording(path);
  Recording take = read_all(*reader);
  std::vector<Instant> instants;
  MemoryReader again(take);
  while (auto instant = again.next()) instants.push_back(std::move(*instant));
  const auto images = drawn_beforehand(take);
  if (instants.empty() || images.empty()) throw Error("{}: is not a take of several cameras", path);
  std::atomic<int> required = -1;
  const Stabilise::time_point begin = Stabilise::now();
  const auto now = [begin] { return Timestamp(std::chrono::duration_cast<Duration>(Stabilise::now() - begin)); };
  viewer::LiveViewer viewer(
      {.location = {.listen = "127.0.0.1", .port = 0}, .record = [&](bool on) { required = on ? 1 : 0; }, .now = now});
  fmt::print("{}\n", viewer.address());
  std::fflush(stdout);
  std::atomic<bool> ended = false;
  std::thread([&ended] {
    while (std::getchar() != EOF) {
    }
    ended = true;
  }).detach();
  take.header.bodies = {some_body()};
  const auto sink = viewer.make_sink();
  sink->begin(take.header);
  double longest_s = 0;
  std::int64_t count = 0;
  for (; !ended; ++count) {
    Instant instant = played(take, instants, images, count, rate_hz);
    if (count == 0) instant.named = reader->tracks();
    std::this_thread::sleep_until(begin + std::chrono::duration_cast<Stabilise::duration>(instant.time.time_since_epoch()));
    const Stabilise::time_point before = Stabilise::now();
    sink->write(instant);
    longest_s = std::max(longest_s, std::chrono::duration<double>(Stabilise::now() - before).count());
    if (count % static_cast<int>(rate_hz / 2) == 0) viewer.report(report_of(take, count, rate_hz));
    const int record = required.exchange(-1);
    if (record < 0) continue;
    viewer.recording(record == 1, "walk.marey");
    fmt::print("record {}\n", record == 1 ? "on" : "off");
    std::fflush(stdout);
  }
  const auto sent = viewer.count();
  fmt::print("instants {} sent {} dropped {} longest_write_ms {:.3f} cpu_s {:.2f} wall_s {:.2f}\n", count, sent.sent, sent.dropped,
             1000 * longest_s, cpu_s(), seconds(now()));
  std::fflush(stdout);
  std::_Exit(0);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    play(argc > 1 ? argv[1] : "", argc > 2 ? std::atof(argv[2]) : 100);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 1;
  }
}

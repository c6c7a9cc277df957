#include "live_viewer.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <map>
#include <mutex>
#include <set>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/draw/jpeg.h"
#include "marey/net/token.h"

#include "access.h"
#include "command_tokens.h"
#include "live_tracks.h"
#include "page_files.h"
#include "scene.h"
#include "status_text.h"
#include "wire.h"

namespace marey::viewer {
namespace {

enum LiveTopic { kLiveScene, kState, kStatus, kRecording, kStated, kPong, kWand, kImages };

std::uint64_t steady_ns() {
  return static_cast<std::uint64_t>(std::chrono::steady_clock::now().time_since_epoch().count());
}

WebServer::Message text_message(int topic, std::string text) {
  return {.topic = topic, .bytes = bytes_of(std::move(text)), .text = true};
}

/// Which camera's image a page shows, and how wide, px.
using Watched = std::map<int, int>;

Watched watched_by(std::string_view line) {
  Watched watched;
  while (true) {
    const auto camera = whole_in(next_word(line), 0, kMaxCameras - 1);
    const auto width = whole_in(next_word(line), 16, 4096);
    if (!camera || !width) return watched;
    watched[static_cast<int>(*camera)] = static_cast<int>(*width);
  }
}

}  // namespace

class LiveViewer::Core {
 public:
  explicit Core(const LiveViewOptions& options);
  ~Core();

  std::string address() const { return server_->address(); }
  WebServer::Count count() const { return server_->count(); }
  void begin(const RecordingHeader& header);
  void write(const Instant& instant);
  void finish() { server_->publish(text_message(kStated, "ended")); }
  void report(const LiveReport& report);
  void recording(bool on, const std::string& into);
  void wand(const std::string& json);

 private:
  // On the server's thread.
  WebAnswer get(std::string_view target);
  void joined(PageId page);
  void left(PageId page);
  void received(PageId page, std::string_view line);
  void record(PageId page, std::string_view word);
  void change(PageId page, const PageCommand& command);
  void watch(PageId page, Watched watched);

  // On the images' thread.
  void make_images();
  void publish_image(const Instant& instant, int camera, int width);

  void keep_for_images(const Instant& instant);
  std::optional<Extent> extent() const;
  void list_tracks(const Instant& instant);

  LiveViewOptions options_;
  std::atomic<std::uint32_t> written_ = 0;
  WireColumns columns_;
  std::map<PageId, Watched> watching_;  // the server's thread alone
  std::set<PageId> asleep_;             // likewise

  std::mutex mutex_;  // for what follows
  std::condition_variable changed_;
  RecordingHeader header_;
  LiveTracks tracks_;
  Watched widths_;  // of all pages, the widest of each camera
  std::shared_ptr<const Instant> newest_;
  std::string status_ = "status {}", recording_ = "recording off", wand_;
  bool ending_ = false;

  std::set<int> with_images_;  // the images' thread alone
  draw::JpegEncoder encoder_;  // likewise
  std::unique_ptr<WebServer> server_;
  std::thread images_;
};

LiveViewer::Core::Core(const LiveViewOptions& options) : options_(options) {
  WebServer::Handlers handlers;
  handlers.get = [this](std::string_view target) { return get(target); };
  handlers.joined = [this](PageId page) { joined(page); };
  handlers.left = [this](PageId page) { left(page); };
  handlers.received = [this](PageId page, std::string_view line) { received(page, line); };
  server_ = std::make_unique<WebServer>(options.location, std::move(handlers));
  server_->start();
  images_ = std::thread([this] { make_images(); });
}

LiveViewer::Core::~Core() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  changed_.notify_all();
  images_.join();
}

void LiveViewer::Core::begin(const RecordingHeader& header) {
  {
    const std::lock_guard lock(mutex_);
    header_ = header;
    tracks_.clear();
  }
  columns_ = wire_columns(header);
  server_->publish(text_message(kLiveScene, "scene"));
}

void LiveViewer::Core::write(const Instant& instant) {
  list_tracks(instant);
  const std::uint32_t sequence = written_++;
  if (server_->count().pages == 0) return;
  keep_for_images(instant);
  // A page that shows how late it is adds what passed between the capture and here, which only the run's clock can measure.
  const std::uint64_t now_ns = steady_ns();
  const std::uint64_t age_ns =
      options_.now ? static_cast<std::uint64_t>(std::max<std::int64_t>(0, (options_.now() - instant.time).count())) : 0;
  server_->publish({.topic = kState, .bytes = bytes_of(wire_of(instant, sequence, columns_, now_ns - age_ns)), .text = false},
                   [this](PageId page) { return !asleep_.contains(page); });
}

void LiveViewer::Core::list_tracks(const Instant& instant) {
  {
    const std::lock_guard lock(mutex_);
    if (!tracks_.add(instant)) return;
  }
  server_->publish(text_message(kLiveScene, "scene"));
}

void LiveViewer::Core::keep_for_images(const Instant& instant) {
  {
    const std::lock_guard lock(mutex_);
    if (widths_.empty()) return;
  }
  auto kept = std::make_shared<Instant>();
  kept->index = instant.index;
  kept->time = instant.time;
  kept->detected = instant.detected;
  kept->boxes = instant.boxes;
  kept->frames = instant.frames;
  if (header_.frame.kind == FrameOfReference::Kind::image) {
    for (const Sample& sample : instant.samples) {
      if (sample.box)
        kept->boxes.push_back(
            {header_.frame.camera.value_or(CameraId{}), instant.index, sample.track, *sample.box, {}, sample.measured()});
    }
  }
  const std::lock_guard lock(mutex_);
  newest_ = std::move(kept);
}

void LiveViewer::Core::make_images() {
  const std::chrono::duration<double> period(1 / options_.images_hz);
  std::unique_lock lock(mutex_);
  while (!changed_.wait_for(lock, period, [this] { return ending_; })) {
    const std::shared_ptr<const Instant> instant = std::exchange(newest_, nullptr);
    const Watched widths = widths_;
    lock.unlock();
    for (const auto& [camera, width] : widths) {
      if (instant != nullptr) publish_image(*instant, camera, width);
    }
    lock.lock();
  }
}

void LiveViewer::Core::publish_image(const Instant& instant, int camera, int width) {
  const auto found = std::find_if(instant.frames.begin(), instant.frames.end(),
                                  [&](const Frame& frame) { return number(frame.camera) == camera && !frame.image.empty(); });
  const bool has = found != instant.frames.end();
  // Of a camera that gave nothing at this instant the last image stays.
  if (!has && with_images_.contains(camera)) return;
  if (has) with_images_.insert(camera);
  const std::string jpeg = has ? encoder_.encode(found->image, width) : std::string();
  std::string bytes = wire_of({.camera = CameraId{camera},
                               .frame = has ? found->index : instant.index,
                               .time = instant.time,
                               .sent_ns = steady_ns(),
                               .size = has ? found->image.size() : cv::Size(),
                               .detected = instant.detected,
                               .boxes = instant.boxes,
                               .jpeg = jpeg});
  server_->publish({.topic = kImages + camera, .bytes = bytes_of(std::move(bytes)), .text = false}, [this, camera](PageId page) {
    const auto watched = watching_.find(page);
    return watched != watching_.end() && watched->second.contains(camera);
  });
}

void LiveViewer::Core::report(const LiveReport& report) {
  std::string text = status_text(report);
  {
    const std::lock_guard lock(mutex_);
    status_ = text;
  }
  server_->publish(text_message(kStatus, std::move(text)));
}

void LiveViewer::Core::recording(bool on, const std::string& into) {
  std::string text = on ? "recording on " + into : "recording off";
  {
    const std::lock_guard lock(mutex_);
    recording_ = text;
  }
  server_->publish(text_message(kRecording, std::move(text)));
}

void LiveViewer::Core::wand(const std::string& json) {
  {
    const std::lock_guard lock(mutex_);
    wand_ = "wand " + json;
  }
  server_->publish(text_message(kWand, "wand " + json));
}

WebAnswer LiveViewer::Core::get(std::string_view target) {
  const std::string_view path = net::path_of(target);
  if (std::optional<WebAnswer> file = page_file(path)) return *file;
  if (path != "/scene")
    return {.status = 404, .type = "text/plain; charset=utf-8", .body = bytes_of("there is nothing of that name\n")};
  const std::lock_guard lock(mutex_);
  LiveScene live{.names = tracks_.names(),
                 .ground = {.pitch = options_.ground_area.pitch},
                 .extent = extent(),
                 .can_record = options_.record != nullptr,
                 .can_change = options_.change != nullptr,
                 .rig_file = options_.change ? options_.rig_file : "",
                 .job = options_.job};
  return {.status = 200, .type = "application/json", .body = bytes_of(scene_text(header_, live))};
}

/// Of the area and of everything that was measured so far.
std::optional<Extent> LiveViewer::Core::extent() const {
  std::optional<Extent> extent = tracks_.extent();
  for (const Vector<3>& corner : options_.ground_area.area) {
    if (!extent) extent = Extent{corner, corner};
    extent->low = extent->low.cwiseMin(corner);
    extent->high = extent->high.cwiseMax(corner);
  }
  return extent;
}

void LiveViewer::Core::joined(PageId page) {
  const std::lock_guard lock(mutex_);
  server_->send(page, text_message(kStatus, status_));
  server_->send(page, text_message(kRecording, recording_));
  if (!wand_.empty()) server_->send(page, text_message(kWand, wand_));
}

void LiveViewer::Core::left(PageId page) {
  asleep_.erase(page);
  watch(page, {});
}

void LiveViewer::Core::received(PageId page, std::string_view line) {
  if (const auto command = page_command(line)) return change(page, *command);
  const std::string_view word = next_word(line);
  if (word == "watch") {
    watch(page, watched_by(line));
  } else if (word == "sleep") {
    asleep_.insert(page);
    watch(page, {});
  } else if (word == "wake") {
    asleep_.erase(page);
  } else if (word == "record") {
    record(page, next_word(line));
  } else if (word == "enough" && options_.enough) {
    options_.enough();
  } else if (word == "ground" && options_.ground) {
    options_.ground();
  } else if (word == "ping") {
    if (const auto number = whole_in(next_word(line), 0, 1'000'000'000))
      server_->send(page, text_message(kPong, fmt::format("pong {} {}", *number, steady_ns())));
  }
}

void LiveViewer::Core::record(PageId page, std::string_view word) {
  if (!options_.record || (word != "on" && word != "off")) return;
  try {
    options_.record(word == "on");
  } catch (const Error& error) {
    server_->send(page, text_message(kStated, fmt::format("said {}", error.what())));
  }
}

void LiveViewer::Core::change(PageId page, const PageCommand& command) {
  if (!options_.change) return;
  try {
    options_.change(command);
    server_->send(page, text_message(kStated, "said "));
  } catch (const Error& error) {
    server_->send(page, text_message(kStated, fmt::format("said {}", error.what())));
  }
}

void LiveViewer::Core::watch(PageId page, Watched watched) {
  watching_.erase(page);
  if (!watched.empty()) watching_[page] = std::move(watched);
  Watched widths;
  for (const auto& [other, cameras] : watching_) {
    for (const auto& [camera, width] : cameras) widths[camera] = std::max(widths[camera], width);
  }
  const std::lock_guard lock(mutex_);
  widths_ = std::move(widths);
}

class LiveViewer::ViewerSink final : public Sink {
 public:
  explicit ViewerSink(std::weak_ptr<Core> core) : core_(std::move(core)) {}

  std::string name() const override { return "the viewer"; }
  SinkRequirements begin(const RecordingHeader& header) override {
    if (const auto core = core_.lock()) core->begin(header);
    return {.images = true, .boxes = true, .detected = true};
  }
  void write(const Instant& instant) override {
    if (const auto core = core_.lock()) core->write(instant);
  }
  void finish() override {
    if (const auto core = core_.lock()) core->finish();
  }

 private:
  std::weak_ptr<Core> core_;
};

LiveViewer::LiveViewer(const LiveViewOptions& options) : core_(std::make_shared<Core>(options)) {}
LiveViewer::~LiveViewer() = default;
std::string LiveViewer::address() const {
  return core_->address();
}
std::unique_ptr<Sink> LiveViewer::make_sink() {
  return std::make_unique<ViewerSink>(core_);
}
void LiveViewer::report(const LiveReport& report) {
  core_->report(report);
}
void LiveViewer::recording(bool on, const std::string& into) {
  core_->recording(on, into);
}
void LiveViewer::wand(const std::string& json) {
  core_->wand(json);
}
WebServer::Count LiveViewer::count() const {
  return core_->count();
}

}  // namespace marey::viewer

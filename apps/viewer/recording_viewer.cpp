#include "recording_viewer.h"

#include <chrono>
#include <filesystem>
#include <limits>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/net/token.h"
#include "marey/pipeline/take/ground_orientation.h"

#include "access.h"
#include "command_tokens.h"
#include "edit_session.h"
#include "page_files.h"
#include "stored_recording.h"
#include "video_frames.h"

namespace marey::viewer {
namespace {

// From kVideoImage on each page has its own; down from kAnswer too.
enum RecordingTopic { kAnswer = -2, kEditsChanged, kSceneChanged, kVideoImage };
constexpr std::chrono::milliseconds kBetweenReports{300};

/// A match that was read whole, as a reader that owns it.
class OwningReader : public format::FileReader {
 public:
  explicit OwningReader(format::match::GroundMatch match)
      : match_(std::move(match)), reader_(format::reader_of(match_.recording)) {}
  const format::FileInfo& info() const override { return reader_->info(); }
  std::optional<Instant> next() override { return reader_->next(); }
  std::vector<std::string> warnings() const override { return match_.warnings; }

 private:
  format::match::GroundMatch match_;
  std::unique_ptr<format::FileReader> reader_;
};

/// Formats of matches specify how large the pitch is, which a recording does not.
std::unique_ptr<format::FileReader> opened(const std::string& path, const ViewOptions& options, GroundChoice& ground) {
  const format::Format& format = format::format_to_read(path, format::kRecordings);
  if (!format.from_corner || format.read == nullptr) return format::open_recording(path, format, options.read);
  format::match::GroundMatch match = format::read_whole(path, format, options.read);
  if (!ground.pitch) ground.pitch = match.pitch;
  return std::make_unique<OwningReader>(std::move(match));
}

}  // namespace

class RecordingViewer::Core {
 public:
  Core(const std::string& path, const ViewOptions& options);
  ~Core() {
    if (video_) video_->end();
    if (edits_) edits_->end();
  }

  std::string address() const { return server_->address(); }
  std::vector<std::string> read(const Hooks& hooks);

 private:
  WebAnswer get(std::string_view target);
  void received(PageId page, std::string_view line);
  void show_video(const std::string& video);
  std::unique_ptr<EditSession> session();
  void report_all(RecordingTopic topic, const char* word);
  void answer(PageId page, std::string line);

  std::string path_;
  std::unique_ptr<EditSession> edits_;  // before the reader: what is edited from then on is not missed
  GroundChoice ground_;
  std::unique_ptr<format::FileReader> reader_;
  RecordingHeader header_;  // a copy: the reader continues while the server reads it
  StoredRecording recording_;
  std::optional<VideoFrames> video_;
  std::unique_ptr<WebServer> server_;
};

RecordingViewer::Core::Core(const std::string& path, const ViewOptions& options)
    : path_(path),
      edits_(options.edit ? session() : nullptr),
      ground_(options.ground),
      reader_(opened(path, options, ground_)),
      header_(reader_->header()),
      recording_(header_, reader_->tracks()) {
  header_.name = std::filesystem::path(path).filename().string();
  if (!options.video.empty()) show_video(options.video);
  WebServer::Handlers handlers;
  handlers.get = [this](std::string_view target) { return get(target); };
  handlers.received = [this](PageId page, std::string_view line) { received(page, line); };
  handlers.left = [this](PageId page) {
    if (video_) video_->forget(page);
  };
  server_ = std::make_unique<WebServer>(options.location, std::move(handlers));
  server_->start();
}

std::unique_ptr<EditSession> RecordingViewer::Core::session() {
  return std::make_unique<EditSession>(
      path_, recording_,
      EditSession::Answers{.answer = [this](PageId page, std::string line) { answer(page, std::move(line)); },
                           .changed =
                               [this] {
                                 report_all(kSceneChanged, "scene");
                                 report_all(kEditsChanged, "edits");
                               }});
}

void RecordingViewer::Core::show_video(const std::string& video) {
  if (header_.frame.kind != FrameOfReference::Kind::image)
    throw Error("{}: holds no tracks in an image, so no video lies behind them", path_);
  video_.emplace(video, [this](PageId page, std::string bytes) {
    server_->publish({.topic = kVideoImage + static_cast<int>(page), .bytes = bytes_of(std::move(bytes)), .text = false},
                     [page](PageId other) { return other == page; });
  });
}

void RecordingViewer::Core::report_all(RecordingTopic topic, const char* word) {
  server_->publish({.topic = topic, .bytes = bytes_of(word), .text = true});
}

void RecordingViewer::Core::answer(PageId page, std::string line) {
  server_->publish({.topic = kAnswer - static_cast<int>(page), .bytes = bytes_of(std::move(line)), .text = true},
                   [page](PageId other) { return other == page; });
}

std::vector<std::string> RecordingViewer::Core::read(const Hooks& hooks) {
  auto reported = std::chrono::steady_clock::now();
  std::int64_t count = 0;
  while (const std::optional<Instant> instant = reader_->next()) {
    recording_.add(*instant);
    hooks.advance({.step = "reading", .done = ++count, .total = reader_->instant_count()});
    const auto now = std::chrono::steady_clock::now();
    if (now - reported < kBetweenReports) continue;
    reported = now;
    report_all(kSceneChanged, "scene");
  }
  std::vector<std::string> warnings = reader_->warnings();
  if (auto message_text = pipeline::take::orientation_unknown(path_, header_); message_text && !ground_.y_down)
    warnings.push_back(std::move(*message_text));
  reader_.reset();  // who holds a take open may keep others from writing it
  recording_.finish(warnings);
  if (edits_) edits_->begin();
  report_all(kSceneChanged, "scene");
  return warnings;
}

WebAnswer RecordingViewer::Core::get(std::string_view target) {
  const std::string_view path = net::path_of(target);
  if (std::optional<WebAnswer> file = page_file(path)) return *file;
  constexpr auto kMaxCount = std::numeric_limits<std::int32_t>::max();
  if (path == "/scene")
    return {.type = "application/json",
            .body = bytes_of(
                scene_text(header_, recording_.state(), ground_, {.show_video = video_.has_value(), .edit = edits_ != nullptr}))};
  if (path == "/edits" && edits_) return {.type = "application/json", .body = edits_->history()};
  if (path == "/stretch") {
    const auto required = whole_in(net::query_value(target, "n"), 0, kMaxCount);
    const Bytes bytes = required ? recording_.segment(static_cast<std::size_t>(*required)) : nullptr;
    if (bytes != nullptr) return {.body = bytes};
  }
  if (path == "/course") {
    if (const auto track = whole_in(net::query_value(target, "track"), 0, kMaxCount))
      return {.body = bytes_of(recording_.course(TrackId{static_cast<int>(*track)}))};
  }
  return {.status = 404, .type = "text/plain; charset=utf-8", .body = bytes_of("there is nothing of that name\n")};
}

void RecordingViewer::Core::received(PageId page, std::string_view line) {
  if (queries_for_edit(line)) {
    if (edits_) return edits_->request(page, line);
    return answer(page, "refused editing was not asked for; \"marey view TAKE --edit\" allows it");
  }
  if (next_word(line) != "video" || !video_) return;
  const auto frame = whole_in(next_word(line), 0, std::numeric_limits<std::int32_t>::max());
  const auto width = whole_in(next_word(line), 16, 4096);
  if (frame && width) video_->request(page, *frame, static_cast<int>(*width));
}

RecordingViewer::RecordingViewer(const std::string& path, const ViewOptions& options)
    : core_(std::make_unique<Core>(path, options)) {}
RecordingViewer::~RecordingViewer() = default;
std::string RecordingViewer::address() const {
  return core_->address();
}
std::vector<std::string> RecordingViewer::read(const Hooks& hooks) {
  return core_->read(hooks);
}

}  // namespace marey::viewer

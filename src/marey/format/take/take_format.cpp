// The take's row of the register: how commands that handle any format read and write it.
#include <memory>
#include <utility>

#include "marey/format/format.h"
#include "marey/format/take/take_file.h"

namespace marey::format::take {
namespace {

class TakeFileReader : public FileReader {
 public:
  explicit TakeFileReader(const std::string& path) : reader_(path) {
    info_.header = reader_.header();
    info_.tracks = reader_.tracks();
    info_.frame_count = reader_.instant_count();
    info_.edits = reader_.edits();
    info_.head = reader_.head();
    if (info_.header.frame.kind == FrameOfReference::Kind::space) info_.up = UpAxis::z;
  }
  const FileInfo& info() const override { return info_; }
  std::optional<Instant> next() override { return reader_.next(); }
  RecordingSummary summary() override { return reader_.summary(); }
  std::vector<std::string> warnings() const override { return reader_.warnings(); }

 private:
  TakeReader reader_;
  FileInfo info_;
};

/// A take with the names and the edits of the one it is a copy of.
class TakeCopy : public Sink {
 public:
  TakeCopy(const std::string& path, const WritePlan& plan) : writer_(path), info_(plan.info) {}
  std::string name() const override { return writer_.name(); }
  SinkRequirements begin(const RecordingHeader& header) override { return writer_.begin(header); }
  void write(const Instant& instant) override {
    copy_names();
    writer_.write(instant);
  }
  void finish() override {
    copy_names();
    writer_.finish();
  }

 private:
  /// Once there is something to be written, not before: a take of that name stays until then.
  void copy_names() {
    if (std::exchange(copied_, true)) return;
    for (const TrackName& track : info_.tracks) writer_.set_name(track);
    for (const Edit& edit : info_.edits) writer_.add_edit(edit);
    if (info_.frame_count) writer_.set_head(info_.head);  // a plan is there
  }

  TakeWriter writer_;
  FileInfo info_;
  bool copied_ = false;
};

}  // namespace

Format take_format() {
  return {.name = "take",
          .title = "a take",
          .endings = ".marey",
          .holds = kRecordings,
          .detail = "m or px; everything, of recordings in an image, on a ground and in space: see [the take](take.md)",
          .is = [](const Beginning& file) { return !file.folder && take::is_take(file.path); },
          .open = [](const std::string& path, const ReadOptions&) -> std::unique_ptr<FileReader> {
            return std::make_unique<take::TakeFileReader>(path);
          },
          .create = [](const std::string& path, const WritePlan& plan) -> std::unique_ptr<Sink> {
            return std::make_unique<take::TakeCopy>(path, plan);
          },
          .while_recording = true,
          .poses = true,
          .z_up = true};
}

}  // namespace marey::format::take

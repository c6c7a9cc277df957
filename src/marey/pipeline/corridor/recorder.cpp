#include "marey/pipeline/corridor/recorder.h"

#include <utility>

#include "marey/format/take/take_file.h"

namespace marey::pipeline::corridor {

Recorder::Recorder(std::string path, std::shared_ptr<const RecordSwitch> required, double preroll_s)
    : path_(std::move(path)), required_(std::move(required)), preroll_(duration_from_seconds(preroll_s)) {}

Recorder::~Recorder() = default;

Sink::SinkRequirements Recorder::begin(const RecordingHeader& header) {
  header_ = header;
  if (required_->on()) open();  // where it cannot be written that is reported before anything runs
  return {.detected = true};
}

void Recorder::open() {
  if (take_ != nullptr) return;
  auto take = std::make_unique<format::take::TakeWriter>(path_);
  take->begin(header_);
  take_ = std::move(take);
}

void Recorder::write(const Instant& instant) {
  for (const TrackName& name : instant.named) unreported_[name.id] = name;
  Instant kept = instant;
  kept.frames.clear();
  before_.push_back(std::move(kept));
  while (instant.time - before_.front().time > preroll_) before_.pop_front();
  if (!required_->on()) return;
  open();
  for (; !before_.empty(); before_.pop_front()) put(std::move(before_.front()));
}

/// With the names that were reported while it was off.
void Recorder::put(Instant instant) {
  instant.named.clear();
  for (auto& [id, name] : std::exchange(unreported_, {})) instant.named.push_back(std::move(name));
  take_->write(instant);
}

void Recorder::finish() {
  if (take_ != nullptr) take_->finish();
}

}  // namespace marey::pipeline::corridor

// Recording on command while something live runs.
#pragma once

#include <atomic>
#include <deque>
#include <map>
#include <memory>
#include <string>

#include "marey/core/sink.h"

namespace marey::pipeline::corridor {

/// Says whether what runs is recorded: by a key, a page, a wire. From any thread.
class RecordSwitch {
 public:
  explicit RecordSwitch(bool on) : on_(on) {}
  void set(bool on) { on_ = on; }
  void toggle() { on_ = !on_; }
  bool on() const { return on_; }

 private:
  std::atomic<bool> on_;
};

/// Writes a take of what comes while the switch is on, with the seconds before it was put on. Off and on again continues in the
/// same take, with a gap. Without having been on it leaves nothing behind. Names that were reported before are reported to the
/// take.
class Recorder final : public Sink {
 public:
  Recorder(std::string path, std::shared_ptr<const RecordSwitch> required, double preroll_s);
  ~Recorder() override;

  std::string name() const override { return path_; }
  SinkRequirements begin(const RecordingHeader& header) override;
  void write(const Instant& instant) override;
  void finish() override;

 private:
  void open();
  void put(Instant instant);

  std::string path_;
  std::shared_ptr<const RecordSwitch> required_;
  Duration preroll_;
  RecordingHeader header_;
  std::map<TrackId, TrackName> unreported_;  // names that the take does not have yet
  std::deque<Instant> before_;               // while it is off
  std::unique_ptr<Sink> take_;
};

}  // namespace marey::pipeline::corridor

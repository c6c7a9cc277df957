// What every wire is: a sink that never waits. It takes times, keeps identities, and passes the instant to its protocol.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "marey/core/sink.h"
#include "marey/core/stage_times.h"
#include "marey/net/loop.h"
#include "marey/stream/channel_layout.h"
#include "marey/stream/stream_clock.h"

namespace marey::stream {

/// What a wire must be reported beyond its address.
inline constexpr std::size_t kMaxUnlabelledSlots = 64;

struct StreamOptions {
  /// Clients may take control: QTM's TakeControl, and what it lets do.
  bool allow_control = false;
  /// Starts or stops a recording, as a client in control asks; false where it could not. Called on the wire's thread.
  std::function<bool(bool on)> record = {};
  /// LSL, whose channels are fixed: how many tracks are sent where none has a label when the stream begins.
  std::size_t unlabelled_slots = kMaxUnlabelledSlots;
  /// When instants were captured; null: it is learned from when they arrive.
  std::shared_ptr<CaptureClock> clock = nullptr;
};

/// What results from a wire.
struct StreamReport {
  std::string protocol;                   ///< "qtm"
  std::string where;                      ///< "127.0.0.1:22223"
  bool listens = true;                    ///< clients come to it; else it sends to one address
  std::int64_t frames = 0;                ///< that it was given
  std::int64_t clients = 0;               ///< that came, in all
  std::int64_t now = 0;                   ///< that are there
  std::int64_t sent = 0;                  ///< frames, over all clients
  std::int64_t dropped = 0;               ///< frames that a client, or the system, did not take in time
  std::int64_t refused = 0;               ///< clients rejected because there were too many
  std::int64_t disconnected_clients = 0;  ///< clients that spoke another protocol, or left answers unread
  StageTimes sending;                     ///< from an instant's arrival to its bytes at the system, s
  std::vector<std::string> notes = {};    ///< one sentence each
};

/// The protocol has no clients to serve before `begin`, but its port from when it is made. From one thread at a time, as any sink.
class ProtocolSink : public Sink {
 public:
  ProtocolSink(std::string protocol, StreamOptions options);
  ~ProtocolSink() override;

  std::string name() const override { return protocol_ + " at " + where(); }
  SinkRequirements begin(const RecordingHeader& header) final;
  void write(const Instant& instant) final;
  void finish() final;

  /// The address it has, "127.0.0.1:22223".
  virtual std::string where() const = 0;
  /// May be asked for at any time, from any thread.
  StreamReport report() const;

 protected:
  // All under the loop's lock but `drain`.
  virtual bool takes_pixels() const { return false; }
  virtual void start() = 0;
  virtual void send(const Instant& instant, FrameTimes times) = 0;
  /// There are labels that were not there before.
  virtual void labels_grew() {}
  /// Informs clients that it is over.
  virtual void report_goodbye() {}
  /// Waits a little until clients have the data in transit to them.
  virtual void drain() {}
  virtual void fill(StreamReport& report) const = 0;

  net::Loop& loop() const { return *loop_; }
  const RecordingHeader& header() const { return header_; }
  const ChannelLayout& channel_layout() const { return channel_layout_; }
  const StreamOptions& options() const { return options_; }
  const std::string& protocol() const { return protocol_; }

 private:
  std::string protocol_;
  StreamOptions options_;
  std::unique_ptr<net::Loop> loop_;
  RecordingHeader header_;
  ChannelLayout channel_layout_;
  std::int64_t frames_ = 0;
  StageTimes sending_;
};

}  // namespace marey::stream

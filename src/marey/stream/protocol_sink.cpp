#include "marey/stream/protocol_sink.h"

#include <utility>

#include "marey/core/error.h"

namespace marey::stream {

ProtocolSink::ProtocolSink(std::string protocol, StreamOptions options)
    : protocol_(std::move(protocol)), options_(std::move(options)), loop_(std::make_unique<net::Loop>()) {
  if (options_.clock == nullptr) options_.clock = std::make_shared<CaptureClock>();
}

ProtocolSink::~ProtocolSink() = default;

Sink::SinkRequirements ProtocolSink::begin(const RecordingHeader& header) {
  if (!header.frame.metric() && !takes_pixels()) {
    throw Error("{}: carries metres, and these positions are {}; stream them as json, osc or lsl", protocol_,
                to_string(header.frame));
  }
  {
    const std::scoped_lock lock(loop_->mutex());
    header_ = header;
    channel_layout_.begin(header);
    start();
  }
  loop_->start();
  return {};
}

void ProtocolSink::write(const Instant& instant) {
  const std::int64_t arrived = steady_now_ns();
  const FrameTimes times{.capture = options_.clock->capture_ns(instant.time, arrived), .solve = arrived, .send = steady_now_ns()};
  const std::scoped_lock lock(loop_->mutex());
  if (channel_layout_.add(instant.named)) labels_grew();
  send(instant, times);
  ++frames_;
  sending_.add(1e-9 * static_cast<double>(steady_now_ns() - arrived));
}

void ProtocolSink::finish() {
  {
    const std::scoped_lock lock(loop_->mutex());
    report_goodbye();
  }
  drain();
  loop_->stop();
}

StreamReport ProtocolSink::report() const {
  const std::scoped_lock lock(loop_->mutex());
  StreamReport report{.protocol = protocol_, .where = where(), .frames = frames_, .sending = sending_};
  fill(report);
  return report;
}

}  // namespace marey::stream

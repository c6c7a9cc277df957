#include "marey/stream/wire_sink.h"

#include <utility>

#include "marey/core/error.h"

namespace marey::stream {

WireSink::WireSink(std::string wire, StreamOptions options)
    : wire_(std::move(wire)), options_(std::move(options)), loop_(std::make_unique<net::Loop>()) {
  if (options_.clock == nullptr) options_.clock = std::make_shared<CaptureClock>();
}

WireSink::~WireSink() = default;

Sink::Wants WireSink::begin(const RecordingHeader& header) {
  if (!header.frame.metric() && !takes_pixels()) {
    throw Error("{}: carries metres, and these positions are {}; stream them as json, osc or lsl", wire_, to_string(header.frame));
  }
  {
    const std::scoped_lock lock(loop_->mutex());
    header_ = header;
    cast_.begin(header);
    start();
  }
  loop_->start();
  return {};
}

void WireSink::write(const Instant& instant) {
  const std::int64_t arrived = steady_now_ns();
  const FrameTimes times{.capture = options_.clock->capture_ns(instant.time, arrived), .solve = arrived, .send = steady_now_ns()};
  const std::scoped_lock lock(loop_->mutex());
  if (cast_.add(instant.named)) labels_grew();
  send(instant, times);
  ++frames_;
  sending_.add(1e-9 * static_cast<double>(steady_now_ns() - arrived));
}

void WireSink::finish() {
  {
    const std::scoped_lock lock(loop_->mutex());
    say_goodbye();
  }
  drain();
  loop_->stop();
}

WireReport WireSink::report() const {
  const std::scoped_lock lock(loop_->mutex());
  WireReport report{.wire = wire_, .where = where(), .frames = frames_, .sending = sending_};
  fill(report);
  return report;
}

}  // namespace marey::stream

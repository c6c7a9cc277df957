#include "marey/stream/streams.h"

#include <utility>

#include <fmt/format.h>

namespace marey::stream {
namespace {

/// Lends a wire to a run.
class LentSink : public Sink {
 public:
  explicit LentSink(std::shared_ptr<WireSink> wire) : wire_(std::move(wire)) {}
  std::string name() const override { return wire_->name(); }
  Wants begin(const RecordingHeader& header) override { return wire_->begin(header); }
  void write(const Instant& instant) override { wire_->write(instant); }
  void finish() override { wire_->finish(); }

 private:
  std::shared_ptr<WireSink> wire_;
};

}  // namespace

Streams::Streams(const std::vector<std::string>& targets, StreamOptions options) : clock_(std::make_shared<CaptureClock>()) {
  if (options.clock != nullptr) clock_ = options.clock;
  options.clock = clock_;
  for (const std::string& target : targets) wires_.push_back(open_wire(parse_target(target), options));
}

std::vector<std::unique_ptr<Sink>> Streams::sinks() const {
  std::vector<std::unique_ptr<Sink>> lent;
  for (const auto& wire : wires_) lent.push_back(std::make_unique<LentSink>(wire));
  return lent;
}

std::vector<WireReport> Streams::reports() const {
  std::vector<WireReport> reports;
  for (const auto& wire : wires_) reports.push_back(wire->report());
  return reports;
}

std::string to_string(const WireReport& report) {
  std::string text = fmt::format("{} {} {}: ", report.wire, report.listens ? "at" : "to", report.where);
  if (report.listens) text += fmt::format("{} clients, ", report.clients);
  text += fmt::format("{} frames sent, {} dropped", report.sent, report.dropped);
  if (report.refused > 0) text += fmt::format(", {} clients refused (too many at once)", report.refused);
  if (report.sent_off > 0) text += fmt::format(", {} sent off", report.sent_off);
  if (report.sending.count() > 0) {
    text += fmt::format("; arrival to bytes sent p50 {:.2f} ms, p99 {:.2f} ms", 1e3 * report.sending.quantile(0.5),
                        1e3 * report.sending.quantile(0.99));
  }
  return text;
}

}  // namespace marey::stream

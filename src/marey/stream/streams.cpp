#include "marey/stream/streams.h"

#include <utility>

#include <fmt/format.h>

namespace marey::stream {
namespace {

/// Lends a wire to a run.
class NonOwningSink : public Sink {
 public:
  explicit NonOwningSink(std::shared_ptr<ProtocolSink> protocol) : protocol_(std::move(protocol)) {}
  std::string name() const override { return protocol_->name(); }
  SinkRequirements begin(const RecordingHeader& header) override { return protocol_->begin(header); }
  void write(const Instant& instant) override { protocol_->write(instant); }
  void finish() override { protocol_->finish(); }

 private:
  std::shared_ptr<ProtocolSink> protocol_;
};

}  // namespace

Streams::Streams(const std::vector<std::string>& targets, StreamOptions options) : clock_(std::make_shared<CaptureClock>()) {
  if (options.clock != nullptr) clock_ = options.clock;
  options.clock = clock_;
  for (const std::string& target : targets) protocols_.push_back(open_protocol(parse_target(target), options));
}

std::vector<std::unique_ptr<Sink>> Streams::sinks() const {
  std::vector<std::unique_ptr<Sink>> lent;
  for (const auto& protocol : protocols_) lent.push_back(std::make_unique<NonOwningSink>(protocol));
  return lent;
}

std::vector<StreamReport> Streams::reports() const {
  std::vector<StreamReport> reports;
  for (const auto& protocol : protocols_) reports.push_back(protocol->report());
  return reports;
}

std::string to_string(const StreamReport& report) {
  std::string text = fmt::format("{} {} {}: ", report.protocol, report.listens ? "at" : "to", report.where);
  if (report.listens) text += fmt::format("{} clients, ", report.clients);
  text += fmt::format("{} frames sent, {} dropped", report.sent, report.dropped);
  if (report.refused > 0) text += fmt::format(", {} clients refused (too many at once)", report.refused);
  if (report.disconnected_clients > 0) text += fmt::format(", {} disconnected", report.disconnected_clients);
  if (report.sending.count() > 0) {
    text += fmt::format("; arrival to bytes sent p50 {:.2f} ms, p99 {:.2f} ms", 1e3 * report.sending.quantile(0.5),
                        1e3 * report.sending.quantile(0.99));
  }
  return text;
}

}  // namespace marey::stream

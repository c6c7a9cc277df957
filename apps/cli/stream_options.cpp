#include "stream_options.h"

#include <utility>

#include <fmt/core.h>

namespace marey::cli {

void add_stream_options(Command& command, StreamArguments& arguments, const std::string& control) {
  command.group("Streams");
  command
      .texts("--stream", arguments.streams,
             fmt::format("WIRE[:HOST[:PORT]], once for each: {}; this host alone where no HOST is named",
                         stream::protocol_names(", ")))
      .check([](const std::string& text) { stream::parse_target(text); });
  command.flag("--allow-control", arguments.allow_control, "clients of qtm may take control: start and stop a recording" + control);
  command.group("");
}

stream::Streams open_streams(const StreamArguments& arguments, bool quiet, std::function<bool(bool on)> record) {
  stream::Streams streams(
      arguments.streams,
      {.allow_control = arguments.allow_control, .record = std::move(record), .unlabelled_slots = arguments.unlabelled_slots});
  if (quiet) return streams;
  for (const stream::StreamReport& report : streams.reports())
    fmt::print(stderr, "marey: {} {} {}\n", report.protocol, report.listens ? "at" : "to", report.where);
  return streams;
}

void report_streams(const stream::Streams& streams) {
  for (const stream::StreamReport& report : streams.reports()) {
    fmt::print(stderr, "{}\n", to_string(report));
    for (const std::string& note : report.notes) fmt::print(stderr, "marey: warning: {}: {}\n", report.protocol, note);
  }
}

Json json_of(const stream::Streams& streams) {
  Json all = Json::array();
  for (const stream::StreamReport& report : streams.reports()) {
    Json reported({{"wire", report.protocol},
                   {"address", report.where},
                   {"frames", report.frames},
                   {"clients", report.clients},
                   {"sent", report.sent},
                   {"dropped", report.dropped},
                   {"refused", report.refused},
                   {"disconnected", report.disconnected_clients},
                   {"notes", report.notes}});
    if (report.sending.count() > 0) {
      reported["p50_ms"] = 1e3 * report.sending.quantile(0.5);
      reported["p99_ms"] = 1e3 * report.sending.quantile(0.99);
    }
    all.push_back(std::move(reported));
  }
  return all;
}

}  // namespace marey::cli

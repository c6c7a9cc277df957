#pragma once

#include <functional>
#include <string>
#include <vector>

#include "marey/stream/streams.h"

#include "command_line.h"
#include "json_value.h"

namespace marey::cli {

struct StreamArguments {
  std::vector<std::string> streams;
  bool allow_control = false;
  std::size_t unlabelled_slots = stream::kMaxUnlabelledSlots;  ///< of LSL
};

/// `--stream` and `--allow-control`, for every command whose results others may listen to; `control` is what the latter allows
/// besides.
void add_stream_options(Command& command, StreamArguments& arguments, const std::string& control = "");

/// Opens the wires, and says on standard error where each is, but for `quiet`. `record` starts and stops a recording, where there
/// is one to be had. Their sinks are `streams.sinks()`.
stream::Streams open_streams(const StreamArguments& arguments, bool quiet, std::function<bool(bool on)> record = {});

/// The result, a line each on standard error.
void report_streams(const stream::Streams& streams);
/// The same for `--json`.
Json json_of(const stream::Streams& streams);

}  // namespace marey::cli

#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "marey/format/format.h"

namespace marey::format::mcap {

/// Writes an MCAP file (mcap.dev, version 0) as it is recorded: Foxglove's messages, in chunks with an index, times counted from
/// the recording's beginning. The same recording gives the same bytes.
std::unique_ptr<Sink> create_mcap(const std::string& path, const WritePlan& plan);

/// What a file says of itself in its summary: messages, channels, seconds. Throws Error, which begins with `name`, for what is cut
/// off or contradicts itself.
std::vector<Fact> mcap_facts(std::string_view bytes, const std::string& name);

}  // namespace marey::format::mcap

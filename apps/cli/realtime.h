#pragma once

#include <optional>
#include <string>

namespace marey::cli {

/// Asks the system to let this thread, and all threads that it begins, go before whatever is not of real time. Returns why that was
/// refused, in a sentence; nothing if it was granted.
std::optional<std::string> query_for_realtime();

}  // namespace marey::cli

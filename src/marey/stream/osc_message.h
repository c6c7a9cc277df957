// OSC 1.0: messages and bundles. Big endian, everything padded to four bytes.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "marey/stream/bytes.h"

namespace marey::stream {

class OscMessage {
 public:
  explicit OscMessage(std::string_view address) : address_(address) {}

  OscMessage& i(std::int32_t value);
  OscMessage& f(double value);  ///< 32 bits
  OscMessage& h(std::int64_t value);
  OscMessage& d(double value);
  OscMessage& s(std::string_view text);

  std::string bytes() const;

 private:
  std::string address_, tags_ = ",";
  BigBytes arguments_;
};

/// Messages together in as many bundles as it takes: each at most `most` bytes where no single message is larger, to be heeded at
/// once.
std::vector<std::string> osc_bundles(const std::vector<std::string>& messages, std::size_t maximum);

}  // namespace marey::stream

#include "marey/files/inflate.h"

#include <algorithm>

#include <boost/beast/zlib/inflate_stream.hpp>

#include "marey/core/error.h"

namespace marey {
namespace {

constexpr std::size_t kInflateChunk = std::size_t{1} << 18;
constexpr std::size_t kZlibHead = 2;  // format: method and flags; the checksum behind the stream is not compared

}  // namespace

std::string inflated(std::string_view stream, std::size_t max_bytes, const std::string& name) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(stream[i]); };
  if (stream.size() < kZlibHead || (byte(0) & 0x0F) != 8 || (byte(0) * 256 + byte(1)) % 31 != 0 || (byte(1) & 0x20) != 0)
    throw Error("{}: a compressed part is damaged", name);
  boost::beast::zlib::inflate_stream inflate;
  boost::beast::zlib::z_params state;
  state.next_in = stream.data() + kZlibHead;
  state.avail_in = stream.size() - kZlibHead;
  std::string bytes;
  boost::beast::error_code problem;
  while (problem != boost::beast::zlib::error::end_of_stream) {
    const std::size_t before = bytes.size();
    if (before >= max_bytes) throw Error("{}: a compressed part holds more than {} MB", name, max_bytes >> 20);
    bytes.resize(std::min(before + kInflateChunk, max_bytes));
    state.next_out = bytes.data() + before;
    state.avail_out = bytes.size() - before;
    inflate.write(state, boost::beast::zlib::Flush::sync, problem);
    const std::size_t after = bytes.size() - state.avail_out;
    bytes.resize(after);
    if (problem == boost::beast::zlib::error::end_of_stream) break;
    if (problem || after == before) throw Error("{}: a compressed part is damaged or cut off", name);
  }
  return bytes;
}

}  // namespace marey

#include "marey/stream/osc_message.h"

namespace marey::stream {
namespace {

/// A text with one NUL at least, to a multiple of four.
std::string padded(std::string_view text) {
  std::string bytes(text.substr(0, text.find('\0')));
  bytes.resize((bytes.size() / 4 + 1) * 4);
  return bytes;
}

std::string bundle_head() {
  BigBytes bytes;
  bytes.raw(padded("#bundle")).put<std::uint64_t>(1);  // at once
  return std::move(bytes).str();
}

}  // namespace

OscMessage& OscMessage::i(std::int32_t value) {
  tags_ += 'i';
  arguments_.put<std::int32_t>(value);
  return *this;
}

OscMessage& OscMessage::f(double value) {
  tags_ += 'f';
  arguments_.put<float>(static_cast<float>(value));
  return *this;
}

OscMessage& OscMessage::h(std::int64_t value) {
  tags_ += 'h';
  arguments_.put<std::int64_t>(value);
  return *this;
}

OscMessage& OscMessage::d(double value) {
  tags_ += 'd';
  arguments_.put<double>(value);
  return *this;
}

OscMessage& OscMessage::s(std::string_view text) {
  tags_ += 's';
  arguments_.raw(padded(text));
  return *this;
}

std::string OscMessage::bytes() const {
  return padded(address_) + padded(tags_) + arguments_.str();
}

std::vector<std::string> osc_bundles(const std::vector<std::string>& messages, std::size_t maximum) {
  std::vector<std::string> bundles;
  const std::string head = bundle_head();
  for (const std::string& message : messages) {
    if (bundles.empty() || (bundles.back().size() > head.size() && bundles.back().size() + 4 + message.size() > maximum))
      bundles.push_back(head);
    const auto size = bytes_of<std::endian::big>(static_cast<std::uint32_t>(message.size()));
    bundles.back().append(size.data(), size.size()).append(message);
  }
  return bundles;
}

}  // namespace marey::stream

#include "marey/stream/websocket.h"

#include <algorithm>
#include <array>
#include <cctype>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/text_safety.h"
#include "marey/stream/bytes.h"

namespace marey::stream {
namespace {

constexpr std::size_t kMostHead = 16'384;

std::string lowered(std::string_view text) {
  std::string lower(text);
  for (char& c : lower) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// The parts of a list with commas between.
std::vector<std::string> listed_in(std::string_view text) {
  std::vector<std::string> parts;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find(','), text.size());
    if (const std::string_view part = trimmed(text.substr(0, end)); !part.empty()) parts.emplace_back(part);
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return parts;
}

/// FIPS 180-4, 6.1: of use here only because the protocol asks for it.
std::array<std::uint32_t, 5> sha1(std::string message) {
  const std::uint64_t bits = 8 * message.size();
  message.push_back('\x80');
  while (message.size() % 64 != 56) message.push_back('\0');
  const auto length = bytes_of<std::endian::big>(bits);
  message.append(length.data(), length.size());
  std::array<std::uint32_t, 5> h{0x67452301, 0xefcdab89, 0x98badcfe, 0x10325476, 0xc3d2e1f0};
  for (std::size_t block = 0; block < message.size(); block += 64) {
    std::array<std::uint32_t, 80> w{};
    for (std::size_t i = 0; i < 16; ++i) w[i] = *number_at<std::uint32_t, std::endian::big>(message, block + 4 * i);
    for (std::size_t i = 16; i < 80; ++i) w[i] = std::rotl(w[i - 3] ^ w[i - 8] ^ w[i - 14] ^ w[i - 16], 1);
    auto [a, b, c, d, e] = h;
    for (std::size_t i = 0; i < 80; ++i) {
      const std::uint32_t f = i < 20 ? ((b & c) | (~b & d)) : i < 40 || i >= 60 ? b ^ c ^ d : ((b & c) | (b & d) | (c & d));
      constexpr std::array<std::uint32_t, 4> kRounds{0x5a827999, 0x6ed9eba1, 0x8f1bbcdc, 0xca62c1d6};
      const std::uint32_t next = std::rotl(a, 5) + f + e + kRounds[i / 20] + w[i];
      e = d, d = c, c = std::rotl(b, 30), b = a, a = next;
    }
    h[0] += a, h[1] += b, h[2] += c, h[3] += d, h[4] += e;
  }
  return h;
}

std::string refusal(std::string_view status, std::string_view sentence) {
  return fmt::format("HTTP/1.1 {}\r\nContent-Type: text/plain\r\nContent-Length: {}\r\nConnection: close\r\n\r\n{}\n", status,
                     sentence.size() + 1, sentence);
}

/// Without its port.
std::string_view host_alone(std::string_view host) {
  if (host.starts_with('[')) return host.substr(0, host.find(']') + 1);
  return host.substr(0, host.find(':'));
}

}  // namespace

std::string base64(std::string_view bytes) {
  constexpr std::string_view kLetters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) group = group << 8 | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kLetters[group >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

Upgrade parse_upgrade(std::string_view head) {
  Upgrade upgrade;
  if (!head.starts_with("GET ")) throw Error("asks for no WebSocket");
  bool asked = false, version = false;
  while (!head.empty()) {
    const std::size_t end = std::min(head.find("\r\n"), head.size());
    const std::string_view line = head.substr(0, end);
    head.remove_prefix(std::min(end + 2, head.size()));
    const std::size_t colon = line.find(':');
    if (colon == std::string_view::npos) continue;
    const std::string name = lowered(line.substr(0, colon));
    const std::string_view value = trimmed(line.substr(colon + 1));
    if (name == "upgrade") asked = lowered(value) == "websocket";
    if (name == "sec-websocket-version") version = value == "13";
    if (name == "sec-websocket-key") upgrade.key = value;
    if (name == "host") upgrade.host = value;
    if (name == "origin") upgrade.origin = value;
    if (name == "sec-websocket-protocol") {
      for (std::string& protocol : listed_in(value)) upgrade.protocols.push_back(std::move(protocol));
    }
  }
  if (!asked || !version || upgrade.key.size() != 24) throw Error("asks for no WebSocket of version 13");
  return upgrade;
}

std::string accept_key(std::string_view key) {
  std::string digest;
  for (const std::uint32_t word : sha1(std::string(key) + "258EAFA5-E914-47DA-95CA-C5AB0DC85B11")) {
    const auto bytes = bytes_of<std::endian::big>(word);
    digest.append(bytes.data(), bytes.size());
  }
  return base64(digest);
}

bool is_plain_host(std::string_view host) {
  const std::string name = lowered(host_alone(host));
  if (name == "localhost" || (name.starts_with('[') && name.ends_with(']'))) return true;
  return !name.empty() && name.find_first_not_of("0123456789.") == std::string::npos;
}

bool is_trusted_origin(std::string_view origin) {
  if (origin.empty() || origin.starts_with("file://")) return true;
  for (const std::string_view trusted : {"https://app.foxglove.dev", "https://studio.foxglove.dev"}) {
    if (origin == trusted) return true;
  }
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (!origin.starts_with(scheme)) continue;
    const std::string_view host = host_alone(origin.substr(scheme.size()));
    return host == "localhost" || host == "127.0.0.1" || host == "[::1]";
  }
  return false;
}

std::string frame_head(Opcode opcode, std::size_t size) {
  BigBytes head;
  head.put<std::uint8_t>(static_cast<std::uint8_t>(0x80 | static_cast<unsigned>(opcode)));
  if (size < 126) {
    head.put<std::uint8_t>(static_cast<std::uint8_t>(size));
  } else if (size < 65'536) {
    head.put<std::uint8_t>(std::uint8_t{126}).put<std::uint16_t>(static_cast<std::uint16_t>(size));
  } else {
    head.put<std::uint8_t>(std::uint8_t{127}).put<std::uint64_t>(size);
  }
  return std::move(head).str();
}

std::size_t parse_frame(std::string_view bytes, std::size_t most, ClientFrame& frame) {
  if (bytes.size() < 2) return 0;
  const auto first = static_cast<unsigned char>(bytes[0]), second = static_cast<unsigned char>(bytes[1]);
  if ((first & 0x70) != 0) throw Error("a frame with bits of an extension that was not agreed on");
  if ((second & 0x80) == 0) throw Error("a client's frame without a mask");
  const unsigned opcode = first & 15;
  if (opcode > 10 || (opcode > 2 && opcode < 8)) throw Error("a frame of unknown kind {}", opcode);
  std::uint64_t size = second & 127;
  std::size_t at = 2;
  if (size == 126) {
    const auto wide = number_at<std::uint16_t, std::endian::big>(bytes, at);
    if (!wide) return 0;
    size = *wide, at += 2;
  } else if (size == 127) {
    const auto wide = number_at<std::uint64_t, std::endian::big>(bytes, at);
    if (!wide) return 0;
    size = *wide, at += 8;
  }
  if (size > most) throw Error("a frame of {} bytes; {} are taken", size, most);
  if (opcode >= 8 && (size > 125 || (first & 0x80) == 0)) throw Error("a control frame in pieces");
  if (bytes.size() - at < 4 + size) return 0;
  const std::string_view mask = bytes.substr(at, 4);
  frame.opcode = static_cast<Opcode>(opcode);
  frame.last = (first & 0x80) != 0;
  frame.payload = bytes.substr(at + 4, size);
  for (std::size_t i = 0; i < size; ++i) frame.payload[i] = static_cast<char>(frame.payload[i] ^ mask[i % 4]);
  return at + 4 + size;
}

std::size_t WebSocket::received(std::string_view bytes, Outbox& out, const std::function<void()>& opened,
                                const std::function<void(std::string_view)>& message) {
  if (!open_) {
    const std::size_t done = shake_hands(bytes, out);
    if (open_) opened();
    return done;
  }
  ClientFrame frame;
  const std::size_t done = parse_frame(bytes, kMostMessage, frame);
  if (done > 0) take(frame, out, message);
  return done;
}

std::size_t WebSocket::shake_hands(std::string_view bytes, Outbox& out) {
  const std::size_t end = bytes.find("\r\n\r\n");
  if (end == std::string_view::npos) {
    if (bytes.size() > kMostHead) throw Error("a request of more than {} bytes", kMostHead);
    return 0;
  }
  const auto refuse = [&](std::string_view status, std::string_view sentence) {
    out.answer(refusal(status, sentence));
    throw Error("{}", sentence);
  };
  Upgrade upgrade;
  try {
    upgrade = parse_upgrade(bytes.substr(0, end));
  } catch (const Error&) {
    refuse("400 Bad Request", "this port speaks WebSocket alone");
  }
  if (!is_plain_host(upgrade.host)) refuse("403 Forbidden", "this host is to be called by its address, or localhost");
  if (!is_trusted_origin(upgrade.origin)) refuse("403 Forbidden", "pages of other origins may not read this");
  std::string chosen;
  for (const std::string& protocol : protocols_) {
    if (chosen.empty() && std::find(upgrade.protocols.begin(), upgrade.protocols.end(), protocol) != upgrade.protocols.end())
      chosen = protocol;
  }
  if (chosen.empty() && !protocols_.empty())
    refuse("400 Bad Request", "none of the sub-protocols that this port speaks was asked for");
  out.answer(fmt::format(
      "HTTP/1.1 101 Switching Protocols\r\nUpgrade: websocket\r\nConnection: Upgrade\r\nSec-WebSocket-Accept: {}\r\n{}\r\n",
      accept_key(upgrade.key), chosen.empty() ? "" : "Sec-WebSocket-Protocol: " + chosen + "\r\n"));
  open_ = true;
  return end + 4;
}

void WebSocket::take(const ClientFrame& frame, Outbox& out, const std::function<void(std::string_view)>& message) {
  switch (frame.opcode) {
    case Opcode::close:
      out.answer(frame_head(Opcode::close, std::min<std::size_t>(2, frame.payload.size())) + frame.payload.substr(0, 2));
      out.end();
      return;
    case Opcode::ping:
      out.answer(frame_head(Opcode::pong, frame.payload.size()) + frame.payload);
      return;
    case Opcode::pong:
      return;
    default:
      break;
  }
  if (pieces_.size() + frame.payload.size() > kMostMessage) throw Error("a message of more than {} bytes", kMostMessage);
  pieces_ += frame.payload;
  if (!frame.last) return;
  const std::string whole = std::exchange(pieces_, {});
  message(whole);
}

}  // namespace marey::stream

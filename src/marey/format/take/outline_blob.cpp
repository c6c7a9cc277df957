#include "marey/format/take/outline_blob.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "marey/core/outline.h"

namespace marey::format::take {
namespace {

constexpr std::size_t kHeadBytes = 8;
constexpr std::size_t kPlainNumbers = 10;  // centre, velocity, scale rate, and their deviations
constexpr std::size_t kMaxPoints = 65535;
enum Flags : std::uint8_t { has_silhouette = 1, has_deviations = 2, is_hidden_partly = 4 };

template <typename Value>
void append(Bytes& blob, Value value) {
  const auto* bytes = reinterpret_cast<const std::byte*>(&value);
  blob.insert(blob.end(), bytes, bytes + sizeof(Value));
}

void append_pair(Bytes& blob, const Vector<2>& pair) {
  append(blob, static_cast<float>(pair.x()));
  append(blob, static_cast<float>(pair.y()));
}

void append_outline(Bytes& blob, const Outline& outline) {
  const std::size_t points = std::min(outline.control_points.size(), kMaxPoints);
  const bool deviations = outline.deviations.size() == outline.control_points.size();
  append(blob, static_cast<std::uint8_t>(outline.state));
  append(blob, static_cast<std::uint8_t>(outline.order));
  append(blob, static_cast<std::uint16_t>(points));
  append(blob, static_cast<std::uint8_t>((outline.silhouette ? has_silhouette : 0) | (deviations ? has_deviations : 0) |
                                         (outline.behind.empty() && outline.hidden.empty() ? 0 : is_hidden_partly)));
  const auto behind = static_cast<std::uint8_t>(std::min<std::size_t>(outline.behind.size(), 255));
  const auto hidden = static_cast<std::uint16_t>(std::min(outline.hidden.size(), points));
  append(blob, behind);
  append(blob, hidden);
  for (std::size_t i = 0; i < points; ++i) append_pair(blob, outline.control_points[i]);
  for (std::size_t i = 0; deviations && i < points; ++i) append_pair(blob, outline.deviations[i]);
  append_pair(blob, outline.centre);
  append_pair(blob, outline.velocity);
  append(blob, static_cast<float>(outline.scale_rate));
  append_pair(blob, outline.centre_deviation);
  append_pair(blob, outline.velocity_deviation);
  append(blob, static_cast<float>(outline.scale_rate_deviation));
  if (outline.silhouette) append_pair(blob, *outline.silhouette);
  for (std::size_t i = 0; i < behind; ++i) append(blob, static_cast<float>(number(outline.behind[i])));
  for (std::size_t i = 0; i < hidden; ++i) append(blob, static_cast<float>(outline.hidden[i]));
}

/// The numbers of one record, one after the other.
class Numbers {
 public:
  explicit Numbers(std::span<const std::byte> bytes) : bytes_(bytes) {}

  double number() {
    float value = 0;
    std::memcpy(&value, bytes_.data(), sizeof value);
    bytes_ = bytes_.subspan(sizeof value);
    finite_ = finite_ && std::isfinite(value);
    return value;
  }
  Vector<2> pair() {
    const double x = number();
    return {x, number()};
  }
  bool finite() const { return finite_; }

 private:
  std::span<const std::byte> bytes_;
  bool finite_ = true;
};

std::shared_ptr<const Outline> outline_of(std::span<const std::byte> record, const ColumnDecoder& decoder) {
  if (record.size() < kHeadBytes) decoder.fail("an outline is too short");
  const auto byte = [&](std::size_t i) { return std::to_integer<std::uint8_t>(record[i]); };
  const std::size_t points = byte(2) | static_cast<std::size_t>(byte(3)) << 8;
  const bool silhouette = (byte(4) & has_silhouette) != 0, deviations = (byte(4) & has_deviations) != 0;
  const bool is_hidden = (byte(4) & is_hidden_partly) != 0;  // earlier takes have nothing in the bytes that count them
  const std::size_t behind = is_hidden ? byte(5) : 0, hidden = is_hidden ? byte(6) | static_cast<std::size_t>(byte(7)) << 8 : 0;
  const std::size_t numbers = points * (deviations ? 4 : 2) + kPlainNumbers + (silhouette ? 2 : 0) + behind + hidden;
  if (byte(0) > 2 || record.size() != kHeadBytes + 4 * numbers) decoder.fail("an outline has another length than its points");
  auto outline = std::make_shared<Outline>();
  outline->state = static_cast<Outline::State>(byte(0));
  outline->order = byte(1);
  Numbers in(record.subspan(kHeadBytes));
  outline->control_points.resize(points);
  for (Vector<2>& point : outline->control_points) point = in.pair();
  outline->deviations.resize(deviations ? points : 0);
  for (Vector<2>& deviation : outline->deviations) deviation = in.pair();
  outline->centre = in.pair();
  outline->velocity = in.pair();
  outline->scale_rate = in.number();
  outline->centre_deviation = in.pair();
  outline->velocity_deviation = in.pair();
  outline->scale_rate_deviation = in.number();
  if (silhouette) outline->silhouette = in.pair();
  for (std::size_t i = 0; i < behind; ++i) outline->behind.push_back(TrackId{static_cast<int>(in.number())});
  for (std::size_t i = 0; i < hidden; ++i) {
    const int point = static_cast<int>(in.number());
    if (point < 0 || static_cast<std::size_t>(point) >= points) decoder.fail("an outline hides a control point that it has not");
    outline->hidden.push_back(point);
  }
  if (!in.finite()) decoder.fail("an outline is nowhere");
  return outline;
}

}  // namespace

void encode_outlines(const TrackColumns& track, Bytes& blob) {
  blob.clear();
  if (track.outlines().empty()) return;
  for (std::size_t row = 0; row < track.size(); ++row) {
    const auto outline = track.outlines().find(row);
    const std::size_t length_at = blob.size();
    append(blob, std::uint32_t{0});
    if (outline == track.outlines().end()) continue;
    append_outline(blob, *outline->second);
    const auto length = static_cast<std::uint32_t>(blob.size() - length_at - sizeof(std::uint32_t));
    std::memcpy(blob.data() + length_at, &length, sizeof length);
  }
}

void decode_outlines(std::span<const std::byte> blob, const ColumnDecoder& decoder, std::size_t first, TrackColumns& track) {
  if (blob.empty()) return;
  for (std::size_t row = 0; row < decoder.rows(); ++row) {
    std::uint32_t length = 0;
    if (blob.size() < sizeof length) decoder.fail("outlines end too early");
    std::memcpy(&length, blob.data(), sizeof length);
    blob = blob.subspan(sizeof length);
    if (length > blob.size()) decoder.fail("an outline is longer than its column");
    if (length > 0) track.set_outline(first + row, outline_of(blob.first(length), decoder));
    blob = blob.subspan(length);
  }
  if (!blob.empty()) decoder.fail("outlines continue behind the last row");
}

}  // namespace marey::format::take

#include "marey/format/take/keypoints_blob.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/format/nesting.h"

namespace marey::format::take {
namespace {

constexpr std::size_t kNumbersOfPoint = 7, kBytesOfPoint = 1 + kNumbersOfPoint * sizeof(float);
constexpr std::size_t kMaxBodyPoints = 4096;  // of one set

void append_bytes(Bytes& blob, const void* from, std::size_t size) {
  const auto* bytes = static_cast<const std::byte*>(from);
  blob.insert(blob.end(), bytes, bytes + size);
}

void append_body(Bytes& blob, const Keypoints<2>& body) {
  const auto presence = static_cast<float>(body.presence);
  append_bytes(blob, &presence, sizeof presence);
  for (const std::optional<Keypoint<2>>& point : body.points) {
    const Keypoint<2> it = point.value_or(Keypoint<2>{.covariance = Matrix<2>::Zero(), .visibility = 0, .presence = 0});
    const std::array<double, kNumbersOfPoint> numbers{it.position.x(),     it.position.y(),     it.covariance(0, 0),
                                                      it.covariance(0, 1), it.covariance(1, 1), it.visibility,
                                                      it.presence};
    blob.push_back(static_cast<std::byte>(point.has_value()));
    for (const double number : numbers) {
      const auto value = static_cast<float>(number);
      append_bytes(blob, &value, sizeof value);
    }
  }
}

float float_at(std::span<const std::byte> bytes, std::size_t location) {
  float value = 0;
  std::memcpy(&value, bytes.data() + location, sizeof value);
  return value;
}

std::shared_ptr<const Keypoints<2>> body_of_record(std::span<const std::byte> record, const ColumnDecoder& decoder) {
  if (record.size() < sizeof(float) || (record.size() - sizeof(float)) % kBytesOfPoint != 0)
    decoder.fail("keypoints have another length than their points");
  auto body = std::make_shared<Keypoints<2>>();
  body->presence = static_cast<double>(float_at(record, 0));
  bool finite = std::isfinite(body->presence);
  for (record = record.subspan(sizeof(float)); !record.empty(); record = record.subspan(kBytesOfPoint)) {
    std::array<double, kNumbersOfPoint> numbers{};
    for (std::size_t i = 0; i < kNumbersOfPoint; ++i) {
      numbers[i] = static_cast<double>(float_at(record, 1 + i * sizeof(float)));
      finite = finite && std::isfinite(numbers[i]);
    }
    std::optional<Keypoint<2>>& point = body->points.emplace_back();
    if (record[0] == std::byte{0}) continue;
    point.emplace();
    point->position = {numbers[0], numbers[1]};
    point->covariance << numbers[2], numbers[3], numbers[3], numbers[4];
    point->visibility = numbers[5];
    point->presence = numbers[6];
  }
  if (!finite) decoder.fail("a keypoint is nowhere");
  return body;
}

std::vector<int> indices_of(const nlohmann::json& json, std::size_t points) {
  std::vector<int> indices;
  for (const auto& one : json) {
    const auto index = one.get<std::int64_t>();
    if (index < 0 || static_cast<std::size_t>(index) >= points) throw Error("there is no point {}", index);
    indices.push_back(static_cast<int>(index));
  }
  return indices;
}

KeypointSet read_set(const nlohmann::json& json) {
  KeypointSet set;
  set.name = json.at("name").get<std::string>();
  set.points = json.at("points").get<std::vector<std::string>>();
  if (set.points.size() > kMaxBodyPoints) throw Error("it has {} points", set.points.size());
  set.mirrored = indices_of(json.at("mirrored"), set.points.size());
  if (set.mirrored.size() != set.points.size()) throw Error("its points and their other sides differ in number");
  for (const auto& bone : json.at("bones")) {
    const std::vector<int> ends = indices_of(bone, set.points.size());
    if (ends.size() != 2) throw Error("a bone has two ends");
    set.bones.emplace_back(ends[0], ends[1]);
  }
  return set;
}

}  // namespace

void encode_keypoints(const TrackColumns& track, Bytes& blob) {
  blob.clear();
  if (track.keypoints().empty()) return;
  for (std::size_t row = 0; row < track.size(); ++row) {
    const auto body = track.keypoints().find(row);
    std::uint32_t length = 0;
    const std::size_t length_at = blob.size();
    append_bytes(blob, &length, sizeof length);
    if (body == track.keypoints().end()) continue;
    append_body(blob, *body->second);
    length = static_cast<std::uint32_t>(blob.size() - length_at - sizeof length);
    std::memcpy(blob.data() + length_at, &length, sizeof length);
  }
}

void decode_keypoints(std::span<const std::byte> blob, const ColumnDecoder& decoder, std::size_t first, TrackColumns& track) {
  if (blob.empty()) return;
  for (std::size_t row = 0; row < decoder.rows(); ++row) {
    std::uint32_t length = 0;
    if (blob.size() < sizeof length) decoder.fail("keypoints end too early");
    std::memcpy(&length, blob.data(), sizeof length);
    blob = blob.subspan(sizeof length);
    if (length > blob.size()) decoder.fail("keypoints are longer than their column");
    if (length > 0) track.set_keypoints(first + row, body_of_record(blob.first(length), decoder));
    blob = blob.subspan(length);
  }
  if (!blob.empty()) decoder.fail("keypoints continue behind the last row");
}

std::string keypoint_set_text(const KeypointSet& set) {
  nlohmann::json json = {
      {"name", set.name}, {"points", set.points}, {"mirrored", set.mirrored}, {"bones", nlohmann::json::array()}};
  for (const auto& [from, to] : set.bones) json["bones"].push_back({from, to});
  return json.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

KeypointSet keypoint_set_of(std::string_view text, const std::string& where) {
  try {
    check_nesting(text, Notation::json, where);
    return read_set(nlohmann::json::parse(text));
  } catch (const nlohmann::json::exception&) {
    throw Error("{}: is damaged (its set of keypoints is not one)", where);
  } catch (const Error& error) {
    throw Error("{}: is damaged (its set of keypoints: {})", where, error.what());
  }
}

}  // namespace marey::format::take

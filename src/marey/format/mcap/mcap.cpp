#include "marey/format/mcap/mcap.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <map>
#include <optional>
#include <type_traits>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/whole_file.h"
#include "marey/format/mapped_file.h"
#include "marey/format/mcap/foxglove_messages.h"

namespace marey::format::mcap {
namespace {

constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
constexpr std::size_t kChunkBytes = std::size_t{1} << 20;

enum class Record : std::uint8_t {
  header = 1,
  footer = 2,
  schema = 3,
  channel = 4,
  message = 5,
  chunk = 6,
  message_index = 7,
  chunk_index = 8,
  statistics = 11,
  summary_offset = 14,
  data_end = 15,
};

/// Little-endian numbers and texts with their lengths before them.
class RecordBytes {
 public:
  template <typename T>
  RecordBytes& put(std::type_identity_t<T> value) {
    for (std::size_t i = 0; i < sizeof(T); ++i) bytes_ += static_cast<char>(static_cast<std::uint64_t>(value) >> 8 * i & 255);
    return *this;
  }
  RecordBytes& text(std::string_view text) {
    put<std::uint32_t>(static_cast<std::uint32_t>(text.size()));
    return raw(text);
  }
  RecordBytes& raw(std::string_view text) {
    bytes_ += text;
    return *this;
  }
  const std::string& str() const { return bytes_; }

 private:
  std::string bytes_;
};

std::string record(Record kind, std::string_view content) {
  RecordBytes bytes;
  bytes.put<std::uint8_t>(static_cast<std::uint8_t>(kind)).put<std::uint64_t>(content.size()).raw(content);
  return bytes.str();
}

/// CRC-32 as zip has it.
std::uint32_t crc32(std::string_view bytes, std::uint32_t before = 0) {
  static const auto table = [] {
    std::array<std::uint32_t, 256> made{};
    for (std::uint32_t i = 0; i < 256; ++i) {
      made[i] = i;
      for (int bit = 0; bit < 8; ++bit) made[i] = (made[i] & 1) != 0 ? 0xedb88320 ^ made[i] >> 1 : made[i] >> 1;
    }
    return made;
  }();
  std::uint32_t crc = ~before;
  for (const char c : bytes) crc = table[(crc ^ static_cast<unsigned char>(c)) & 255] ^ crc >> 8;
  return ~crc;
}

std::string schema_record(std::size_t topic) {
  const Topic& of = topics()[topic];
  RecordBytes content;
  content.put<std::uint16_t>(static_cast<std::uint16_t>(topic + 1)).text(of.schema_name).text(of.schema_encoding).text(of.schema);
  return record(Record::schema, content.str());
}

std::string channel_record(std::size_t topic) {
  const Topic& of = topics()[topic];
  RecordBytes content;
  content.put<std::uint16_t>(static_cast<std::uint16_t>(topic)).put<std::uint16_t>(static_cast<std::uint16_t>(topic + 1));
  content.text(of.name).text(of.encoding).put<std::uint32_t>(0);
  return record(Record::channel, content.str());
}

class McapFile : public Sink {
 public:
  explicit McapFile(std::string path) : path_(std::move(path)), file_(path_) {}
  std::string name() const override { return path_; }

  SinkRequirements begin(const RecordingHeader& header) override {
    if (!header.frame.metric())
      throw Error("{}: such a file holds metres, and these positions are {}", path_, to_string(header.frame));
    messages_.begin(header);
    put(kMagic);
    put(record(Record::header, RecordBytes().text("").text("marey").str()));
    return {};
  }

  void write(const Instant& instant) override {
    messages_.add(instant.named);
    const auto time = static_cast<std::uint64_t>(std::max<std::int64_t>(0, instant.time.time_since_epoch().count()));
    for (std::size_t topic = 0; topic < topics().size(); ++topic) {
      const std::string message = messages_.message(topic, instant, {.stamp = static_cast<std::int64_t>(time)});
      if (!message.empty()) add(topic, time, static_cast<std::uint32_t>(instant.index), message);
    }
    if (chunk_.size() >= kChunkBytes) close_chunk();
  }

  void finish() override {
    close_chunk();
    put(record(Record::data_end, RecordBytes().put<std::uint32_t>(0).str()));
    put_summary();
    put(kMagic);
    file_.finish();
  }

 private:
  struct Chunk {
    std::uint64_t begin = 0, end = 0;  // ns
    std::uint64_t offset = 0, length = 0, index_length = 0, bytes = 0;
    std::map<std::uint16_t, std::uint64_t> index_offsets;
  };

  void put(std::string_view bytes) {
    file_.write(bytes);
    at_ += bytes.size();
  }

  void add(std::size_t topic, std::uint64_t time, std::uint32_t sequence, const std::string& message) {
    if (chunk_.empty()) now_ = {.begin = time, .end = time, .index_offsets = {}};
    if (counts_.empty()) first_ = time;
    const auto channel = static_cast<std::uint16_t>(topic);
    if (counts_[channel]++ == 0) chunk_ += schema_record(topic) + channel_record(topic);
    now_.begin = std::min(now_.begin, time), now_.end = std::max(now_.end, time), last_ = std::max(last_, time);
    index_[channel].put<std::uint64_t>(time).put<std::uint64_t>(chunk_.size());
    RecordBytes content;
    content.put<std::uint16_t>(channel).put<std::uint32_t>(sequence).put<std::uint64_t>(time).put<std::uint64_t>(time).raw(message);
    chunk_ += record(Record::message, content.str());
  }

  void close_chunk() {
    if (chunk_.empty()) return;
    now_.offset = at_;
    now_.bytes = chunk_.size();
    RecordBytes content;
    content.put<std::uint64_t>(now_.begin).put<std::uint64_t>(now_.end).put<std::uint64_t>(chunk_.size());
    content.put<std::uint32_t>(crc32(chunk_)).text("").put<std::uint64_t>(chunk_.size()).raw(chunk_);
    put(record(Record::chunk, content.str()));
    now_.length = at_ - now_.offset;
    const std::uint64_t begin = at_;
    for (const auto& [channel, entries] : index_) {
      now_.index_offsets[channel] = at_;
      put(record(Record::message_index, RecordBytes().put<std::uint16_t>(channel).text(entries.str()).str()));
    }
    now_.index_length = at_ - begin;
    chunks_.push_back(std::move(now_));
    index_.clear();
    chunk_.clear();
  }

  std::string statistics() const {
    std::uint64_t messages = 0;
    RecordBytes by_channel;
    for (const auto& [channel, count] : counts_) {
      by_channel.put<std::uint16_t>(channel).put<std::uint64_t>(count);
      messages += count;
    }
    RecordBytes content;
    content.put<std::uint64_t>(messages).put<std::uint16_t>(static_cast<std::uint16_t>(counts_.size()));
    content.put<std::uint32_t>(static_cast<std::uint32_t>(counts_.size())).put<std::uint32_t>(0).put<std::uint32_t>(0);
    content.put<std::uint32_t>(static_cast<std::uint32_t>(chunks_.size())).put<std::uint64_t>(first_).put<std::uint64_t>(last_);
    return record(Record::statistics, content.text(by_channel.str()).str());
  }

  static std::string chunk_index(const Chunk& chunk) {
    RecordBytes offsets;
    for (const auto& [channel, offset] : chunk.index_offsets) offsets.put<std::uint16_t>(channel).put<std::uint64_t>(offset);
    RecordBytes content;
    content.put<std::uint64_t>(chunk.begin)
        .put<std::uint64_t>(chunk.end)
        .put<std::uint64_t>(chunk.offset)
        .put<std::uint64_t>(chunk.length);
    content.text(offsets.str()).put<std::uint64_t>(chunk.index_length).text("");
    content.put<std::uint64_t>(chunk.bytes).put<std::uint64_t>(chunk.bytes);
    return record(Record::chunk_index, content.str());
  }

  void put_summary() {
    const std::uint64_t begin = at_;
    std::string summary, offsets;
    const auto group = [&](Record kind, const std::string& records) {
      if (records.empty()) return;
      RecordBytes content;
      content.put<std::uint8_t>(static_cast<std::uint8_t>(kind)).put<std::uint64_t>(begin + summary.size());
      offsets += record(Record::summary_offset, content.put<std::uint64_t>(records.size()).str());
      summary += records;
    };
    std::string schemas, channels, indices;
    for (const auto& [channel, count] : counts_) schemas += schema_record(channel), channels += channel_record(channel);
    for (const Chunk& chunk : chunks_) indices += chunk_index(chunk);
    group(Record::schema, schemas);
    group(Record::channel, channels);
    group(Record::statistics, statistics());
    group(Record::chunk_index, indices);
    const std::uint64_t offsets_at = begin + summary.size();
    summary += offsets;
    // The footer's head and its two first numbers are a part of what is summed.
    RecordBytes footer;
    footer.put<std::uint8_t>(static_cast<std::uint8_t>(Record::footer)).put<std::uint64_t>(20).put<std::uint64_t>(begin);
    footer.put<std::uint64_t>(offsets_at);
    summary += footer.str();
    put(summary);
    put(RecordBytes().put<std::uint32_t>(crc32(summary)).str());
  }

  std::string path_;
  WholeFile file_;
  FoxgloveMessages messages_;
  std::uint64_t at_ = 0, first_ = 0, last_ = 0;
  std::string chunk_;
  Chunk now_;
  std::map<std::uint16_t, RecordBytes> index_;  // of the open chunk, by channel
  std::vector<Chunk> chunks_;
  std::map<std::uint16_t, std::uint64_t> counts_;  // messages by channel
};

/// A little-endian number of `count` bytes; nothing beyond the end.
std::optional<std::uint64_t> little_at(std::string_view bytes, std::uint64_t at, std::size_t count) {
  if (at > bytes.size() || bytes.size() - at < count) return std::nullopt;
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value |= std::uint64_t{static_cast<unsigned char>(bytes[at + i])} << 8 * i;
  return value;
}

std::vector<Fact> facts_of_file(const std::string& path) {
  const MappedFile file(path);
  return mcap_facts(file.text(), path);
}

}  // namespace

std::unique_ptr<Sink> create_mcap(const std::string& path, const WritePlan& /*plan*/) {
  return std::make_unique<McapFile>(path);
}

std::vector<Fact> mcap_facts(std::string_view bytes, const std::string& name) {
  constexpr std::size_t kFooter = 29;  // with its head
  if (bytes.size() < 2 * kMagic.size() + kFooter || !bytes.ends_with(kMagic))
    throw Error("{}: has no end: it is still being written, or was cut off; `mcap recover` makes a whole file of it", name);
  const auto begin = little_at(bytes, bytes.size() - kMagic.size() - kFooter + 9, 8);
  if (!begin || *begin == 0) throw Error("{}: has no summary; `mcap recover` makes one", name);
  std::vector<Fact> facts;
  for (std::uint64_t at = *begin; at < bytes.size() - kMagic.size();) {
    const auto kind = little_at(bytes, at, 1), size = little_at(bytes, at + 1, 8);
    if (!kind || !size || *size > bytes.size() - at - 9) throw Error("{}: its summary goes beyond its end", name);
    if (*kind == static_cast<std::uint64_t>(Record::statistics)) {
      const auto messages = little_at(bytes, at + 9, 8), channels = little_at(bytes, at + 19, 4);
      const auto first = little_at(bytes, at + 35, 8), last = little_at(bytes, at + 43, 8);
      if (*size < 46 || !last || *last < *first) throw Error("{}: its statistics contradict themselves", name);
      facts.push_back({"messages", static_cast<std::int64_t>(std::min<std::uint64_t>(*messages, std::uint64_t{1} << 62))});
      facts.push_back({"channels", static_cast<std::int64_t>(*channels)});
      facts.push_back({"seconds", 1e-9 * static_cast<double>(*last - *first),
                       fmt::format("{:.2f}", 1e-9 * static_cast<double>(*last - *first))});
      return facts;
    }
    at += 9 + *size;
  }
  throw Error("{}: has no statistics; `mcap doctor` says what is there", name);
}

Format mcap_format() {
  return {.name = "mcap",
          .title = "an MCAP file",
          .endings = ".mcap",
          .holds = Content::space | Content::ground,
          .detail =
              "for Foxglove and Rerun: points as PointCloud, bodies as FrameTransforms, both as SceneUpdate (protobuf); m, z up; "
              "times from the recording's beginning. Written; of one that is read, `marey info` tells what its summary says",
          .is = [](const Beginning& file) { return file.bytes.starts_with(mcap::kMagic); },
          .facts = mcap::facts_of_file,
          .create = mcap::create_mcap,
          .while_recording = true,
          .poses = true,
          .z_up = true};
}

}  // namespace marey::format::mcap

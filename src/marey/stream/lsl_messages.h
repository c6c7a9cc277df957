// What an outlet of Lab Streaming Layer says: its description, answers to searches, the head of a feed, samples. As liblsl speaks
// it (protocol 1.10, read in its MIT sources); one outlet of 32-bit floats, type MoCap, with the channels of the xdf wiki's MoCap
// metadata.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "marey/stream/channel_layout.h"

namespace marey::stream {

/// Which tracks and bodies have channels, fixed when the outlet begins.
struct LslLayout {
  std::vector<std::string> labels;  ///< three channels each: x, y, z
  std::vector<Body> bodies;         ///< seven each: place, and the quaternion A (real), B, C, D
  bool metric = true;               ///< m; else px
  bool flat = false;                ///< two channels a label: x, y
  std::size_t slots = 0;            ///< for tracks without a label: the track's ID, then its coordinates, in each

  std::size_t axes() const { return flat ? 2 : 3; }
  std::size_t channels() const { return labels.size() * axes() + bodies.size() * 7 + slots * (1 + axes()); }
};

struct LslOutlet {
  std::string name, uid, source_id, host;
  double rate_hz = 0;     ///< nominal
  double created_at = 0;  ///< s of the steady clock
  std::uint16_t port = 0;
  LslLayout layout;
};

/// `<info>` with what a search sees; `full` with all channels.
std::string lsl_info_xml(const LslOutlet& outlet, bool full);
/// Whether the stream that this `<info>` describes is meant: the query is a condition in XPath, as "type='MoCap'". What is not one
/// is not met.
bool lsl_matches(const std::string& info_xml, std::string_view query);

/// "LSL:shortinfo", as a datagram.
struct LslSearch {
  std::string query, id;
  std::uint16_t port = 0;  ///< where the answer goes
};
std::optional<LslSearch> lsl_search(std::string_view datagram);
/// "LSL:timedata": answers with when it came and when it was answered, s; nothing if it is not one.
std::optional<std::string> lsl_time_answer(std::string_view datagram, double came, double answered);

/// A request by TCP: nothing while it is not whole. Throws Error if it is not one.
struct LslRequest {
  enum class Kind { short_info, full_info, feed };
  Kind kind = Kind::short_info;
  std::string text;      ///< a query, or the UID that is asked for
  int version = 0;       ///< of a feed
  std::size_t size = 0;  ///< bytes that it took
};
std::optional<LslRequest> lsl_request(std::string_view bytes);

/// The head of a feed and its two test samples; or the refusal of another outlet's.
std::string lsl_feed_head(const LslOutlet& outlet);
/// A sample at that time, s: one channel each; NaN for missing values.
std::string lsl_sample(double time, const std::vector<float>& channels);

/// An instant's channels; `slotted` has the sample in each slot, null if it is empty.
std::vector<float> lsl_channels(const LslLayout& layout, const ChannelLayout& channel_layout, const ChannelLayout::Scene& scene,
                                const Instant& instant, std::span<const Sample* const> slotted = {});

}  // namespace marey::stream

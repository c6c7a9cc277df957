// Lab Streaming Layer: an outlet of our own, for experiments that record motion beside EEG, eyes and forces (LabRecorder, pylsl,
// MNE). Found by multicast; listening on this host alone it answers this host's programs alone.
#include <algorithm>
#include <array>
#include <cstdio>
#include <memory>
#include <random>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include "marey/net/server.h"
#include "marey/stream/lsl_messages.h"
#include "marey/stream/protocols.h"
#include "marey/stream/track_slots.h"

namespace marey::stream {
namespace {

constexpr std::uint16_t kSearchPort = 16'571, kFirstPort = 16'572;
constexpr std::array<std::uint32_t, 2> kGroups{0xe00000b7, 0xefffacd7};  // 224.0.0.183, 239.255.172.215

double steady_seconds() {
  return 1e-9 * static_cast<double>(steady_now_ns());
}

/// A name for this run of an outlet; a reader that was cut off knows by it whether the outlet is another one.
std::string new_uid() {
  std::random_device dice;
  std::array<std::uint32_t, 4> words{};
  for (std::uint32_t& word : words) word = dice();
  return fmt::format("{:08x}-{:04x}-4{:03x}-a{:03x}-{:08x}{:04x}", words[0], words[1] & 0xffff, words[1] >> 16 & 0xfff,
                     words[2] & 0xfff, words[3], words[2] >> 16);
}

/// What sessions read. There is no outlet before the first moment: its channels are not known.
struct LslShared {
  LslOutlet outlet;
  bool begun = false;
};

class LslSession : public net::Session {
 public:
  explicit LslSession(const LslShared& shared) : shared_(shared) {}

  std::size_t received(std::string_view bytes, net::Outbox& out) override {
    if (feeding_) return bytes.size();
    const auto request = lsl_request(bytes);
    if (!request) return 0;
    switch (request->kind) {
      case LslRequest::Kind::short_info: {
        const std::string info = lsl_info_xml(shared_.outlet, false);
        if (shared_.begun && lsl_matches(info, request->text)) out.answer(info);
        out.end();
        break;
      }
      case LslRequest::Kind::full_info:
        if (shared_.begun) out.answer(lsl_info_xml(shared_.outlet, true));
        out.end();
        break;
      case LslRequest::Kind::feed:
        feed(*request, out);
        break;
    }
    return request->size;
  }

  void frame(const std::shared_ptr<const std::string>& sample, net::Outbox& out) const {
    if (feeding_) out.frame({.body = sample});
  }

 private:
  void feed(const LslRequest& request, net::Outbox& out) {
    if (!shared_.begun || (!request.text.empty() && request.text != shared_.outlet.uid)) {
      out.answer("LSL/110 404 Not found\r\n\r\n");
      out.end();
      return;
    }
    if (request.version < 110 || request.version > 199) {
      out.answer("LSL/110 505 Version not supported\r\n\r\n");
      out.end();
      return;
    }
    out.answer(lsl_feed_head(shared_.outlet));
    feeding_ = true;
  }

  const LslShared& shared_;
  bool feeding_ = false;
};

class LslProtocol : public ProtocolSink {
 public:
  LslProtocol(const Target& target, StreamOptions options)
      : ProtocolSink("lsl", std::move(options)),
        at_(free_port(target.address("lsl"))),
        server_(loop(), at_, "lsl", {.max_clients = 32, .max_bytes = 8192},
                [this](const net::Address&) { return std::make_unique<LslSession>(shared_); }) {
    at_ = server_.address();
    service_ = datagrams_at(at_, "lsl");
    loop().watch(service_.get(), [this] { return answer_datagrams(service_); });
    listen_for_searches();
  }
  ~LslProtocol() override { loop().stop(); }

  std::string where() const override { return to_string(at_); }

 protected:
  bool takes_pixels() const override { return true; }
  void start() override {
    shared_ = {};
    loop().on_tick([this] { server_.tick(); });
  }

  void send(const Instant& instant, FrameTimes times) override {
    if (!shared_.begun) begin_outlet();
    channel_layout().location(instant, scene_);
    const auto channels = lsl_channels(shared_.outlet.layout, channel_layout(), scene_, instant, slotted(instant));
    const auto sample = std::make_shared<const std::string>(lsl_sample(1e-9 * static_cast<double>(times.capture), channels));
    server_.each([&](net::Session& session, net::Outbox& out) { static_cast<LslSession&>(session).frame(sample, out); });
  }

  void drain() override { server_.drain(kDrainMs); }

  void fill(StreamReport& report) const override {
    take_counts(report, server_.counts());
    if (!note_.empty()) report.notes.push_back(note_);
    const LslLayout& layout = shared_.outlet.layout;
    if (!shared_.begun) return;
    if (layout.slots == 0 && channel_layout().labels().size() > layout.labels.size()) {
      report.notes.push_back(fmt::format("{} labels came after the first moment and have no channels; an outlet's are fixed",
                                         channel_layout().labels().size() - layout.labels.size()));
    }
    if (slots_.without_slot() > 0) {
      report.notes.push_back(fmt::format("{} positions of unlabelled tracks were not sent: more than {} tracks at once",
                                         slots_.without_slot(), slots_.size()));
    }
  }

 private:
  /// All tracks, for those that get their labels later stay where they are.
  const std::vector<const Sample*>& slotted(const Instant& instant) {
    all_.clear();
    for (const Sample& sample : instant.samples) all_.push_back(&sample);
    return slots_.location(all_);
  }

  /// liblsl searches for an outlet at the first port that is free from 16572 on.
  static net::Address free_port(net::Address required) {
    if (required.port != kFirstPort) return required;
    for (std::uint16_t port = kFirstPort; port < kFirstPort + 32; ++port) {
      net::Address at{.host = required.host, .port = port};
      try {
        const net::Descriptor tcp = listen_at(at, "lsl"), udp = datagrams_at(at, "lsl");
        return at;
      } catch (const Error&) {
        continue;
      }
    }
    return required;
  }

  void begin_outlet() {
    std::array<char, 256> host{};
    gethostname(host.data(), host.size() - 1);
    LslOutlet& outlet = shared_.outlet;
    outlet.name = "Marey";
    outlet.uid = new_uid();
    outlet.source_id = "marey " + header().name;
    outlet.host = host.data();
    outlet.rate_hz = header().rate_hz;
    outlet.created_at = steady_seconds();
    outlet.port = at_.port;
    outlet.layout = {.labels = channel_layout().labels(),
                     .bodies = header().bodies,
                     .metric = header().frame.metric(),
                     .flat = header().frame.dimensions() == 2};
    // An outlet's channels are fixed. Where nothing has a name yet, tracks are sent by slot.
    if (outlet.layout.channels() == 0) outlet.layout.slots = options().unlabelled_slots;
    slots_ = TrackSlots(outlet.layout.slots);
    shared_.begun = true;
  }

  /// Searches go to groups that every program of this host may listen to.
  void listen_for_searches() {
    net::Address any{.host = 0, .port = kSearchPort};
    try {
      searches_ = datagrams_at(any, "lsl", true);
    } catch (const Error& error) {
      note_ = fmt::format("{}; the outlet is not found by searching", error.what());
      return;
    }
    hosts_ = net::own_hosts();
    for (const std::uint32_t group : kGroups) {
      for (const std::uint32_t host : hosts_) join_group(searches_, group, host);
    }
    loop().watch(searches_.get(), [this] { return answer_datagrams(searches_); });
  }

  bool may_know(const net::Address& from) const {
    return !at_.is_loopback() || from.is_loopback() || std::find(hosts_.begin(), hosts_.end(), from.host) != hosts_.end();
  }

  bool answer_datagrams(const net::Descriptor& socket) {
    for (int i = 0; i < 64; ++i) {  // then others' turn
      const auto came = receive(socket, 2048);
      if (!came) return true;
      const double now = steady_seconds();
      if (!shared_.begun || !may_know(came->from)) continue;
      if (const auto answer = lsl_time_answer(came->bytes, now, steady_seconds())) {
        send_to(service_, came->from, *answer);
      } else if (const auto search = lsl_search(came->bytes)) {
        const std::string info = lsl_info_xml(shared_.outlet, false);
        if (lsl_matches(info, search->query))
          send_to(service_, {.host = came->from.host, .port = search->port}, search->id + "\r\n" + info);
      }
    }
    return true;
  }

  LslShared shared_;
  net::Address at_;
  net::Server server_;
  net::Descriptor service_, searches_;
  std::vector<std::uint32_t> hosts_;
  ChannelLayout::Scene scene_;
  TrackSlots slots_;
  std::vector<const Sample*> all_;
  std::string note_;
};

}  // namespace

StreamProtocol lsl_protocol() {
  return {.name = "lsl",
          .title = "Lab Streaming Layer, an outlet of type MoCap",
          .port = kFirstPort,
          .detail =
              "one channel a coordinate of every labelled point and every body, times of capture by the steady clock; m (px of "
              "images), z up; missing is NaN; without labels and bodies 64 slots, each a track's ID and coordinates",
          .open = [](const Target& target, const StreamOptions& options) -> std::unique_ptr<ProtocolSink> {
            return std::make_unique<LslProtocol>(target, options);
          }};
}

}  // namespace marey::stream

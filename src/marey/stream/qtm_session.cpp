#include "marey/stream/qtm_session.h"

#include <charconv>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"

namespace marey::stream {
namespace {

constexpr int kNewestMinor = 25;

std::string announce(std::string_view text) {
  return qtm_text_packet(QtmPacket::command, text);
}
std::string refuse(std::string_view text) {
  return qtm_text_packet(QtmPacket::error, text);
}

/// "1.19": what follows the dot.
std::optional<int> minor_of(std::string_view version) {
  if (!version.starts_with("1.")) return std::nullopt;
  version.remove_prefix(2);
  int minor = 0;
  const auto [end, error] = std::from_chars(version.data(), version.data() + version.size(), minor);
  if (error != std::errc() || end != version.data() + version.size()) return std::nullopt;
  return minor;
}

}  // namespace

QtmSession::~QtmSession() {
  if (state_->master == this) state_->master = nullptr;
}

void QtmSession::joined(net::Outbox& out) {
  out.answer(announce("QTM RT Interface connected"));
}

std::size_t QtmSession::received(std::string_view bytes, net::Outbox& out) {
  const auto packet = qtm_received(bytes);
  if (!packet) return 0;
  if (packet->type == static_cast<std::uint32_t>(QtmPacket::command)) {
    for (std::string& reply : answer(packet->body)) out.answer(std::move(reply));
    if (closing_) out.end();
  } else if (packet->type == static_cast<std::uint32_t>(QtmPacket::xml)) {
    out.answer(refuse(state_->master == this ? "Setting parameters failed" : "You must be master to issue this command"));
  } else {
    out.answer(refuse("Parse error"));
  }
  return packet->size;
}

std::vector<std::string> QtmSession::answer(std::string_view command) {
  const std::vector<std::string> words = qtm_words(command);
  if (words.empty()) return {refuse("Parse error")};
  return answer_known(words);
}

std::vector<std::string> QtmSession::answer_known(const std::vector<std::string>& words) {
  const std::string& verb = words.front();
  const auto one = [](std::string reply) { return reply.empty() ? std::vector<std::string>{} : std::vector{std::move(reply)}; };
  if (verb == "version") return one(version(words));
  if (verb == "qtmversion") return one(announce("QTM Version is 2.17 (build 4000)"));  // a client matches this shape
  if (verb == "byteorder") return one(announce("Byte order is little endian"));
  if (verb == "getstate") return one(qtm_event_packet(state_->last_event));
  if (verb == "getlastevent") return one(qtm_event_packet(state_->last_event));
  if (verb == "getparameters") return one(parameters(words));
  if (verb == "getcurrentframe") return one(current_frame(words));
  if (verb == "streamframes") return one(stream(words));
  if (verb == "takecontrol" || verb == "releasecontrol") return one(control(words));
  if (verb == "checklicense") return one(announce("License pass"));
  if (verb == "quit") {
    closing_ = true;
    return {};
  }
  for (const std::string_view known : {"new", "close", "start", "stop", "load", "save", "loadproject", "trig", "setqtmevent",
                                       "event", "calibrate", "reprocess", "led"}) {
    if (verb == known) return one(as_master(words));
  }
  return {refuse("Parse error")};
}

std::string QtmSession::version(const std::vector<std::string>& words) {
  if (words.size() == 1) return announce(fmt::format("Version is 1.{}", minor_));
  const auto minor = minor_of(words[1]);
  if (!minor || *minor < 1 || *minor > kNewestMinor) return refuse("Version NOT supported");
  minor_ = *minor;
  return announce(fmt::format("Version set to 1.{}", minor_));
}

std::string QtmSession::parameters(const std::vector<std::string>& words) const {
  QtmSettings required;
  for (std::size_t i = 1; i < words.size(); ++i) {
    const std::string& word = words[i];
    const bool all = word == "all";
    required.general |= all || word == "general";
    required.points |= all || word == "3d";
    required.bodies |= all || word == "6d";
    required.skeletons |= all || word == "skeleton" || word == "skeleton:global";
  }
  if (!required.general && !required.points && !required.bodies && !required.skeletons) return refuse("Parameters not available");
  return qtm_text_packet(QtmPacket::xml, qtm_parameters_xml(*state_->header, *state_->channel_layout, required, minor_));
}

std::string QtmSession::current_frame(const std::vector<std::string>& words) const {
  const auto components = qtm_components(words, 1);
  if (!components || words.size() < 2) return refuse("Parse error");
  if (!state_->newest) return qtm_packet(QtmPacket::no_more_data, {});
  ChannelLayout::Scene scene;
  state_->channel_layout->location(*state_->newest, scene);
  return qtm_data_packet(*state_->channel_layout, scene, *state_->newest, *components);
}

std::string QtmSession::stream(const std::vector<std::string>& words) {
  const auto request = qtm_stream_request(words);
  if (!request) return refuse("Parse error");
  // Frames go to the one who asked: a client that could name another host could have it flooded.
  if (!request->udp_host.empty() && request->udp_host != net::host_text(client_.host))
    return refuse("UDP goes to the client's own address");
  streaming_.reset();
  if (request->stop) return {};
  streaming_ = request;
  detected_ = 0;
  due_.reset();
  return state_->newest ? std::string() : qtm_packet(QtmPacket::no_more_data, {});
}

std::string QtmSession::control(const std::vector<std::string>& words) {
  if (words.front() == "releasecontrol") {
    if (state_->master == this) state_->master = nullptr;
    return announce("You are now a regular client");
  }
  if (!state_->allow_control) return refuse("Client control disabled in QTM");
  if (state_->master == this) return announce("You are already master");
  if (state_->master != nullptr) return refuse("Another client is already master");
  state_->master = this;
  return announce("You are now master");
}

std::string QtmSession::as_master(const std::vector<std::string>& words) {
  if (state_->master != this) return refuse("You must be master to issue this command");
  const std::string& verb = words.front();
  if (verb == "new") return announce("Creating new connection");
  if (verb == "close") return announce("Closing connection");
  if (verb == "trig") return announce("Trig ok");
  if (verb == "setqtmevent" || verb == "event") return announce("Event set");
  if (verb == "start" && words.size() > 1 && words[1] == "rtfromfile") return announce("Starting RT from file");
  if (verb == "start" || verb == "stop") {
    const bool on = verb == "start";
    if (!state_->record || !state_->record(on))
      return refuse(on ? "Measurement could not be started" : "No measurement is running");
    state_->last_event = on ? QtmEvent::capture_started : QtmEvent::capture_stopped;
    return announce(on ? "Starting measurement" : "Stopping measurement");
  }
  return refuse("Parse error");
}

bool QtmSession::is_due(const Instant& instant) {
  if (!streaming_) return false;
  if (detected_++ % streaming_->divisor != 0) return false;
  if (streaming_->frequency <= 0) return true;
  const Duration period = duration_from_seconds(1 / streaming_->frequency);
  const Duration half = duration_from_seconds(0.5 / state_->header->rate_hz);
  if (due_ && instant.time + half < *due_) return false;
  due_ = due_ && instant.time - *due_ < period ? *due_ + period : instant.time + period;
  return true;
}

std::optional<net::Address> QtmSession::datagrams_to() const {
  if (!streaming_ || !streaming_->udp_port) return std::nullopt;
  return net::Address{.host = client_.host, .port = *streaming_->udp_port};
}

}  // namespace marey::stream

#include "marey/pipeline/bodies/bodies_in_space.h"

#include <algorithm>
#include <deque>
#include <filesystem>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/bodies/body_file.h"
#include "marey/format/input_hash.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"

namespace marey::pipeline::bodies {
namespace {

using solve::bodies::Correction;

/// Instants that wait until a body that came back is known not to be turned.
class SettledInstants {
 public:
  SettledInstants(Sink& sink, double wait_s) : sink_(&sink), wait_(duration_from_seconds(wait_s)) {}

  void add(Instant instant, std::span<const Correction> corrections) {
    for (const Correction& correction : corrections) {
      for (Instant& waiting : waiting_) {
        if (waiting.time >= correction.since) correct(waiting, correction);
      }
    }
    const Timestamp now = instant.time;
    waiting_.push_back(std::move(instant));
    const auto settled = [&] {
      return std::ssize(waiting_) > solve::bodies::BodyTracker::kSettled && now - waiting_.front().time > wait_;
    };
    for (; settled(); waiting_.pop_front()) sink_->write(waiting_.front());
  }
  /// The index of the instant of this time, of those that wait.
  std::int64_t frame_at(Timestamp time) const {
    const auto at = std::find_if(waiting_.begin(), waiting_.end(), [&](const Instant& one) { return one.time >= time; });
    return at == waiting_.end() ? 0 : at->index;
  }
  void finish() {
    for (const Instant& instant : waiting_) sink_->write(instant);
    waiting_.clear();
  }

 private:
  static void correct(Instant& instant, const Correction& correction) {
    for (BodyPose& pose : instant.bodies) {
      if (pose.body != correction.body) continue;
      pose.world_from_body = pose.world_from_body * correction.reported_from_body;
      pose.other = correction.other;
      if (pose.other) pose.other->world_from_body = pose.world_from_body * correction.other->world_from_body;
    }
  }

  Sink* sink_;
  Duration wait_;
  std::deque<Instant> waiting_;
};

void require_space(const RecordingHeader& header, const std::string& path) {
  if (header.frame.kind != FrameOfReference::Kind::space)
    throw Error("{}: bodies are found among points in space, and these positions are {}", path, to_string(header.frame));
}

/// The returns that were decided at this instant, and may be wrong.
void add_in_question(const solve::bodies::BodyTracker& tracker, const SettledInstants& settled,
                     std::vector<TrackBodiesSummary::InQuestion>& in_question) {
  for (const Correction& one : tracker.corrections()) {
    if (!(one.ambiguity > 0)) continue;
    const auto& bodies = tracker.bodies();
    const auto body = std::find_if(bodies.begin(), bodies.end(), [&](const Body& each) { return each.id == one.body; });
    in_question.push_back({.body = body->label,
                           .frame = settled.frame_at(one.since),
                           .time = one.since,
                           .probability = one.ambiguity,
                           .turn = one.words});
  }
}

TrackBodiesSummary summary_of(const solve::bodies::BodyTracker& tracker, const std::vector<double>& errors) {
  TrackBodiesSummary summary;
  summary.noise_m = tracker.noise();
  for (std::size_t b = 0; b < tracker.bodies().size(); ++b) {
    const auto& counts = tracker.counts()[b];
    std::vector<Vector<3>> layout;
    for (const BodyMarker& marker : tracker.bodies()[b].markers) layout.push_back(marker.position);
    summary.bodies.push_back({tracker.bodies()[b], counts,
                              counts.measured > 0 ? errors[b] / static_cast<double>(counts.measured) : 0,
                              solve::bodies::symmetries(layout, 0.004)});
    if (counts.measured == 0)
      summary.warnings.push_back(fmt::format("body \"{}\" was not found in any frame", tracker.bodies()[b].label));
  }
  return summary;
}

}  // namespace

BodiesInSpace::BodiesInSpace(std::vector<Body> bodies, const solve::bodies::TrackingOptions& options)
    : target_tracker_(std::move(bodies), options) {
  std::map<std::string, int> bearers;
  for (const Body& body : target_tracker_.bodies()) {
    for (const BodyMarker& marker : body.markers) ++bearers[marker.label];
  }
  for (int b = 0; b < std::ssize(target_tracker_.bodies()); ++b) {
    const Body& body = target_tracker_.bodies()[static_cast<std::size_t>(b)];
    for (int m = 0; m < std::ssize(body.markers); ++m) {
      const std::string& label = body.markers[static_cast<std::size_t>(m)].label;
      if (bearers[label] == 1) markers_.emplace(label, std::pair(b, m));
      markers_.insert_or_assign(body.label + ":" + label, std::pair(b, m));
    }
  }
}

void BodiesInSpace::name(const TrackName& track) {
  const auto found = markers_.find(track.label);
  if (found == markers_.end()) {
    named_.erase(track.id);
  } else {
    named_[track.id] = found->second;
  }
}

void BodiesInSpace::add_to(Instant& instant) {
  for (const TrackName& track : instant.named) name(track);
  points_.clear();
  for (const Sample& sample : instant.samples) {
    if (sample.provenance != Provenance::measured && sample.provenance != Provenance::filled) continue;
    const auto known = named_.find(sample.track);
    points_.push_back({sample.position, known == named_.end() ? std::nullopt : std::optional(known->second)});
  }
  const auto poses = target_tracker_.step(instant.time, points_);
  instant.bodies.assign(poses.begin(), poses.end());
}

TrackBodiesSummary track_bodies(const std::string& recording, const std::string& bodies, const std::string& out,
                                const TrackBodiesOptions& options, const Hooks& hooks) {
  const auto reader = format::open_recording(recording);
  require_space(reader->header(), recording);
  const format::Format& format = format::format_to_write(out, options.format, format::Content::space);
  BodiesInSpace step(format::bodies::read_bodies(bodies), options.tracking);
  RecordingHeader header = reader->header();
  header.bodies = step.tracker().bodies();
  header.made_by = {
      .program = "marey body track", .options = hooks.options, .inputs = {format::input_of(recording), format::input_of(bodies)}};
  format::WritePlan plan;
  if (!format.while_recording) plan = format::plan_of(*format::open_recording(recording), recording);
  plan.info.header = header;
  const auto sink = format::create_recording(out, format, plan);
  sink->begin(header);
  SettledInstants settled(*sink, options.settle_s);
  const std::vector<TrackName> names = reader->tracks();
  for (const TrackName& name : names) step.name(name);
  std::vector<double> errors(header.bodies.size());
  std::int64_t instants = 0;
  bool stopped = false;
  std::vector<TrackBodiesSummary::InQuestion> in_question;
  while (auto instant = reader->next()) {
    if (instants == 0) instant->named.insert(instant->named.begin(), names.begin(), names.end());
    step.add_to(*instant);
    for (const BodyPose& pose : instant->bodies) {
      if (pose.tracked) errors[static_cast<std::size_t>(number(pose.body)) - 1] += pose.residual_m.value_or(0);
    }
    settled.add(*std::move(instant), step.tracker().corrections());
    add_in_question(step.tracker(), settled, in_question);
    stopped = hooks.report({.step = "following bodies", .done = ++instants, .total = reader->instant_count()}) == Continue::no;
    if (stopped) break;
  }
  settled.finish();
  if (!stopped) sink->finish();
  TrackBodiesSummary summary = summary_of(step.tracker(), errors);
  summary.instants = instants;
  summary.in_question = std::move(in_question);
  summary.stopped = stopped;
  for (std::string& warning : reader->warnings()) summary.warnings.push_back(std::move(warning));
  if (auto message_text = format::poses_lost(header, out, format)) summary.warnings.push_back(std::move(*message_text));
  if (auto message_text = format::auxiliary_lost(reader->info().auxiliary, out, format))
    summary.warnings.push_back(std::move(*message_text));
  return summary;
}

constexpr double kBends = 0.004;  // m; skin and cloth on a limb, and noise, stay below

std::vector<std::string> review_items_of(const solve::bodies::DefinedBody& defined) {
  std::vector<std::string> warnings;
  for (const auto& marker : defined.markers) {
    if (marker.loose)
      warnings.push_back(
          fmt::format("{} is loose: it varies by {:.1f} mm to the others, and is omitted", marker.label, 1000 * marker.deviation));
  }
  const solve::bodies::DefinedMarker* bends = nullptr;
  for (const auto& marker : defined.markers) {
    if (!marker.loose && marker.deviation > kBends && (bends == nullptr || marker.deviation > bends->deviation)) bends = &marker;
  }
  if (bends != nullptr)
    warnings.push_back(
        fmt::format("{} varies by {:.1f} mm to the others: is this one rigid thing?", bends->label, 1000 * bends->deviation));
  if (!defined.symmetries.empty()) {
    const auto& first = defined.symmetries.front();
    const std::size_t others = defined.symmetries.size() - 1;
    warnings.push_back(
        fmt::format("{} it appears the same to {:.1f} mm{}: after it was hidden it may come back turned; move a marker",
                    words_of(first), 1000 * first.worst, others == 0 ? "" : fmt::format(" (and {} other ways)", others)));
  }
  if (defined.shortest_edge < 0.02)
    warnings.push_back(
        fmt::format("two of its markers are {:.0f} mm from each other; cameras distinguish them better from 20 mm on",
                    1000 * defined.shortest_edge));
  return warnings;
}

solve::bodies::DefinedBody define_body(const std::string& recording, const std::string& out, bool add,
                                       const solve::bodies::DefineOptions& options) {
  Recording read = [&] {
    const auto reader = format::open_recording(recording);
    require_space(reader->header(), recording);
    return read_all(*reader);
  }();
  read.header.name = recording;
  const solve::bodies::DefinedBody defined = solve::bodies::define_body(read, options);
  std::vector<Body> bodies;
  if (add && std::filesystem::exists(out)) bodies = format::bodies::read_bodies(out);
  const auto same = std::find_if(bodies.begin(), bodies.end(), [&](const Body& body) { return body.label == defined.body.label; });
  if (same == bodies.end()) {
    bodies.push_back(defined.body);
  } else {
    same->markers = defined.body.markers;
  }
  format::bodies::write_bodies(out, bodies);
  return defined;
}

}  // namespace marey::pipeline::bodies

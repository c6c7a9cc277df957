#include "marey/pipeline/markers/set_search.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include "marey/pipeline/corridor/stopwatch.h"

namespace marey::pipeline::markers {
namespace {

using solve::labels::TrackedPoint;

constexpr double kRememberedHz = 100;   // about, of the points that are kept
constexpr double kAgainS = 2;           // after a search, if many labels are missing
constexpr double kMinFirstStaticS = 1;  // of points that are searched first, with a set of a person who stood still
constexpr int kStaticSearches = 5;      // consecutive ones, with such a set
constexpr double kMaxAgainS = 5;        // after a search that found nothing
constexpr double kHeldFraction = 0.7;   // of the labels that could be given

SetInSpaceOptions options_for(SetInSpaceOptions options, const LearnedMarkers& set) {
  if (!set.moves) options.first_after_s = std::max(options.first_after_s, kMinFirstStaticS);
  return options;
}

}  // namespace

solve::labels::LabelOptions live_label_options() {
  solve::labels::LabelOptions options;
  options.initialises = 2;
  options.initialise.answers = 250;
  return options;
}

RecentPoints::RecentPoints(double rate_hz, double duration_s)
    : rate_hz_(rate_hz), duration_s_(duration_s), every_(std::max<std::int64_t>(1, std::llround(rate_hz / kRememberedHz))) {}

void RecentPoints::add(std::int64_t index, Timestamp time, std::span<const TrackedPoint> points) {
  if (count_++ % every_ != 0) return;
  auto instant = std::make_shared<Instant>();
  instant->index = index;
  instant->time = time;
  instant->points.assign(points.begin(), points.end());
  instants_.push_back(std::move(instant));
  while (seconds(time - instants_.front()->time) > duration_s_) instants_.pop_front();
}

SetSearch::SetSearch(std::shared_ptr<const LearnedMarkers> set, double rate_hz, const SetInSpaceOptions& options)
    : set_(std::move(set)), options_(options_for(options, *set_)), recent_(rate_hz, options.remembered_s) {}

SetSearch::~SetSearch() {
  stop_.request_stop();
  if (running_.valid()) running_.wait();
}

double SetSearch::min_points(const LearnedMarkers& set) {
  return std::max(4.0, kMinObserved * static_cast<double>(set.size()));
}

void SetSearch::begin_if_due(Timestamp now, std::size_t points, std::optional<std::size_t> held) {
  if (static_cast<double>(points) < min_points(*set_)) {
    enough_since_.reset();
    return;
  }
  if (!enough_since_) enough_since_ = now;
  if (running_.valid() || !is_due(now, points, held)) return;
  ++searches_;
  begun_at_ = now;
  running_ = std::async(std::launch::async, [recent = recent_.instants(), rate = recent_.rate_hz(), set = set_, options = options_,
                                             stop = stop_.get_token()] { return search_in(recent, rate, *set, options, stop); });
}

bool SetSearch::is_due(Timestamp now, std::size_t points, std::optional<std::size_t> held) const {
  if (seconds(now - *enough_since_) < options_.first_after_s) return false;
  if (searches_ == 0) return true;
  double pause = options_.search_again_s;
  if (!held) {
    pause = std::min<double>(failures_, kMaxAgainS);
  } else if (searches_ - failures_ <= (set_->moves ? 1 : kStaticSearches) ||
             static_cast<double>(*held) < kHeldFraction * static_cast<double>(std::min(points, set_->size()))) {
    pause = set_->moves ? kAgainS : 0;
  }
  return seconds(now - begun_at_) >= options_.answer_after_s + pause;
}

SetSearch::Answer SetSearch::search_in(const RecentPoints::Instants& recent, double rate_hz, const LearnedMarkers& set,
                                       const SetInSpaceOptions& options, const std::stop_token& stop) {
  const corridor::Stopwatch taken;
  Answer answer;
  Recording recording;
  recording.header.name = "the markers seen";
  recording.header.rate_hz = rate_hz;
  Instant instant;
  for (const auto& kept : recent) {
    instant.index = kept->index;
    instant.time = kept->time;
    instant.samples.clear();
    for (const TrackedPoint& point : kept->points) {
      Sample& sample = instant.samples.emplace_back();
      sample.track = point.track;
      sample.position = point.location;
    }
    recording.add(instant);
  }
  try {
    const Hooks hooks{.progress = {}, .stop = stop, .options = {}};
    answer.found = solve::labels::find_names(recording, set, options.find, options.tracking, hooks);
  } catch (const std::exception& error) {
    answer.failure = error.what();
  }
  answer.seconds = taken.seconds();
  return answer;
}

std::optional<solve::labels::FoundNames> SetSearch::answer(Timestamp now) {
  if (!running_.valid() || seconds(now - begun_at_) < options_.answer_after_s) return std::nullopt;
  if (!options_.wait && running_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::nullopt;
  Answer answer = running_.get();
  longest_s_ = std::max(longest_s_, answer.seconds);
  if (answer.found.tracker != nullptr) return std::move(answer.found);
  ++failures_;
  failure_ = answer.failure;
  return std::nullopt;
}

}  // namespace marey::pipeline::markers

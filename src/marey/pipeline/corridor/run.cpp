#include "marey/pipeline/corridor/run.h"

#include <chrono>
#include <set>
#include <utility>

#include "marey/core/error.h"
#include "marey/files/source_name.h"
#include "marey/format/input_hash.h"

namespace marey::pipeline::corridor {
namespace {

/// Counts what goes to the sinks.
class Counter {
 public:
  explicit Counter(Summary& summary) : summary_(summary) {}

  void add(const Instant& instant) {
    for (const TrackName& name : instant.named) {
      if (name.kind == TrackKind::ball) balls_.insert(name.id);
      if (name.label.empty()) {
        labelled_.erase(name.id);
      } else {
        labelled_.insert(name.id);
      }
    }
    for (const Sample& sample : instant.samples) {
      tracks_.insert(sample.track);
      ++summary_.samples;
      ++of(sample.provenance);
      summary_.keypoints += sample.keypoints != nullptr;
      if (sample.outline == nullptr) continue;
      ++summary_.outlines;
      summary_.held_outlines += sample.outline->state == Outline::State::held;
    }
  }

  void finish() {
    summary_.tracks = std::ssize(tracks_);
    for (const TrackId id : balls_) summary_.tracks -= tracks_.contains(id);
    for (const TrackId id : labelled_) summary_.labelled += tracks_.contains(id);
  }

 private:
  std::int64_t& of(Provenance provenance) {
    switch (provenance) {
      case Provenance::measured:
        return summary_.measured;
      case Provenance::filled:
        return summary_.filled;
      case Provenance::predicted:
        return summary_.predicted;
      case Provenance::solved:
        break;
    }
    return summary_.solved;
  }

  Summary& summary_;
  std::set<TrackId> tracks_, labelled_, balls_;
};

/// The header with how it was made.
RecordingHeader signed_header(RecordingHeader header, const Clock& clock, const Hooks& hooks) {
  if (header.made_by.program.empty()) header.made_by.program = "marey";
  header.made_by.program += " " MAREY_VERSION;
  header.made_by.options = hooks.options;
  if (header.rig) {
    for (RigCamera& camera : header.rig->cameras) camera.source = shown_source(camera.source);  // a recording keeps no password
  }
  for (const Feed& feed : clock.feeds()) {
    if (!feed.info().name.empty()) header.made_by.inputs.push_back(format::input_of(shown_source(feed.info().name)));
  }
  return header;
}

void attach(std::vector<Frame>& frames, const FrameSet& set) {
  for (const auto& camera : set.cameras) {
    if (camera && !camera->frame.image.empty()) frames.push_back(camera->frame);
  }
}

/// Whether the instant is of these frames. Live, instants of one camera have the numbers of its frames, and the clock counts from
/// the first frame that it took.
bool is_of(const Instant& instant, const FrameSet& frames) {
  if (instant.index == frames.index) return true;
  return frames.cameras.size() == 1 && frames.cameras.front() && instant.time == frames.cameras.front()->frame.time;
}

/// The images of instants that are past, asked of the feeds once more.
class Images {
 public:
  explicit Images(const Clock& clock) : clock_(clock.again()) {}

  /// Of the instant of this index, which grows from call to call. Throws Error if the images end before it.
  void attach_to(Instant& instant) {
    while (!now_ || now_->index < instant.index) {
      now_ = clock_.next();
      if (!now_)
        throw Error("{}: has no frame {} when it is read again to be drawn; memory is short, or the file has changed",
                    clock_.feeds().front().info().name, instant.index);
    }
    if (now_->index == instant.index) attach(instant.frames, *now_);
  }

 private:
  Clock clock_;
  std::optional<FrameSet> now_;
};

/// What a second pass knows of the whole recording, to the sinks. A run that was stopped draws nothing any more: to read the
/// images again takes as long as the run did.
void replay(InstantSource& rest, const Clock& clock, Sinks& sinks, Counter& counter, const Hooks& hooks, Summary& summary) {
  if (hooks.stop.stop_requested()) {
    for (const std::string& name : sinks.drop_images())
      summary.warnings.push_back(name + ": is not written, because the run was stopped before its images were drawn");
  }
  std::optional<Images> images;
  if (sinks.need_images()) images.emplace(clock);
  std::int64_t done = 0;
  while (auto instant = rest.next()) {
    if (images && instant->frames.empty()) images->attach_to(*instant);
    counter.add(*instant);
    if (!sinks.write(std::move(*instant))) break;
    if (!sinks.need_images() || hooks.report({"drawing", ++done, summary.frames}) == Continue::yes) continue;
    summary.stopped = true;
    break;
  }
}

/// Nothing at the end, and where waiting for a camera was given up.
std::optional<FrameSet> next_of(Clock& clock, const Hooks& hooks, Summary& summary) {
  try {
    auto frames = clock.next();
    if (!frames) summary.stopped = hooks.stop.stop_requested();
    return frames;
  } catch (const Stopped&) {
    summary.stopped = true;
    return std::nullopt;
  }
}

/// From the first frame to the cameras' end, a stop, or a sink that fails.
void first_pass(Stage& stage, Clock& clock, Sinks& sinks, Counter& counter, const Hooks& hooks, Summary& summary) {
  const auto begin = std::chrono::steady_clock::now();
  std::optional<Timestamp> first;
  while (const std::optional<FrameSet> frames = next_of(clock, hooks, summary)) {
    for (const Instant& known : stage.step(*frames)) {
      Instant instant = known;
      if (is_of(instant, *frames) && instant.frames.empty()) attach(instant.frames, *frames);
      counter.add(instant);
      if (!sinks.write(std::move(instant))) summary.stopped = true;
    }
    for (const std::string& message_text : stage.news()) {
      if (hooks.news) hooks.news(message_text);
    }
    if (!first) first = frames->time;
    ++summary.frames;
    summary.seconds = seconds(frames->time - *first);
    if (summary.stopped) break;
    summary.stopped = hooks.report({"tracking", summary.frames, clock.count()}) == Continue::no;
    if (summary.stopped) break;
  }
  summary.first_pass_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

Summary run(Stage& stage, Clock& clock, Sinks& sinks, const Hooks& hooks) {
  const StopScope keeps_what_there_is{{}};  // the state when it stops is written
  Summary summary;
  Counter counter(summary);
  sinks.begin(signed_header(stage.header(), clock, hooks));
  if (sinks.need_boxes()) stage.need_boxes();
  if (sinks.need_foregrounds()) {
    stage.need_foregrounds([&](FrameForeground foreground) {
      if (!sinks.write(std::move(foreground))) summary.stopped = true;
    });
  }
  first_pass(stage, clock, sinks, counter, hooks, summary);
  if (summary.frames == 0 && !summary.stopped) throw Error("{}: not one frame could be read", stage.header().name);
  if (const auto rest = stage.finish(hooks)) replay(*rest, clock, sinks, counter, hooks, summary);
  if (hooks.stop.stop_requested() && summary.stopped && summary.samples == 0)
    throw Stopped("stopped before anything was tracked; nothing was written");
  sinks.finish();
  for (std::string& trouble : sinks.troubles()) summary.warnings.push_back(std::move(trouble));
  summary.sink_failed = sinks.failed();
  counter.finish();
  summary.rate_hz = clock.rate_hz();
  summary.live = clock.drops();
  for (std::string& warning : clock.warnings()) summary.warnings.push_back(std::move(warning));
  stage.report(summary);
  return summary;
}

}  // namespace marey::pipeline::corridor

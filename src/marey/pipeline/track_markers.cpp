#include "marey/pipeline/track_markers.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"
#include "marey/core/observation.h"
#include "marey/draw/movie_writer.h"
#include "marey/draw/overlay.h"
#include "marey/pipeline/plot_file.h"
#include "marey/pipeline/read_ahead.h"
#include "marey/pipeline/rows_by_frame.h"
#include "marey/source/open_source.h"
#include "marey/track/fill_gaps.h"
#include "marey/track/recording.h"

namespace marey::pipeline {
namespace {

constexpr double kFittedSeconds = 20;  // of the recording, from which noise is told

class MarkerRun {
 public:
  MarkerRun(const std::string& pictures, std::optional<double> rate_hz, const TrackOutput& output,
            const TrackMarkersOptions& options, const RunHooks& hooks)
      : pictures_(pictures), rate_hz_(rate_hz), options_(options), hooks_(hooks), source_(open()), detector_(options.markers) {
    if (options.fit_noise && !options.live) fit();
    tracker_ = track::make_roster_tracker<2>(options_.tracker);
    file_.emplace(output.tracks, output.format);
    if (!output.plot.empty()) plot_.emplace(output.plot, "Trajectories in " + source_->info().name);
    if (!output.overlay.empty()) movie_.emplace(output.overlay, source_->info().size, source_->info().rate_hz);
  }

  MarkerSummary operator()() {
    follow();
    if (!options_.live) {
      const std::vector<track::TrackRow> rows = track::fill_gaps(recording_);
      for (RowsByFrame by_frame(rows, labels()); const std::int64_t frame : frames_) {
        tell(frame, recording_.time_of(static_cast<std::int32_t>(frame)), by_frame.at(frame));
      }
      file_->finish();
      if (movie_) draw(rows);
    } else {
      file_->finish();
    }
    if (movie_) movie_->finish();
    if (plot_) plot_->finish();
    summary_.markers = std::ssize(names_);
    if (summary_.detections == 0) {
      summary_.warnings.push_back(pictures_ +
                                  ": no marker was seen in any frame; are they bright on dark (else --dark or --colour), "
                                  "and brighter than --threshold?");
    }
    return std::move(summary_);
  }

 private:
  std::unique_ptr<Source> open() const { return read_ahead(source::open_source(pictures_, rate_hz_)); }

  /// A first look at the beginning of the recording, to learn how the markers move and how well they are seen.
  void fit() {
    const std::unique_ptr<Source> source = source::open_source(pictures_, rate_hz_);
    detect::markers::MarkerDetector detector(options_.markers);
    const auto tracker = track::make_roster_tracker<2>(options_.tracker);
    std::map<TrackId, filter::MeasuredPath<2>> paths;
    while (const auto frame = source->next()) {
      if (seconds(frame->time) > kFittedSeconds) break;
      const auto seen = look(detector, *frame, *tracker);
      for (const Track<2>& track : tracker->step(frame->time, seen)) {
        if (!track.observation || !track.confirmed) continue;
        paths[track.id].times.push_back(seconds(frame->time));
        paths[track.id].positions.push_back(seen[*track.observation].value);
      }
    }
    std::vector<filter::MeasuredPath<2>> list;
    for (auto& [id, path] : paths) list.push_back(std::move(path));
    summary_.noise = filter::fit_noise<2>(list);
    if (summary_.noise) {
      options_.tracker.filter = filter::with_noise(options_.tracker.filter, *summary_.noise);
    } else {
      summary_.warnings.push_back(pictures_ + ": too little moves in its beginning to tell the noise from; the defaults were kept");
    }
  }

  static std::vector<Observation<2>> look(detect::markers::MarkerDetector& detector, const Frame& frame,
                                          track::Tracker<2>& tracker) {
    std::vector<Expected> expected;
    for (const Track<2>& track : tracker.expected(frame.time)) {
      if (track.box) expected.push_back({*track.box});
    }
    std::vector<Observation<2>> seen;
    for (const Detection& detection : detector.detect(frame, expected).detections) seen.push_back(observation_of(detection));
    return seen;
  }

  void follow() {
    while (const auto frame = source_->next()) {
      const auto seen = look(detector_, *frame, *tracker_);
      confirmed_.clear();
      for (const Track<2>& track : tracker_->step(frame->time, seen)) {
        if (track.confirmed) confirmed_.push_back(track);
        if (!track.label.empty()) label_of_[track.id] = track.label;
      }
      if (options_.live) {
        tell(frame->index, frame->time, confirmed_);
        if (movie_) movie_->write(overlay_.draw(frame->picture, frame->time, confirmed_), frame->time);
      } else {
        recording_.add(frame->index, frame->time, confirmed_);
        frames_.push_back(frame->index);
      }
      summary_.detections += std::ssize(seen);
      summary_.frames = frame->index + 1;
      summary_.seconds = seconds(frame->time);
      summary_.stopped = hooks_.tell({TrackProgress::Step::tracking, summary_.frames, source_->info().frame_count});
      if (summary_.stopped) break;
    }
    if (summary_.frames == 0) throw Error("{}: not one frame could be read", source_->info().name);
    for (const std::string& warning : source_->warnings()) summary_.warnings.push_back(warning);
    for (const std::string& warning : detect::markers::warnings(detector_.counts()))
      summary_.warnings.push_back(pictures_ + ": " + warning);
  }

  std::vector<std::string> labels() const {
    std::vector<std::string> result;
    for (const auto& [id, label] : label_of_) {
      result.resize(std::max(result.size(), static_cast<std::size_t>(number(id)) + 1));
      result[static_cast<std::size_t>(number(id))] = label;
    }
    return result;
  }

  void tell(std::int64_t frame, Timestamp time, std::span<const Track<2>> tracks) {
    file_->write(frame, time, tracks);
    summary_.rows += std::ssize(tracks);
    for (const Track<2>& track : tracks) names_.insert(track.id);
    if (plot_) plot_->add(frame, tracks);
  }

  /// A second look at the pictures, because the tracks of a frame are known only after the last one.
  void draw(const std::vector<track::TrackRow>& rows) {
    const auto source = open();
    RowsByFrame by_frame(rows, labels());
    for (std::int64_t done = 0; done < summary_.frames;) {
      const auto frame = source->next();
      if (!frame) break;
      movie_->write(overlay_.draw(frame->picture, frame->time, by_frame.at(frame->index)), frame->time);
      if (hooks_.tell({TrackProgress::Step::drawing, ++done, summary_.frames}) && !summary_.stopped) {
        summary_.stopped = true;
        break;
      }
    }
  }

  std::string pictures_;
  std::optional<double> rate_hz_;
  TrackMarkersOptions options_;
  RunHooks hooks_;
  MarkerSummary summary_;
  std::unique_ptr<Source> source_;
  detect::markers::MarkerDetector detector_;
  std::unique_ptr<track::Tracker<2>> tracker_;
  std::optional<format::tracks::TrackFile> file_;
  std::optional<PlotFile> plot_;
  std::optional<draw::MovieWriter> movie_;
  draw::Overlay overlay_;
  track::Recording recording_;
  std::vector<std::int64_t> frames_;
  std::vector<Track<2>> confirmed_;
  std::map<TrackId, std::string> label_of_;
  std::set<TrackId> names_;
};

}  // namespace

MarkerSummary track_markers(const std::string& pictures, std::optional<double> rate_hz, const TrackOutput& output,
                            const TrackMarkersOptions& options, const RunHooks& hooks) {
  return MarkerRun(pictures, rate_hz, output, options, hooks)();
}

std::vector<std::string> read_labels(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error("{}: cannot be read; give a text file with one name a line", path);
  std::vector<std::string> labels;
  std::set<std::string> seen;
  int line_number = 0;
  for (std::string line; std::getline(file, line);) {
    ++line_number;
    const auto first = line.find_first_not_of(" \t\r");
    if (first == std::string::npos) continue;
    line = line.substr(first, line.find_last_not_of(" \t\r") - first + 1);
    if (!seen.insert(line).second)
      throw Error("{}:{}: the name \"{}\" occurs twice; every marker needs its own", path, line_number, line);
    labels.push_back(line);
  }
  if (labels.empty()) throw Error("{}: holds no name; write one a line", path);
  return labels;
}

cv::Mat read_mask(const std::string& path) {
  constexpr double kBlack = 8;  // what a lossy picture may make of 0
  const auto frame = source::open_source(path)->next();
  if (!frame) throw Error("{}: cannot be read as a picture; give a PNG in which what is to be left out is white", path);
  cv::Mat grey;
  cv::cvtColor(frame->picture.bgr(), grey, cv::COLOR_BGR2GRAY);
  return grey > kBlack;
}

}  // namespace marey::pipeline

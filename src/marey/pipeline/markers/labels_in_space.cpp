#include "marey/pipeline/markers/labels_in_space.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <string_view>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/bodies/label_set_file.h"
#include "marey/format/input_hash.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/solve/labels/accept_suggestions.h"

namespace marey::pipeline::markers {
namespace {

Recording points_in(const std::string& path, std::vector<std::string>* warnings, format::AuxiliaryData* auxiliary = nullptr) {
  const auto reader = format::open_recording(path);
  if (reader->header().frame.kind != FrameOfReference::Kind::space)
    throw Error("{}: names are for points in space, and these positions are {}", path, to_string(reader->header().frame));
  Recording recording = read_all(*reader);
  recording.header.name = path;
  if (warnings != nullptr) *warnings = reader->warnings();
  if (auxiliary != nullptr) *auxiliary = reader->info().auxiliary;
  return recording;
}

constexpr std::size_t kFewFrames = 10;  // that a set is barely learned from
constexpr double kMisfit = 2;           // times as far off as distances of the subject that taught are
constexpr double kFewFound = 0.7;       // of the set's markers

/// Whether a label is of a pattern, in which * stands for any letters.
bool is_like(std::string_view label, std::string_view pattern) {
  if (pattern.empty()) return label.empty();
  if (pattern.front() != '*')
    return !label.empty() && label.front() == pattern.front() && is_like(label.substr(1), pattern.substr(1));
  for (std::size_t skipped = 0; skipped <= label.size(); ++skipped) {
    if (is_like(label.substr(skipped), pattern.substr(1))) return true;
  }
  return false;
}

/// The tracks of those patterns, taken out of the recording. `fitted` gets the patterns that fit one. "Anna:LHJC" is LHJC too.
std::vector<TrackColumns> take_out(Recording& recording, const std::vector<std::string>& patterns, std::set<std::string>& fitted) {
  std::vector<TrackColumns> out;
  const auto is_meant = [&](const TrackColumns& track) {
    const std::string_view label = track.name.label, alone = label.substr(label.find(':') + 1);
    bool meant = false;
    for (const std::string& pattern : patterns) {
      if (label.empty() || (!is_like(label, pattern) && !is_like(alone, pattern))) continue;
      fitted.insert(pattern);
      meant = true;
    }
    return meant;
  };
  for (const TrackColumns& track : recording.tracks()) {
    if (is_meant(track)) out.push_back(track);
  }
  recording.erase_tracks_if(is_meant);
  return out;
}

bool is_all(const std::vector<std::string>& accept) {
  return accept == std::vector<std::string>{"all"};
}

void require_of_set(const std::vector<std::string>& accept, const LearnedMarkers& learned, const std::string& set) {
  for (const std::string& name : accept) {
    if (!is_all(accept) && std::find(learned.labels.begin(), learned.labels.end(), name) == learned.labels.end())
      throw Error("{}: has no marker {}, whose name could be accepted; `all` accepts what fits best", set, name);
  }
}

void require_fitted(const std::vector<std::string>& patterns, const std::set<std::string>& fitted, const std::string& where) {
  for (const std::string& pattern : patterns) {
    if (!fitted.contains(pattern)) throw Error("{}: no point is called {}, so that it cannot be omitted", where, pattern);
  }
}

}  // namespace

std::optional<std::string> set_misfit(const std::string& set, double misfit, double misfit_m, std::size_t found,
                                      std::size_t markers) {
  const bool off = misfit > kMisfit, few = static_cast<double>(found) < kFewFound * static_cast<double>(markers);
  if (!off && !few) return std::nullopt;
  return fmt::format(
      "{} does not fit: {}{} of its {} markers have names, and of those some may be wrong; is it of another person, or were "
      "markers "
      "moved? Learn one of this person, or one with --scale-invariant from several",
      set,
      off ? fmt::format("distances that it knows as rigid are off by {:.0f} mm (median), {:.1f} times what is expected; ",
                        1e3 * misfit_m, misfit)
          : "",
      found, markers);
}

LearnedMarkers learn_labels(const std::vector<std::string>& recordings, const std::string& out,
                            const solve::labels::LearnOptions& options, const std::vector<std::string>& exclude,
                            std::vector<std::string>* warnings) {
  std::vector<Recording> read;
  std::set<std::string> fitted;
  std::size_t frames = 0;
  for (const std::string& path : recordings) {
    take_out(read.emplace_back(points_in(path, nullptr)), exclude, fitted);
    frames += read.back().instants().size();
  }
  require_fitted(exclude, fitted, recordings.size() == 1 ? recordings.front() : "the recordings");
  if (warnings != nullptr && frames < kFewFrames)
    warnings->push_back(fmt::format("learned from {} {}: one cannot know from it what is rigid and what moves; give some seconds",
                                    frames, frames == 1 ? "frame" : "frames"));
  LearnedMarkers learned = solve::labels::learn_markers(read, options);
  format::bodies::write_label_set(out, learned);
  return learned;
}

std::vector<std::string> warnings_of(const LearnedMarkers& learned) {
  std::vector<std::string> stated;
  if (solve::labels::is_flat(learned))
    stated.push_back(
        "the set's markers lie in one plane, so that it appears the same from behind: names may be exchanged as in a mirror");
  const std::vector<std::string> near = solve::labels::too_near_for_markers(learned);
  if (near.empty()) return stated;
  stated.push_back(
      fmt::format("{} of the set's {} points, as {} and {}, lie within 10 mm of another, as points do that a program computed "
                  "(joints' centres): name the markers alone with --markers, or leave those points out with --exclude",
                  near.size(), learned.size(), near.front(), near.back()));
  return stated;
}

namespace {

/// Says what of the names a user should know: a set of another person, one that does not fit, markers that are not there.
/// `which` names recording and set.
void warn_of_set(LabelSummary& summary, const solve::labels::Labelled& labelled, const std::string& which,
                 const std::string& recording) {
  if (labelled.found_again)
    summary.warnings.push_back(
        fmt::format("{} is of another person, and was scaled to this one (by {:.2f}, and segment by segment); searches at other "
                    "instants gave {:.0f} % of the names again",
                    which, labelled.scale, 100 * *labelled.found_again));
  const auto found =
      std::count_if(summary.health.begin(), summary.health.end(), [](const auto& marker) { return marker.detected > 0; });
  if (auto message_text =
          set_misfit(which, labelled.misfit, labelled.misfit_m, static_cast<std::size_t>(found), summary.health.size()))
    summary.warnings.push_back(std::move(*message_text));
  for (const auto& marker : summary.health) {
    if (marker.detected == 0) summary.warnings.push_back(fmt::format("{}: marker {} was not found", recording, marker.label));
  }
}

}  // namespace

LabelSummary label_recording(const std::string& recording, const std::string& set, const std::string& out,
                             const solve::labels::LabelOptions& options, const Hooks& hooks,
                             const std::vector<std::string>& exclude, const std::vector<std::string>& accept) {
  LabelSummary summary;
  const format::Format& format = format::format_to_write(out, "", format::Content::space);
  const LearnedMarkers learned = format::bodies::read_label_set(set);
  require_of_set(accept, learned, set);
  format::AuxiliaryData auxiliary;
  Recording read = points_in(recording, &summary.warnings, &auxiliary);
  std::set<std::string> fitted;
  std::vector<TrackColumns> excluded = take_out(read, exclude, fitted);
  require_fitted(exclude, fitted, recording);
  solve::labels::Labelled labelled = solve::labels::label_recording(read, learned, options, hooks);
  if (!accept.empty())
    summary.accepted = solve::labels::accept_suggestions(labelled, is_all(accept) ? std::vector<std::string>() : accept);
  Recording& named = labelled.recording;
  named.header.name = std::filesystem::path(recording).stem().string();
  named.header.made_by = {
      .program = "marey label", .options = hooks.options, .inputs = {format::input_of(recording), format::input_of(set)}};
  summary.instants = std::ssize(named.instants());
  summary.points = named.samples();
  for (TrackColumns& track : excluded) {
    track.name.id = TrackId{number(named.tracks().back().id()) + 1};
    named.put(std::move(track));
  }
  for (const auto& marker : labelled.health) summary.named += marker.detected;
  format::WritePlan plan = format::plan_of(*format::reader_of(named), out);
  plan.info.auxiliary = auxiliary;
  const auto sink = format::create_recording(out, format, plan, &summary.warnings);
  MemoryReader reader(named);
  replay(reader, *sink);
  if (auto message_text = format::auxiliary_lost(auxiliary, out, format)) summary.warnings.push_back(std::move(*message_text));
  summary.health = std::move(labelled.health);
  summary.unnamed = std::move(labelled.unnamed);
  summary.renamed = labelled.renamed;
  summary.scale = labelled.scale;
  summary.misfit = labelled.misfit;
  warn_of_set(summary, labelled, fmt::format("{}: the set {}", recording, set), recording);
  return summary;
}

}  // namespace marey::pipeline::markers

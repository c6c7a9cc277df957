#include "marey/pipeline/labels_in_space.h"

#include <filesystem>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/bodies/label_set_file.h"
#include "marey/format/input_hash.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"

namespace marey::pipeline {
namespace {

Recording points_in(const std::string& path, std::vector<std::string>* warnings, format::BesidePoints* beside = nullptr) {
  const auto reader = format::open_recording(path);
  if (reader->header().frame.kind != FrameOfReference::Kind::space)
    throw Error("{}: names are for points in space, and these positions are {}", path, to_string(reader->header().frame));
  Recording recording = read_all(*reader);
  recording.header.name = path;
  if (warnings != nullptr) *warnings = reader->warnings();
  if (beside != nullptr) *beside = reader->info().beside;
  return recording;
}

}  // namespace

LearnedMarkers learn_labels(const std::vector<std::string>& recordings, const std::string& out,
                            const solve::labels::LearnOptions& options) {
  std::vector<Recording> read;
  for (const std::string& path : recordings) read.push_back(points_in(path, nullptr));
  LearnedMarkers learned = solve::labels::learn_markers(read, options);
  format::bodies::write_label_set(out, learned);
  return learned;
}

std::vector<std::string> warnings_of(const LearnedMarkers& learned) {
  const std::vector<std::string> near = solve::labels::too_near_for_markers(learned);
  if (near.empty()) return {};
  return {
      fmt::format("{} of the set's {} points, as {} and {}, lie within 10 mm of another, as points do that a program computed "
                  "(joints' centres): name the markers alone with --markers",
                  near.size(), learned.size(), near.front(), near.back())};
}

LabelSummary label_recording(const std::string& recording, const std::string& set, const std::string& out,
                             const solve::labels::LabelOptions& options, const Hooks& hooks) {
  LabelSummary summary;
  const format::Format& format = format::format_to_write(out, "", format::Content::space);
  const LearnedMarkers learned = format::bodies::read_label_set(set);
  format::BesidePoints beside;
  const Recording read = points_in(recording, &summary.warnings, &beside);
  solve::labels::Labelled labelled = solve::labels::label_recording(read, learned, options, hooks);
  Recording& named = labelled.recording;
  named.header.name = std::filesystem::path(recording).stem().string();
  named.header.made_by = {
      .program = "marey label", .options = hooks.options, .inputs = {format::input_of(recording), format::input_of(set)}};
  summary.instants = std::ssize(named.instants());
  summary.points = named.samples();
  for (const auto& marker : labelled.health) summary.named += marker.seen;
  format::WritePlan plan = format::plan_of(*format::reader_of(named), out);
  plan.info.beside = beside;
  const auto sink = format::create_recording(out, format, plan, &summary.warnings);
  MemoryReader reader(named);
  replay(reader, *sink);
  if (auto sentence = format::beside_lost(beside, out, format)) summary.warnings.push_back(std::move(*sentence));
  summary.health = std::move(labelled.health);
  summary.unnamed = std::move(labelled.unnamed);
  summary.renamed = labelled.renamed;
  summary.scale = labelled.scale;
  for (const auto& marker : summary.health) {
    if (marker.seen == 0) summary.warnings.push_back(fmt::format("{}: marker {} was not found", recording, marker.label));
  }
  return summary;
}

}  // namespace marey::pipeline

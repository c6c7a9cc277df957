#include "marey/pipeline/take/describe_edits.h"

#include <algorithm>
#include <map>
#include <set>

#include <fmt/core.h>
#include <fmt/ranges.h>

#include "marey/files/text_safety.h"

namespace marey::pipeline::take {
namespace {

using edit::FilledGap;
using edit::Operation;

/// What tracks are called.
class NamesThen {
 public:
  NamesThen(const std::vector<TrackName>& tracks, const std::vector<Body>& bodies) {
    for (const TrackName& track : tracks) names_[track.id] = track.label;
    for (const Body& body : bodies) bodies_[body.id] = body.label;
  }
  std::string of(BodyId body) const {
    const auto found = bodies_.find(body);
    return found == bodies_.end() ? fmt::format("body {}", number(body)) : found->second;
  }
  std::string of(TrackId track) const {
    const auto found = names_.find(track);
    return found == names_.end() || found->second.empty() ? fmt::format("#{}", number(track)) : found->second;
  }
  std::string of(const std::vector<TrackId>& tracks) const {
    constexpr std::size_t kMaxCount = 6;  // format: a sentence stays short
    std::vector<std::string> names;
    for (std::size_t i = 0; i < std::min(tracks.size(), kMaxCount); ++i) names.push_back(of(tracks[i]));
    return fmt::format("{}{}", fmt::join(names, ", "),
                       tracks.size() > kMaxCount ? fmt::format(" and {} more", tracks.size() - kMaxCount) : "");
  }
  /// What it did to names counts for the edits behind it.
  void apply(const Operation& operation) {
    if (operation.kind == Operation::Kind::rename) names_[operation.tracks[0]] = operation.label;
    if (operation.kind == Operation::Kind::split) names_[*operation.initiated] = operation.label;
  }

 private:
  std::map<TrackId, std::string> names_;
  std::map<BodyId, std::string> bodies_;
};

std::string frames_of(const std::optional<edit::FrameRange>& frames) {
  if (!frames) return {};
  if (frames->last == edit::FrameRange::kToTheEnd) return fmt::format(", from frame {} on", frames->first);
  return fmt::format(", frames {} to {}", frames->first, frames->last);
}

std::string fills_of(const std::vector<FilledGap>& gaps, const NamesThen& names) {
  std::int64_t frames = 0;
  std::vector<TrackId> tracks;
  std::map<std::string_view, int> by_method;
  double minimum = gaps.front().expected_m, maximum = minimum;
  for (const FilledGap& gap : gaps) {
    if (std::find(tracks.begin(), tracks.end(), gap.track) == tracks.end()) tracks.push_back(gap.track);
    frames += gap.frames.last - gap.frames.first + 1;
    ++by_method[edit::name_of(gap.method)];
    minimum = std::min(minimum, gap.expected_m);
    maximum = std::max(maximum, gap.expected_m);
  }
  std::vector<std::string> methods;
  for (const auto& [method, count] : by_method) methods.push_back(fmt::format("{} by {}", count, method));
  const std::string off = maximum - minimum < 5e-5 ? fmt::format("{:.1f}", maximum * 1e3)
                                                   : fmt::format("{:.1f} to {:.1f}", minimum * 1e3, maximum * 1e3);
  return fmt::format("{}: {} {}, {} frames: {}; expected to be off by {} mm", names.of(tracks), gaps.size(),
                     gaps.size() == 1 ? "gap" : "gaps", frames, fmt::join(methods, ", "), off);
}

std::string cutoffs_of(const std::vector<double>& cutoffs) {
  const auto [minimum, maximum] = std::minmax_element(cutoffs.begin(), cutoffs.end());
  return *minimum == *maximum ? fmt::format("{:g} Hz", *minimum) : fmt::format("{:g} to {:g} Hz", *minimum, *maximum);
}

std::string words_of(const DoneEdit& done, const NamesThen& names) {
  if (!done.operation) return fmt::format("{} {}", done.edit.operation, done.edit.payload);
  const Operation& operation = *done.operation;
  using Kind = Operation::Kind;
  std::string words(edit::name_of(operation.kind));
  if (operation.kind == Kind::fill) return fmt::format("{} {}", words, fills_of(operation.gaps, names));
  words += " " + (operation.body ? names.of(*operation.body) : names.of(operation.tracks));
  if (operation.kind == Kind::rename) return fmt::format("{} to {}", words, operation.label);
  if (operation.kind == Kind::team) return fmt::format("{}: {}", words, operation.label);
  if (operation.kind == Kind::split)
    return fmt::format("{} at frame {}: {} from there on", words, operation.frames->first,
                       operation.label.empty() ? fmt::format("#{}", number(*operation.initiated)) : operation.label);
  if (operation.kind == Kind::filter) words += " at " + cutoffs_of(operation.cutoffs_hz);
  return words + frames_of(operation.frames);
}

/// What tracks are called as one edit follows the other: each follows its parent, mostly the one before it.
class NamesOnBranches {
 public:
  explicit NamesOnBranches(const EditHistory& history) : history_(&history), names_(history.tracks, history.bodies) {
    for (const DoneEdit& done : history.edits) by_id_[done.edit.id] = &done;
  }

  /// Before this edit was done.
  const NamesThen& before(const DoneEdit& done) {
    if (done.edit.parent == last_) return names_;
    names_ = NamesThen(history_->tracks, history_->bodies);
    std::vector<const DoneEdit*> branch;
    for (auto id = done.edit.parent; id && by_id_.contains(*id) && branch.size() < by_id_.size(); id = by_id_[*id]->edit.parent)
      branch.push_back(by_id_[*id]);
    for (auto one = branch.rbegin(); one != branch.rend(); ++one) apply(**one);
    return names_;
  }
  void apply(const DoneEdit& done) {
    if (done.operation) names_.apply(*done.operation);
    last_ = done.edit.id;
  }

 private:
  const EditHistory* history_;
  std::map<std::int64_t, const DoneEdit*> by_id_;
  NamesThen names_;
  std::optional<std::int64_t> last_;
};

EditLine line_of(const DoneEdit& done, const NamesThen& names) {
  EditLine line{.id = done.edit.id,
                .parent = done.edit.parent,
                .operation = plain_text(done.edit.operation),
                .words = plain_text(words_of(done, names)),
                .gaps = {}};
  if (!done.operation) return line;
  for (const FilledGap& gap : done.operation->gaps)
    line.gaps.push_back({plain_text(names.of(gap.track)), gap.frames, gap.method, gap.expected_m});
  return line;
}

}  // namespace

std::vector<EditLine> lines_of(const EditHistory& history) {
  NamesOnBranches names(history);
  const std::set<std::int64_t> counting(history.counting.begin(), history.counting.end());
  std::vector<EditLine> lines;
  for (const DoneEdit& done : history.edits) {
    lines.push_back(line_of(done, names.before(done)));
    lines.back().counts = counting.contains(done.edit.id);
    names.apply(done);
  }
  return lines;
}

}  // namespace marey::pipeline::take

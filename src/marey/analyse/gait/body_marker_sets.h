// The marker sets of the field, as data: which label sits on which segment, and in which of Plug-in Gait's markers' place, so that
// the conventional model reads them all. A new set is a table in the source and a line in its register.
#pragma once

#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "marey/analyse/gait/conventional_model.h"

namespace marey::analyse::gait {

/// A marker of a set. "?" in a label or role stands for L and R: the table has it once.
struct SetMarker {
  std::string_view label;
  SegmentId segment;           ///< of the left side, where there are two
  std::string_view role = {};  ///< Plug-in Gait's marker in whose place it is, or ?KNM, ?ANM: the joint's inner side
};

class BodyMarkerSet {
 public:
  BodyMarkerSet(std::string_view name, std::string_view title, std::span<const SetMarker> markers,
                std::span<const std::string_view> needed);

  std::string_view name() const { return name_; }    ///< for a command line: "cmu-41"
  std::string_view title() const { return title_; }  ///< "CMU's 41 markers"
  std::size_t size() const { return markers_.size(); }

  std::vector<std::string> labels() const;
  bool has(std::string_view label) const { return find(label) != nullptr; }
  /// What the model calls a label of the set: its role, or else the label itself; and back. Nothing for what is not of the set.
  std::optional<std::string> key_of(std::string_view label) const;
  std::string label_of(std::string_view key) const;
  std::optional<SegmentId> segment_of(std::string_view key) const;
  std::optional<SegmentId> segment_of_label(std::string_view label) const;
  /// Which labels lack without which the set makes no skeleton: the pelvis' and the legs'.
  std::vector<std::string> missing(const std::set<std::string, std::less<>>& labels) const;

 private:
  struct Marker {
    std::string label, key;
    SegmentId segment;
  };
  const Marker* find(std::string_view label) const;

  std::string_view name_, title_;
  std::vector<Marker> markers_;
  std::vector<std::string> needed_;
};

const BodyMarkerSet& plug_in_gait();
std::span<const BodyMarkerSet> body_marker_sets();
/// By its name. Throws Error, with the names that there are.
const BodyMarkerSet& body_marker_set(std::string_view name);
/// The labels of a set by its name, or of its part on pelvis and legs by its name with "-lower" behind it. Throws Error, with the
/// names that there are.
std::vector<std::string> marker_set_labels(std::string_view name);
/// The set whose labels these are, subjects' names before them omitted: whose needed ones are all there, and of several the one of
/// which most are. Throws Error, one sentence, where none is whole (with what the nearest lacks), and where two have the same many.
const BodyMarkerSet& recognised_marker_set(const std::set<std::string, std::less<>>& labels);

}  // namespace marey::analyse::gait

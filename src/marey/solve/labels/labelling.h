// The processing of one recording by label_recording.h, of which the steps lie in three sources: whose names they are, where names
// begin (labelling_initialise.cpp), and how they are distributed and checked (labelling_distribute.cpp).
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "marey/assign/no_index.h"
#include "marey/solve/labels/check_names.h"
#include "marey/solve/labels/label_recording.h"
#include "marey/solve/labels/labelled_result.h"
#include "marey/solve/labels/learn_markers.h"
#include "marey/solve/labels/named_chains.h"

namespace marey::solve::labels {

/// The whole processing of one recording.
class Labelling {
 public:
  Labelling(const Recording& recording, const LearnedMarkers& learned, const LabelOptions& options, const Hooks& hooks)
      : recording_(recording), learned_(learned), options_(options), distances_(options.distances), hooks_(hooks), chains_([&] {
          auto tracklets = tracklets_of(recording, options.tracklets);
          const auto chain_of = chains_of(tracklets, recording.header.rate_hz, options.tracklets);
          return NamedChains(std::move(tracklets), chain_of, recording.instants().size(), learned.size());
        }()) {}

  Labelled run() {
    name_person();
    Labelled labelled = labelled_result(recording_, learned_, chains_, *model_, candidates_, scale_);
    for (const int other : undecided_) labelled.undecided.push_back(other == assign::kNoIndex ? 0 : 1);
    const Misfit misfit_now = misfit();
    labelled.misfit = misfit_now.ratio;
    labelled.misfit_m = misfit_now.off_m;
    if (person_) labelled.found_again = found_again_;
    return labelled;
  }

 private:
  void name_all() {
    initialise();
    for (int round = 0; round < options_.rounds; ++round) {
      hooks_.advance({.step = "naming", .done = round + 1, .total = options_.rounds + 1});
      chains_.gather();
      if (round > 0) {
        cut_untrusted();  // before they spoil the learned distances
        chains_.gather();
      }
      if (round > 0 || !learned_.moves || person_)
        refine();  // a subject who stood still gave no rigid distances: the first names do
      distribute();
    }
    chains_.gather();
    refine();
  }

  bool is_scaled() const { return learned_.scaled || person_; }
  DistanceModel taught(double scale) const {
    return person_ ? DistanceModel(learned_, scale, distances_, *person_) : DistanceModel(learned_, scale, distances_);
  }
  void name_person();
  void decide(std::vector<int> undecided);
  double found() const;
  bool scale_to_person();
  void scale_segments();
  std::vector<int> search_again();
  LabelHypothesis answer_at(std::size_t instant, double scale, std::vector<int>& chains, std::size_t& crowd) const;
  void forget();

  /// Of those that have names now, by what was taught.
  Misfit misfit() const {
    if (person_) return misfit_of(chains_.named_distances(), taught(scale_));
    return misfit_of(chains_.named_distances(), DistanceModel(learned_, scale_, options_.distances));
  }
  std::vector<int> check();
  void drop(const std::vector<int>& undecided);
  void initialise();
  [[noreturn]] void fail_to_initialise(std::ptrdiff_t booted, std::size_t crowd) const;
  void refine();
  void distribute();
  void cut_untrusted();
  void assess();
  std::vector<std::size_t> initialise_instants(int count) const;
  std::vector<double> scales(std::size_t instant) const;
  LabelHypothesis initialise_again(const InitialiseScene& scene, const LabelHypothesis& first, DistanceModel model,
                                   const Matrix<3>& turn) const;
  std::optional<Matrix<3>> turn_to_learned(const InitialiseScene& scene, const LabelHypothesis& answer) const;
  void settle(const std::vector<std::vector<int>>& votes);
  double margin(int chain, int name, const std::vector<NamedChains::Fits>& fits, int& next) const;

  const Recording& recording_;
  const LearnedMarkers& learned_;
  const LabelOptions& options_;
  DistanceOptions distances_;
  const Hooks& hooks_;
  NamedChains chains_;
  std::unique_ptr<DistanceModel> model_;
  double scale_ = 1;
  std::optional<AnotherPerson> person_;
  bool scale_known_ = false;
  double found_again_ = 0;                    // of the names, in other searches
  std::vector<int> undecided_;                // by name: which other it could as well be
  std::vector<int> search_again_;             // by name: which other those give
  std::map<int, NameCandidates> candidates_;  // by chain without a name
  std::vector<std::vector<int>> bearers_;     // by name, of the last round
};

}  // namespace marey::solve::labels

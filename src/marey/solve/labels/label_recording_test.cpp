#include "marey/solve/labels/label_recording.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include <gtest/gtest.h>

#include "marey/core/error.h"
#include "marey/filter/random_stream.h"
#include "marey/geometry/rigid.h"
#include "marey/solve/labels/learn_markers.h"

namespace marey::solve::labels {
namespace {

double between(filter::RandomStream& random, double low, double high) {
  return low + (high - low) * random.uniform();
}

/// A figure of four stiff segments of five markers each that swing about each other, and walks round.
class Figure {
 public:
  explicit Figure(std::uint64_t seed) {
    filter::RandomStream random(seed);
    for (int marker = 0; marker < 20; ++marker) {
      const double half = marker < 5 ? 0.18 : 0.1;
      for (;;) {
        const Vector<3> location(between(random, -half, half), between(random, -half, half), between(random, -half, half));
        bool apart = true;
        for (int other = marker / 5 * 5; other < marker; ++other) apart &= (locations_[other] - location).norm() > 0.05;
        locations_[marker] = location;
        if (apart) break;
      }
    }
  }
  /// The last segment becomes a forearm whose two wrist markers have like distances to the rest of it: their side alone differs.
  void make_forearm() {
    locations_[15] = {0.035, 0, -0.05};
    locations_[16] = {-0.035, 0, -0.05};
    locations_[17] = {0, 0.03, -0.12};
    locations_[18] = {0, 0, 0.18};
    locations_[19] = {0, -0.02, 0.1};
  }
  /// Another person: each segment larger by its own factor, and every marker elsewhere by up to `moved`, m, along each axis.
  void become_another(double scale, double uneven, double moved, std::uint64_t seed) {
    filter::RandomStream random(seed);
    for (int marker = 0; marker < 20; ++marker) {
      const double segment = scale * (1 + uneven * ((marker / 5) % 2 == 0 ? 1 : -1));
      for (int axis = 0; axis < 3; ++axis)
        locations_[marker][axis] = segment * locations_[marker][axis] + between(random, -moved, moved);
    }
    size_ = scale;
  }
  /// The last segment's turn about its length, rad.
  void turn_forearm(double angle) { forearm_ = angle; }

  Vector<3> at(int marker, double time, double swing = 1) const {
    const int segment = marker / 5;
    const Rigid3 trunk{geometry::rotation_from({0, 0, 0.5 * time}), {0.5 * std::cos(time), 0.5 * std::sin(time), 1}};
    if (segment == 0) return trunk * locations_[marker];
    const double angle = swing * 0.6 * std::sin(5 * time + segment);
    const Rigid3 limb{geometry::rotation_from({angle, 0.3 * angle, 0}),
                      size_ * Vector<3>(0.3 * (segment - 2), 0.1 * segment, -0.4)};
    const Rigid3 rotated{geometry::rotation_from({0, 0, segment == 3 ? forearm_ : 0}), Vector<3>::Zero()};
    return trunk * (limb * (rotated * locations_[marker] - size_ * Vector<3>(0, 0, 0.3)));
  }

 private:
  double forearm_ = 0, size_ = 1;
  Vector<3> locations_[20];
};

std::string label_of(int marker) {
  return "m" + std::to_string(marker);
}

Recording labelled_recording(const Figure& figure, double from, int instants, double swing = 1) {
  Recording recording;
  recording.header.name = "figure";
  recording.header.rate_hz = 100;
  for (int i = 0; i < instants; ++i) {
    Instant instant;
    instant.index = i;
    instant.time = timestamp_from_seconds(i / 100.0);
    for (int m = 0; m < 20; ++m) {
      Sample sample;
      sample.track = TrackId{m + 1};
      sample.position = figure.at(m, from + i / 100.0, swing);
      instant.samples.push_back(sample);
    }
    recording.add(instant);
  }
  for (int m = 0; m < 20; ++m) recording.set_name({.id = TrackId{m + 1}, .label = label_of(m), .team = {}});
  return recording;
}

/// Without names, 5 % hidden, tracks broken there, ghosts; and whose each track is.
struct Stripped {
  Recording recording;
  std::map<std::pair<std::int32_t, double>, std::string> truth;  // by instant and x
};

Stripped strip(const Recording& recording, std::uint64_t seed) {
  filter::RandomStream random(seed);
  Stripped stripped;
  stripped.recording = Recording(recording.header);
  for (const auto& time_step : recording.instants()) stripped.recording.add_time_step(time_step);
  int id = 1;
  for (const TrackColumns& track : recording.tracks()) {
    TrackColumns piece({.id = TrackId{id}, .label = {}, .team = {}}, 3);
    int hidden = 0;
    for (std::size_t row = 0; row < track.size(); ++row) {
      if (hidden == 0 && random.uniform() < 0.005) hidden = static_cast<int>(between(random, 1, 20));
      if (hidden > 0) {
        --hidden;
        if (!piece.empty())
          stripped.recording.put(std::exchange(piece, TrackColumns({.id = TrackId{++id}, .label = {}, .team = {}}, 3)));
        continue;
      }
      Sample sample = track.sample(row);
      sample.track = TrackId{id};
      piece.add(track.at()[row], sample);
      stripped.truth[{track.at()[row], sample.position.x()}] = track.name.label;
    }
    if (!piece.empty()) stripped.recording.put(std::move(piece));
    ++id;
  }
  for (int ghost = 0; ghost < 60; ++ghost, ++id) {
    TrackColumns track({.id = TrackId{id}, .label = {}, .team = {}}, 3);
    const Vector<3> location(between(random, -1, 1), between(random, -1, 1), between(random, 0, 2));
    const auto first = static_cast<std::int32_t>(between(random, 0, static_cast<double>(recording.instants().size()) - 8));
    for (std::int32_t i = 0; i < 5; ++i) {
      Sample sample;
      sample.track = TrackId{id};
      sample.position = location;
      track.add(first + i, sample);
    }
    stripped.recording.put(std::move(track));
  }
  return stripped;
}

struct Score {
  int right = 0, wrong = 0, unnamed = 0;
};

Score score_of(const Labelled& labelled, const Stripped& stripped) {
  Score score;
  for (const TrackColumns& track : labelled.recording.tracks()) {
    for (std::size_t row = 0; row < track.size(); ++row) {
      const auto found = stripped.truth.find({track.at()[row], track.position(row).x()});
      const std::string truth = found == stripped.truth.end() ? "" : found->second;
      if (track.name.label.empty()) {
        score.unnamed += !truth.empty();
      } else {
        ++(track.name.label == truth ? score.right : score.wrong);
      }
    }
  }
  return score;
}

TEST(LabelRecording, NamesWhatALabelledTakeOfTheSubjectTaught) {
  const Figure figure(1);
  const std::vector<Recording> taught{labelled_recording(figure, 20, 300)};
  const LearnedMarkers learned = learn_markers(taught, {});
  EXPECT_TRUE(learned.moves);
  for (std::uint64_t seed = 1; seed <= 2; ++seed) {
    const Stripped stripped = strip(labelled_recording(figure, 3, 250), seed);
    const Labelled labelled = label_recording(stripped.recording, learned);
    const Score score = score_of(labelled, stripped);
    EXPECT_GT(score.right, 0.99 * static_cast<double>(stripped.truth.size())) << "seed " << seed;
    EXPECT_LT(score.wrong, 0.003 * static_cast<double>(stripped.truth.size())) << "seed " << seed;
    EXPECT_EQ(labelled.recording.instants().size(), stripped.recording.instants().size());
  }
}

TEST(LabelRecording, PutsExchangedNamesRight) {
  const Figure figure(1);
  const std::vector<Recording> taught{labelled_recording(figure, 20, 300)};
  Recording swapped = labelled_recording(figure, 5, 300);
  Recording wrong(swapped.header);
  InstantsOf instants(swapped);
  for (auto instant = instants.next(); instant; instant = instants.next()) {
    if (instant->index >= 120) {  // from here on 3 and 11 have each other's names
      for (Sample& sample : instant->samples) {
        if (sample.track == TrackId{4})
          sample.track = TrackId{12};
        else if (sample.track == TrackId{12})
          sample.track = TrackId{4};
      }
      std::sort(instant->samples.begin(), instant->samples.end(),
                [](const Sample& a, const Sample& b) { return a.track < b.track; });
    }
    wrong.add(*instant);
  }
  const Labelled labelled = label_recording(wrong, learn_markers(taught, {}));
  ASSERT_EQ(labelled.health.size(), 20U);
  for (int name = 0; name < 20; ++name) {
    const MarkerHealth& health = labelled.health[static_cast<std::size_t>(name)];
    SCOPED_TRACE(health.label);
    const int marker = std::stoi(health.label.substr(1));  // names come in the order of their letters
    const TrackColumns* track = labelled.recording.find(TrackId{name + 1});
    ASSERT_EQ(track->name.label, health.label);
    ASSERT_EQ(track->size(), 300U);
    for (std::size_t row = 0; row < 300; ++row)
      ASSERT_NEAR((track->position(row) - figure.at(marker, 5 + static_cast<double>(row) / 100)).norm(), 0, 1e-9) << row;
    EXPECT_EQ(health.renamed, marker == 3 || marker == 11 ? 180 : 0);
  }
  EXPECT_EQ(labelled.renamed, 2);
}

TEST(LabelRecording, LearnsFromStandingPerson) {
  const Figure figure(3);
  const std::vector<Recording> taught{labelled_recording(figure, 20, 300)};
  Recording still = labelled_recording(figure, 1, 100, 0);
  const std::vector<Recording> stood{still};
  EXPECT_FALSE(learn_markers(stood, {}).moves) << "one who stands still does not specify what is rigid";
  const Stripped stripped = strip(labelled_recording(figure, 3, 250), 4);
  const Score score = score_of(label_recording(stripped.recording, learn_markers(stood, {})), stripped);
  EXPECT_GT(score.right, 0.98 * static_cast<double>(stripped.truth.size()));
}

TEST(LabelRecording, MarkersOfOneWristAreToldByTheirSideWhateverThePosture) {
  for (const double rotated : {0.0, 1.2, 2.4}) {
    Figure figure(3);
    figure.make_forearm();
    const std::vector<Recording> stood{labelled_recording(figure, 1, 100, 0)};
    figure.turn_forearm(rotated);
    const Stripped stripped = strip(labelled_recording(figure, 3, 250), 4);
    const Score score = score_of(label_recording(stripped.recording, learn_markers(stood, {})), stripped);
    EXPECT_GT(score.right, 0.98 * static_cast<double>(stripped.truth.size())) << "turned by " << rotated;
  }
}

TEST(LabelRecording, SwappedRecordingDoesNotDecideSides) {
  std::vector<Recording> taught;
  for (const double from : {20, 21, 22}) {
    Figure figure(3);
    figure.make_forearm();
    taught.push_back(labelled_recording(figure, from, 200));
  }
  for (const auto& [id, label] : {std::pair{16, 16}, std::pair{17, 15}})  // of the first, the wrist's two are exchanged
    taught[0].set_name({.id = TrackId{id}, .label = label_of(label), .team = {}});
  Figure figure(3);
  figure.make_forearm();
  const Stripped stripped = strip(labelled_recording(figure, 3, 250), 4);
  const Score score = score_of(label_recording(stripped.recording, learn_markers(taught, {})), stripped);
  EXPECT_GT(score.right, 0.98 * static_cast<double>(stripped.truth.size()));
}

TEST(LabelRecording, AnotherPersonsSetIsScaledToThisOne) {
  for (const double scale : {0.8, 1.1, 1.25}) {
    const std::vector<Recording> taught{labelled_recording(Figure(1), 20, 300)};
    Figure other(1);
    other.become_another(scale, 0.05, 0.01, 7);
    const Stripped stripped = strip(labelled_recording(other, 3, 250), 2);
    LabelOptions as_taught;
    as_taught.scale_to_person = false;
    try {
      EXPECT_GT(label_recording(stripped.recording, learn_markers(taught, {}), as_taught).misfit, 2) << "scale " << scale;
    } catch (const Error&) {  // off by so much that barely anything is found
    }
    const Labelled labelled = label_recording(stripped.recording, learn_markers(taught, {}));
    ASSERT_TRUE(labelled.found_again) << "scale " << scale;
    EXPECT_GT(*labelled.found_again, 0.95);
    EXPECT_NEAR(labelled.scale, scale, 0.06);
    EXPECT_LT(labelled.misfit, 2);
    const Score score = score_of(labelled, stripped);
    EXPECT_GT(score.right, 0.95 * static_cast<double>(stripped.truth.size())) << "scale " << scale;
    EXPECT_LT(score.wrong, 0.01 * static_cast<double>(stripped.truth.size())) << "scale " << scale;
  }
}

/// Two people in one recording: the second's tracks come after the first's, and it stands 1 m beside.
Recording of_two_people(const Recording& one, const Recording& other) {
  Recording both(one.header);
  for (const auto& time_step : one.instants()) both.add_time_step(time_step);
  for (const TrackColumns& track : one.tracks()) both.put(track);
  for (const TrackColumns& track : other.tracks()) {
    TrackColumns its({.id = TrackId{number(track.id()) + 100}, .label = "other:" + track.name.label, .team = {}}, 3);
    for (std::size_t row = 0; row < track.size(); ++row) {
      Sample sample = track.sample(row);
      sample.track = its.id();
      sample.position += Vector<3>(1, 0, 0);
      its.add(track.at()[row], sample);
    }
    both.put(std::move(its));
  }
  return both;
}

TEST(LabelRecording, OfTwoPeopleWithTheSameSetTheOneWhoTaughtIsNamed) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const std::vector<Recording> taught{labelled_recording(Figure(1), 20, 300)};
    Figure other(1);
    other.become_another(1.03, 0.02, 0.008, seed);
    const Recording both = of_two_people(labelled_recording(Figure(1), 3, 250), labelled_recording(other, 3.7, 250));
    const Stripped stripped = strip(both, seed);
    const Score score = score_of(label_recording(stripped.recording, learn_markers(taught, {})), stripped);
    const double its = static_cast<double>(stripped.truth.size()) / 2;
    EXPECT_GT(score.right, 0.99 * its) << "seed " << seed;
    EXPECT_LT(score.wrong, 0.003 * its) << "seed " << seed;
  }
}

TEST(LabelRecording, AnotherShapeIsNotScaled) {
  const std::vector<Recording> taught{labelled_recording(Figure(1), 20, 300)};
  const LearnedMarkers learned = learn_markers(taught, {});
  for (const std::uint64_t shape : {2, 5}) {
    const Stripped stripped = strip(labelled_recording(Figure(shape), 3, 250), 2);
    try {
      const Labelled labelled = label_recording(stripped.recording, learned);
      EXPECT_FALSE(labelled.found_again) << "shape " << shape;
    } catch (const Error&) {  // barely anything is found
    }
  }
}

TEST(LabelRecording, TheOwnSetIsNotScaled) {
  const std::vector<Recording> taught{labelled_recording(Figure(1), 20, 300)};
  const Stripped stripped = strip(labelled_recording(Figure(1), 3, 250), 2);
  EXPECT_FALSE(label_recording(stripped.recording, learn_markers(taught, {})).found_again);
}

TEST(LabelRecording, RefusesWhatIsAnotherSet) {
  const std::vector<Recording> taught{labelled_recording(Figure(1), 20, 200)};
  const LearnedMarkers learned = learn_markers(taught, {});
  EXPECT_THROW(label_recording(Recording(taught[0].header), learned), Error);
  EXPECT_THROW(learn_markers(taught, {.labels = {"m1", "m2", "m3", "x"}}), Error);
}

}  // namespace
}  // namespace marey::solve::labels

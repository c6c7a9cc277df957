#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "marey/core/recording.h"
#include "marey/core/track_kind.h"

namespace marey::format::match {

/// m from the origin, to either side: what is farther stands on no ground near a pitch.
constexpr double kMaxOnGround = 1e5;
/// The last frame as files count that begin with 1.
constexpr double kMaxFrame = 1e9;

/// Gathers the people of a file that names them by its own method, in whatever order its rows come, and makes a recording of them.
class GroundBuilder {
 public:
  /// Where a person was in one row of the file.
  struct Row {
    std::int32_t frame = 0;
    Provenance provenance = Provenance::measured;
    double time = 0;  ///< s
    Vector<2> location = Vector<2>::Zero();
    std::optional<Vector<2>> velocity = {};
    std::optional<Matrix<2>> covariance = {};  ///< of `place`, m²
    CameraMask cameras = 0;
    std::optional<Box> box = {};  ///< px, of one in an image
    std::optional<double> score = {};
    double height = 0, climb = 0;  ///< m and m/s upwards, of the ball
  };

  explicit GroundBuilder(const std::string& name) : name_(name) {}

  /// The index of the file's person `key`; a new one gets this label and team, and the wanted id where it is positive and free,
  /// else the next one that is.
  std::int32_t person(const std::string& key, int required, const std::string& label, const std::string& team);
  /// The index of the one with this id, which is positive; a label and a team that are still empty are filled in.
  std::int32_t person(int id, const std::string& label, const std::string& team);

  /// The index of the ball.
  std::int32_t ball() { return person(std::string(kBallLabel), 0, std::string(kBallLabel), {}); }

  /// x and y in m. Throws Error, which says `where`, for what is not a place on the ground near a pitch.
  void add(std::int32_t frame, double time, std::int32_t person, double x, double y, std::string_view where);
  void add(std::int32_t person, const Row& row);

  /// None of those that were added is known after all.
  void forget_velocities();

  /// Moves everything into `recording`, whose header is known: a frame is an instant, whose time is that of its first row. Gives
  /// the people in the order in which they came. Throws Error if a person is twice in a frame.
  std::vector<TrackId> finish(Recording& recording);

 private:
  struct Person {
    TrackColumns rows;      // a frame stands where the instant will
    std::vector<Row> late;  // came after one of the same or a later frame
  };

  void put_in_order(Person& person) const;
  void require_once() const;

  const std::string& name_;
  std::vector<Person> people_;                   // in the order in which they came
  std::vector<Recording::TimeStep> time_steps_;  // of each frame, once at least
  std::map<std::string, std::int32_t> index_of_;
  std::map<int, std::int32_t> by_id_;
};

/// A name that only says the number again ("Player 7", "Track_7", "7") is the number; so is not one.
std::string label_of(const std::string& name, int number);

}  // namespace marey::format::match

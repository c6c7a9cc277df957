#pragma once

#include <cstdint>
#include <string>

#include "marey/core/hooks.h"
#include "marey/simulate/markers/marker_scene.h"
#include "marey/simulate/match/match_camera.h"
#include "marey/simulate/people/people_film.h"
#include "marey/simulate/room/room_film.h"

namespace marey::pipeline {

// All of these throw Stopped where they are asked to end, and leave nothing that is begun behind.

/// Films a scene into an H.264 file, hardly compressed. Throws Error where it cannot be written.
void film_markers(const simulate::markers::MarkerScene& scene, const std::string& path, const Hooks& hooks = {});

/// Writes a scene into a folder, which must exist: video.mp4, and its truth as truth.csv: `frame,time,label,x,y,visible`, 0-based
/// frames, s, px. Throws Error where a file cannot be written.
void write_markers(const simulate::markers::MarkerScene& scene, const std::string& folder, const Hooks& hooks = {});

/// Films people into a folder, which must exist:
///   video.mp4          H.264, hardly compressed
///   truth.txt          MOTChallenge truth: the box of each whole person, cut at the picture's border; the ninth column is the
///                      share that can be seen
///   rig.toml           the exact camera, its film as its source
///   positions.csv      frame,time,id,team,x,y,foot_x,foot_y,visible: 0-based frames, s, m on the ground, px
///   silhouettes.jsonl  an object a person and frame: frame, id, size [height, width], and the silhouettes `whole` and `visible`
///                      within the picture as COCO's run lengths (column by column, background first)
/// Throws Error where a file cannot be written.
void film_people(const simulate::people::PeopleFilm& film, const std::string& folder, const Hooks& hooks = {});

struct RoomFilesOptions {
  bool videos = false;  ///< renders camN.mp4, and makes it each camera's source
  simulate::room::RoomFilmOptions film;
};

/// Writes a simulated room into a folder, which must exist:
///   rig.toml          the true rig; rig_after.toml too, where a camera is bumped
///   start.toml        what is known before a calibration: names, sizes, rates, lenses
///   observations.csv  camera,frame,x,y: what the cameras report, from top to bottom in each picture
///   blobs.csv         the same rows with their markers: camera,frame,x,y,marker (blank for ghosts)
///   labels.csv        label,x,y,z: where each marker is at the beginning, m
///   skeleton.toml     the body that bears the markers, where one does
///   truth.csv         frame,time,label,x,y,z,cameras: m, by the rig's clock; by how many cameras it can be seen
/// Memory does not grow with the length. Throws Error where a file cannot be written.
void write_room(const simulate::room::RoomScene& scene, const std::string& folder, const RoomFilesOptions& options = {},
                const Hooks& hooks = {});

struct MatchFilesOptions {
  simulate::match::MatchCamerasOptions cameras;
  simulate::match::MatchDetectorOptions detector;
  std::uint64_t seed = 1;
  double seconds = 60;  ///< positive
  bool boxes = true;    ///< what a detector says of each camera
  bool films = false;   ///< what each camera films, and clicks on its picture
  simulate::match::MatchFilmOptions film;
  double click_noise = 1;     ///< px, standard deviation in each axis
  int wrong_clicks = 0;       ///< of each camera
  bool hide_offsets = false;  ///< rig.toml says nothing of when cameras were started; true_rig.toml does
};

/// Writes a simulated match into a folder, which must exist:
///   rig.toml        the exact cameras, with their films as sources, else with their boxes as detections
///   truth.csv       where everybody is at the first camera's frames (format/match/ground_file.h), in the pitch's own frame;
///                   `cameras` are those for which the target is in the picture and not hidden
///   CAM_truth.txt   MOTChallenge truth for each camera: the box of each whole person, cut at the picture's border; ids as in
///                   truth.csv; the ninth column is the share of it that can be seen
///   CAM.txt         with `boxes`: MOTChallenge detections for each camera; with films too, boxes.toml is the rig that names them
///   CAM.mp4         with `films`: what each camera films, H.264
///   ball.csv        with a ball in the films, where it is at the first camera's frames: frame,time,x,y,z,vx,vy,vz,state,holder;
///                   z is that of its centre above the ground; state is held, rolling, flying or dead; holder is an id of
///                   truth.csv; no row while somebody fetches it
///   CAM_ball.csv    with a ball in the films, what each camera sees of it: frame,x,y,radius,visible; px, and the share of its disc
///   CAM_clicks.csv  with `films`: x,y,u,v of places on the pitch that were clicked, with which start.toml, the rig without its
///                   calibration, can be calibrated
/// Memory does not grow with the length. Throws Error where an option is out of its domain or a file
/// cannot be written.
void write_match(const MatchFilesOptions& options, const std::string& folder, const Hooks& hooks = {});

}  // namespace marey::pipeline

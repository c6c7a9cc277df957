#pragma once

#include <functional>
#include <string>

#include "marey/simulate/people/people_film.h"

namespace marey::pipeline {

/// Films people into a folder, which must exist:
///   video.mp4          H.264, hardly compressed
///   truth.txt          MOTChallenge truth: the box of each whole person, cut at the picture's border; the ninth column is the
///   share
///                      that can be seen
///   positions.csv      frame,time,id,team,x,y,foot_x,foot_y,visible: 0-based frames, s, m on the ground, px
///   silhouettes.jsonl  an object a person and frame: frame, id, size [height, width], and the silhouettes `whole` and `visible`
///                      within the picture as COCO's run lengths (column by column, background first)
/// `progress` may be empty. Throws Error where a file cannot be written.
void film_people(const simulate::people::PeopleFilm& film, const std::string& folder,
                 const std::function<void(int done, int all)>& progress = {});

}  // namespace marey::pipeline

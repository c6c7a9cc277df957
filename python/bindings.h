// The extension module `marey._core`: what Python needs of the library, behind nanobind. What users call is python/marey/*.py,
// which checks arguments and says what is wrong in Python's words; what stands here trusts it.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "marey/core/instant.h"
#include "marey/core/recording.h"
#include "marey/core/sink.h"
#include "marey/core/source.h"
#include "marey/detect/detector.h"
#include "marey/filter/custom_filter.h"

namespace marey::python {

namespace nb = nanobind;

/// A Python object that any thread may release.
class Held {
 public:
  explicit Held(nb::object object) : object_(std::move(object)) {}
  ~Held() {
    const nb::gil_scoped_acquire gil;
    object_.reset();
  }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;

  nb::handle get() const { return object_; }

 private:
  nb::object object_;
};

/// Frames that an object of python/marey/_frames.py gives: `open()` begins again, and `next()` of what it returns is
/// (time in s or None, C-contiguous uint8 array H×W or H×W×3, blue first), or None at the end.
std::unique_ptr<Source> open_frames(std::shared_ptr<Held> frames);

/// A function from an image (H×W×3 uint8, blue first) to float64 rows x1, y1, x2, y2, score, px.
std::unique_ptr<detect::Detector> detector_of(std::shared_ptr<Held> function);

/// An object with `begin(header: dict)`, `write(instant: tuple)` and `finish()`.
std::unique_ptr<Sink> sink_of(std::shared_ptr<Held> object, bool images);

/// A `Maker` of python/marey/_filters.py.
filter::CustomFilterOptions filter_of(const std::shared_ptr<Held>& make);

/// What python/marey/_instant.py takes apart.
nb::tuple tuple_of(const Instant& instant, int dimensions, bool images);

/// Writes the file in the format of that name, else of the path's ending; the losses, one sentence each. Without Python's lock.
std::vector<std::string> write_recording(const Recording& recording, const std::string& path, const std::string& format);

void bind_recording(nb::module_& module);
void bind_jobs(nb::module_& module);
void bind_calibrations(nb::module_& module);

}  // namespace marey::python

#include "marey/core/error.h"
#include "marey/core/stop.h"

#include "bindings.h"

extern "C" {
#include <libavutil/log.h>
}

NB_MODULE(_core, module) {
  using namespace marey::python;
  av_log_set_level(AV_LOG_QUIET);  // what went wrong in a video is reported in our own sentences
  module.doc() = "What the package marey is built on; use that.";
  module.attr("version") = MAREY_VERSION;
  nb::exception<marey::Error>(module, "Error");
  nb::register_exception_translator([](const std::exception_ptr& thrown, void*) {
    try {
      std::rethrow_exception(thrown);
    } catch (const marey::Stopped& stopped) {
      PyErr_SetString(PyExc_KeyboardInterrupt, stopped.what());
    }
  });
  bind_recording(module);
  bind_jobs(module);
  bind_calibrations(module);
}

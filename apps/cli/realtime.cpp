#include "realtime.h"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <sched.h>

namespace marey::cli {

std::optional<std::string> query_for_realtime() {
  const sched_param priority{.sched_priority = 10};  // below the kernel's own threads, which feed the cameras
  if (sched_setscheduler(0, SCHED_RR, &priority) == 0) return std::nullopt;
  return fmt::format(
      "--realtime-priority was refused ({}); it continues at the typical priority. Run as root, or add to "
      "/etc/security/limits.conf: YOU - "
      "rtprio 10",
      std::strerror(errno));
}

}  // namespace marey::cli

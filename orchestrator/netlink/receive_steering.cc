#include "orchestrator/netlink/receive_steering.h"

#include "common/posix/kernel_settings.h"
#include "common/posix/processors.h"

namespace cuscus::netlink {

void steer_receiving(const std::string& interface, std::span<const int> processors) {
  // TAPs, as we make them, have one queue.
  posix::write_sysfs("class/net/" + interface + "/queues/rx-0/rps_cpus",
                     posix::processor_mask(processors));
}

}  // namespace cuscus::netlink

#include "common/posix/capability_set.h"

#include <linux/capability.h>
#include <sys/capability.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <array>
#include <stdexcept>

namespace cuscus::posix {

CapabilityMask capability_mask(std::span<const std::string> names) {
  CapabilityMask mask = 0;
  for (const std::string& name : names) {
    cap_value_t number = 0;
    if (::cap_from_name(name.c_str(), &number) != 0) {
      throw std::invalid_argument{"unknown capability '" + name +
                                  "' (capabilities(7) lists them, such as cap_net_raw)"};
    }
    mask |= capability_bit(number);
  }
  return mask;
}

CapabilityMask effective_capabilities() noexcept {
  __user_cap_header_struct header{.version = _LINUX_CAPABILITY_VERSION_3, .pid = 0};
  std::array<__user_cap_data_struct, _LINUX_CAPABILITY_U32S_3> words{};
  if (::syscall(SYS_capget, &header, words.data()) != 0) {
    return 0;
  }
  return words[0].effective | CapabilityMask{words[1].effective} << 32U;
}

}  // namespace cuscus::posix

#pragma once

#include <string>
#include <string_view>

namespace cuscus::posix {

/// Writes `value` to /proc/sys/`path`, such as "net/ipv4/ip_forward". Below net/ this changes the
/// calling thread's network namespace. False when the kernel has no such key.
/// A read-only /proc/sys is no obstacle for who may mount a procfs.
/// @throws std::system_error naming the key and the value when it may not be written.
bool write_sysctl(const std::string& path, std::string_view value);

/// Writes `value` to `path` of a sysfs that shows the calling thread's network namespace, such as
/// "class/net/eth0/queues/rx-0/rps_cpus". Needs CAP_SYS_ADMIN.
/// @throws std::system_error naming the file and the value.
void write_sysfs(const std::string& path, std::string_view value);

}  // namespace cuscus::posix

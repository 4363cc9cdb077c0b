#pragma once

#include <span>
#include <string>

namespace cuscus::netlink {

/// Has the kernel carry what arrives at an interface of the calling thread's network namespace up
/// to its sockets on `processors` (Receive Packet Steering: Documentation/networking/scaling.rst).
///
/// Otherwise whoever writes a frame to a TAP does all of that within write(), up to waking the
/// program that waits for it; and to wake a program on another processor takes longer than the rest
/// of it.
/// @throws std::system_error when the kernel has no such thing, or does not allow it.
void steer_receiving(const std::string& interface, std::span<const int> processors);

}  // namespace cuscus::netlink

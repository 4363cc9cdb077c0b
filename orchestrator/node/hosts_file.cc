#include "orchestrator/node/hosts_file.h"

namespace cuscus::node {

std::string hosts_file(std::span<const HostEntry> entries) {
  std::string text = "127.0.0.1\tlocalhost\n::1\tip6-localhost ip6-loopback\n";
  for (const HostEntry& entry : entries) {
    text += netlink::to_string(entry.address) + '\t' + entry.name + '\n';
  }
  return text;
}

}  // namespace cuscus::node

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "orchestrator/node/environment_checks.h"
#include "orchestrator/node/hosts_file.h"
#include "orchestrator/node/node_identity.h"

namespace cuscus::node {
namespace {

TEST_CASE("the table of names has localhost, then the fleet") {
  const std::vector<HostEntry> entries{{.name = "uav3", .address = {10, 0, 0, 4}},
                                       {.name = "gcs", .address = {10, 0, 0, 200}}};

  CHECK(hosts_file(entries) ==
        "127.0.0.1\tlocalhost\n"
        "::1\tip6-localhost ip6-loopback\n"
        "10.0.0.4\tuav3\n"
        "10.0.0.200\tgcs\n");
}

TEST_CASE("a kernel's version is read from its release, and anything else is version zero") {
  CHECK(parse_kernel_version("6.1.0-18-amd64") == KernelVersion{.major = 6, .minor = 1});
  CHECK(parse_kernel_version("5.15") == KernelVersion{.major = 5, .minor = 15});
  CHECK(parse_kernel_version("6") == KernelVersion{.major = 6, .minor = 0});
  CHECK(parse_kernel_version("") == KernelVersion{});
  CHECK(parse_kernel_version("next") == KernelVersion{});
  CHECK(KernelVersion{.major = 5, .minor = 4} < KernelVersion{.major = 5, .minor = 11});
}

TEST_CASE("every service and node has a uid of its own, below 60000") {
  STATIC_REQUIRE(service_uid(kServices - 1) < node_uid(0));
  STATIC_REQUIRE(node_uid(0) + 1 == node_uid(1));
  STATIC_REQUIRE(node_uid(kMaximumNodes - 1) < 60000);
}

}  // namespace
}  // namespace cuscus::node

#include "orchestrator/app/emulator_processor.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "common/posix/network_namespace.h"
#include "common/posix/processors.h"
#include "tests/support/root_only.h"

namespace cuscus::orchestrator {
namespace {

/// As many as there are, in the calling thread's network namespace.
std::vector<EmulatorProcessor> reserve_all() {
  std::vector<EmulatorProcessor> reserved;
  for (;;) {
    auto next = EmulatorProcessor::reserve();
    auto* const processor = std::get_if<EmulatorProcessor>(&next);
    if (processor == nullptr) {
      CHECK(std::get<netlink::NotAvailable>(next).reason == "other runs have them all");
      return reserved;
    }
    reserved.push_back(std::move(*processor));
  }
}

TEST_CASE("no two emulators get one processor, and it is free again when one goes") {
  CUSCUS_ROOT_ONLY();
  const std::vector<int> allowed = posix::allowed_processors();
  if (allowed.size() < 2) {
    WARN("SKIPPED: one processor only");
    return;
  }
  // Runs of this machine are in other namespaces.
  posix::NetworkNamespace::create().run([&] {
    std::vector<int> first;
    {
      const auto reserved = reserve_all();
      for (const EmulatorProcessor& processor : reserved) {
        first.push_back(processor.number());
        std::vector<int> all{processor.others().begin(), processor.others().end()};
        all.push_back(processor.number());
        std::sort(all.begin(), all.end());
        CHECK(all == allowed);
      }
    }
    CHECK(first == allowed);
    CHECK(reserve_all().size() == allowed.size());
  });
}

TEST_CASE("the only processor is not reserved") {
  CUSCUS_ROOT_ONLY();
  const std::vector<int> allowed = posix::allowed_processors();
  posix::NetworkNamespace::create().run([&] {
    REQUIRE(posix::try_pin(allowed.front()));  // this thread only
    const auto reserved = EmulatorProcessor::reserve();
    REQUIRE(std::holds_alternative<netlink::NotAvailable>(reserved));
    CHECK(std::get<netlink::NotAvailable>(reserved).reason == "there is one processor only");
  });
}

}  // namespace
}  // namespace cuscus::orchestrator

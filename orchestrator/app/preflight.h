#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>

#include "common/posix/unique_fd.h"
#include "orchestrator/node/rights.h"
#include "orchestrator/plan/plan.h"

/// What must be true before anything is created. Each throws UsageError with what is missing and
/// the remedy.
namespace cuscus::orchestrator {

/// The rights to make namespaces and TAPs.
[[nodiscard]] node::Rights acquire_run_rights();

/// /dev/net/tun can be opened.
void check_tun();

/// Folder of this executable, in which cuscus-netsim and the others are.
[[nodiscard]] std::filesystem::path check_own_programs();

/// Raises the limit of open files to what the plan needs.
void check_open_files(const Plan& plan);

/// Listens on 127.0.0.1 in the host's network namespace.
[[nodiscard]] posix::UniqueFd listen_for_page(std::uint16_t port);

}  // namespace cuscus::orchestrator

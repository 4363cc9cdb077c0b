#pragma once

#include <spdlog/spdlog.h>

#include <string>

namespace cuscus::log {

// Lines go through spdlog's default logger: spdlog::info("uav3: link up"). What a level means:
// error: the process will exit non-zero, and why; warning: check this before trusting the run;
// info: life cycle; debug: anything.

/// Makes the default logger write "2026-01-31 12:00:00.000 info netsim: ..." to standard error.
/// The level is `info`, or what CUSCUS_LOG_LEVEL says (trace, debug, info, warning, error).
void start(const std::string& process_name);

}  // namespace cuscus::log

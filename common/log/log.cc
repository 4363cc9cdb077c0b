#include "common/log/log.h"

#include <spdlog/sinks/ansicolor_sink.h>

#include <cstdlib>
#include <memory>

namespace cuscus::log {

void start(const std::string& process_name) {
  auto sink = std::make_shared<spdlog::sinks::ansicolor_stderr_sink_st>();
  auto logger = std::make_shared<spdlog::logger>(process_name, std::move(sink));
  logger->set_pattern("%Y-%m-%d %H:%M:%S.%e %^%l%$ %n: %v");
  logger->flush_on(spdlog::level::info);
  // Read before any thread exists.
  if (const char* const level = std::getenv("CUSCUS_LOG_LEVEL")) {  // NOLINT(concurrency-mt-unsafe)
    logger->set_level(spdlog::level::from_str(level));
  }
  spdlog::set_default_logger(std::move(logger));
}

}  // namespace cuscus::log

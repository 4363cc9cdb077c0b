// Any text as a line of a frame log.
#include <algorithm>
#include <stdexcept>
#include <string>
#include <string_view>

#include "netsim/app/frame_record.h"
#include "tests/fuzz/fuzz_target.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace cuscus;          // NOLINT(google-build-using-namespace): a main
  using namespace cuscus::netsim;  // NOLINT(google-build-using-namespace): a main
  std::string_view text{reinterpret_cast<const char*>(data), size};
  AirParameters parameters;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(text.size(), line.size() + 1));
    if (const auto record = parse_frame_record(line)) {
      std::string written;
      append_frame_record(written, *record);
      const auto again =
          parse_frame_record(std::string_view{written}.substr(0, written.size() - 1));
      must(again && again->sent_ns == record->sent_ns && again->node == record->node &&
               again->destination == record->destination &&
               again->first_delivery_ns == record->first_delivery_ns &&
               again->priority == record->priority && record->priority < kPriorities,
           "a record does not survive writing and reading");
    }
    try {
      static_cast<void>(parse_frame_log_header(line, parameters));
      static_cast<void>(parse_frame_log_header("# nodes=" + std::string{line}, parameters));
      static_cast<void>(parse_frame_log_header("# tx_power_dbm=" + std::string{line}, parameters));
    } catch (const std::invalid_argument&) {
      // Said so: that is what is asked.
    }
    must(parameters.nodes.size() <= 65'535, "a log may ask for more nodes than there can be");
  }
  return 0;
}

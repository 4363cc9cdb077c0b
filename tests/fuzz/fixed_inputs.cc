// Runs a fuzz target on inputs of our own: NAME [count]. They are the same in each run.
#include <algorithm>
#include <string>
#include <vector>

#include "common/random/counter_stream.h"
#include "tests/fuzz/fuzz_target.h"

namespace {

constexpr std::uint64_t kSeed = 1;
constexpr std::uint32_t kLongest = 8192;

/// Runs of one octet, of few values, of text and of anything: what parsers branch on is rare in
/// uniform noise.
std::vector<std::uint8_t> input(std::uint64_t number) {
  const cuscus::random::CounterStream draws{kSeed, number};
  std::uint64_t draw = 0;
  // As often short as long.
  const std::uint32_t longest = 1U << draws.below(draw++, 14);
  std::vector<std::uint8_t> bytes(draws.below(draw++, std::min(longest, kLongest) + 1));
  static const std::string kText = "0123456789-+.,=#e \ngroupnobodysent";
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t run = std::min<std::size_t>(1 + draws.below(draw++, 16), bytes.size() - at);
    const std::uint32_t kind = draws.below(draw++, 4);
    const std::uint32_t same = draws.below(draw++, 256);
    for (std::size_t i = 0; i < run; ++i, ++at) {
      const std::uint32_t any = draws.below(draw++, 256);
      const std::uint32_t few = any % 3 == 0 ? 0x00U : (any % 3 == 1 ? 0x02U : 0xffU);
      const auto letter = static_cast<std::uint8_t>(kText[any % kText.size()]);
      bytes[at] = static_cast<std::uint8_t>(kind == 0   ? same
                                            : kind == 1 ? few
                                            : kind == 2 ? letter
                                                        : any);
    }
  }
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  const std::uint64_t count = argc > 1 ? std::stoull(argv[1]) : 1000;
  for (std::uint64_t number = 0; number < count; ++number) {
    const auto bytes = input(number);
    LLVMFuzzerTestOneInput(bytes.data(), bytes.size());
  }
  std::printf("%llu inputs\n", static_cast<unsigned long long>(count));
  return 0;
}

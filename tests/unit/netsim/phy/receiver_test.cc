#include "netsim/phy/receiver.h"

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <utility>

namespace cuscus::netsim {
namespace {

using std::chrono::microseconds;

SimTime at(int us) { return SimTime{} + microseconds{us}; }

ReceiverParameters standard_parameters() {
  return {.noise = noise_floor(20e6, Decibel{7.0}),
          .cca_preamble = {-82.0},
          .cca_energy = {-62.0},
          .sensitivity = {-101.0},
          .detection_minimum = {-82.0},
          .detection_minimum_sinr = {4.0}};
}

/// A receiver and frames of 6 Mb/s that arrive at it; 100 B: energy for 160 us.
struct Bench {
  // The analyser takes the members of a std::array for uninitialised.
  // NOLINTBEGIN(clang-analyzer-optin.cplusplus.UninitializedObject)
  explicit Bench(const ReceiverParameters& parameters = standard_parameters())
      : model{parameters, errors}, receiver{model, random::CounterStream{1, 2}} {}
  // NOLINTEND(clang-analyzer-optin.cplusplus.UninitializedObject)

  static PpduTiming timing(int begins_us) {
    return {.header_begins = at(begins_us + 16),
            .payload_begins = at(begins_us + 20),
            .energy_ends = at(begins_us + 160),
            .mode = &ieee80211g().mode(6'000)};
  }
  /// Each has a sender of its own.
  Arrival arrival(double power_dbm) {
    return {
        .sender = ++senders, .receiver = 0, .power_mw = DecibelMilliwatt{power_dbm}.milliwatts()};
  }

  NistErrorModel errors;
  ReceiverModel model;
  Receiver receiver;
  std::uint32_t senders{0};
};

/// All of one undisturbed reception that begins at 0.
Receiver::End receive(Bench& bench, Arrival& frame) {
  bench.receiver.begin(at(0), frame);
  bench.receiver.detect(at(4), frame, Bench::timing(0));
  bench.receiver.header(at(20), frame);
  bench.receiver.energy_ends(at(160), frame);
  return bench.receiver.finish(frame);
}

TEST_CASE("the noise floor of 20 MHz with a noise figure of 7 dB is -93.97 dBm") {
  CHECK(noise_floor(20e6, Decibel{7.0}).value == Approx(-93.97).margin(0.01));
}

TEST_CASE("a strong frame alone is decoded and holds the medium until its end") {
  Bench bench;
  Arrival frame = bench.arrival(-70.0);

  bench.receiver.begin(at(0), frame);
  CHECK_FALSE(bench.receiver.medium_busy());  // below the energy threshold, not yet detected
  CHECK(bench.receiver.detect(at(4), frame, Bench::timing(0)));
  CHECK(bench.receiver.medium_busy());
  CHECK(bench.receiver.header(at(20), frame) == Receiver::Header::kDecoded);
  bench.receiver.energy_ends(at(160), frame);
  CHECK(bench.receiver.medium_busy());  // for the signal extension
  CHECK(bench.receiver.finish(frame) == Receiver::End::kDecoded);
  CHECK_FALSE(bench.receiver.medium_busy());
  CHECK(frame.decoded);
}

TEST_CASE("a frame below the detection threshold is lost as too weak") {
  Bench bench;
  Arrival frame = bench.arrival(-82.1);

  CHECK(receive(bench, frame) == Receiver::End::kNotMine);
  CHECK(frame.cause == LossCause::kBelowDetection);
}

TEST_CASE("without preamble detection a hopeless frame is lost to noise") {
  auto parameters = standard_parameters();
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  parameters.detection_minimum = {kNone};
  parameters.detection_minimum_sinr = {kNone};
  Bench bench{parameters};
  Arrival frame = bench.arrival(-97.0);

  CHECK(receive(bench, frame) != Receiver::End::kDecoded);
  CHECK(frame.cause == LossCause::kNoise);
}

TEST_CASE("two equal frames at once are both lost to collision") {
  Bench bench;
  Arrival first = bench.arrival(-50.0);
  Arrival second = bench.arrival(-50.0);

  bench.receiver.begin(at(0), first);
  bench.receiver.begin(at(0), second);
  CHECK_FALSE(bench.receiver.detect(at(4), first, Bench::timing(0)));
  CHECK_FALSE(bench.receiver.detect(at(4), second, Bench::timing(0)));

  CHECK(first.cause == LossCause::kCollision);
  CHECK(second.cause == LossCause::kCollision);
  CHECK(first.interferer == second.sender);
  CHECK(second.interferer == first.sender);
  CHECK(bench.receiver.medium_busy());  // energy
}

TEST_CASE("interference during part of a frame is charged to that part and named as the cause") {
  Bench bench;
  Arrival frame = bench.arrival(-70.0);
  Arrival disturber = bench.arrival(-68.0);

  bench.receiver.begin(at(0), frame);
  bench.receiver.detect(at(4), frame, Bench::timing(0));
  CHECK(bench.receiver.header(at(20), frame) == Receiver::Header::kDecoded);
  bench.receiver.begin(at(60), disturber);
  bench.receiver.detect(at(64), disturber, Bench::timing(60));
  bench.receiver.energy_ends(at(160), frame);

  CHECK(bench.receiver.finish(frame) == Receiver::End::kFailed);
  CHECK(frame.cause == LossCause::kInterference);
  CHECK(frame.interferer == disturber.sender);
  // -70 dBm over -68 dBm and noise; and the other way round.
  CHECK(10.0 * std::log10(frame.sinr_ratio) == Approx(-2.01).margin(0.01));
  CHECK(10.0 * std::log10(disturber.sinr_ratio) == Approx(1.98).margin(0.01));
  CHECK(disturber.cause == LossCause::kCollision);  // the receiver was busy with the first
  CHECK(disturber.interferer == frame.sender);
}

TEST_CASE("interference that ends before the SIGNAL field does no harm") {
  Bench bench;
  Arrival disturber = bench.arrival(-75.0);
  Arrival frame = bench.arrival(-70.0);

  // The disturber is in its last 10 us when the frame begins.
  bench.receiver.begin(at(-150), disturber);
  bench.receiver.begin(at(0), frame);
  bench.receiver.detect(at(4), frame, Bench::timing(0));
  bench.receiver.energy_ends(at(10), disturber);
  CHECK(bench.receiver.header(at(20), frame) == Receiver::Header::kDecoded);
  bench.receiver.energy_ends(at(160), frame);

  CHECK(bench.receiver.finish(frame) == Receiver::End::kDecoded);
}

/// What becomes of a frame of -70 dBm when one of -58 dBm begins `later_us` after it.
std::pair<Receiver::End, Receiver::End> with_stronger_frame(const ReceiverParameters& parameters,
                                                            int later_us) {
  Bench bench{parameters};
  Arrival first = bench.arrival(-70.0);
  Arrival stronger = bench.arrival(-58.0);
  bench.receiver.begin(at(0), first);
  bench.receiver.detect(at(4), first, Bench::timing(0));
  if (later_us > 16) {
    CHECK(bench.receiver.header(at(20), first) == Receiver::Header::kDecoded);
  }
  bench.receiver.begin(at(later_us), stronger);
  bench.receiver.detect(at(later_us + 4), stronger, Bench::timing(later_us));
  if (later_us <= 16) {
    bench.receiver.header(at(20), first);
  }
  bench.receiver.header(at(later_us + 20), stronger);
  bench.receiver.energy_ends(at(160), first);
  const Receiver::End first_end = bench.receiver.finish(first);
  bench.receiver.energy_ends(at(later_us + 160), stronger);
  return {first_end, bench.receiver.finish(stronger)};
}

TEST_CASE(
    "a stronger frame captures the receiver during the preamble, or at any time, if allowed") {
  using End = Receiver::End;
  ReceiverParameters none = standard_parameters();
  ReceiverParameters preamble = none;
  preamble.capture_in_preamble = {5.0};
  ReceiverParameters any_time = preamble;
  any_time.capture_in_frame = {10.0};
  ReceiverParameters too_high = preamble;
  too_high.capture_in_preamble = {13.0};  // the frames are 12 dB apart

  CHECK(with_stronger_frame(none, 8) == std::pair{End::kNotMine, End::kNotMine});  // no SIGNAL
  CHECK(with_stronger_frame(preamble, 8) == std::pair{End::kNotMine, End::kDecoded});
  CHECK(with_stronger_frame(too_high, 8).second == End::kNotMine);
  CHECK(with_stronger_frame(preamble, 60) == std::pair{End::kFailed, End::kNotMine});
  CHECK(with_stronger_frame(any_time, 60) == std::pair{End::kNotMine, End::kDecoded});
}

TEST_CASE("a node that transmits receives nothing") {
  Bench bench;
  Arrival during = bench.arrival(-50.0);
  Arrival interrupted = bench.arrival(-50.0);

  bench.receiver.begin(at(0), interrupted);
  bench.receiver.detect(at(4), interrupted, Bench::timing(0));
  bench.receiver.start_transmission();
  bench.receiver.begin(at(30), during);
  bench.receiver.end_transmission();
  bench.receiver.detect(at(34), during, Bench::timing(30));

  CHECK(interrupted.cause == LossCause::kHalfDuplex);
  CHECK(bench.receiver.finish(interrupted) == Receiver::End::kNotMine);
  CHECK(during.cause == LossCause::kHalfDuplex);
}

TEST_CASE("energy from several weak frames adds up to a busy medium") {
  Bench bench;
  Arrival first = bench.arrival(-64.0);
  Arrival second = bench.arrival(-64.0);

  bench.receiver.begin(at(0), first);
  CHECK_FALSE(bench.receiver.medium_busy());
  bench.receiver.begin(at(1), second);
  CHECK(bench.receiver.medium_busy());  // -61 dBm
  bench.receiver.energy_ends(at(160), first);
  CHECK_FALSE(bench.receiver.medium_busy());
}

}  // namespace
}  // namespace cuscus::netsim

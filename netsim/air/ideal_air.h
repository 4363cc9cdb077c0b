#pragma once

#include <cstdint>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "netsim/air/air.h"
#include "netsim/air/frame_carrier.h"
#include "netsim/kernel/event_queue.h"
#include "netsim/kernel/slot_pool.h"

namespace cuscus::netsim {

/// A radio without a medium: rate, delay, jitter, loss and range, and nothing else.
///
/// - A node sends its frames one after another, in the order of the offers, each for B / R: B the
///   bits of its Ethernet frame, header included, R the data rate, of group frames the group rate.
/// - A frame reaches those that it is meant for and that were within the range when its sending
///   began, each after the end of the sending by the delay and a jitter that is uniform in +/- the
///   jitter, or not at all with the probability of loss: both drawn for every frame and receiver.
///   Frames may overtake one another when the jitter is longer than they are.
/// - Nobody contends, collides or acknowledges; nodes send and receive at once.
/// - The queue is bounded, the frame that is being sent included; one that has waited longer than
///   the lifetime is dropped. The disruption holds as on the other air.
///
/// The model of EMANE's RF Pipe radio model, with a probability of loss in place of its curve over
/// SINR and a range in place of its path loss. Propagation takes no time. A received power is that
/// of the sender; a loss by chance counts as noise, what is out of range as below the floor.
class IdealAir final : public FrameCarrier {
 public:
  /// `positions`, `listener` and `monitor`, if any, must outlive this object.
  /// @throws std::invalid_argument naming what is wrong and what is allowed.
  IdealAir(const AirParameters& parameters, PositionSource& positions, AirListener& listener,
           AirMonitor* monitor = nullptr);

  void offer(std::uint32_t node, SimTime sent_at, const OfferedFrame& frame) override;
  bool run_next(SimTime limit) override;
  void run_until(SimTime limit) override;
  [[nodiscard]] SimTime now() const override { return now_; }
  [[nodiscard]] std::optional<SimTime> next_event() const override;
  [[nodiscard]] std::optional<SimTime> next_delivery_bound() const override;
  [[nodiscard]] std::uint32_t node_count() const override {
    return static_cast<std::uint32_t>(nodes_.size());
  }
  [[nodiscard]] std::uint32_t queue_places() const override { return queue_frames_; }
  [[nodiscard]] const Tally& tally(std::uint32_t node) const override { return nodes_[node].tally; }
  [[nodiscard]] std::uint64_t events() const override { return events_; }

 private:
  struct Node {
    std::deque<std::uint32_t> queue;  ///< Frames; the front one is being sent.
    std::uint64_t transmissions{0};
    DecibelMilliwatt tx_power{};
    random::CounterStream draws{0, 0};
    Tally tally{};
  };
  /// A frame between offer() and finished().
  struct Frame {
    FrameReport report;
    SimTime queued_at{};
    Ppdu ppdu;
    std::uint32_t under_way{0};  ///< Copies that have not arrived, and its sending.
  };
  struct Step {
    enum class Kind : std::uint8_t { kOffer, kSent, kArrival };
    Kind kind{Kind::kOffer};
    LossCause cause{LossCause::kNone};  ///< Of an arrival.
    std::uint32_t frame{0};
    std::uint32_t receiver{0};  ///< Of an arrival.
  };

  void enqueue(std::uint32_t frame);
  void send_next(std::uint32_t node);
  void spread(std::uint32_t frame, const std::vector<Eigen::Vector3d>& positions);
  void schedule_arrival(std::uint32_t frame, std::uint32_t receiver, double distance_m);
  void arrive(const Step& step);
  void end(std::uint32_t frame, SendOutcome outcome);
  void release(std::uint32_t frame);
  [[nodiscard]] const Mode& mode_of(const FrameReport& report) const;

  IdealParameters ideal_;
  const Mode* data_mode_;
  const Mode* group_mode_;
  std::uint32_t queue_frames_;
  Duration queue_lifetime_;
  std::optional<Disruption> disruption_;
  PositionSource* positions_;
  AirListener* listener_;
  AirMonitor* monitor_;  ///< Nothing: nobody asks.

  EventQueue<Step> queue_;
  SimTime now_{};
  std::uint64_t events_{0};
  std::vector<Node> nodes_;
  SlotPool<Frame> frames_;
};

/// The air that the parameters ask for: an IdealAir where the MAC is "ideal", else an Air.
[[nodiscard]] std::unique_ptr<FrameCarrier> make_air(const AirParameters& parameters,
                                                     PositionSource& positions,
                                                     AirListener& listener,
                                                     AirMonitor* monitor = nullptr);

}  // namespace cuscus::netsim

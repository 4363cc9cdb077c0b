#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "common/posix/unique_fd.h"
#include "netsim/air/air.h"
#include "netsim/app/log_writer.h"
#include "proto/reception_log.h"

namespace cuscus::netsim {

/// Logs how every PPDU came out at every node that it was meant for, with its link budget term by
/// term, and what became of frames that never got so far. What it is told by an AirListener must
/// carry ids that no two frames share, none of them 0.
///
/// The budget is reckoned anew from the channel's pure terms and from where everybody was when the
/// PPDU began; its sum is the power that the air reckoned with.
class ReceptionLog final : public AirMonitor {
 public:
  /// Takes over a descriptor open for writing. `parameters` and `positions` are the air's own, and
  /// `positions` must outlive this object.
  ReceptionLog(posix::UniqueFd file, const AirParameters& parameters,
               std::span<const std::string> names, PositionSource& positions);

  void transmitted(const Ppdu& ppdu) override;
  void received(const Ppdu& ppdu, const Reception& reception) override;
  void unreached(const Ppdu& ppdu, std::uint32_t receiver) override;

  /// What an AirListener is told.
  void finished(const FrameReport& report);
  /// A frame that was delivered at `time` did not get into its receiver's interface.
  void copy_lost(std::uint64_t frame, std::uint32_t sender, std::uint32_t receiver, SimTime time,
                 logs::Cause cause);

  /// Writes what is left; nothing may be added any more. How many records the file lacks.
  std::uint64_t finish() { return writer_.finish(); }

 private:
  struct Format {
    void operator()(std::string& text, const logs::ReceptionLogRecord& record) const {
      text.append(reinterpret_cast<const char*>(&record), sizeof record);
    }
  };
  /// Where everybody was at one version of the positions.
  struct Poses {
    std::uint64_t version{0};
    std::vector<AntennaPose> nodes;
  };
  /// No PPDU lasts as long as this many changes of the positions, which come every millisecond.
  static constexpr std::size_t kKeptVersions = 64;

  [[nodiscard]] logs::LinkBudget budget(const Ppdu& ppdu, std::uint32_t receiver);

  bool ideal_;  ///< There is no channel: what is received has the sender's power.
  Channel channel_;
  LinkTerms links_;
  std::unique_ptr<const Antenna> antenna_;  ///< Nothing: isotropic.
  std::vector<AirNode> radios_;
  PositionSource* positions_;
  std::array<Poses, kKeptVersions> poses_{};
  LogWriter<logs::ReceptionLogRecord, Format> writer_;
};

}  // namespace cuscus::netsim

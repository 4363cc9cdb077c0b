#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "netsim/air/air.h"
#include "netsim/capture/ppdu_record.h"

namespace cuscus::netsim {

/// Makes of PPDUs what a monitor interface delivers: a radiotap header and the MPDU with its FCS.
class PpduEncoder {
 public:
  /// `addresses`: MAC addresses by node.
  PpduEncoder(const AirParameters& air, std::vector<std::uint64_t> addresses);

  /// Appends the PPDU. `ethernet` is the frame that it is sent for; of no account unless
  /// needs_payload(). A frame that failed has its FCS inverted.
  void append(std::vector<std::uint8_t>& octets, const PpduRecord& record,
              std::span<const std::uint8_t> ethernet) const;

 private:
  void append_header(std::vector<std::uint8_t>& octets, const PpduRecord& record) const;
  [[nodiscard]] std::uint64_t address_of(std::int32_t node,
                                         std::span<const std::uint8_t> ethernet) const;

  double carrier_hz_;
  double bandwidth_hz_;
  double noise_dbm_;
  bool acknowledges_;
  std::uint64_t bssid_;
  std::vector<double> tx_power_dbm_;  ///< By node.
  std::vector<std::uint64_t> addresses_;
};

/// Why the reception of a record failed, such as "lost: interference, SINR 3.2 dB, uav7 was on the
/// air"; empty for one that did not. `names`: of all nodes.
[[nodiscard]] std::string comment_of(const PpduRecord& record, std::span<const std::string> names);

}  // namespace cuscus::netsim

#pragma once

#include <cstdint>
#include <deque>
#include <memory>

#include "netsim/air/air_monitor.h"
#include "netsim/app/capture_files.h"
#include "netsim/app/frame_store.h"
#include "netsim/app/monitor_devices.h"

namespace cuscus::netsim {

/// Gives the PPDUs of a live air to captures and monitor interfaces, together with the Ethernet
/// frames that they carry, in the order in which they were on the air. A frame may be on the air
/// before it has been read from its TAP: then it, and all behind it, wait here.
class PpduRecorder final : public AirMonitor {
 public:
  /// `frames` must outlive this object; OfferedFrame::id is a number in it. Either of the others
  /// may be null.
  PpduRecorder(FrameStore& frames, std::unique_ptr<CaptureFiles> captures,
               std::unique_ptr<MonitorDevices> monitors)
      : frames_{&frames}, captures_{std::move(captures)}, monitors_{std::move(monitors)} {}

  void transmitted(const Ppdu& ppdu) override;
  void received(const Ppdu& ppdu, const Reception& reception) override;

  /// Hands on what waits and is complete. To be called often.
  void hand_over() {
    while (!waiting_.empty() && hand_over_first()) {
    }
  }
  /// Nothing more comes; what still waits is left out.
  void finish();

  // Null: none.
  [[nodiscard]] CaptureFiles* captures() { return captures_.get(); }
  [[nodiscard]] const CaptureFiles* captures() const { return captures_.get(); }
  [[nodiscard]] const MonitorDevices* monitors() const { return monitors_.get(); }

 private:
  /// Who wants a PPDU.
  struct Takers {
    bool captures;
    bool monitor;
  };
  struct Record {
    PpduRecord ppdu;
    Takers takers;
  };

  [[nodiscard]] Takers takers_of(std::uint32_t node, LossCause cause) const;
  void record(const Record& record);
  bool hand_over_first();
  void give(const Record& record);
  void leave_out(const Record& record);

  FrameStore* frames_;
  std::unique_ptr<CaptureFiles> captures_;
  std::unique_ptr<MonitorDevices> monitors_;
  std::deque<Record> waiting_;
};

}  // namespace cuscus::netsim

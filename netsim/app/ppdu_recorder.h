#pragma once

#include <cstdint>
#include <deque>
#include <memory>

#include "netsim/air/air_monitor.h"
#include "netsim/app/capture_files.h"
#include "netsim/app/frame_store.h"

namespace cuscus::netsim {

/// Gives the PPDUs of a live air to captures, together with the Ethernet frames that they carry,
/// in the order in which they were on the air. A frame may be on the air before it has been read
/// from its TAP: then it, and all behind it, wait here.
class PpduRecorder final : public AirMonitor {
 public:
  /// `frames` must outlive this object; OfferedFrame::id is a number in it.
  PpduRecorder(FrameStore& frames, std::unique_ptr<CaptureFiles> captures)
      : frames_{&frames}, captures_{std::move(captures)} {}

  void transmitted(const Ppdu& ppdu) override;
  void received(const Ppdu& ppdu, const Reception& reception) override;

  /// Hands on what waits and is complete. To be called often.
  void hand_over() {
    while (!waiting_.empty() && hand_over_first()) {
    }
  }
  /// Nothing more comes; what still waits is left out.
  void finish();

  /// Null: none.
  [[nodiscard]] CaptureFiles* captures() { return captures_.get(); }
  [[nodiscard]] const CaptureFiles* captures() const { return captures_.get(); }

 private:
  void record(const PpduRecord& record);
  bool hand_over_first();
  void give(const PpduRecord& record);
  void leave_out(const PpduRecord& record);

  FrameStore* frames_;
  std::unique_ptr<CaptureFiles> captures_;
  std::deque<PpduRecord> waiting_;
};

}  // namespace cuscus::netsim

#pragma once

#include "netsim/mac/mac.h"

namespace cuscus::netsim {

/// What a station knows of the medium: physical and virtual carrier sense and whether EIFS is due
/// (IEEE Std 802.11-2016, 10.3.2.1, 10.3.2.3.7 and 10.3.2.4).
class CarrierSense {
 public:
  /// `parameters` must outlive this object. The medium was idle before the run began.
  explicit CarrierSense(const MacParameters& parameters);

  void medium_busy();
  void medium_idle(SimTime now);
  void transmission_ended(SimTime now) { idle_since_ = now; }
  /// EIFS begins when the medium is idle after the frame that failed (10.3.2.3.7).
  void reception_failed(SimTime now);
  void reception_succeeded(SimTime now);
  /// Sets the NAV from a frame that ends now; false when it does not reach beyond the NAV.
  bool reserve(SimTime now, Duration duration, bool by_rts);
  /// An RTS came to nothing: the NAV goes back to what it was without it.
  void take_back(SimTime now);

  [[nodiscard]] bool busy() const { return busy_; }
  [[nodiscard]] bool reserved(SimTime now) const { return now < nav_until_; }
  /// From when on a station counts DIFS or AIFS. An EIFS that is due is in it: its end, less DIFS.
  [[nodiscard]] SimTime idle_since() const;

 private:
  const MacParameters* parameters_;
  bool busy_{false};
  SimTime idle_since_{};
  SimTime nav_until_{};
  SimTime nav_without_rts_{};
  bool eifs_due_{false};  ///< When the medium is idle again.
  SimTime eifs_until_{};  ///< End of an EIFS, less DIFS.
};

}  // namespace cuscus::netsim

#include "netsim/app/neighbour_readings.h"

#include <algorithm>

namespace cuscus::netsim {

void NeighbourReadings::received(const Ppdu& ppdu, const Reception& reception) {
  const MacFrame::Kind kind = ppdu.frame.kind;
  const bool names_transmitter = kind == MacFrame::Kind::kData || kind == MacFrame::Kind::kRts;
  auto& readings = readings_[reception.receiver];
  if (readings && names_transmitter && reception.cause == LossCause::kNone) {
    readings->heard(ppdu.frame.sender, to_ns(reception.time),
                    static_cast<float>(reception.power.value),
                    static_cast<float>((reception.power - noise_).value), ppdu.mode->rate_kbps);
  }
}

DecibelMilliwatt receiver_noise(const AirParameters& parameters) {
  const Standard& standard = standard_of(parameters.standard, parameters.dsss_preamble);
  return noise_floor(standard.bandwidth_hz, parameters.noise_figure);
}

DecibelMilliwatt reception_threshold(const AirParameters& parameters, DecibelMilliwatt noise) {
  return std::max({parameters.sensitivity, parameters.detection_minimum,
                   noise + parameters.detection_minimum_sinr});
}

}  // namespace cuscus::netsim

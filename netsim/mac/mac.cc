#include "netsim/mac/mac.h"

#include <algorithm>
#include <array>
#include <limits>
#include <stdexcept>
#include <string>

#include "netsim/mac/csma.h"
#include "netsim/mac/edca.h"
#include "netsim/mac/tdma.h"

namespace cuscus::netsim {

namespace {

/// The mode whose ACK is the longest that stations wait for (10.3.7, ACKTxTime): the lowest
/// mandatory one of DSSS if any frame is sent by it, else that of OFDM. Where nobody sends DSSS,
/// waiting for its ACKs would be for nothing.
const Mode& lowest_mode(const Standard& standard, const MacParameters& parameters,
                        std::span<const std::uint32_t> basic_rates_kbps) {
  const auto is_dsss = [](const Mode& mode) {
    return mode.modulation_class == ModulationClass::kDsss;
  };
  const bool dsss =
      is_dsss(*parameters.data_mode) || is_dsss(*parameters.group_mode) ||
      std::any_of(basic_rates_kbps.begin(), basic_rates_kbps.end(),
                  [&](std::uint32_t rate_kbps) { return is_dsss(standard.mode(rate_kbps)); });
  return *std::find_if(standard.modes.begin(), standard.modes.end(),
                       [&](const Mode& mode) { return mode.mandatory && is_dsss(mode) == dsss; });
}

std::unique_ptr<Mac> make_csma(const MacSetting& s, const AccessProfile& profile) {
  return std::make_unique<Csma>(s.node, *s.parameters, *s.host, *s.rates, s.draws, profile);
}

/// Every MAC by name: a new one is a class and a row here.
constexpr std::array kMacs{
    MacMaker{"dcf", [](const MacSetting& s) { return make_csma(s, dcf_access(*s.parameters)); }},
    MacMaker{"edca", [](const MacSetting& s) { return make_csma(s, edca_access(*s.parameters)); }},
    MacMaker{"tdma",
             [](const MacSetting& s) -> std::unique_ptr<Mac> {
               return std::make_unique<Tdma>(s.node, *s.parameters, *s.host);
             }},
    // Has no stations: make_air() makes another air for it, and asks nobody for a MAC.
    MacMaker{"ideal",
             [](const MacSetting& /*s*/) -> std::unique_ptr<Mac> {
               throw std::invalid_argument{"MAC 'ideal' is an air of its own (IdealAir)"};
             }},
};

}  // namespace

MacParameters MacParameters::from(const Standard& standard, Duration slot,
                                  std::uint32_t data_rate_kbps, std::uint32_t group_rate_kbps,
                                  std::span<const std::uint32_t> basic_rates_kbps,
                                  ControlAnswerRule rule) {
  MacParameters parameters;
  parameters.standard = &standard;
  for (const Mode& mode : standard.modes) {
    parameters.answers.push_back(&control_answer(standard, mode, basic_rates_kbps, rule));
  }
  parameters.slot = slot;
  parameters.sifs = standard.sifs;
  parameters.difs = standard.sifs + 2 * slot;
  parameters.cw_min = standard.cw_min;
  parameters.cw_max = standard.cw_max;
  parameters.data_mode = &standard.mode(data_rate_kbps);
  parameters.group_mode = &standard.mode(group_rate_kbps);
  const Mode& lowest = lowest_mode(standard, parameters, basic_rates_kbps);
  parameters.eifs = standard.sifs + airtime(lowest, kAckBytes) + parameters.difs;
  parameters.rts_mode = &parameters.answer_to(*parameters.data_mode);
  parameters.rts_threshold_bytes = std::numeric_limits<std::uint32_t>::max();
  return parameters;
}

std::unique_ptr<Mac> make_mac(std::string_view name, const MacSetting& setting,
                              std::span<const MacMaker> more) {
  return find_maker<MacMaker>("MAC", name, kMacs, more).make(setting);
}

}  // namespace cuscus::netsim

#include "netsim/capture/ppdu_encoder.h"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "netsim/capture/mac_frame.h"
#include "netsim/capture/radiotap.h"

namespace cuscus::netsim {
namespace {

using std::chrono::microseconds;

/// TSFT: the MPDU begins behind preamble and header of its PPDU.
std::uint64_t mac_time_us(const PpduRecord& record) {
  const Ppdu& ppdu = record.ppdu;
  const SimTime begins =
      record.own ? ppdu.begins : record.reception.time - (ppdu.ends - ppdu.begins);
  const PpduFormat& format = *ppdu.mode->format;
  const SimTime mpdu = begins + format.preamble + format.header;
  return static_cast<std::uint64_t>(std::chrono::floor<microseconds>(mpdu - SimTime{}).count());
}

/// 802.11, 16.2.2.3: the short preamble takes 72 us, the long one 144 us.
bool has_short_preamble(const Mode& mode) {
  constexpr microseconds kShort{72};
  return mode.modulation_class == ModulationClass::kDsss && mode.format->preamble == kShort;
}

std::uint32_t retries_of(const Ppdu& ppdu) {
  return ppdu.frame.kind == MacFrame::Kind::kData && ppdu.attempt > 1 ? ppdu.attempt - 1 : 0;
}

std::string_view text_of(LossCause cause) {
  switch (cause) {
    case LossCause::kNoise:
      return "noise";
    case LossCause::kInterference:
      return "interference";
    case LossCause::kJammed:
      return "jammed";
    default:
      return "not detected";
  }
}

}  // namespace

PpduEncoder::PpduEncoder(const AirParameters& air, std::vector<std::uint64_t> addresses)
    : carrier_hz_{air.channel.carrier_hz},
      bandwidth_hz_{standard_of(air.standard, air.dsss_preamble).bandwidth_hz},
      noise_dbm_{noise_floor(bandwidth_hz_, air.noise_figure).value},
      acknowledges_{air.mac != "tdma"},
      bssid_{air.standard == "802.11p" ? kWildcardBssid : kIbssBssid},
      addresses_{std::move(addresses)} {
  for (const AirNode& node : air.nodes) {
    tx_power_dbm_.push_back(node.tx_power.value);
  }
}

void PpduEncoder::append_header(std::vector<std::uint8_t>& octets, const PpduRecord& record) const {
  const Ppdu& ppdu = record.ppdu;
  const Mode& mode = *ppdu.mode;
  RadiotapHeader header;
  header.mac_time_us = mac_time_us(record);
  header.short_preamble = has_short_preamble(mode);
  header.bad_fcs = record.failed();
  header.rate_kbps = mode.rate_kbps;
  header.channel = radiotap_channel(carrier_hz_, bandwidth_hz_, mode.modulation_class);
  if (record.own) {
    const bool answered = needs_payload(ppdu) && ppdu.frame.receiver != kGroup && acknowledges_;
    header.transmitted = {
        .power_dbm = tx_power_dbm_[record.node], .no_ack = !answered, .retries = retries_of(ppdu)};
  } else {
    header.received = {.signal_dbm = record.reception.power.value, .noise_dbm = noise_dbm_};
  }
  append_radiotap(octets, header);
}

/// Whoever is no node is known by the destination of the Ethernet frame alone.
std::uint64_t PpduEncoder::address_of(std::int32_t node,
                                      std::span<const std::uint8_t> ethernet) const {
  if (node >= 0) {
    return addresses_[static_cast<std::size_t>(node)];
  }
  std::uint64_t address = 0;
  for (const std::uint8_t octet : ethernet.first<6>()) {
    address = address << 8U | octet;
  }
  return address;
}

void PpduEncoder::append(std::vector<std::uint8_t>& octets, const PpduRecord& record,
                         std::span<const std::uint8_t> ethernet) const {
  append_header(octets, record);
  const MacFrame& frame = record.ppdu.frame;
  if (frame.kind == MacFrame::Kind::kData) {
    append_data_frame(octets, {.ethernet = ethernet,
                               .bssid = bssid_,
                               .sequence = frame.sequence,
                               .retry = retries_of(record.ppdu) > 0,
                               .duration = frame.duration});
  } else {
    const ControlKind kind = frame.kind == MacFrame::Kind::kRts   ? ControlKind::kRts
                             : frame.kind == MacFrame::Kind::kCts ? ControlKind::kCts
                                                                  : ControlKind::kAck;
    append_control_frame(octets, {.kind = kind,
                                  .receiver = address_of(frame.receiver, ethernet),
                                  .transmitter = addresses_[frame.sender],
                                  .duration = frame.duration});
  }
  if (record.failed()) {
    for (std::uint8_t& octet : std::span{octets}.last(kFcsBytes)) {
      octet = static_cast<std::uint8_t>(~octet);
    }
  }
}

std::string comment_of(const PpduRecord& record, std::span<const std::string> names) {
  if (!record.failed()) {
    return {};
  }
  const Reception& reception = record.reception;
  std::string text = "lost: " + std::string{text_of(reception.cause)};
  if (std::isfinite(reception.sinr.value)) {
    std::array<char, 32> sinr{};
    std::snprintf(sinr.data(), sinr.size(), ", SINR %.1f dB", reception.sinr.value);
    text += sinr.data();
  }
  if (reception.interferer < names.size()) {
    text += ", " + names[reception.interferer] + " was on the air";
  }
  return text;
}

}  // namespace cuscus::netsim

// ns3_tap_bridge: N ad-hoc 802.11g stations in ns-3's real-time mode, one per existing TAP device
// tap0 ... tap<N-1> of the current network namespace. The comparison for scripts/bench-ns3: what
// the same air costs and delays in ns-3 3.37. Written on ns-3's public API.
//
// usage: ns3_tap_bridge N RATE_MBPS DURATION_S

#include <ns3/core-module.h>
#include <ns3/mobility-module.h>
#include <ns3/network-module.h>
#include <ns3/propagation-module.h>
#include <ns3/tap-bridge-module.h>
#include <ns3/wifi-module.h>

#include <cstdlib>
#include <iostream>
#include <string>

int main(int argc, char* argv[]) {
  if (argc != 4) {
    std::cerr << "usage: ns3_tap_bridge N RATE_MBPS DURATION_S\n";
    return 2;
  }
  const auto count = static_cast<uint32_t>(std::stoul(argv[1]));
  const std::string mode = "ErpOfdmRate" + std::string{argv[2]} + "Mbps";
  const std::string control = std::stoi(argv[2]) >= 24 ? "ErpOfdmRate24Mbps" : "ErpOfdmRate6Mbps";

  ns3::GlobalValue::Bind("SimulatorImplementationType",
                         ns3::StringValue("ns3::RealtimeSimulatorImpl"));
  ns3::GlobalValue::Bind("ChecksumEnabled", ns3::BooleanValue(true));

  ns3::NodeContainer nodes;
  nodes.Create(count);
  ns3::MobilityHelper mobility;
  mobility.SetMobilityModel("ns3::ConstantPositionMobilityModel");
  mobility.Install(nodes);

  ns3::YansWifiChannelHelper channel;
  channel.SetPropagationDelay("ns3::ConstantSpeedPropagationDelayModel");
  channel.AddPropagationLoss("ns3::FixedRssLossModel", "Rss", ns3::DoubleValue(-50.0));
  ns3::YansWifiPhyHelper phy;
  phy.SetChannel(channel.Create());
  phy.SetErrorRateModel("ns3::NistErrorRateModel");
  ns3::WifiMacHelper mac;
  mac.SetType("ns3::AdhocWifiMac");
  ns3::WifiHelper wifi;
  wifi.SetStandard(ns3::WIFI_STANDARD_80211g);
  wifi.SetRemoteStationManager("ns3::ConstantRateWifiManager", "DataMode", ns3::StringValue(mode),
                               "ControlMode", ns3::StringValue(control), "NonUnicastMode",
                               ns3::StringValue(mode));
  const ns3::NetDeviceContainer devices = wifi.Install(phy, mac, nodes);

  ns3::TapBridgeHelper tap;
  tap.SetAttribute("Mode", ns3::StringValue("UseLocal"));
  for (uint32_t i = 0; i < count; ++i) {
    tap.SetAttribute("DeviceName", ns3::StringValue("tap" + std::to_string(i)));
    tap.Install(nodes.Get(i), devices.Get(i));
  }

  ns3::Simulator::Stop(ns3::Seconds(std::stod(argv[3])));
  ns3::Simulator::Run();
  ns3::Simulator::Destroy();
  return 0;
}

#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "common/scenario/city_section.h"
#include "common/scenario/ipv4.h"
#include "common/scenario/override.h"
#include "common/scenario/vehicle_section.h"
#include "common/units/decibel.h"
#include "common/units/sim_time.h"

/// What a scenario file says, checked, in SI units, defaults filled in. docs/scenario.md describes
/// every key; the members here have the keys' names with their units.
namespace cuscus::scenario {

using Duration = SimClock::duration;

/// UAVs that one scenario may have.
inline constexpr std::uint32_t kMaxUavs = 1000;
/// The same with its ground station.
inline constexpr std::uint32_t kMaxNodes = 1000;

struct FriisPropagation {};

struct LogDistancePropagation {
  double exponent{3.0};
  /// At 1 m; nothing: free-space loss at 1 m.
  std::optional<Decibel> reference_loss;
};

/// Equation 1 of the CUSCUS paper (doi 10.1016/j.adhoc.2017.09.004).
struct PaperPropagation {
  double alpha{20.0};
  double chi_dB2{0.0};       ///< Variance of Psi.
  Decibel outer_wall{12.0};  ///< Of each outer wall of an obstacle.
  Decibel inner_wall{5.0};   ///< Of each inner one.
};

enum class Ground { kVeryDry, kMediumDry, kWet };
enum class Polarisation { kVertical, kHorizontal };

/// A direct ray and one reflected by the ground.
struct TwoRayPropagation {
  Ground ground{Ground::kMediumDry};
  Polarisation polarisation{Polarisation::kVertical};
  double roughness_m{0.0};
};

enum class CanyonBound { kLower, kMiddle, kUpper };

/// Along a street, below the roofs: Recommendation ITU-R P.1411.
struct StreetCanyonPropagation {
  CanyonBound bound{CanyonBound::kMiddle};
};

/// How a model that knows only how likely line of sight is decides on a link.
struct LineOfSight {
  bool mean{false};  ///< The mean of both losses instead of a draw.
  double decorrelation_m{50.0};
};

enum class BuiltUpArea { kSuburban, kUrban, kDenseUrban, kHighRise };

struct AlHouraniPropagation {
  BuiltUpArea environment{BuiltUpArea::kUrban};
  LineOfSight line_of_sight;
};

enum class AerialArea { kRuralMacro, kUrbanMacro, kUrbanMicro };

/// 3GPP TR 36.777.
struct Tr36777Propagation {
  AerialArea area{AerialArea::kUrbanMacro};
  LineOfSight line_of_sight;
};

using Propagation =
    std::variant<FriisPropagation, LogDistancePropagation, PaperPropagation, TwoRayPropagation,
                 StreetCanyonPropagation, AlHouraniPropagation, Tr36777Propagation>;

/// Whether the model stands in for a map by chance of line of sight: it must not meet one.
[[nodiscard]] inline bool draws_line_of_sight(const Propagation& propagation) {
  return std::holds_alternative<AlHouraniPropagation>(propagation) ||
         std::holds_alternative<Tr36777Propagation>(propagation);
}

struct Shadowing {
  double deviation_dB{4.0};
  double decorrelation_m{20.0};
};

/// Rice; Rayleigh where there is no direct wave.
struct RiceFading {
  std::optional<Decibel> k_factor{Decibel{5.0}};  ///< At the horizon; nothing: Rayleigh.
  Decibel k_factor_overhead{15.0};
  double residual_doppler_Hz{1.0};
};

struct NakagamiFading {
  double m{1.0};
};

struct NoFading {};

using Fading = std::variant<NoFading, RiceFading, NakagamiFading>;

/// Evenly spaced walls within an obstacle.
struct InnerWalls {
  double spacing_m{5.0};
  Decibel loss{5.0};  ///< Of one.
};

/// A box that stands on the ground, for radio waves only.
struct BoxObstacle {
  std::string name;
  std::array<double, 2> centre_m{};
  std::array<double, 3> size_m{};  ///< Length, width, height.
  double heading_rad{0.0};         ///< Of the length, counter-clockwise from east.
  Decibel outer_wall{12.0};        ///< Of one wall, and of the roof.
  std::optional<InnerWalls> inner_walls;
};

enum class RadioStandard { k80211a, k80211b, k80211g, k80211p };
/// From which basic rates ACK and CTS are taken.
enum class ControlAnswer { kSameClass, kAnyClass };
enum class RateControl { kConstant, kIdeal, kAarf, kMinstrel };
enum class DsssPreamble { kLong, kShort };
enum class ErrorModel { kNist, kYans, kTable };

struct PreambleDetection {
  DecibelMilliwatt minimum_power{-82.0};
  Decibel minimum_sinr{4.0};
};

/// SINR from which a later frame takes the receiver from the one that it is locked on.
struct Capture {
  Decibel preamble{5.0};         ///< During that one's preamble.
  std::optional<Decibel> frame;  ///< After it; nothing: never.
};

/// Distributed coordination function: listen before talk.
struct DcfMac {};

/// How frames of one access category contend.
struct EdcaCategory {
  std::uint32_t aifsn{};  ///< Slots after SIFS.
  std::uint32_t cw_min{};
  std::uint32_t cw_max{};
};

/// Enhanced distributed channel access: the DCF with priorities.
struct EdcaMac {
  EdcaCategory background;
  EdcaCategory best_effort;
  EdcaCategory video;
  EdcaCategory voice;
};

/// Time division multiple access.
struct TdmaMac {
  Duration slot{std::chrono::microseconds{2500}};
  Duration guard{std::chrono::microseconds{10}};
  /// Names of the slots' owners, kNoOwner where there is none. Empty: every node in turn.
  std::vector<std::string> frame;
};
inline constexpr std::string_view kNoOwner = "-";

/// No medium at all: rate, delay, loss and range.
struct IdealMac {
  Duration delay{0};
  Duration jitter{0};
  double loss{0.0};               ///< Probability.
  std::optional<double> range_m;  ///< Nothing: unlimited.
};

using Mac = std::variant<DcfMac, EdcaMac, TdmaMac, IdealMac>;

/// Whether receivers confirm what they get.
[[nodiscard]] inline bool acknowledges(const Mac& mac) {
  return std::holds_alternative<DcfMac>(mac) || std::holds_alternative<EdcaMac>(mac);
}

struct IsotropicAntenna {};
struct DipoleAntenna {};  ///< Half-wave, along the body's z axis.
/// Rows of one elevation each, from -90 to 90 degrees; in a row by azimuth, from 0 degrees (ahead)
/// counter-clockwise; both evenly spaced.
struct PatternAntenna {
  std::vector<std::vector<double>> gains_dBi;
};

using Antenna = std::variant<IsotropicAntenna, DipoleAntenna, PatternAntenna>;

/// For a part of every interval nobody receives anything: the paper's network disruption.
struct Disruption {
  double fraction{0.4};  ///< The paper's gamma.
  Duration interval{std::chrono::seconds{1}};
  std::optional<Duration> phase{Duration{0}};  ///< Offset in the interval; nothing: at random.
};

/// A located source of noise.
struct Jammer {
  std::string name;
  std::array<double, 3> position_m{};
  DecibelMilliwatt power{20.0};        ///< EIRP.
  std::optional<double> frequency_hz;  ///< Nothing: the channel's.
  double bandwidth_hz{20e6};
  double duty{1.0};  ///< Of every period.
  Duration period{std::chrono::milliseconds{10}};
  Duration start{0};
  std::optional<Duration> stop;  ///< Nothing: never.
};

/// What walls of a city's buildings lose.
enum class WallModel { kPaper, kP2040 };

struct Radio {
  RadioStandard standard{RadioStandard::k80211g};
  std::uint32_t data_rate_kbps{6000};   ///< Individually addressed frames.
  std::uint32_t group_rate_kbps{6000};  ///< Broadcast and multicast frames.
  RateControl rate_control{RateControl::kConstant};
  std::vector<std::uint32_t> basic_rates_kbps{6000, 12000, 24000};
  ControlAnswer control_answer{ControlAnswer::kSameClass};
  DsssPreamble dsss_preamble{DsssPreamble::kLong};  ///< Of DSSS and CCK rates.
  double channel_frequency_hz{2.437e9};
  DecibelMilliwatt tx_power{16.0};
  Decibel antenna_gain{0.0};  ///< Besides the antenna's.
  Antenna antenna{IsotropicAntenna{}};
  Decibel noise_figure{7.0};
  Duration slot{std::chrono::microseconds{20}};
  std::uint32_t retry_limit{7};       ///< Attempts of RTS, and of data without.
  std::uint32_t long_retry_limit{7};  ///< Attempts of data after an RTS.
  /// PSDUs above this many bytes are sent after RTS and CTS; nothing: none is.
  std::optional<std::uint32_t> rts_threshold_bytes;
  Mac mac{DcfMac{}};
  std::uint32_t queue_frames{500};
  Duration queue_lifetime{std::chrono::milliseconds{500}};
  ErrorModel error_model{ErrorModel::kNist};
  DecibelMilliwatt cca_preamble{-82.0};
  DecibelMilliwatt cca_energy{-62.0};
  /// Nothing: every frame is attempted, however weak.
  std::optional<PreambleDetection> preamble_detection{PreambleDetection{}};
  std::optional<Capture> capture;
  Propagation propagation{FriisPropagation{}};
  std::optional<Shadowing> shadowing;
  Fading fading{NoFading{}};
  std::optional<Disruption> disruption;
  std::vector<BoxObstacle> obstacles;
  WallModel walls{WallModel::kPaper};  ///< Of the city.
  std::vector<Jammer> jammers;
};

enum class Attach { kBridge, kDirect };
enum class AddressResolution { kStatic, kArp };

struct Network {
  Subnet subnet{.network = 0x0a2a0000, .prefix_length = 16};  // 10.42.0.0/16
  Attach attach{Attach::kBridge};
  AddressResolution neighbours{AddressResolution::kStatic};
  bool ipv6{false};
  std::uint32_t mtu_bytes{1500};
  bool hosts{true};     ///< Every node finds the others by name.
  bool monitor{false};  ///< mon0 is up from the start.
};

/// Compiegne, where FL-AIR is at home.
inline constexpr city::Geodetic kDefaultSite{
    .latitude_deg = 49.4, .longitude_deg = 2.8, .height_m = 40.0};

struct World {
  Duration step{std::chrono::milliseconds{1}};
  double gravity_mps2{9.81};
  Duration imu_period{std::chrono::milliseconds{5}};
  // PX4's gz-classic IMU at 200 Hz: 8.7266e-4 rad/s/rtHz and 6.37e-3 m/s^2/rtHz, rounded.
  double gyro_noise_radps{0.0125};
  double accelerometer_noise_mps2{0.09};
  Duration motion_capture_period{std::chrono::milliseconds{10}};
  double motion_capture_noise_m{0.0002};
  double motion_capture_noise_rad{0.001};
  /// When the run begins, for the satellites of GNSS.
  std::chrono::sys_seconds epoch{std::chrono::sys_days{std::chrono::year{2026} / 1 / 1} +
                                 std::chrono::hours{12}};
  /// Where on Earth the origin is; nothing: where the city is, else kDefaultSite.
  std::optional<city::Geodetic> site;
};

/// A position in the world frame W: ENU, z = 0 on the ground [m].
using Position_m = std::array<double, 3>;

struct CircleLayout {
  double radius_m{20.0};
  Position_m centre_m{};
};

/// As square as it can be, rows from south to north.
struct GridLayout {
  double spacing_m{2.0};
  Position_m centre_m{};
};

struct LineLayout {
  double spacing_m{2.0};
  Position_m centre_m{};
  double direction_rad{0.0};  ///< Counter-clockwise from east.
};

struct ListLayout {
  std::vector<Position_m> positions_m;
};

struct Start {
  std::variant<CircleLayout, GridLayout, LineLayout, ListLayout> layout{GridLayout{}};
  double heading_rad{0.0};  ///< Counter-clockwise from east.
};

struct CircleMission {
  std::array<double, 2> centre_m{};
  double radius_m{20.0};
  double altitude_m{10.0};
  double speed_mps{2.0};
  double spacing_gain{0.2};  ///< Angular speed per radian of spacing error [1/s].
};

enum class NeighbourSource { kBeacons, kMotionCapture };

struct Neighbours {
  NeighbourSource source{NeighbourSource::kBeacons};
  Duration beacon_period{std::chrono::milliseconds{50}};
  Duration timeout{std::chrono::milliseconds{500}};
  std::uint16_t port{0};
};

/// What a UAV's program means for the run when it ends early with an error or a signal.
enum class OnExit { kFail, kMark, kIgnore };

/// UAVs of one kind: one formation, named <name>0, <name>1, ...
struct Group {
  std::string name;
  std::uint32_t count{1};
  Vehicle vehicle;
  Start start;
  bool autopilot{true};
  std::optional<CircleMission> mission;
  Neighbours neighbours;
  Duration control_period{std::chrono::milliseconds{5}};
  Duration telemetry_period{std::chrono::milliseconds{200}};
  /// A program on the SDK and its arguments, which flies the UAV instead of cuscus-agent; as
  /// `command` below. Empty: cuscus-agent.
  std::vector<std::string> agent;
  /// The group's own program and its arguments, with placeholders; empty: none. The executable is
  /// absolute, or a name without '/' to be searched in PATH.
  std::vector<std::string> command;
  std::map<std::string, std::string> environment;  ///< Of both; values have placeholders.
  std::vector<std::string> capabilities;           ///< Of the command: "cap_net_raw", ...
  OnExit on_exit{OnExit::kMark};

  [[nodiscard]] bool is_fixed() const { return std::holds_alternative<FixedVehicle>(vehicle); }
};

struct GroundStation {
  bool enabled{true};
  Position_m position_m{0.0, 0.0, 1.0};
  std::uint16_t telemetry_port{47000};
  /// Port of the operator's page on 127.0.0.1; nothing: no page.
  std::optional<std::uint16_t> page_port{8080};
};

/// Name of the ground station's node.
inline constexpr std::string_view kGroundStationName = "gcs";

/// Of what radios send and receive, a file per node.
struct Captures {
  bool everyone{false};
  std::vector<std::string> nodes;                  ///< Unless it is everyone.
  bool failed_receptions{false};                   ///< Also those that failed by their FCS.
  std::optional<std::uint32_t> snap_length_bytes;  ///< Of a packet; nothing: all of it.
};

struct Record {
  bool frames{false};      ///< A line per frame on the air.
  bool receptions{false};  ///< How every frame came out at every node that it was meant for.
  Captures captures;
  Duration metrics_period{std::chrono::milliseconds{100}};
};

enum class ClockSource { kReal };

/// What follows from a host that does not keep up.
enum class OnLate {
  kWarn,  ///< A warning; the verdict says the rest.
  kFail,  ///< And the run counts as failed unless its verdict is VALID.
  kStop,  ///< It ends as soon as it cannot become VALID any more.
};

struct Scenario {
  std::string name;
  std::string description;
  std::uint64_t seed{1};
  Duration duration{std::chrono::seconds{60}};
  ClockSource clock{ClockSource::kReal};
  bool realtime{true};  ///< Ask for SCHED_FIFO.
  OnLate on_late{OnLate::kWarn};
  std::optional<CitySection> city;
  Radio radio;
  Network network;
  World world;
  std::vector<Group> fleet;
  GroundStation ground_station;
  Record record;
  /// Absolute folder of the scenario file, {scenario_dir} in commands. Not a key.
  std::filesystem::path folder;

  [[nodiscard]] std::uint32_t uav_count() const;
  /// UAVs, and the ground station when there is one.
  [[nodiscard]] std::uint32_t node_count() const;
};

/// Reads, checks and fills in the scenario in `file`.
/// @throws ScenarioError with every problem found.
[[nodiscard]] Scenario load_scenario(const std::filesystem::path& file,
                                     std::span<const Override> overrides = {});

/// The same for `text`; `source` names it in messages, and `folder`, absolute, is where relative
/// executables are looked for.
[[nodiscard]] Scenario parse_scenario(std::string_view text, const std::string& source,
                                      const std::filesystem::path& folder,
                                      std::span<const Override> overrides = {});

/// The scenario with every key written out. Parsing it gives the same scenario again.
[[nodiscard]] nlohmann::ordered_json to_json(const Scenario& scenario);

/// Name of UAV `member` of `group`: "uav3".
[[nodiscard]] std::string uav_name(const Group& group, std::uint32_t member);

/// Where the members of `group` start, in order.
[[nodiscard]] std::vector<Position_m> start_positions(const Group& group);

/// Rates of `standard` [kb/s], rising.
[[nodiscard]] std::span<const std::uint32_t> rates_kbps(RadioStandard standard);

/// What a radio of that standard has where a scenario says nothing else.
[[nodiscard]] Radio default_radio(RadioStandard standard);

/// EDCA's parameters where a scenario says nothing else: IEEE Std 802.11-2016, table 9-137, and
/// 9-138 for 802.11p.
[[nodiscard]] EdcaMac default_edca(RadioStandard standard);

/// Time on air of a frame whose IP packet has `ip_bytes`, preamble and signal extension included.
///
/// OFDM: 20 us + 4 us ceil((16 + 8 L + 6) / N_DBPS), 6 us more in 802.11g, all of it doubled in
/// 802.11p; DSSS: 192 us (96 us with a short preamble) + 8 L / R, with L the PSDU: 24 B of header
/// (26 B with EDCA), 8 B of LLC/SNAP, the packet, 4 B of FCS.
/// Source: IEEE Std 802.11-2020, 18.3.2.4 and 17.3.2 (equation 17-29), 16.3.4.
[[nodiscard]] double airtime_s(const Radio& radio, std::uint32_t ip_bytes, std::uint32_t rate_kbps);
[[nodiscard]] double psdu_airtime_s(const Radio& radio, std::uint32_t psdu_bytes,
                                    std::uint32_t rate_kbps);
/// MAC header, LLC/SNAP and FCS around an IP packet.
[[nodiscard]] std::uint32_t psdu_bytes(const Radio& radio, std::uint32_t ip_bytes);

/// The JSON schema of scenarios (draft-07), as it is in scenarios/scenario.schema.json.
[[nodiscard]] std::string_view scenario_schema();

}  // namespace cuscus::scenario

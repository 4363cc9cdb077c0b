#include "netsim/app/replay.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <ostream>
#include <span>
#include <sstream>
#include <stdexcept>

#include "netsim/air/ideal_air.h"
#include "netsim/app/city_of_message.h"

namespace cuscus::netsim {
namespace {

/// Positions that change at recorded instants.
class RecordedPositions final : public PositionSource {
 public:
  RecordedPositions(const std::vector<PositionRecord>& records, std::size_t nodes)
      : records_{&records}, p_WN_(nodes, Eigen::Vector3d::Zero()) {}

  const std::vector<Eigen::Vector3d>& positions(SimTime now) override {
    while (next_ < records_->size() && (*records_)[next_].time_ns <= to_ns(now)) {
      p_WN_[(*records_)[next_].node] = (*records_)[next_].p_WN;
      ++next_;
      ++version_;
    }
    return p_WN_;
  }
  [[nodiscard]] std::uint64_t version() const override { return version_; }

 private:
  const std::vector<PositionRecord>* records_;
  std::vector<Eigen::Vector3d> p_WN_;
  std::size_t next_{0};
  std::uint64_t version_{1};
};

void add(ReplaySum& sum, std::int64_t sent_ns, std::uint32_t attempts, std::uint32_t deliveries,
         std::int64_t first_delivery_ns) {
  ++sum.frames;
  sum.attempts += attempts;
  sum.deliveries += deliveries;
  if (deliveries > 0) {
    ++sum.frames_delivered;
    sum.delay_sum_us += static_cast<double>(first_delivery_ns - sent_ns) / 1e3;
  }
}

/// Adds up what the simulation makes of the log's frames.
class Sum final : public AirListener {
 public:
  Sum(ReplayResult& result, const ReplayLog& log, std::ostream* receptions)
      : result_{&result}, log_{&log}, receptions_{receptions} {
    if (receptions_ != nullptr) {
      *receptions_ << "frame,sender,sent_ns,receiver,delivery_ns\n";
    }
  }

  void delivered(const Delivery& delivery) override {
    if (receptions_ != nullptr) {
      *receptions_ << delivery.id << ',' << delivery.sender << ','
                   << log_->frames[delivery.id].sent_ns << ',' << delivery.receiver << ','
                   << to_ns(delivery.time) << '\n';
    }
  }
  void finished(const FrameReport& report) override {
    auto& cast = report.destination == kGroup ? result_->group : result_->individual;
    add(cast.simulated, to_ns(report.sent_at), report.attempts, report.deliveries,
        to_ns(report.first_delivery));
  }

 private:
  ReplayResult* result_;
  const ReplayLog* log_;
  std::ostream* receptions_;
};

std::vector<PositionRecord> read_positions(const std::string& path, std::size_t nodes) {
  std::ifstream file{path};
  std::vector<PositionRecord> records;
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    if (line.empty() || line.front() == '#' || line.compare(0, 7, "time_ns") == 0) {
      continue;
    }
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream text{line};
    PositionRecord r{};
    if (!(text >> r.time_ns >> r.node >> r.p_WN.x() >> r.p_WN.y() >> r.p_WN.z()) ||
        r.node >= nodes) {
      throw std::runtime_error{path + ":" + std::to_string(number) +
                               ": expected time_ns,node,x_m,y_m,z_m with a node below " +
                               std::to_string(nodes)};
    }
    records.push_back(r);
  }
  std::stable_sort(records.begin(), records.end(),
                   [](const auto& a, const auto& b) { return a.time_ns < b.time_ns; });
  return records;
}

/// The file is beside the log, whatever the log says.
void read_city(const std::filesystem::path& file, AirParameters& air) {
  std::ifstream stream{file, std::ios::binary};
  const std::string bytes{std::istreambuf_iterator<char>{stream}, {}};
  if (!stream) {
    throw std::runtime_error{file.string() + ": the log's city cannot be read"};
  }
  try {
    put_city(std::as_bytes(std::span{bytes}), air.channel);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error{file.string() + ": " + error.what()};
  }
}

}  // namespace

ReplayLog read_replay_log(const std::string& path, const std::string& positions_path) {
  std::ifstream file{path};
  ReplayLog log;
  std::string line;
  for (std::size_t number = 1; std::getline(file, line); ++number) {
    if (file.eof()) {
      break;  // cut: each whole line ends with a newline
    }
    if (line.empty() || line.compare(0, 7, "sent_ns") == 0) {
      continue;
    }
    if (line.front() == '#') {
      try {
        parse_frame_log_header(line, log.air);
      } catch (const std::invalid_argument& error) {
        throw std::runtime_error{path + ":" + std::to_string(number) + ": " + error.what()};
      }
      continue;
    }
    const auto record = parse_frame_record(line);
    if (!record || record->node >= log.air.nodes.size() ||
        record->destination >= static_cast<std::int32_t>(log.air.nodes.size()) ||
        record->frame_bytes < kEthernetHeaderBytes) {
      throw std::runtime_error{path + ":" + std::to_string(number) + ": not a frame record of a " +
                               std::to_string(log.air.nodes.size()) + "-node log"};
    }
    log.frames.push_back(*record);
  }
  if (log.air.nodes.empty()) {
    throw std::runtime_error{path + ": not a frame log: no '# nodes=' line"};
  }
  std::stable_sort(log.frames.begin(), log.frames.end(),
                   [](const auto& a, const auto& b) { return a.sent_ns < b.sent_ns; });
  if (!log.air.channel.city_file.empty() && !positions_path.empty()) {
    const auto name = std::filesystem::path{log.air.channel.city_file}.filename();
    read_city(std::filesystem::path{path}.replace_filename(name), log.air);
  }
  if (!positions_path.empty()) {
    log.positions = read_positions(positions_path, log.air.nodes.size());
  }
  return log;
}

ReplayResult replay(const ReplayLog& log, DecibelMilliwatt equal_power, std::ostream* receptions) {
  AirParameters parameters = log.air;
  parameters.channel.seed = parameters.seed;
  if (log.positions.empty()) {
    // Where walls and jammers are means nothing without where the nodes are.
    parameters.channel.obstacles.clear();
    parameters.channel.city.reset();
    parameters.jammers.clear();
    parameters.channel.model = "fixed";
    parameters.channel.reference_loss = parameters.nodes.front().tx_power - equal_power;
  }
  ReplayResult result;
  Sum sum{result, log, receptions};
  RecordedPositions positions{log.positions, parameters.nodes.size()};
  const auto simulated = make_air(parameters, positions, sum);
  std::int64_t last_ns = 0;
  std::uint64_t number = 0;
  for (const FrameRecord& frame : log.frames) {
    // The simulation is kept just behind the sends, so that its queue stays short.
    simulated->run_until(sim_time(std::max<std::int64_t>(0, frame.sent_ns - 1)));
    simulated->offer(frame.node, sim_time(frame.sent_ns),
                     {.id = number++,
                      .destination = frame.destination,
                      .psdu_bytes = psdu_bytes_of_ethernet(frame.frame_bytes),
                      .priority = frame.priority});
    last_ns = frame.sent_ns;
    add(frame.destination == kGroup ? result.group.live : result.individual.live, frame.sent_ns,
        frame.attempts, frame.deliveries, frame.first_delivery_ns);
  }
  simulated->run_until(sim_time(last_ns) + std::chrono::seconds{10});
  for (std::uint32_t node = 0; node < simulated->node_count(); ++node) {
    result.tallies.push_back(simulated->tally(node));
  }
  return result;
}

void print_replay(std::ostream& out, const ReplayLog& log, const ReplayResult& result) {
  out << "cast,side,frames,attempts,deliveries,delivery_ratio,first_delivery_delay_mean_us\n";
  const auto line = [&](const char* cast, const char* side, const ReplaySum& sum,
                        double receivers) {
    const auto ratio = [](double a, double b) { return b > 0.0 ? a / b : 0.0; };
    out << cast << ',' << side << ',' << sum.frames << ',' << sum.attempts << ',' << sum.deliveries
        << ','
        << ratio(static_cast<double>(sum.deliveries), static_cast<double>(sum.frames) * receivers)
        << ',' << ratio(sum.delay_sum_us, static_cast<double>(sum.frames_delivered)) << '\n';
  };
  const double others = static_cast<double>(log.air.nodes.size()) - 1.0;
  line("group", "live", result.group.live, others);
  line("group", "simulated", result.group.simulated, others);
  line("individual", "live", result.individual.live, 1.0);
  line("individual", "simulated", result.individual.simulated, 1.0);
}

}  // namespace cuscus::netsim

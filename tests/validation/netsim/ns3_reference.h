#pragma once

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <cstdint>
#include <string>

#include "netsim/app/synthetic.h"
#include "tests/validation/netsim/csv.h"

/// What the comparisons with ns-3 3.37 share. What the reference files hold:
/// tests/validation/netsim/ns3-3.37/README.md.
namespace cuscus::netsim {

inline std::vector<CsvRow> reference(const std::string& file) {
  return read_csv(std::string{CUSCUS_NS3_REFERENCE} + '/' + file);
}

inline SyntheticParameters with_rate(double rate_mbps) {
  SyntheticParameters p;
  p.air.data_rate_kbps = static_cast<std::uint32_t>(rate_mbps * 1e3);
  p.air.group_rate_kbps = p.air.data_rate_kbps;
  return p;
}

/// Where the nodes of a reference's row stand.
inline Layout layout(const CsvRow& row) {
  if (row.at("layout") == "equalRSS-50") {
    return {.kind = Layout::Kind::kEqualPower};
  }
  REQUIRE(row.at("layout") == "circle10m-friis");
  return {.kind = Layout::Kind::kCircle, .circle_radius_m = 10.0};
}

/// Whether a measured value is the reference's, within its interval or 3 % of it.
inline bool agrees(double measured, double reference, double ci95) {
  return std::abs(measured - reference) <= std::max(ci95, 0.03 * std::abs(reference));
}

/// Mean of independent runs, and the half-width of its 95 % confidence interval.
class Sample {
 public:
  void add(double x) {
    ++count_;
    sum_ += x;
    squares_ += x * x;
  }
  [[nodiscard]] double mean() const { return sum_ / count_; }
  [[nodiscard]] double ci95() const {
    const double variance = (squares_ - sum_ * mean()) / (count_ - 1.0);
    return 1.96 * std::sqrt(std::max(variance, 0.0) / count_);
  }

 private:
  double count_{0.0};
  double sum_{0.0};
  double squares_{0.0};
};

/// Data frames that went on the air, of all nodes.
struct Attempts {
  double all{0.0};
  double repeated{0.0};
  double acknowledged{0.0};

  explicit Attempts(const SyntheticResult& result) {
    for (const Tally& tally : result.tallies) {
      all += static_cast<double>(tally.transmissions);
      repeated += static_cast<double>(tally.retries);
      acknowledged += static_cast<double>(tally.acknowledged);
    }
  }
};

}  // namespace cuscus::netsim

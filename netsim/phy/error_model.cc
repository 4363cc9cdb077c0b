#include "netsim/phy/error_model.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "netsim/phy/link_error_model.h"

namespace cuscus::netsim {
namespace {

double square_qam(double sinr_ratio, double points) {
  const double s = std::sqrt(points);
  return (s - 1.0) / (s * std::log2(s)) *
         std::erfc(std::sqrt(sinr_ratio / (2.0 * (points - 1.0) / 3.0)));
}

double coded_bit_error(Modulation modulation, double sinr_ratio) {
  switch (modulation) {
    case Modulation::kBpsk:
      return 0.5 * std::erfc(std::sqrt(sinr_ratio));
    case Modulation::kQpsk:
      return 0.5 * std::erfc(std::sqrt(sinr_ratio / 2.0));
    case Modulation::k16Qam:
      return square_qam(sinr_ratio, 16.0);
    case Modulation::k64Qam:
      return square_qam(sinr_ratio, 64.0);
    default:
      return 0.5;
  }
}

/// Σ weights[k] · x^k by Horner's rule.
template <std::size_t n>
double polynomial(const std::array<double, n>& weights, double x) {
  double sum = 0.0;
  for (std::size_t k = n; k-- > 0;) {
    sum = sum * x + weights[k];
  }
  return sum;
}

// Bit weights c_d of the code (133, 171) and its puncturings, from the free distance upwards: by
// steps of 2 from 10 at rate 1/2 (odd ones vanish), by steps of 1 from 6 at 2/3 and from 5 at 3/4.
constexpr std::array<double, 9> kHalfWeights{36.0,     211.0,     1404.0,     11633.0,    77433.0,
                                             502690.0, 3322763.0, 21292910.0, 134365911.0};
constexpr std::array<double, 10> kTwoThirdsWeights{
    3.0, 70.0, 285.0, 1276.0, 6160.0, 27128.0, 117019.0, 498860.0, 2103891.0, 8784123.0};
constexpr std::array<double, 10> kThreeQuartersWeights{
    42.0,     201.0,     1492.0,     10469.0,    62935.0,
    379644.0, 2253373.0, 13073811.0, 75152755.0, 428005675.0};

bool is_dsss(CodeRate code_rate) { return code_rate == CodeRate::kUncoded; }

double yans_coded_bit_error(Modulation modulation, double sinr_ratio) {
  constexpr double kBandwidth_MHz = 20.0;
  const auto qam = [&](double points, double coded_Mbps) {
    const double bits = std::log2(points);
    const double snr = sinr_ratio * kBandwidth_MHz / coded_Mbps;
    const double z = std::sqrt(1.5 * bits * snr / (points - 1.0));
    const double one_axis = (1.0 - 1.0 / std::sqrt(points)) * std::erfc(z);
    return (1.0 - (1.0 - one_axis) * (1.0 - one_axis)) / bits;
  };
  switch (modulation) {
    case Modulation::kBpsk:
      return 0.5 * std::erfc(std::sqrt(sinr_ratio * kBandwidth_MHz / 12.0));
    case Modulation::kQpsk:
      return qam(4.0, 24.0);
    case Modulation::k16Qam:
      return qam(16.0, 48.0);
    case Modulation::k64Qam:
      return qam(64.0, 72.0);
    default:
      return 0.5;
  }
}

/// Probability that a path at Hamming distance `d` is preferred to the right one.
double pairwise_error(double bit_error, int d) {
  double sum = 0.0;
  double binomial = 1.0;  // C(d, i)
  for (int i = 0; i <= d; ++i) {
    if (2 * i >= d) {
      const double share = 2 * i == d ? 0.5 : 1.0;
      sum += share * binomial * std::pow(bit_error, i) * std::pow(1.0 - bit_error, d - i);
    }
    binomial = binomial * (d - i) / (i + 1);
  }
  return sum;
}

template <typename Model>
std::unique_ptr<const ErrorModel> make() {
  return std::make_unique<Model>();
}

/// Every error model by name: a new one is a class and a row here.
constexpr std::array<ErrorModelMaker, 3> kErrorModels{{{"nist", make<NistErrorModel>},
                                                       {"yans", make<YansErrorModel>},
                                                       {"table", make<LinkErrorModel>}}};

}  // namespace

double NistErrorModel::bit_failure(Modulation modulation, CodeRate code_rate,
                                   double sinr_ratio) const {
  if (is_dsss(code_rate)) {
    return dsss_bit_failure(modulation, sinr_ratio);
  }
  const double p = coded_bit_error(modulation, sinr_ratio);
  const double d2 = 4.0 * p * (1.0 - p);
  const double d = std::sqrt(d2);
  const double d4 = d2 * d2;
  double bound = 0.0;
  switch (code_rate) {
    case CodeRate::kHalf:
      bound = 0.5 * d4 * d4 * d2 * polynomial(kHalfWeights, d2);
      break;
    case CodeRate::kTwoThirds:
      bound = 0.25 * d4 * d2 * polynomial(kTwoThirdsWeights, d);
      break;
    case CodeRate::kThreeQuarters:
      bound = d4 * d * polynomial(kThreeQuartersWeights, d) / 6.0;
      break;
    case CodeRate::kUncoded:
      break;  // above
  }
  return std::min(bound, 1.0);
}

double YansErrorModel::bit_failure(Modulation modulation, CodeRate code_rate,
                                   double sinr_ratio) const {
  if (is_dsss(code_rate)) {
    return dsss_bit_failure(modulation, sinr_ratio);
  }
  const double p = yans_coded_bit_error(modulation, sinr_ratio);
  const bool first_term_only = modulation == Modulation::kBpsk;
  double bound = 0.0;
  switch (code_rate) {
    case CodeRate::kHalf:
      bound = 11.0 * pairwise_error(p, 10);
      break;
    case CodeRate::kTwoThirds:
      bound = pairwise_error(p, 6) + 16.0 * pairwise_error(p, 7);
      break;
    case CodeRate::kThreeQuarters:
      bound = 8.0 * pairwise_error(p, 5);
      if (!first_term_only) {
        bound += 31.0 * pairwise_error(p, 6);
      }
      break;
    case CodeRate::kUncoded:
      break;  // above
  }
  return std::min(bound, 1.0);
}

std::unique_ptr<const ErrorModel> make_error_model(std::string_view name,
                                                   std::span<const ErrorModelMaker> more) {
  return find_maker<ErrorModelMaker>("error model", name, kErrorModels, more).make();
}

double log_success(double bit_failure, double bits) {
  if (bits <= 0.0) {
    return 0.0;
  }
  return bit_failure >= 1.0 ? -std::numeric_limits<double>::infinity()
                            : bits * std::log1p(-bit_failure);
}

}  // namespace cuscus::netsim

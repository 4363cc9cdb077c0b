#pragma once

#include "common/statistics/log2_histogram.h"
#include "proto/report.pb.h"

namespace cuscus::ipc {

/// `histogram` as a component reports it; bins above the longest duration are left out.
[[nodiscard]] proto::DurationSummary summary_of(const statistics::Log2Histogram& histogram);

}  // namespace cuscus::ipc

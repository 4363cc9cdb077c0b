#pragma once

#include <string>

#include "netsim/app/synthetic.h"
#include "proto/synthetic.pb.h"

namespace cuscus::netsim {

/// The run that `cuscus air` asks for.
/// @throws std::invalid_argument naming what is wrong and what is allowed.
[[nodiscard]] SyntheticParameters synthetic_parameters(const proto::SyntheticRun& run);

/// The kind of traffic called `name`: "beacons", "saturated", "flow", "ping".
/// @throws std::invalid_argument naming what is allowed.
[[nodiscard]] Traffic::Kind traffic_kind(const std::string& name);

}  // namespace cuscus::netsim
